"""One C file: kernels, each for the types of the arguments that it is called with."""

import ast
import re
from collections import Counter
from collections.abc import Callable
from typing import Any

from dh2urdf.translate.c_text import comment, folded
from dh2urdf.translate.definitions import Definitions, Instance
from dh2urdf.translate.source import Source, every, source_of
from dh2urdf.translate.statements import Body
from dh2urdf.translate.types import Array, Type

INCLUDES = ["", *(f"#include <{name}.h>" for name in ("math", "stdbool", "stdint", "string"))]


class CFile(Definitions):
    """Kernels, each once for each list of argument types, and what they share."""

    def __init__(self) -> None:
        super().__init__()
        self.entries: list[Instance] = []
        """The kernels that Python calls, in the order in which they were added."""
        self.order: list[Instance] = []
        """All kernels, those that others call before these."""
        self._instances: dict[tuple[Source, tuple[Type, ...]], Instance] = {}
        self._open: set[Source] = set()

    def add_entry(self, function: Callable[..., Any], arguments: list[Type]) -> Instance:
        """A kernel that others may call, and all that it calls."""
        entry = self.instance(source_of(function), tuple(arguments))
        entry.entered = tuple(arguments)
        self.entries.append(entry)
        return entry

    def instance(self, source: Source, given: tuple[Type, ...]) -> Instance:
        """A kernel for some types of arguments; where it asks for no length, for any."""
        if (source, given) not in self._instances:
            if source in self._open:
                source.refuse(source.tree, "a kernel that calls itself", "a loop")
            self._open.add(source)
            made = self._made(source, given)
            self._open.remove(source)
            if (source, made.arguments) not in self._instances:
                made.name = self.unique(source.name.lstrip("_"), source.module.__name__, made)
                self.order.append(made)
                self._instances[source, made.arguments] = made
            self._instances[source, given] = self._instances[source, made.arguments]
        return self._instances[source, given]

    def _made(self, source: Source, given: tuple[Type, ...]) -> Instance:
        made = Instance(source, given)
        body = Body(self, made)
        made.body = body.body()
        kinds = dict(zip(source.parameters, given, strict=True))
        for p in set(kinds) - made.asked:
            kinds[p] = _loose(kinds[p])
        made.arguments = tuple(kinds.values())
        loose = {body.values[p].text: t for p, t in kinds.items()}
        made.parameters = [(c, loose.get(c, t)) for c, t in made.parameters]
        return made

    def header(self) -> str:
        """Types, and the table of the entries."""
        lines = [*INCLUDES, *self.types(), "", "typedef struct {", "    void (*leave)(void);"]
        for e in self.entries:
            lines += folded(self._head(e, f"(*{e.name})") + ";", 4)
        return "\n".join([*lines, "} Entries;", ""])

    def kernels(self) -> str:
        """The kernels, and their entries as the table that is to be named ``TABLE``."""
        bodies = "\n\n".join(map(self._function, self.order))
        names = ", ".join(e.name for e in self.entries)
        table = folded(f"const Entries TABLE = {{leave, {names}}};")
        head = ['#include "kernels.h"', *self.definitions(bodies)]
        return "\n".join([*head, "", bodies, "", "extern const Entries TABLE;", *table, ""])

    def _head(self, instance: Instance, name: str) -> str:
        """A function's declaration."""
        given = [f"int {length}" for length in instance.lengths()]
        for c, t in instance.parameters:
            storage = isinstance(t, Array) and isinstance(t.shape[0], int)
            given.append(self.declaration(t, c, storage))
        return self.declaration(instance.returned, f"{name}({', '.join(given) or 'void'})")

    def _function(self, instance: Instance) -> str:
        """A function with its docstring; what has no loop may become a part of its callers."""
        head = self._head(instance, instance.name)
        named = Counter(re.findall(r"\w+", head + instance.body))
        given = [*instance.lengths(), *(c for c, _ in instance.parameters)]
        unused = [f"    (void){c};" for c in given if named[c] == 1]
        loops = any(isinstance(s, ast.For | ast.While) for s in every(instance.source.body))
        head = f"static {'' if loops else 'inline '}{head}"
        doc = comment(instance.source.doc) if instance.source.doc else []
        return "\n".join([*doc, *folded(head), "{", *unused, instance.body, "}"])


def _loose(t: Type) -> Type:
    """A type without the first length, of which a kernel may not ask."""
    return t.first() if isinstance(t, Array) and isinstance(t.element, str) else t
