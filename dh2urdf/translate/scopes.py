"""Where C declares a kernel's names: at their first assignment, if all uses follow it."""

import ast
from collections import Counter
from dataclasses import dataclass, field
from functools import cache

from dh2urdf.translate.source import Source, blocks_of, every, loaded, stored


@dataclass
class Scopes:
    """For statements, by identity: the names that they declare, and those declared before them."""

    at: set[tuple[int, str]] = field(default_factory=set)
    before: dict[int, list[str]] = field(default_factory=dict)
    astray: set[str] = field(default_factory=set)
    """Counters that something outside their loops uses."""


@cache
def scopes_of(source: Source) -> Scopes:
    """Decide for every name of a body that is no parameter."""
    found, uses = Scopes(), _Uses()
    for name in sorted(source.stored - set(source.parameters) - {"_"}):
        loops = [s for s in every(source.body) if isinstance(s, ast.For) and _counts(s, name)]
        if not loops:
            uses.place(name, source.body, found)
        elif sum(uses.of(s, name) for s in loops) != sum(uses.of(s, name) for s in source.body):
            found.astray.add(name)
    return found


@cache
def _given(s: ast.Assign) -> set[str]:
    return {*stored([s])}


def _counts(loop: ast.For, name: str) -> bool:
    return isinstance(loop.target, ast.Name) and loop.target.id == name


class _Uses:
    """How often statements name something, counted once."""

    def __init__(self) -> None:
        self._counts: dict[ast.AST, Counter[str]] = {}

    def of(self, node: ast.AST, name: str) -> int:
        """How often a node names something."""
        if node not in self._counts:
            names = (n.id for n in ast.walk(node) if isinstance(n, ast.Name))
            self._counts[node] = Counter(names)
        return self._counts[node][name]

    def _begins(self, name: str, block: list[ast.stmt]) -> bool:
        """Whether a block gives a name its value before it reads it, wherever it is used."""
        users = [s for s in block if self.of(s, name)]
        first = users[0]
        if isinstance(first, ast.Assign) and name in _given(first) and name not in loaded(first):
            return True
        for s in users:
            inside = [b for b in blocks_of(s) if any(self.of(x, name) for x in b)]
            if sum(self.of(x, name) for b in inside for x in b) != self.of(s, name):
                return False
            if not all(self._begins(name, b) for b in inside):
                return False
        return True

    def place(self, name: str, block: list[ast.stmt], found: Scopes) -> None:
        """Decide for a name in a block in which all its uses are."""
        users = [s for s in block if self.of(s, name)]
        if isinstance(users[0], ast.Assign) and self._begins(name, block):
            found.at.add((id(users[0]), name))
        elif self._begins(name, block):
            for b in (b for s in users for b in blocks_of(s)):
                if any(self.of(x, name) for x in b):
                    self.place(name, b, found)
        else:
            found.before.setdefault(id(users[0]), []).append(name)
