"""Texts of users as each language that is written takes them."""

import re
from itertools import groupby

_LATEX = {
    **{character: f"\\{character}" for character in "{}$&#%_"},
    "\\": r"\textbackslash{}",
    "^": r"\textasciicircum{}",
    "~": r"\textasciitilde{}",
    "<": r"\textless{}",
    ">": r"\textgreater{}",
    "|": r"\textbar{}",
}

_MARKDOWN = re.compile(r"[\\`*<>&\[\]~$!:@]|(?<![^\W_])_|_(?![^\W_])")


XML_FORBIDDEN = re.compile(r"[\x00-\x08\x0b\x0c\x0e-\x1f\ud800-\udfff\ufffe\uffff]")
"""A character that no XML document holds, written out or by its number."""


def one_line(text: str) -> str:
    """A text for a comment or a cell: what does not print, line ends too, is a space."""
    return "".join(c if c.isprintable() else " " for c in text).strip()


def latex(text: str) -> str:
    """A text for a line of LaTeX, in which no character means anything else."""
    return "".join(_LATEX.get(c, c) for c in one_line(text))


def markdown(text: str) -> str:
    """A text for a line of Markdown: no markup, HTML or link, and no end of a cell."""
    return _MARKDOWN.sub(r"\\\g<0>", one_line(text)).replace("|", "&#124;")


def matlab(text: str) -> str:
    """An expression of MATLAB whose value is the text; its literals have no line ends."""
    parts = []
    for prints, run in groupby(text, str.isprintable):
        part = "".join(run)
        data = part.encode("utf-16-be")
        codes = [int.from_bytes(data[k : k + 2], "big") for k in range(0, len(data), 2)]
        parts.append("'" + part.replace("'", "''") + "'" if prints else f"char({codes})")
    return parts[0] if len(parts) == 1 else f"[{' '.join(parts)}]"
