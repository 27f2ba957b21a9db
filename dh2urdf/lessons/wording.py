"""Words of a worked solution as text, Markdown and LaTeX, the letters of formulas as such."""

import re
import textwrap
from collections.abc import Callable

from dh2urdf.lessons.notation import LETTER, latex_name

ASCII = str.maketrans({"─": "-", "−": "-", "°": "d", "α": "alpha", "θ": "theta", "·": "*"})
"""Signs of tables that not every LaTeX takes; degrees keep their column."""

WIDTH = 88
"""Columns of text."""

ESCAPES = {"\\": r"\textbackslash{}", "^": r"\textasciicircum{}", "~": r"\textasciitilde{}"}
ESCAPES |= {sign: f"\\{sign}" for sign in "&%$#_{}"}


def paragraphs(words: str) -> str:
    """Words in lines; lines that are set out already (a table) stay as they are."""
    blocks = words.split("\n\n")
    return "\n\n".join(b if "\n" in b else textwrap.fill(b, WIDTH) for b in blocks)


def markdown_block(block: str) -> str:
    """A paragraph; lines that are set out already as they are."""
    return f"```text\n{block}\n```" if "\n" in block else markdown_words(block)


def markdown_words(words: str) -> str:
    """Plain words, letters of formulas as such, in which nothing is taken for emphasis."""
    return _with_letters(words, lambda text: re.sub(r"([*_|<])", r"\\\1", text))


def latex_block(block: str) -> str:
    """A paragraph; lines that are set out already as they are."""
    if "\n" in block:
        return f"\\begin{{verbatim}}\n{block.translate(ASCII)}\n\\end{{verbatim}}"
    return latex_words(block) + "\n"


def latex_words(words: str) -> str:
    """Plain words, letters of formulas as such, with what LaTeX would take for orders escaped."""
    words = re.sub(r"`(\w+)`", r"\1", words)
    return _with_letters(words, lambda text: "".join(ESCAPES.get(sign, sign) for sign in text))


def _with_letters(words: str, escaped: Callable[[str], str]) -> str:
    """Words with the letters of formulas between dollar signs, the rest escaped."""
    out, at = "", 0
    for match in LETTER.finditer(words):
        out += f"{escaped(words[at : match.start()])}${latex_name(match.group())}$"
        at = match.end()
    return out + escaped(words[at:])
