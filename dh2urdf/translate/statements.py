"""Statements as C, assignments apart."""

import ast

from dh2urdf.translate.assignments import Assignments
from dh2urdf.translate.c_text import folded
from dh2urdf.translate.definitions import Definitions, Instance
from dh2urdf.translate.source import every, loaded, stored, uses
from dh2urdf.translate.types import Array, Record, Tuple, Type, told
from dh2urdf.translate.values import COMPARISON, Value

EMPTY = {"float": "0.0", "int": "0", "bool": "false"}


class Body(Assignments):
    """Writes the body of one kernel; methods for statements say whether nothing comes after."""

    def __init__(self, file: Definitions, instance: Instance) -> None:
        super().__init__(file, instance)
        self.said = set[int]()
        """Lines of the kernel's comments that are written."""
        self.hoisted: dict[int, str] = {}
        """Names that are declared before the block that gives them a value, by their line of C."""
        for p, t in zip(self.source.parameters, instance.arguments, strict=True):
            self.values[p] = self._parameter(p, t, self._pattern(p))

    def _pattern(self, p: str) -> ast.expr | None:
        """How a kernel takes a parameter apart that is a tuple: C has the names from there."""
        for s in every(self.source.body):
            match s:
                case ast.Assign(targets=[ast.Tuple() as target], value=ast.Name(id=name)):
                    if name == p:
                        return target
        return None

    def _parameter(self, name: str, t: Type, pattern: ast.expr | None) -> Value:
        if not isinstance(t, Tuple) or t.is_struct:
            if isinstance(pattern, ast.Name) and pattern.id in self.source.once:
                name = pattern.id
            self.instance.parameters.append((self.name(name), t))
            return Value(t, self.name(name))
        inner: list[ast.expr | None] = [None] * len(t.items)
        if isinstance(pattern, ast.Tuple) and len(pattern.elts) == len(inner):
            inner = list(pattern.elts)
        pairs = enumerate(zip(t.items, inner, strict=True))
        parts = (self._parameter(f"{name}_{k}", item, x) for k, (item, x) in pairs)
        return Value(t, parts=tuple(parts))

    def body(self) -> str:
        """The lines between the braces."""
        ended = self.block(self.source.body)
        if self.instance.returned is not None and not ended:
            self.refuse(self.source.body[-1], "an end without a value", "return of the same types")
        for k, name in self.hoisted.items():
            if self.values[name].known is None:
                t = self.values[name].type
                empty = "{0}" if isinstance(t, Tuple) else EMPTY.get(str(t), "NULL")
                self.lines[k] = 1, f"{self.file.declaration(t, self.name(name))} = {empty};"
        return "\n".join(x for depth, text in self.lines if text for x in folded(text, 4 * depth))

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
        for line, text in self.source.comments.items():
            if line <= s.lineno and line not in self.said:
                self.said.add(line)
                self.out(f"/* {text} */")
        for name in sorted(self.source.declared[1][s]):
            self.hoisted[len(self.lines)] = name
            self.out("")
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
            case ast.Return():
                return self._return(s)
            case ast.Break() | ast.Continue():
                self.out(f"{type(s).__name__.lower()};")
                return True
            case ast.Expr(value=ast.Call()):
                self.out(f"{self.value(s.value).text};")
            case _:
                self.refuse(s, f"{type(s).__name__} is not allowed", "assignments, calls, loops")
        return False

    def _if(self, s: ast.If, before: str = "") -> bool:
        test = self.test(s.test, alone=bool(before))
        taken = test.known
        if taken is not None:
            left = s.orelse if taken else s.body
            self.said.update(k for x in left for k in range(x.lineno, (x.end_lineno or 0) + 1))
            return self.block(s.body if taken else s.orelse)
        self.out(f"{before}if ({test.text}) {{")
        ended = self._inner(s.body)
        match s.orelse:
            case [ast.If() as other] if self.test(other.test).known is None:
                return self._if(other, "} else ") and ended
            case [_, *_]:
                self.out("} else {")
                ended = self._inner(s.orelse) and ended
            case _:
                ended = False
        self.out("}")
        return ended

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
        body = self.source.body
        loops = [x for x in every(body) if isinstance(x, ast.For) and uses(x.target)[counter]]
        astray = sum(uses(x)[counter] for x in loops) != sum(uses(x)[counter] for x in body)
        if counter != "_" and (astray or counter in stored(s.body)):
            self.refuse(s.target, "a counter that is more than that", "another name")
        step = self.value(more[0]).known if more else 1
        if not isinstance(step, int) or step == 0:
            self.refuse(s.iter, "a step that is not known before the kernel runs", "a number")
        start, end = self.integer(low, "a bound").text, self.integer(high, "a bound")
        if end.known is None and self._changes(high, s.body):
            end = self.temporary(end, "end")
        i = self.fresh("turn") if counter == "_" else self.name(counter)
        move = {1: f"{i}++", -1: f"{i}--"}.get(step, f"{i} += {step}")
        sign = "<" if step > 0 else ">"
        self.values[counter] = Value("int", i)
        if kind == "side_by_side":
            self.out("SIDE_BY_SIDE")
        self.out(f"for (int {i} = {start}; {i} {sign} {end.at(COMPARISON + 1)}; {move}) {{")
        self._inner(s.body)
        self.out("}")

    def _changes(self, n: ast.expr, body: list[ast.stmt]) -> bool:
        """Whether the end of a loop may change in it, which Python would not see."""
        if not loaded(n) & self.source.stored:
            return False
        inside = any(isinstance(x, ast.Subscript) for x in ast.walk(n))
        return inside or bool(loaded(n) & set(stored(body)))

    def _return(self, s: ast.Return) -> bool:
        if s.value is None:
            self.out("return;")
            return True
        value = self.value(s.value)
        if isinstance(value.type, Array | Record) or value.leaves() != [value]:
            self.refuse(s, "a returned array", "into an array that is handed in")
        if self.instance.returned not in (None, value.type):
            types = f"{told(value.type)} after {told(self.instance.returned)}"
            self.refuse(s, f"returned values of other types, {types}", "the same types")
        self.instance.returned = value.type
        self.out(f"return {self.text(value)};")
        return True
