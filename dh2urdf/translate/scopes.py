"""Where C declares a kernel's names: at their first assignment, if all uses follow it."""

import ast
from collections import Counter
from dataclasses import dataclass, field

from dh2urdf.translate.inference import Instance
from dh2urdf.translate.source import blocks_of, every, loaded, stored


@dataclass
class Scopes:
    """For statements, by identity: the names that they declare, and those declared before them."""

    at: set[tuple[int, str]] = field(default_factory=set)
    before: dict[int, list[str]] = field(default_factory=dict)
    counters: set[str] = field(default_factory=set)
    """Loop counters that nothing outside their loops uses."""


def scopes_of(instance: Instance) -> Scopes:
    """Decide for every name of a body that is no parameter."""
    found = Scopes()
    for name in sorted(set(stored(instance.body)) - set(instance.source.parameters) - {"_"}):
        loops = [s for s in every(instance.body) if isinstance(s, ast.For) and _counts(s, name)]
        inside = sum(_uses(s, name) for s in loops)
        if loops and inside == sum(_uses(s, name) for s in instance.body):
            found.counters.add(name)
        else:
            _place(name, instance.body, found)
    return found


def _counts(loop: ast.For, name: str) -> bool:
    return isinstance(loop.target, ast.Name) and loop.target.id == name


_used: dict[ast.AST, Counter[str]] = {}


def _uses(node: ast.AST, name: str) -> int:
    """How often a node names something; counted once for each node."""
    if node not in _used:
        _used[node] = Counter(n.id for n in ast.walk(node) if isinstance(n, ast.Name))
    return _used[node][name]


def _heads(s: ast.stmt) -> list[ast.AST]:
    """The parts of a statement outside its blocks."""
    if isinstance(s, ast.For):
        return [s.target, s.iter]
    return [s.test] if isinstance(s, ast.If | ast.While) else [s]


def _defines(s: ast.stmt, name: str) -> bool:
    """Whether a statement gives a name its value without reading it."""
    return isinstance(s, ast.Assign) and _uses(s, name) > 0 and _gives(s, name)


def _gives(s: ast.Assign, name: str) -> bool:
    return name in stored([s]) and name not in loaded(s)


def _stays_in_blocks(name: str, block: list[ast.stmt]) -> bool:
    """Whether each block in which a name is used gives it a value of its own first."""
    for s in block:
        if not _uses(s, name):
            continue
        if any(_uses(h, name) for h in _heads(s)):
            return False
        for b in blocks_of(s):
            first = next((x for x in b if _uses(x, name)), None)
            if first is not None and not (_defines(first, name) or _stays_in_blocks(name, b)):
                return False
    return True


def _place(name: str, block: list[ast.stmt], found: Scopes) -> None:
    users = [s for s in block if _uses(s, name)]
    if _defines(users[0], name):
        found.at.add((id(users[0]), name))
    elif _stays_in_blocks(name, block):
        for s in users:
            for b in blocks_of(s):
                if any(_uses(x, name) for x in b):
                    _place(name, b, found)
    else:
        found.before.setdefault(id(users[0]), []).append(name)
