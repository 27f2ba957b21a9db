"""How much of the stack a C file's functions take: more than any compiler needs for them."""

import re

_FUNCTION = re.compile(r"^static [^;{=]*?\b(\w+)\([^;{]*\)\n\{\n(.*?)^\}", re.DOTALL | re.MULTILINE)

_LOCAL = re.compile(r"^\s*(?:const )?(\w+) (\(?\*)?\w+\)?((?:\[\d+\])*)(?: =|;)", re.MULTILINE)

_STRUCT = re.compile(r"^typedef struct \{\n(.*?)^\} (\w+);", re.DOTALL | re.MULTILINE)

FRAME = 160
"""Bytes for saved registers, the arguments that are passed on, and alignment."""


SIZES = {"double": 8, "int64_t": 8, "int": 8, "bool": 8}


def stack_bytes(text: str, function: str) -> int:
    """Most bytes of the stack that a function of a C text and those it calls take."""
    sizes = _sizes(text)
    bodies = dict(_FUNCTION.findall(text))
    makers = {f"{name}_of": size for name, size in sizes.items() if f"{name}_of" in bodies}
    heads = {name: size for name, size in _returned(text, sizes).items() if name in bodies}
    parts = {*re.findall(r"^static \w+_INLINE \w+ (\w+)\(", text, re.MULTILINE)} & bodies.keys()
    known = dict[str, int]()

    def most(name: str) -> int:
        if name not in known:
            words = re.findall(r"\w+(?=\()", bodies[name])
            given = sum(makers.get(w, 0) or heads.get(w, 0) for w in words)
            given += sum(most(w) for w in words if w in parts)
            inner = max((most(w) for w in {*words} & bodies.keys() - parts), default=0)
            frame = 0 if name in parts else FRAME
            known[name] = frame + _local(bodies[name], sizes) + given + inner
        return known[name]

    return most(function)


LARGE = 256
"""Bytes of a function's own from which on it is kept apart from its callers."""

MANY = 96
"""Bytes that a function without a loop returns from which on it is a part of its callers: twelve
numbers of a pose, which compilers would write one by one and read two at a time, and wait."""


def apart_or_part(text: str, prefix: str) -> str:
    """The text with marks at functions that compilers are to keep apart, and to make a part.

    Apart are those whose arrays would add up if they became one function: compilers that inline
    them give each its own place in the frame.
    """
    sizes = _sizes(text)

    def marked(found: re.Match[str]) -> str:
        if _local(found[2], SIZES) >= LARGE:
            return re.sub(r"^static (inline )?", f"static {prefix}_NOINLINE ", found[0], count=1)
        returned = re.match(r"static inline (\w+)", found[0])
        if returned and sizes.get(returned[1], 0) >= MANY and not found[1].endswith("_of"):
            return re.sub(r"^static inline ", f"static {prefix}_INLINE ", found[0], count=1)
        return found[0]

    return _FUNCTION.sub(marked, text)


def _sizes(text: str) -> dict[str, int]:
    """Bytes of the types of a C text."""
    sizes = dict(SIZES)
    for body, name in _STRUCT.findall(text):
        sizes[name] = _local(body, sizes)
    return sizes


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
    found = re.findall(r"^static (?:\w*inline |\w+_INLINE )?(\w+) (\w+)\(", text, re.MULTILINE)
    return {name: sizes.get(kind, 0) for kind, name in found}
