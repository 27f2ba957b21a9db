"""How much of the stack a C file's functions take: more than any compiler needs for them."""

import re

_FUNCTION = re.compile(r"^static [^;{=]*?\b(\w+)\([^;{]*\)\n\{\n(.*?)^\}", re.DOTALL | re.MULTILINE)

_LOCAL = re.compile(r"^\s*(?:const )?(\w+) (\(?\*)?\w+\)?((?:\[\d+\])*)(?: =|;)", re.MULTILINE)

_STRUCT = re.compile(r"^typedef struct \{\n(.*?)^\} (\w+);", re.DOTALL | re.MULTILINE)

FRAME = 160
"""Bytes for saved registers, the arguments that are passed on, and alignment."""


def stack_bytes(text: str, function: str) -> int:
    """Most bytes of the stack that a function of a C text and those it calls take."""
    sizes = {"double": 8, "int64_t": 8, "int": 8, "bool": 8}
    for body, name in _STRUCT.findall(text):
        sizes[name] = _local(body, sizes)
    bodies = dict(_FUNCTION.findall(text))
    makers = {f"{name}_of": size for name, size in sizes.items() if f"{name}_of" in bodies}
    heads = {name: size for name, size in _returned(text, sizes).items() if name in bodies}
    known = dict[str, int]()

    def most(name: str) -> int:
        if name not in known:
            words = re.findall(r"\w+(?=\()", bodies[name])
            given = sum(makers.get(w, 0) or heads.get(w, 0) for w in words)
            inner = max((most(w) for w in {*words} & bodies.keys()), default=0)
            known[name] = FRAME + _local(bodies[name], sizes) + given + inner
        return known[name]

    return most(function)


LARGE = 256
"""Bytes of a function's own from which on it is kept apart from its callers."""


def kept_apart(text: str, mark: str) -> str:
    """The text with a mark at functions whose arrays would add up if they became one function.

    Compilers that inline them give each its own place in the frame.
    """
    sizes = {"double": 8, "int64_t": 8, "int": 8, "bool": 8}

    def marked(found: re.Match[str]) -> str:
        head = re.sub(r"^static (inline )?", f"static {mark} ", found[0], count=1)
        return head if _local(found[2], sizes) >= LARGE else found[0]

    return _FUNCTION.sub(marked, text)


def _local(body: str, sizes: dict[str, int]) -> int:
    """Bytes of what is declared in a body."""
    total = 0
    for kind, pointer, lengths in _LOCAL.findall(body):
        if pointer:
            total += 8
            continue
        size = sizes.get(kind, 0)
        for length in re.findall(r"\d+", lengths):
            size *= int(length)
        total += size
    return total


def _returned(text: str, sizes: dict[str, int]) -> dict[str, int]:
    """Bytes of the structs that functions return."""
    found = re.findall(r"^static (?:inline )?(\w+) (\w+)\(", text, re.MULTILINE)
    return {name: sizes.get(kind, 0) for kind, name in found}
