"""``dh2urdf ik``: ``verb`` the options and the answers, ``poses`` the poses that are read."""

from dh2urdf.cli.verbs.ik.verb import ik_

__all__ = ["ik_"]
