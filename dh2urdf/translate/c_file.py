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

    def __init__(self, prefix: str = "") -> None:
        super().__init__(prefix)
        self.exported = True
        """Whether the entries are seen from outside the file."""
        self.entries: list[Instance] = []
        """The kernels that others may call, in the order in which they were added."""
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

    def text(self, header: str = "") -> str:
        """The whole file, to be compiled by itself."""
        bodies, out = self.bodies(), comment(header) if header else []
        return "\n".join([*out, *INCLUDES, *self.types(), *self.definitions(bodies)]) + bodies

    def bodies(self) -> str:
        """The functions."""
        return "\n\n" + "\n\n".join(map(self._function, self.order)) + "\n"

    def _function(self, instance: Instance) -> str:
        """A function with its docstring; what has no loop may become a part of its callers."""
        head = f"{instance.name}({', '.join(self.parameters(instance)) or 'void'})"
        head = self.declaration(instance.returned, head)
        named = Counter(re.findall(r"\w+", head + instance.body))
        given = [*instance.lengths(), *(c for c, _ in instance.parameters)]
        unused = [f"    (void){c};" for c in given if named[c] == 1]
        if not (self.exported and instance in self.entries):
            loops = any(isinstance(s, ast.For | ast.While) for s in every(instance.source.body))
            head = f"static {'' if loops else 'inline '}{head}"
        doc = comment(instance.source.doc) if instance.source.doc else []
        return "\n".join([*doc, *folded(head), "{", *unused, instance.body, "}"])

    def parameters(self, instance: Instance) -> list[str]:
        """Declarations of all that an instance is handed."""
        return [f"int {length}" for length in instance.lengths()] + [
            self.declaration(t, c, isinstance(t, Array) and isinstance(t.shape[0], int))
            for c, t in instance.parameters
        ]


def _loose(t: Type) -> Type:
    """A type without the first length, of which a kernel may not ask."""
    return t.first() if isinstance(t, Array) and isinstance(t.element, str) else t
