"""What nothing reads any more once branches have been left out."""

import re
from collections import Counter

_DECLARED = re.compile(r"(?:const )?\w+ \(?\*?(\w+)\)?(?:\[\w+\])*(?: = (.*))?;", re.DOTALL)

_SET = re.compile(r"(\w+) (?:[-+*/]?=) (.*);", re.DOTALL)

_CALL = re.compile(r"(\w+)\(")

PURE = {"sqrt", "fabs", "floor", "ceil", "rint", "copysign", "larger", "smaller", "sizeof"}
"""Functions whose calls change nothing."""

Lines = list[tuple[int, str]]


def without_unused(lines: Lines) -> Lines:
    """Lines of a body, by depth, without the variables that are never read.

    Where a call gives the value, which may write into arrays, the variable stays and is named.
    """
    while True:
        given = [_given(text) for _, text in lines]
        words = Counter(w for _, text in lines if not text.startswith("/*") for w in _words(text))
        sets = Counter(name for name, _ in given if name)
        unread = {name for name in sets if words[name] == sets[name]}
        kept = [
            line
            for line, (name, value) in zip(lines, given, strict=True)
            if name not in unread or not _is_pure(value)
        ]
        if len(kept) == len(lines):
            break
        lines = kept
    named = Lines()
    for (depth, text), (name, _) in zip(lines, given, strict=True):
        named.append((depth, text))
        if name in unread and _DECLARED.fullmatch(text):
            named.append((depth, f"(void){name};"))
    return named


def _given(text: str) -> tuple[str, str]:
    """The variable that a line declares or sets, and its value."""
    if text.startswith(("return", "/*")):
        return "", ""
    match = _SET.fullmatch(text) or _DECLARED.fullmatch(text)
    return (match[1], match[2] or "") if match else ("", "")


def _words(text: str) -> list[str]:
    return re.findall(r"[A-Za-z_]\w*", text)


def _is_pure(value: str) -> bool:
    return set(_CALL.findall(value)) <= PURE
