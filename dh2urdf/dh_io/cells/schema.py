"""Which keys a table file has, what else they are called, and what those words might mean."""

import difflib
import re
import unicodedata
from collections.abc import Iterable, Mapping

from dh2urdf.dh import DHConvention, JointType
from dh2urdf.dh_io.cells.units import Kind

TABLE_KEYS = (
    "name", "source", "checked", "convention", "units", "constants", "base", "tool", "couplings",
    "joints",
)  # fmt: skip

ROW_KEYS = (
    "name",
    "type",
    "theta",
    "d",
    "a",
    "alpha",
    "sign",
    "mimic",
    "lower",
    "upper",
    "serial_lower",
    "serial_upper",
    "velocity",
    "effort",
    "damping",
    "friction",
    "mass",
    "com",
    "inertia",
    "inertia_frame",
    "xyz",
    "rpy",
)

MIMIC_KEYS = ("joint", "multiplier", "offset")  # fmt: skip

ROW_KINDS = {
    "theta": Kind.ANGLE,
    "d": Kind.LENGTH,
    "a": Kind.LENGTH,
    "alpha": Kind.ANGLE,
    "com": Kind.LENGTH,
    "xyz": Kind.LENGTH,
    "rpy": Kind.ANGLE,
}
"""What a row's cells measure; limits and ``velocity`` go by the joint's type."""

BY_TYPE = ("lower", "upper", "serial_lower", "serial_upper", "velocity")
"""What measures as the joint moves: lengths of one that slides, else angles."""

_ALIASES = {
    "theta": ("th", "θ", "ϑ", "joint_angle"),
    "d": ("link_offset",),
    "a": ("link_length",),
    "alpha": ("α", "al", "twist", "link_twist", "twist_angle"),
    "type": (
        "typ",
        "joint_type",
        "type_of_joint",
        "kind",
        "sigma",
        "σ",
        "r/p",
        "p/r",
        "rp",
        "r_or_p",
        "motion",
    ),
    "sign": ("direction",),
    "lower": ("min", "qmin", "q_min", "q_", "q-", "lower_limit", "limit_lower"),
    "upper": ("max", "qmax", "q_max", "q+", "upper_limit", "limit_upper"),
    "velocity": ("max_velocity", "velocity_limit", "speed", "vmax"),
    "effort": ("max_effort", "effort_limit", "torque", "max_torque"),
    "com": ("centre_of_mass", "center_of_mass", "cog", "centre_of_gravity", "center_of_gravity"),
    "joints": ("rows",),
    "couplings": ("coupling",),
    "mimic": ("mimics", "follows"),
}
_CANONICAL = {alias: key for key, aliases in _ALIASES.items() for alias in aliases}

MISUSED_KEYS = {
    "r": "r is a (link length) in some books and d (link offset) in others; write a or d",
    "offset": "an offset may be d (link offset) or the constant part of theta; write d or theta",
    "limits": "write lower and upper",
    "limit": "write lower and upper",
    "qlim": "write lower and upper",
    "range": "write lower and upper",
    "flip": "write sign: -1",
    "beta": "a beta (Hayati) is no DH parameter; write the step as a fixed row with xyz and rpy",
}

CONVENTIONS = {
    **dict.fromkeys(("standard", "sdh", "distal", "classic", "classical", "original", "paul",
                     "spong"), DHConvention.STANDARD),
    **dict.fromkeys(("modified", "mdh", "proximal", "craig", "khalil"), DHConvention.MODIFIED),
}  # fmt: skip

_TYPE_WORDS = {
    JointType.REVOLUTE: "revolute r rev rotary rotational rotation rot hinge 0",
    JointType.PRISMATIC: "prismatic p pris prism sliding slider linear translational trans 1",
    JointType.FIXED: "fixed f",
}
JOINT_TYPES = {word: kind for kind, words in _TYPE_WORDS.items() for word in words.split()}

FLAGS = {
    **dict.fromkeys(("r", "revolute", "is_revolute"), JointType.REVOLUTE),
    **dict.fromkeys(("p", "prismatic", "is_prismatic"), JointType.PRISMATIC),
}
"""Keys whose true says the type of the joint, and whose false says the other."""

TRUTHS = {"true": True, "yes": True, "false": False, "no": False}

_PREVIOUS = re.compile(r"_?(?:\(?[ijkn]_?[-−]_?1\)?)$")
_OWN = re.compile(r"_?\(?[ijkn]\)?$")
_MARKS = str.maketrans({**dict.fromkeys("\\${}", ""), "⍺": "α", "ɑ": "α"})


def _plain(text: str) -> str:
    """A word in small letters without LaTeX's signs, its subscripts on the line."""
    return unicodedata.normalize("NFKC", text).translate(_MARKS).casefold()


def canonical(text: str) -> str:
    r"""Key that a word stands for: ``$\alpha_{i-1}$``, ``Twist`` and ``alpha`` are one."""
    clean = _plain(text).strip().replace("−", "-")
    clean = re.sub(r"[\s-]+", "_", clean) if not re.search("[ijkn]-1", clean) else clean
    stem = _OWN.sub("", _PREVIOUS.sub("", clean)).strip("_ ")
    for word in (clean, stem):
        key = _CANONICAL.get(word, word)
        if key in ROW_KEYS or key in TABLE_KEYS or key in MISUSED_KEYS:
            return key
    return clean


def of_previous_link(text: str) -> bool:
    """Tell whether a header is ``a_{i-1}`` or ``alpha_(i-1)``, as in modified tables."""
    clean = re.sub(r"\s", "", _plain(text))
    return canonical(text) in ("a", "alpha") and _PREVIOUS.search(clean) is not None


def did_you_mean(word: str, allowed: Iterable[str] | Mapping[str, object]) -> str:
    """Hint with the nearest allowed word, empty where none is near."""
    near = nearest(word, allowed)
    return f"did you mean {near}?" if near else ""


def nearest(word: str, allowed: Iterable[str] | Mapping[str, object]) -> str:
    """Nearest allowed word, empty where none is near."""
    return next(iter(difflib.get_close_matches(word.casefold(), list(allowed), n=1)), "")
