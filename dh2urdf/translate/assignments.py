"""Assignments as C: of tuples at once, of all elements of an array, with an operator."""

import ast
from collections.abc import Iterator

from dh2urdf.translate.calls import Calls
from dh2urdf.translate.definitions import Definitions, Instance
from dh2urdf.translate.expressions import BINARY
from dh2urdf.translate.source import loaded
from dh2urdf.translate.types import NUMBERS, Array, Record, Tuple, Type, told
from dh2urdf.translate.values import Value


class Assignments(Calls):
    """Writes the assignments of one kernel."""

    def __init__(self, file: Definitions, instance: Instance) -> None:
        super().__init__(file, instance)
        self.hoisted: dict[str, str] = {}
        """Names that are declared before the block that gives them a value, by their line."""

    def assign(self, s: ast.Assign) -> None:
        """An assignment: all is read before anything is written."""
        late = []
        given = list(self._pairs(s.targets[0], s.value))
        for i, (target, n, value) in enumerate(given):
            root = _root(target)
            later = ((v.words() if v.text or v.parts else loaded(m)) for _, m, v in given[i + 1 :])
            if {root, self.name(root)} & set[str]().union(*later):
                if isinstance(value.type, Array) and isinstance(target, ast.Subscript):
                    self.refuse(s, "an array that is read after it", "two assignments")
                late.append((target, n, self.temporary(value, f"{root}_next")))
            else:
                self._store(s, target, n, value)
        for target, n, value in late:
            self._store(s, target, n, value)

    def _pairs(self, target: ast.expr, n: ast.expr) -> Iterator[tuple[ast.expr, ast.expr, Value]]:
        """The single assignments that one of tuples is made of."""
        starred = isinstance(n, ast.Tuple) and any(isinstance(x, ast.Starred) for x in n.elts)
        if isinstance(target, ast.Tuple) and isinstance(n, ast.Tuple) and not starred:
            if len(target.elts) != len(n.elts):
                self.refuse(n, f"{len(n.elts)} values for {len(target.elts)} names", "as many")
            for x, y in zip(target.elts, n.elts, strict=True):
                yield from self._pairs(x, y)
        elif isinstance(target, ast.Tuple):
            yield from self._unpacked(target, n, self.value(n))
        elif isinstance(target, ast.Name):
            size = self.size(n) if target.id in self.source.once else None
            if size is None:
                yield target, n, self.value(n)
            else:
                self.known[target.id] = size
        else:
            t = self.value(target).type
            yield target, n, Value(t) if isinstance(t, Array) else self.number(n)

    def _unpacked(
        self, target: ast.Tuple, n: ast.expr, value: Value
    ) -> Iterator[tuple[ast.expr, ast.expr, Value]]:
        parts = self.parts(n, value)
        if len(parts) != len(target.elts):
            self.refuse(n, f"{len(parts)} values for {len(target.elts)} names", "as many")
        for x, part in zip(target.elts, parts, strict=True):
            if isinstance(x, ast.Tuple):
                yield from self._unpacked(x, n, part)
            else:
                yield x, n, part

    def _store(self, s: ast.stmt, target: ast.expr, n: ast.expr, value: Value) -> None:
        if isinstance(target, ast.Name):
            self._bind(s, target, value)
            return
        written = self.value(target)
        self._writable(target)
        if isinstance(written.type, Array):
            self._elements(target, n, "")
        else:
            self._fits(target, written.type, value.type)
            self.out(f"{written.text} = {value.text};")

    def _writable(self, target: ast.expr) -> None:
        array = self.values.get(_root(target))
        if array is None or (isinstance(array.type, Array) and array.type.constant):
            self.refuse(target, "a constant that is written to", "an array of the caller")

    def _fits(self, target: ast.expr, kept: Type, given: Type) -> None:
        """Refuse what an element of an array does not hold."""
        if not (isinstance(kept, str) and isinstance(given, str)):
            self.refuse(target, f"{told(given)} for {told(kept)}", "element by element")
        if NUMBERS.index(given) > NUMBERS.index(kept):
            self.refuse(target, f"{given} for an element of {kept}", "int(x), or a comparison")

    def _bind(self, s: ast.stmt, target: ast.Name, value: Value) -> None:
        name, c, t = target.id, self.name(target.id), value.type
        if name == "_" or value.text == c:
            self.values.setdefault(name, value)
            return
        here, before = name in self.source.declared[0][s], self.values.get(name)
        if before is not None and before.type != t:
            types = f"{told(before.type)} and {told(t)}"
            self.refuse(target, f"one name for two types, {types}", "two names, or 0.0 for 0")
        if value.maker or value.leaves() != [value]:
            if not here or name not in self.source.once:
                self.refuse(s, "arrays that are made, or put together, in a block", "it before")
            self.values[name] = self._kept(self.stored(value, c), c)
            return
        self.values[name] = Value(t, c)
        text = self.text(value)
        if not here:
            self.out(f"{c} = {text};")
            return
        const = "const " if name in self.source.once and not isinstance(t, Array | Record) else ""
        if isinstance(t, Tuple):
            text = text.removeprefix(f"({self.file.tuple_name(t)})")
        self.out(f"{const}{self.file.declaration(t, c)} = {text};")

    def _kept(self, value: Value, name: str) -> Value:
        """A group of values by names that do not change while it is used."""
        if value.parts:
            parts = (self._kept(part, f"{name}_{k}") for k, part in enumerate(value.parts))
            return Value(value.type, parts=tuple(parts))
        if value.words() & set(map(self.name, self.source.changing)):
            return self.temporary(value, name)
        return value

    def augment(self, s: ast.AugAssign) -> None:
        """An assignment with an operator."""
        if type(s.op) not in BINARY:
            self.refuse(s, "an operator that has no such assignment", "x = x ... y")
        sign, target = BINARY[type(s.op)][0], self.value(s.target)
        if isinstance(s.target, ast.Subscript):
            self._writable(s.target)
        if isinstance(target.type, Array):
            self._elements(s.target, s.value, sign)
            return
        value = self.number(s.value)
        after = self._binary(s, s.op, target, value).type
        if after != target.type:
            self.refuse(s, f"{told(after)} for {told(target.type)}", "another name, or float(x)")
        self.out(f"{target.text} {sign}= {value.text};")

    def _elements(self, target: ast.expr, n: ast.expr, sign: str) -> None:
        """All elements of an array, one after the other."""
        t = self.value(target).type
        assert isinstance(t, Array)
        e = self.fresh("e")
        self.values[e] = Value("int", e)
        self.out(f"for (int {e} = 0; {e} < {self._length(target, t)}; {e}++) {{")
        self.depth += 1
        element, value = _at(target, e), self._element(target, n, t, e)
        if isinstance(t.at(1), Array):
            self._elements(element, value, sign)
        else:
            given = self.number(value)
            self._fits(target, t.at(1), given.type)
            self.out(f"{self.value(element).text} {sign}= {given.text};")
        self.depth -= 1
        self.out("}")
        self.taken.discard(e)

    def _length(self, target: ast.expr, t: Array) -> str:
        match target:
            case ast.Subscript(slice=ast.Slice(lower=None, upper=ast.expr() as upper)):
                return self.value(upper).text
            case ast.Subscript(slice=ast.Slice(lower=ast.expr())):
                self.refuse(target, "an assignment to elements from the middle", "a loop")
        if t.shape[0] is None:
            self.refuse(target, "an array whose length is not known", "a loop")
        return str(t.shape[0])

    def _element(self, target: ast.expr, n: ast.expr, t: Array, e: str) -> ast.expr:
        """An expression with arrays for one element of them."""
        match n:
            case ast.BinOp():
                left, right = (self._element(target, x, t, e) for x in (n.left, n.right))
                return ast.copy_location(ast.BinOp(left, n.op, right), n)
            case ast.UnaryOp():
                return ast.copy_location(
                    ast.UnaryOp(n.op, self._element(target, n.operand, t, e)), n
                )
        given = self.base(n).type
        if isinstance(given, Array):
            if len(given.shape) != len(t.shape):
                self.refuse(n, f"{told(given)} for {told(t)}", "a loop")
            return _at(n, e)
        if _root(target) in loaded(n):
            self.refuse(n, "an element of the array that is assigned to", "an assignment before")
        return n


def _at(n: ast.expr, e: str) -> ast.expr:
    return ast.copy_location(ast.Subscript(n, ast.copy_location(ast.Name(e), n)), n)


def _root(n: ast.AST) -> str:
    while isinstance(n, ast.Subscript | ast.Attribute):
        n = n.value
    return str(getattr(n, "id", ""))
