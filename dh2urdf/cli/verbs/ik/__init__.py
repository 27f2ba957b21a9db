"""``dh2urdf ik`` and ``dh2urdf path``.

``verb`` has the options of ik, ``answers`` what is said of one pose, ``many`` of many, for which
``digits`` writes numbers; ``formulas`` are said of all; ``poses`` reads poses; ``path`` is the
other verb.
"""

from dh2urdf.cli.verbs.ik.verb import ik_

__all__ = ["ik_"]
