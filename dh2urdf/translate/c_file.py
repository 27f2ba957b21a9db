"""One C file: kernels, each for the types of the arguments that it is called with."""

import re
from collections import Counter
from collections.abc import Callable
from typing import Any

from dh2urdf.translate.definitions import Definitions, comment, folded
from dh2urdf.translate.source import Source, source_of
from dh2urdf.translate.statements import Body
from dh2urdf.translate.types import Array, Type

INCLUDES = ["", *(f"#include <{name}.h>" for name in ("math", "stdbool", "stdint", "string"))]


class CFile(Definitions):
    """Kernels, each once for each list of argument types, and what they share."""

    writes = Body
    """What writes a kernel."""

    def __init__(self) -> None:
        super().__init__()
        self.entries: list[Body] = []
        """The kernels that Python calls, in the order in which they were added."""
        self.order: list[Body] = []
        """All kernels, those that others call before these."""
        self._made: dict[tuple[Source, tuple[Type, ...]], Body] = {}
        self._open: set[Source] = set()

    def add_entry(self, function: Callable[..., Any], arguments: list[Type]) -> Body:
        """A kernel that others may call, and all that it calls."""
        entry = self.kernel(source_of(function), tuple(arguments))
        entry.entered = tuple(arguments)
        self.entries.append(entry)
        return entry

    def kernel(self, source: Source, given: tuple[Type, ...]) -> Body:
        """A kernel for some types of arguments; where it asks for no length, for any."""
        if (source, given) in self._made:
            return self._made[source, given]
        if source in self._open:
            source.refuse(source.tree, "a kernel that calls itself", "a loop")
        self._open.add(source)
        made = self.writes(self, source, given, self.kernel)
        made.write()
        self._open.remove(source)
        first = self._made.setdefault((source, made.arguments), made)
        if first is made:
            made.function = self.unique(source.name.lstrip("_"), source.module.__name__, made)
            self.order.append(made)
        self._made[source, given] = first
        return first

    def header(self) -> str:
        """Types, and the table of the entries."""
        structs = (line for _, lines in self.structs.values() for line in lines)
        lines = [*INCLUDES, *structs, "", "typedef struct {", "    void (*leave)(void);"]
        for e in self.entries:
            lines += folded(self._head(e, f"(*{e.function})") + ";", 4)
        return "\n".join([*lines, "} Entries;", ""])

    def kernels(self) -> str:
        """The kernels, and their entries as the table that is to be named ``TABLE``."""
        bodies = "\n\n".join(map(self._function, self.order))
        names = ", ".join(e.function for e in self.entries)
        table = folded(f"const Entries TABLE = {{leave, {names}}};")
        head = ['#include "kernels.h"', *self.definitions(bodies)]
        return "\n".join([*head, "", bodies, "", "extern const Entries TABLE;", *table, ""])

    def _head(self, kernel: Body, name: str) -> str:
        """A function's declaration."""
        given = [f"int {length}" for length in kernel.lengths()]
        for c, t in kernel.parameters:
            storage = isinstance(t, Array) and isinstance(t.shape[0], int)
            given.append(self.declaration(t, c, storage))
        return self.declaration(kernel.returned, f"{name}({', '.join(given) or 'void'})")

    def _function(self, kernel: Body) -> str:
        """A function with its docstring; what has no loop may become a part of its callers."""
        head = self._head(kernel, kernel.function)
        named = Counter(re.findall(r"\w+", head + kernel.body))
        given = [*kernel.lengths(), *(c for c, _ in kernel.parameters)]
        unused = [f"    (void){c};" for c in given if named[c] == 1]
        head = f"static {'' if kernel.source.loops else 'inline '}{head}"
        doc = comment(kernel.source.doc) if kernel.source.doc else []
        return "\n".join([*doc, *folded(head), "{", *unused, kernel.body, "}"])
