"""Names in a C file that no macro of a program that includes it changes."""

import re

KEYWORDS = """
bool break char const continue defined do double else extern false float for if inline int int64_t
return sizeof static struct true typedef unsigned void while
"""

LIBRARY = """
INFINITY NAN ceil copysign fabs floor fmod isfinite isinf isnan memcpy memset rint sqrt
"""

FOUND = "found->"
"""Before what callers read of solutions."""

_KEPT = {*KEYWORDS.split(), *LIBRARY.split()}

_TOKEN = re.compile(
    r"/\*.*?\*/|^#(?:[^\n]*\\\n)*[^\n]*|\b\d[\w.]*|(?P<name>\b[A-Za-z_]\w*)",
    re.DOTALL | re.MULTILINE,
)
"""A comment, a line of the preprocessor, a number, or a name."""


def hidden(text: str, prefix: str) -> str:
    """C in which names that do not begin with a prefix end with an underscore.

    Variables, parameters and fields of kernels are short words, and so are macros of programs, such
    as ``N``, ``pi`` or ``near``.
    """
    own = f"{prefix}_".lower()

    def changed(found: re.Match[str]) -> str:
        name = found["name"]
        if name is None or name in _KEPT or name.endswith("_") or name.lower().startswith(own):
            return found[0]
        if text.endswith(FOUND, 0, found.start()):
            return name
        return f"{name}_"

    return _TOKEN.sub(changed, text)
