"""Which keys a table file has, what else they are called, and what those words might mean."""

import difflib
import re
import unicodedata
from collections.abc import Iterable, Mapping

from dh2urdf.dh import DHConvention, JointType
from dh2urdf.dh_io.cells.units import Kind

TABLE_KEYS = (
    "name", "source", "checked", "convention", "units", "constants", "base", "tool", "joints",
)  # fmt: skip

ROW_KEYS = (
    "name", "type", "theta", "d", "a", "alpha", "sign", "lower", "upper", "velocity", "effort",
    "damping", "friction", "mass", "com", "inertia", "inertia_frame", "xyz", "rpy",
)  # fmt: skip

ROW_KINDS = {
    "theta": Kind.ANGLE,
    "d": Kind.LENGTH,
    "a": Kind.LENGTH,
    "alpha": Kind.ANGLE,
    "com": Kind.LENGTH,
    "xyz": Kind.LENGTH,
    "rpy": Kind.ANGLE,
}
"""What a row's cells measure; ``lower``, ``upper`` and ``velocity`` go by the joint's type."""

_ALIASES = {
    "theta": ("th", "θ", "ϑ", "joint_angle"),
    "d": ("link_offset",),
    "a": ("link_length",),
    "alpha": ("α", "al", "twist", "link_twist", "twist_angle"),
    "type": ("joint_type", "kind", "sigma", "σ"),
    "sign": ("direction",),
    "lower": ("min", "qmin", "q_min", "lower_limit", "limit_lower"),
    "upper": ("max", "qmax", "q_max", "upper_limit", "limit_upper"),
    "velocity": ("max_velocity", "velocity_limit", "speed", "vmax"),
    "effort": ("max_effort", "effort_limit", "torque", "max_torque"),
    "com": ("centre_of_mass", "center_of_mass", "cog"),
    "joints": ("rows",),
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

JOINT_TYPES = {
    **dict.fromkeys(("revolute", "r", "rev", "rotary", "rotational", "hinge", "0"),
                    JointType.REVOLUTE),
    **dict.fromkeys(("prismatic", "p", "pris", "sliding", "slider", "linear", "1"),
                    JointType.PRISMATIC),
    **dict.fromkeys(("fixed", "f"), JointType.FIXED),
}  # fmt: skip

_PREVIOUS = re.compile(r"_?(?:\(?i_?[-−]_?1\)?)$")
_OWN = re.compile(r"_?\(?i\)?$")


def _plain(text: str) -> str:
    """A word in small letters without LaTeX's signs, its subscripts on the line."""
    return re.sub(r"[\\${}]", "", unicodedata.normalize("NFKC", text)).casefold()


def canonical(text: str) -> str:
    r"""Key that a word stands for: ``$\alpha_{i-1}$``, ``Twist`` and ``alpha`` are one."""
    clean = _plain(text).strip()
    clean = re.sub(r"[\s-]+", "_", clean) if "i-1" not in clean else clean
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
