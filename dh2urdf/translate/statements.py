"""Statements as C, assignments apart."""

import ast

from dh2urdf.translate.assignments import Assignments
from dh2urdf.translate.definitions import folded
from dh2urdf.translate.source import named
from dh2urdf.translate.types import Array, Record, Tuple, Type, is_fixed, told
from dh2urdf.translate.unused import without_unused
from dh2urdf.translate.values import Binds, Value

EMPTY = {"float": "0.0", "int": "0", "bool": "false"}


class Body(Assignments):
    """Writes the body of one kernel; methods for statements say whether nothing comes after."""

    def write(self) -> None:
        """Write the body."""
        self.comments = dict(self.source.comments)
        """Those that are not yet written, by their lines."""
        self.hoisted: dict[int, str] = {}
        """Names that are declared before the block that gives them a value, by their line of C."""
        taken = dict[str, ast.expr]()
        """How the kernel takes parameters apart that are tuples: C has the names from there."""
        for s in ast.walk(self.source.tree):
            match s:
                case ast.Assign(targets=[ast.Tuple() as target], value=ast.Name(id=name)):
                    taken.setdefault(name, target)
        for p, t in zip(self.source.parameters, self.arguments, strict=True):
            self.values[p] = self._parameter(p, t, taken.get(p))
        ended = self.block(self.source.body)
        if self.returned is not None and not ended:
            self.refuse(self.source.body[-1], "an end without a value", "return of the same types")
        for k, name in self.hoisted.items():
            if self.values[name].known is None:
                t = self.values[name].type
                empty = "{0}" if isinstance(t, Tuple) else EMPTY.get(str(t), "NULL")
                self.lines[k] = 1, f"{self.file.declaration(t, self.name(name))} = {empty};"
        if self.file.folds:
            self.lines = without_unused(self.lines)
        lines = (folded(text, 4 * depth) for depth, text in self.lines if text)
        self.body = "\n".join("\n".join(x) for x in lines)
        kinds = dict(zip(self.source.parameters, self.arguments, strict=True))
        for p, t in kinds.items():
            if is_fixed(t):
                continue
            if p not in self.asked and isinstance(t, Array) and isinstance(t.element, str):
                kinds[p] = t.first()
        self.arguments = tuple(kinds.values())
        loose = {self.values[p].text: t for p, t in kinds.items()}
        self.parameters = [(c, loose.get(c, t)) for c, t in self.parameters]

    def _parameter(self, name: str, t: Type, pattern: ast.expr | None) -> Value:
        if not isinstance(t, Tuple) or t.is_struct:
            if isinstance(pattern, ast.Name) and pattern.id in self.source.once:
                name = pattern.id
            if isinstance(t, Array) and t.fixed:
                return Value(t, t.fixed.text)
            self.parameters.append((self.name(name), t))
            return Value(t, self.name(name))
        inner = getattr(pattern, "elts", [])
        if len(inner) != len(t.items):
            inner = [None] * len(t.items)
        pairs = enumerate(zip(t.items, inner, strict=True))
        parts = (self._parameter(f"{name}_{k}", item, x) for k, (item, x) in pairs)
        return Value(t, parts=tuple(parts))

    def block(self, statements: list[ast.stmt]) -> bool:
        """Statements one after the other, and whether nothing comes after them."""
        return any(self._statement(s) for s in statements)

    def _inner(self, statements: list[ast.stmt]) -> bool:
        self.depth += 1
        ended = self.block(statements)
        self.depth -= 1
        return ended

    def _statement(self, s: ast.stmt) -> bool:
        """A statement, the comments above it, and names that have their values inside it."""
        for line in [x for x in self.comments if x <= s.lineno]:
            self.out(f"/* {self.comments.pop(line)} */")
        for name in sorted(self.source.declared[1][s]):
            self.hoisted[len(self.lines)] = name
            self.out("")
        if isinstance(s, ast.For | ast.While) and s.orelse:
            self.refuse(s, "else of a loop", "a flag, or a kernel that returns")
        match s:
            case ast.Assign():
                self.assign(s)
            case ast.AugAssign():
                self.augment(s)
            case ast.For():
                self._for(s)
            case ast.While():
                self.out(f"while ({self.test(s.test, alone=True).text}) {{")
                self._inner(s.body)
                self.out("}")
            case ast.If():
                return self._if(s)
            case ast.Return(value=ast.expr() as value):
                self._return(s, self.value(value))
                return True
            case ast.Return() | ast.Break() | ast.Continue():
                self.out(f"{type(s).__name__.lower()};")
                return True
            case ast.Expr(value=ast.Call() | ast.Yield()):
                self.out(f"{self.value(s.value).text};")
            case _:
                self.unknown(s, s, "assignments, calls, loops")
        return False

    def _if(self, s: ast.If, before: str = "") -> bool:
        test = self.test(s.test, alone=bool(before))
        taken = test.known
        if taken is not None:
            for x in s.orelse if taken else s.body:
                for line in range(x.lineno, (x.end_lineno or 0) + 1):
                    self.comments.pop(line, None)
            return self.block(s.body if taken else s.orelse)
        self.out(f"{before}if ({test.text}) {{")
        ended = self._inner(s.body)
        match s.orelse:
            case [ast.If() as other] if self.test(other.test).known is None:
                return self._if(other, "} else ") and ended
        if s.orelse:
            self.out("} else {")
            ended = self._inner(s.orelse) and ended
        self.out("}")
        return ended and bool(s.orelse)

    def _for(self, s: ast.For) -> None:
        match s:
            case ast.For(
                target=ast.Name(id=counter),
                iter=ast.Call(func=ast.Name(id="range" | "side_by_side" as kind), args=arguments),
            ) if 1 <= len(arguments) <= 3:
                several = len(arguments) > 1
                low, high, *more = arguments if several else (ast.Constant(0), *arguments)
            case _:
                self.refuse(s.iter, "a loop over something else", "for ... in range(...)")
        again = counter != "_" and named(s, ast.Store)[counter] > 1
        if again or counter in self.source.astray:
            self.refuse(s.target, "a counter that is more than that", "another name")
        step = self.value(more[0]).known if more else 1
        if not isinstance(step, int) or step == 0:
            self.refuse(s.iter, "a step that is not known before the kernel runs", "a number")
        start, end = self.integer(low, "a bound").text, self.integer(high, "a bound")
        reads = named(high).keys() & self.source.stored
        items = reads and any(isinstance(x, ast.Subscript) for x in ast.walk(high))
        calls = any(isinstance(x, ast.Call) and self._is_kernel(x) for x in ast.walk(high))
        changes = items or calls or reads & named(s, ast.Store).keys()
        if end.known is None and changes:
            end = self.temporary(end, "end")
        i = self.fresh("turn") if counter == "_" else self.name(counter)
        move = {1: f"{i}++", -1: f"{i}--"}.get(step, f"{i} += {step}")
        sign = "<" if step > 0 else ">"
        self.values[counter] = Value("int", i)
        if kind == "side_by_side":
            self.out("SIDE_BY_SIDE")
        self.out(f"for (int {i} = {start}; {i} {sign} {end.at(Binds.COMPARISON + 1)}; {move}) {{")
        self._inner(s.body)
        self.out("}")

    def _is_kernel(self, call: ast.Call) -> bool:
        """Whether a call is one of a kernel."""
        return self.source.kernel(ast.unparse(call.func)) is not None

    def _return(self, s: ast.Return, value: Value) -> None:
        if isinstance(value.type, Array | Record) or value.leaves() != [value]:
            self.refuse(s, "a returned array", "into an array that is handed in")
        if self.returned not in (None, value.type):
            types = f"{told(value.type)} after {told(self.returned)}"
            self.refuse(s, f"returned values of other types, {types}", "the same types")
        self.returned = value.type
        self.out(f"return {self.text(value)};")
