"""What else the arms that ship are called: ``panda``, ``kr6``, ``LBR iiwa 14 R820``."""

import difflib
import re
from functools import lru_cache
from pathlib import Path

FOLDER = Path(__file__).parents[1] / "robots"
"""Tables that ship, one YAML file an arm."""

_MAKERS = re.compile(
    "(?:abb|denso|doosan|fanuc|franka|kinova|kuka|mecademic|omron|staubli|techman|unitree|yaskawa)_"
)
_ALSO = {
    "abb_gofa5": "gofa crb15000_5_95",
    "abb_irb120": "irb120_3_58",
    "abb_irb460": "irb460_110_240",
    "ar4": "ar4_mk3 annin_ar4",
    "fanuc_lrmate200id": "lrmate",
    "fanuc_r1000ia80f": "r1000ia",
    "franka_fer": "panda franka franka_panda franka_emika_panda",
    "franka_fr3": "franka_research_3",
    "kinova_jaco2": "jaco j2n6s300",
    "kuka_iiwa14": "lbr_iiwa_14 lbr_iiwa_14_r820",
    "kuka_iiwa7": "lbr_iiwa_7 lbr_iiwa_7_r800",
    "kuka_kr16_2": "kr16",
    "kuka_kr6_r700": "kr6 kr6_r700_sixx",
    "lite6": "ufactory_lite6",
    "omron_cobra600": "ecobra600",
    "piper": "agilex_piper",
    "puma560": "puma p560",
    "so100": "so_arm100",
    "so101": "so_arm101",
    "stanford": "stanford_arm",
    "uf850": "ufactory850 xarm850",
    "yaskawa_gp7": "motoman_gp7",
}


@lru_cache(maxsize=1)
def list_tables() -> tuple[str, ...]:
    """Names of the tables that ship, sorted.

    Examples
    --------
    >>> from dh2urdf import list_tables
    >>> "ur5" in list_tables()
    True
    """
    return tuple(sorted(path.stem for path in FOLDER.glob("*.yaml")))


def other_names(name: str) -> tuple[str, ...]:
    """What else a table that ships is called, beside spellings such as ``UR-5e``."""
    short = _MAKERS.sub("", name)
    return (*([short] if short != name else []), *_ALSO.get(name, "").split())


@lru_cache(maxsize=1)
def _by_spelling() -> dict[str, tuple[str, str]]:
    """For each spelling a name that is written so, and the table's own."""
    every = [(also, name) for name in list_tables() for also in (name, *other_names(name))]
    return {_spelling(also): (also, name) for also, name in every}


def _spelling(text: str) -> str:
    return re.sub(r"[\s_.-]", "", text.casefold())


def shipped_name(text: str) -> str | None:
    """Name of the table that ships which a text means, in any spelling; None where it is none."""
    return _by_spelling().get(_spelling(text), (None, None))[1]


def near_names(text: str) -> list[str]:
    """Names of tables that ship which are like a text, nearest first, each table once."""
    close = difflib.get_close_matches(_spelling(text), _by_spelling(), 6, 0.6)
    near: dict[str, str] = {}
    for also, name in map(_by_spelling().__getitem__, close):
        near.setdefault(name, also)
    return list(near.values())[:3]
