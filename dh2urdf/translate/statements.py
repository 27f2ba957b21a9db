"""The body of one instance as C."""

import ast
import re
from typing import TYPE_CHECKING

from dh2urdf.translate.c_text import NUMBER, comment, folded
from dh2urdf.translate.expressions import BINARY, Expressions
from dh2urdf.translate.inference import Instance
from dh2urdf.translate.scopes import scopes_of
from dh2urdf.translate.source import every, loaded, makes_array, stored
from dh2urdf.translate.types import Array, Kernel, Record, Tuple, Type

if TYPE_CHECKING:
    from dh2urdf.translate.c_file import CFile

EMPTY = {"float": "0.0", "int": "0", "bool": "false"}


class Body(Expressions):
    """Writes one function."""

    def __init__(self, file: "CFile", instance: Instance) -> None:
        super().__init__(file, instance)
        self.scopes = scopes_of(instance)
        self.lines: list[str] = []
        self.depth, self.said = 1, set[int]()
        self.labels: list[str] = []
        """For the loops around: where to go on without their else; nothing if they have none."""

    def text(self) -> str:
        """The function with its docstring."""
        instance = self.instance
        used = {n.id for s in instance.body for n in ast.walk(s) if isinstance(n, ast.Name)}
        for p, t in zip(instance.source.parameters, instance.arguments, strict=True):
            if p not in used and not isinstance(t, Kernel):
                self.out(f"(void){self.name(p)};")
        self.block(instance.body)
        for name in map(self.name, reversed(instance.known)):  # numbers that only gave shapes
            if len(re.findall(rf"\b{name}\b", "\n".join(self.lines))) == 1:
                self.lines = [x for x in self.lines if f"const int {name} = " not in x]
        doc = comment(instance.source.doc) if instance.source.doc else []
        return "\n".join([*doc, *folded(self.signature()), "{", *self.lines, "}"])

    def signature(self) -> str:
        """The head; what has no loop is asked to become a part of its callers."""
        instance = self.instance
        parameters = ", ".join(self.file.parameters(instance)) or "void"
        head = self.file.declaration(instance.returned, f"{instance.name}({parameters})")
        seen = self.file.exported and instance in self.file.entries
        inline = (
            ""
            if any(isinstance(n, ast.For | ast.While) for n in every(instance.body))
            else ("inline ")
        )
        return head if seen else f"static {inline}{head}"

    def out(self, text: str) -> None:
        """A line, or a few."""
        self.lines += folded(text, 4 * self.depth)

    def flush(self) -> None:
        """What has to come before."""
        for line in self.pending:
            self.out(line)
        self.pending = []

    def block(self, statements: list[ast.stmt]) -> None:
        """Statements one after the other."""
        for s in self.instance.reached(statements):
            self._statement(s)

    def _inner(self, statements: list[ast.stmt]) -> None:
        self.depth += 1
        self.block(statements)
        self.depth -= 1

    def _statement(self, s: ast.stmt) -> None:
        for line, text in self.instance.source.comments.items():
            if line <= s.lineno and line not in self.said:
                self.said.add(line)
                self.out(f"/* {text} */")
        for name in self.scopes.before.get(id(s), []):
            self._declare(name)
        match s:
            case ast.Assign():
                self._assign(s)
            case ast.AugAssign():
                self._augment(s)
            case ast.For():
                self._loop(s)
            case ast.While():
                self._while(s)
            case ast.If():
                self._branch(s, "")
            case ast.Return():
                value = ""
                if s.value is not None:
                    value = " " + self.value(s.value, self.instance.returned)
                self.flush()
                self.out(f"return{value};")
            case ast.Expr():
                text = self.value(s.value)
                self.flush()
                self.out(f"{text};")
            case ast.Break():
                label = self.labels[-1]
                self.out(f"goto {label};" if label else "break;")
            case ast.Continue():
                self.out("continue;")

    def _elementwise(self, target: ast.expr, value: ast.expr, sign: str = "") -> None:
        """All elements of an array, one after the other."""
        t = self.type_of(target)
        assert isinstance(t, Array)
        names = [self.fresh(x) for x in "efg"[: len(t.shape)]]
        lengths = [self._length(target), *t.shape[1:]]
        for name, length in zip(names, lengths, strict=True):
            self.out(f"for (int {name} = 0; {name} < {length}; {name}++) {{")
            self.depth += 1
        self.element = "".join(f"[{name}]" for name in names)
        self.out(f"{self.value(target)} {sign}= {self.value(value)};")
        self.element = ""
        for _ in names:
            self.depth -= 1
            self.out("}")

    def _length(self, target: ast.expr) -> str:
        """First length of an array that is assigned to."""
        t = self.type_of(target)
        assert isinstance(t, Array)
        if t.shape[0] is not None:
            return str(t.shape[0])
        assert isinstance(target, ast.Subscript)
        assert isinstance(target.slice, ast.Slice)
        assert target.slice.upper is not None
        high, low = self.value(target.slice.upper), target.slice.lower
        return high if low is None else f"{high} - {self.value(low, None, 13)}"

    def _test(self, n: ast.expr) -> str:
        text = self.value(n)
        self.flush()
        return text

    def _while(self, s: ast.While) -> None:
        test = self.value(s.test)
        if self.pending:
            self.instance.refuse(s.test, "an array made in the test of a loop", "it before")
        self.out(f"while ({test}) {{")
        self._looped(s)

    def _branch(self, s: ast.If, lead: str) -> None:
        taken = self.instance.decided(s.test)
        if taken is not None and not lead:
            self.block(s.body if taken else s.orelse)
            return
        self.out(f"{lead}if ({self._test(s.test)}) {{")
        self._inner(s.body)
        other = s.orelse[0] if len(s.orelse) == 1 else None
        if isinstance(other, ast.If) and id(other) not in self.scopes.before:
            self._branch(other, "} else ")
            return
        if s.orelse:
            self.out("} else {")
            self._inner(s.orelse)
        self.out("}")

    def _declare(self, name: str) -> None:
        t = self.instance.types[name]
        pointer = isinstance(t, Array | Record)
        empty = EMPTY[t] if isinstance(t, str) else "0" if pointer else "{0}"
        self.out(f"{self.file.declaration(t, self.name(name))} = {empty};")

    def _take(self, s: ast.For) -> None:
        """A loop over a few values."""
        assert isinstance(s.target, ast.Name)
        t = self.type_of(s.iter)
        values = self.value(s.iter) if isinstance(t, Array) else ""
        item = self.instance.types[s.target.id]
        k, name = self.fresh("k"), self.name(s.target.id)
        if isinstance(t, Tuple):
            assert isinstance(s.iter, ast.Tuple)
            values, parts = self.fresh("items"), [self.value(x, item) for x in s.iter.elts]
            self.flush()
            declared = self.file.declaration(Array(str(item), (len(parts),)), values, True)
            self.out(f"const {declared} = {{{', '.join(parts)}}};")
            t = Array(str(item), (len(parts),))
        assert isinstance(t, Array)
        self.out(f"for (int {k} = 0; {k} < {t.shape[0]}; {k}++) {{")
        self.depth += 1
        kind = f"{NUMBER[str(item)]} " if s.target.id in self.scopes.counters else ""
        self.out(f"{kind}{name} = {values}[{k}];")
        self.depth -= 1
        self._looped(s)

    def _loop(self, s: ast.For) -> None:
        assert isinstance(s.target, ast.Name)
        if not isinstance(s.iter, ast.Call):
            self._take(s)
            return
        arguments, name = s.iter.args, s.target.id
        changed = set(stored(s.body)) | {
            _root(n)
            for b in s.body
            for n in ast.walk(b)
            if isinstance(n, ast.Subscript) and isinstance(n.ctx, ast.Store)
        }
        if name in changed and name != "_":
            self.instance.refuse(s.iter, "a counter that its loop changes", "while")
        step = self.instance.whole(arguments[2]) if len(arguments) == 3 else 1
        if step is None:
            self.instance.refuse(s.iter, "a step that is not known")
        low = "0" if len(arguments) == 1 else self.value(arguments[0])
        high = arguments[0] if len(arguments) == 1 else arguments[1]
        end = self.value(high, None, 10)
        if loaded(high) & changed:
            keep = self.fresh("end")
            self.out(f"const int {keep} = {end};")
            end = keep
        i = self.fresh("unused") if name == "_" else self.name(name)
        kind = "int " if name == "_" or name in self.scopes.counters else ""
        move = {1: f"{i}++", -1: f"{i}--"}.get(step, f"{i} += {step}")
        self.flush()
        if ast.unparse(s.iter.func) == "side_by_side":
            self.out("SIDE_BY_SIDE")
        self.out(f"for ({kind}{i} = {low}; {i} {'>' if step < 0 else '<'} {end}; {move}) {{")
        self._looped(s)

    def _looped(self, s: ast.For | ast.While) -> None:
        """The body of a loop, and its else, which a break leaves out."""
        label = self.fresh("after") if s.orelse else ""
        self.labels.append(label)
        self._inner(s.body)
        self.labels.pop()
        self.out("}")
        if label:
            self.block(s.orelse)
            self.lines.append(f"{label}:;")

    def _augment(self, s: ast.AugAssign) -> None:
        if type(s.op) in (ast.FloorDiv, ast.Mod):
            self.instance.refuse(s, "an augmented floor division", "an assignment")
        if s.target in self.instance.elementwise:
            self._elementwise(s.target, s.value, BINARY[type(s.op)][0])
            return
        text = self.value(s.value)
        self.flush()
        self.out(f"{self.value(s.target)} {BINARY[type(s.op)][0]}= {text};")

    def _assign(self, s: ast.Assign) -> None:
        target, value = s.targets[0], s.value
        choice = isinstance(value, ast.IfExp) and isinstance(value.body, ast.Tuple)
        if not (isinstance(target, ast.Tuple) and choice):
            self._parallel(s, list(_pairs(target, value)))
            return
        assert isinstance(value, ast.IfExp)
        for n in ast.walk(target):
            if isinstance(n, ast.Name) and (id(s), n.id) in self.scopes.at:
                self.scopes.at.discard((id(s), n.id))
                self._declare(n.id)
        self.out(f"if ({self._test(value.test)}) {{")
        for side, lead in ((value.body, ""), (value.orelse, "} else {")):
            if lead:
                self.out(lead)
            self.depth += 1
            self._parallel(s, list(_pairs(target, side)))
            self.depth -= 1
        self.out("}")

    def _parallel(self, s: ast.Assign, pairs: list[tuple[ast.expr, ast.expr]]) -> None:
        """Assignments that all read before any of them writes."""
        late = []
        for i, (target, value) in enumerate(pairs):
            name = target.id if isinstance(target, ast.Name) else ""
            if name == "_" and not isinstance(value, ast.Call):
                continue
            if isinstance(target, ast.Tuple):
                self._unpack(s, target, value)
                continue
            if target in self.instance.elementwise:
                if any(_root(target) in loaded(v) for _, v in pairs[i + 1 :]):
                    self.instance.refuse(s, "an array that is read after it", "two assignments")
                self._elementwise(target, value)
                continue
            if makes_array(value) and (id(s), name) in self.scopes.at:
                assert isinstance(value, ast.Call)
                for line in self.storage(value, self.name(name)):
                    self.out(line)
                continue
            t = self.instance.types[name] if name in self.instance.types else self.type_of(target)
            text, root = self.value(value, t), _root(target)
            self.flush()
            if any(root in loaded(v) for _, v in pairs[i + 1 :]):
                keep = self.fresh(f"{root}_next")
                self.out(f"const {self.file.declaration(t, keep)} = {text};")
                late.append((target, keep))
            else:
                self._store(s, target, text)
        for target, keep in late:
            self._store(s, target, keep)

    def _store(self, s: ast.Assign, target: ast.expr, text: str) -> None:
        name = target.id if isinstance(target, ast.Name) else ""
        if name and (name == "_" or self.name(name) == text):
            return
        if name and (id(s), name) in self.scopes.at:
            t: Type = self.instance.types[name]
            fixed = name in self.instance.once and not isinstance(t, Array | Record)
            const = "const " if fixed else ""
            self.out(f"{const}{self.file.declaration(t, self.name(name))} = {text};")
        else:
            self.out(f"{self.value(target)} = {text};")

    def _unpack(self, s: ast.Assign, target: ast.Tuple, value: ast.expr) -> None:
        t = self.type_of(value)
        if isinstance(value, ast.Name):
            text = self.value(value)
        else:
            text, expression = self.fresh("got"), self.value(value)
            self.flush()
            const = "" if isinstance(t, Array) else "const "
            self.out(f"{const}{self.file.declaration(t, text)} = {expression};")
        self._unpack_into(s, target, text, t)

    def _unpack_into(self, s: ast.Assign, target: ast.Tuple, text: str, t: Type) -> None:
        for i, x in enumerate(target.elts):
            part = self.part(text, i, t.items[i]) if isinstance(t, Tuple) else f"{text}[{i}]"
            if isinstance(x, ast.Tuple):
                inner = t.items[i] if isinstance(t, Tuple) else t.at(1)  # type: ignore[union-attr]
                self._unpack_into(s, x, part, inner)
            else:
                self._store(s, x, part)


def _root(n: ast.AST) -> str:
    while isinstance(n, ast.Subscript | ast.Attribute):
        n = n.value
    return str(getattr(n, "id", ""))


def _pairs(target: ast.expr, value: ast.expr):  # type: ignore[no-untyped-def]
    """The single assignments that one of tuples is made of."""
    if isinstance(target, ast.Tuple) and isinstance(value, ast.Tuple):
        for x, y in zip(target.elts, value.elts, strict=True):
            yield from _pairs(x, y)
    else:
        yield target, value
