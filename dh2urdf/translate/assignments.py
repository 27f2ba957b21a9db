"""Assignments as C: of tuples at once, of all elements of an array, with an operator."""

import ast
from collections.abc import Iterator
from dataclasses import replace

from dh2urdf.translate.calls import Calls
from dh2urdf.translate.source import named
from dh2urdf.translate.types import Array, Record, Tuple, Type, told, wider
from dh2urdf.translate.values import SIGNS, Binds, Value, sized


class Assignments(Calls):
    """Writes the assignments of one kernel."""

    def assign(self, s: ast.Assign) -> None:
        """An assignment: all is read before anything is written."""
        if len(s.targets) > 1:
            self.refuse(s, "two assignments in one", "two")
        late = []
        given = list(self._pairs(s.targets[0], s.value))
        for i, (target, n, value) in enumerate(given):
            root = _root(target)
            later = (v.words() or named(m, ast.Load) for _, m, v in given[i + 1 :])
            if not {root, self.name(root)} & set[str]().union(*later):
                self._store(s, target, n, value)
                continue
            if isinstance(value.type, Array) and isinstance(target, ast.Subscript):
                self.refuse(s, "an array that is read after it", "two assignments")
            late.append((target, n, self.temporary(value, f"{root}_next")))
        for target, n, value in late:
            self._store(s, target, n, value)

    def _pairs(
        self, target: ast.expr, n: ast.expr, value: Value | None = None
    ) -> Iterator[tuple[ast.expr, ast.expr, Value]]:
        """The single assignments that one of tuples is made of."""
        if isinstance(target, ast.Tuple):
            items: list[tuple[ast.expr, Value | None]]
            starred = any(isinstance(x, ast.Starred) for x in ast.iter_child_nodes(n))
            if isinstance(n, ast.Tuple) and not value and not starred:
                items = [(x, None) for x in n.elts]
            else:
                items = [(n, part) for part in self.parts(n, value or self.value(n))]
            if len(target.elts) != len(items):
                self.refuse(n, f"{len(items)} values for {len(target.elts)} names", "as many")
            for x, (y, part) in zip(target.elts, items, strict=True):
                yield from self._pairs(x, y, part)
        elif value or isinstance(target, ast.Name):
            value, name = value or self.value(n), _root(target)
            if name in self.source.once and value.known is not None and value.type == "int":
                self.values[name] = sized(value.length)
            else:
                yield target, n, value
        else:
            t = self.value(target).type
            yield target, n, Value(t) if isinstance(t, Array) else self.number(n)

    def _store(self, s: ast.Assign, target: ast.expr, n: ast.expr, value: Value) -> None:
        if isinstance(target, ast.Name):
            self._bind(s, target, value)
            return
        written = self._written(target)
        if isinstance(written.type, Array):
            self._elements(target, written.type, n, "")
        else:
            self._fits(target, written.type, value.type)
            self.out(f"{written.text} = {value.text};")

    def _written(self, target: ast.expr) -> Value:
        """What is assigned to, unless it is a constant."""
        array = self.values.get(_root(target))
        if array is None or (isinstance(array.type, Array) and array.type.constant):
            self.refuse(target, "a constant that is written to", "an array of the caller")
        return self.value(target)

    def _fits(self, target: ast.expr, kept: Type, given: Type) -> None:
        """Refuse what an element of an array does not hold."""
        if not isinstance(kept, str) or wider(kept, given) != kept:
            found = f"{told(given)} for an element of {told(kept)}"
            self.refuse(target, found, "int(x), or a comparison")

    def _bind(self, s: ast.Assign, target: ast.Name, value: Value) -> None:
        name, c, t = target.id, self.name(target.id), value.type
        if isinstance(t, Array) and name not in self.source.once:
            t = replace(t, fixed=None)
        if name == "_" or value.text == c:
            self.values.setdefault(name, value)
            return
        before = self.values.get(name)
        if before is not None and before.type != t:
            types = f"{told(before.type)} and {told(t)}"
            self.refuse(target, f"one name for two types, {types}", "two names, or 0.0 for 0")
        here, once = name in self.source.declared[0][s], name in self.source.once
        if isinstance(t, Array) and t.fixed and once:
            self.values[name] = value
            return
        if value.maker or value.leaves() != [value]:
            changing = {self.name(x) for x in self.source.changing}
            if not (here and once) or value.words() & changing:
                self.refuse(s, "arrays that are made, or put together, in a block", "it before")
            self.values[name] = self.stored(value, c)
            return
        known = value.known if once and isinstance(value.known, bool | float) else None
        self.values[name], text = Value(t, c, known=known), self.text(value)
        if here:
            const = "const " if once and not isinstance(t, Array | Record) else ""
            if isinstance(t, Tuple):
                text = text.removeprefix(f"({self.file.struct(t)})")
            c = const + self.file.declaration(t, c)
        self.out(f"{c} = {text};")

    def augment(self, s: ast.AugAssign) -> None:
        """An assignment with an operator."""
        self.allow(s, s.op)
        (sign, binds), target = SIGNS[type(s.op)], self._written(s.target)
        if binds == Binds.POSTFIX:
            self.refuse(s, "an operator that has no such assignment", "x = x ... y")
        if isinstance(target.type, Array):
            self._elements(s.target, target.type, s.value, sign)
            return
        value = self.number(s.value)
        after = self.joined(s, s.op, target, value).type
        if after != target.type:
            self.refuse(s, f"{told(after)} for {told(target.type)}", "another name, or float(x)")
        self.out(f"{target.text} {sign}= {value.text};")

    def _elements(self, target: ast.expr, t: Array, n: ast.expr, sign: str) -> None:
        """All elements of an array, one after the other."""
        first = t.shape[0]
        match target:
            case ast.Subscript(slice=ast.Slice(lower=None, upper=ast.expr() as upper)):
                first = self.value(upper).text
            case ast.Subscript(slice=ast.Slice(lower=ast.expr())):
                self.refuse(target, "an assignment to elements from the middle", "a loop")
        if first is None:
            self.refuse(target, "an array whose length is not known", "a loop")
        for x in ast.walk(n):
            if not isinstance(x, ast.Subscript) or _root(x) != _root(target):
                continue
            if not isinstance(self.value(x).type, Array):
                self.refuse(x, "an element of the array it is assigned to", "an assignment before")
        indices = [self.fresh("e") for _ in t.shape]
        for e, length in zip(indices, (first, *t.shape[1:]), strict=True):
            self.out(f"for (int {e} = 0; {e} < {length}; {e}++) {{")
            self.depth += 1
        self.whole = t, indices
        element, value = self.number(target), self.number(n)
        self._fits(target, element.type, value.type)
        self.out(f"{element.text} {sign}= {value.text};")
        del self.whole
        for _ in indices:
            self.depth -= 1
            self.out("}")
        self.taken -= {*indices}


def _root(n: ast.AST) -> str:
    """The name that a target starts with."""
    while isinstance(n, ast.Subscript | ast.Attribute):
        n = n.value
    return str(getattr(n, "id", ""))
