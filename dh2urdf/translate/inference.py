"""Types of everything in a kernel, found by going through it with the types of its arguments.

A kernel is translated once for each list of argument types: an *instance*. Kernels that make
arrays and return them become a part of their callers, since C hands out no local memory.
"""

import ast
import copy
import re
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass, field
from typing import Any, NoReturn

import numpy as np

from dh2urdf.translate.source import MAKERS, Source, makes_array, stored
from dh2urdf.translate.types import Array, Kernel, Record, Tuple, Type, joined, told, type_of_value

LIBRARY = """
sqrt sin cos tan atan asin acos atan2 hypot floor ceil copysign fmod isinf isnan isfinite
"""
C_FUNCTIONS = {f"math.{name}": name for name in LIBRARY.split()}
C_FUNCTIONS |= {f"np.{name}": name for name in ("rint", "floor", "ceil")} | {"float": "(double)"}

SUMS: dict[type[ast.operator], tuple[str, Callable[[int, int], int]]] = {
    ast.Add: ("+", int.__add__),
    ast.Sub: ("-", int.__sub__),
    ast.Mult: ("*", int.__mul__),
    ast.FloorDiv: ("//", int.__floordiv__),
}

DECIDE: dict[type[ast.cmpop], Callable[[int, int], bool]] = {
    ast.Eq: int.__eq__,
    ast.NotEq: int.__ne__,
    ast.Lt: int.__lt__,
    ast.LtE: int.__le__,
    ast.Gt: int.__gt__,
    ast.GtE: int.__ge__,
}

COUNTS = ("range", "side_by_side")

PREDICATES = ("math.isinf", "math.isnan", "math.isfinite")

INTEGERS = ("int", "np.int64", "len")

ELEMENT_OF = {"np.float64": "float", "np.int64": "int", "np.bool_": "bool"}


@dataclass(eq=False)
class Instance:
    """A kernel for one list of argument types."""

    source: Source
    arguments: tuple[Type, ...]
    body: list[ast.stmt]
    types: dict[str, Type] = field(default_factory=dict)
    types_of: dict[ast.expr, Type] = field(default_factory=dict)
    called: dict[ast.Call, "Instance"] = field(default_factory=dict)
    elementwise: set[ast.expr] = field(default_factory=set)
    """Targets that are arrays, all of whose elements are assigned."""
    once: set[str] = field(default_factory=set)
    known: dict[str, int | str] = field(default_factory=dict)
    returned: Type = None
    name: str = ""

    def refuse(self, node: ast.AST, found: str, instead: str = "") -> NoReturn:
        """Refuse a node of the body."""
        self.source.refuse(node, found, instead)

    def reached(self, statements: list[ast.stmt]) -> Iterator[ast.stmt]:
        """Statements up to one that is known to return."""
        for s in statements:
            yield s
            taken = self.decided(s.test) if isinstance(s, ast.If) else None
            if taken is not None and isinstance(s, ast.If):
                block = s.body if taken else s.orelse
                if block and isinstance(block[-1], ast.Return):
                    return

    def lengths(self) -> list[str]:
        """Names of the lengths that it is handed."""
        arrays = (t for t in _leaves(self.arguments) if isinstance(t, Array))
        symbols = (d for t in arrays for d in t.shape if isinstance(d, str))
        return sorted({x for d in symbols for x in re.findall(r"[a-z]\w*", d)})

    def size(self, node: ast.expr) -> int | str | None:
        """A whole number that is known before the kernel runs, or in terms of its lengths."""
        if isinstance(node, ast.Constant):
            return node.value if type(node.value) is int else None
        if isinstance(node, ast.Name):
            if node.id in self.types:
                return self.known.get(node.id)
            value = self.source.stands_for(node)
            return int(value) if isinstance(value, int | np.integer) else None
        if isinstance(node, ast.UnaryOp) and isinstance(node.op, ast.USub):
            value = self.size(node.operand)
            return -value if isinstance(value, int) else None
        if isinstance(node, ast.BinOp):
            return self._sum(node)
        if isinstance(node, ast.Attribute) and node.attr == "ndim":
            t = self.types_of.get(node.value)
            return len(t.shape) if isinstance(t, Array) else None
        return self.length(node)

    def whole(self, node: ast.expr) -> int | None:
        """A whole number that is known before the kernel runs."""
        value = self.size(node)
        return value if isinstance(value, int) else None

    def decided(self, test: ast.expr) -> bool | None:
        """What a comparison of whole numbers says that are known before the kernel runs."""
        if isinstance(test, ast.Compare) and len(test.ops) == 1:
            a, b = self.whole(test.left), self.whole(test.comparators[0])
            if a is not None and b is not None and type(test.ops[0]) in DECIDE:
                return DECIDE[type(test.ops[0])](a, b)
        return None

    def _sum(self, node: ast.BinOp) -> int | str | None:
        a, b = self.size(node.left), self.size(node.right)
        if a is None or b is None or type(node.op) not in SUMS:
            return None
        sign, exact = SUMS[type(node.op)]
        if isinstance(a, int) and isinstance(b, int):
            return exact(a, b)
        return None if sign == "//" else f"({a} {sign} {b})"

    def length(self, node: ast.expr) -> int | str | None:
        """The length that ``x.shape[k]`` or ``len(x)`` asks for."""
        if isinstance(node, ast.Subscript) and isinstance(node.value, ast.Attribute):
            of, index = node.value.value, self.whole(node.slice)
            if node.value.attr != "shape" or index is None:
                return None
        elif isinstance(node, ast.Call) and ast.unparse(node.func) == "len":
            of, index = node.args[0], 0
        else:
            return None
        t = self.types_of.get(of)
        if isinstance(t, Tuple):
            return len(t.items)
        return t.shape[index] if isinstance(t, Array) else None


def _leaves(types: Iterable[Type]) -> Iterator[Type]:
    for t in types:
        yield from _leaves(t.items) if isinstance(t, Tuple) else (t,)


class Inference:
    """All instances that some entries need, in the order in which C has to have them."""

    def __init__(self) -> None:
        self.order: list[Instance] = []
        self.entries: list[Instance] = []
        self._instances: dict[tuple[Source, tuple[Type, ...]], Instance] = {}
        self._sources: dict[Any, Source] = {}
        self._asking: dict[tuple[Source, str], bool] = {}
        self._inlined: dict[Source, set[str]] = {}

    def add_entry(self, function: Any, arguments: list[Type]) -> Instance:
        """An instance that others may call."""
        instance = self._instance(self._source(function), tuple(arguments))
        self.entries.append(instance)
        return instance

    def _source(self, function: Any) -> Source:
        key = getattr(function, "py_func", function)
        if key not in self._sources:
            self._sources[key] = Source(key)
        return self._sources[key]

    def _kernel(self, source: Source, node: ast.expr) -> Any:
        """The kernel that a name of the module stands for."""
        value = source.stands_for(node)
        own = source.module.__name__.partition(".")[0]
        inside = getattr(value, "__module__", "").partition(".")[0] == own
        return value if inside and hasattr(value, "__code__") else None

    def _asks_length(self, source: Source, name: str) -> bool:
        """Whether a kernel asks for the first length of a parameter, itself or where it goes."""
        key = source, name
        if key not in self._asking:
            self._asking[key] = False  # a kernel does not call itself
            self._asking[key] = self._asks_itself(source, name)
        return self._asking[key]

    def _asks_itself(self, source: Source, name: str) -> bool:
        for n in ast.walk(source.tree):
            shape = isinstance(n, ast.Attribute) and n.attr == "shape"
            if shape and ast.unparse(n.value) == name:
                return True
            if isinstance(n, ast.AugAssign) and ast.unparse(n.target) == name:
                return True
            sliced = isinstance(n, ast.Subscript) and isinstance(n.slice, ast.Slice)
            if sliced and ast.unparse(n.value) == name:
                return True
            if not isinstance(n, ast.Call):
                continue
            if ast.unparse(n.func) == "len" and ast.unparse(n.args[0]) == name:
                return True
            at = [i for i, a in enumerate(n.args) if isinstance(a, ast.Name) and a.id == name]
            if at and any(isinstance(a, ast.Starred) for a in n.args):
                return True
            if at and isinstance(n.func, ast.Name) and n.func.id in source.parameters:
                return True
            callee = self._kernel(source, n.func)
            if callee is not None and at:
                other = self._source(callee)
                if any(self._asks_length(other, other.parameters[i]) for i in at):
                    return True
        return False

    def _instance(self, source: Source, arguments: tuple[Type, ...]) -> Instance:
        seen = tuple(
            t.unsized()
            if isinstance(t, Array)
            and not isinstance(t.element, Record)
            and not self._asks_length(source, p)
            else t
            for p, t in zip(source.parameters, arguments, strict=True)
        )
        if (source, seen) not in self._instances:
            instance = Instance(source, seen, self._with_makers(source, source.body))
            self._instances[source, seen] = instance
            instance.types = dict(zip(source.parameters, seen, strict=True))
            names = stored(instance.body)
            instance.once = {x for x in names if names.count(x) == 1} - set(source.parameters)
            walk = Walk(self, instance)
            while True:
                before = dict(instance.types), instance.returned
                walk.block(instance.body)
                if before == (instance.types, instance.returned):
                    break
            self.order.append(instance)
        return self._instances[source, seen]

    # ------------------------------------------------------------- kernels that make arrays

    def _is_maker(self, source: Source) -> bool:
        """Whether a kernel makes arrays and returns them."""
        last = source.body[-1]
        returns = [n for n in ast.walk(source.tree) if isinstance(n, ast.Return)]
        if returns != [last] or not isinstance(last, ast.Return) or last.value is None:
            return False
        made = set()
        for s in source.body:
            if isinstance(s, ast.Assign):
                targets = getattr(s.targets[0], "elts", s.targets)
                values = getattr(s.value, "elts", [s.value])
                for x, v in zip(targets, values, strict=False):
                    if any(makes_array(n) for n in ast.walk(v)) and isinstance(x, ast.Name):
                        made.add(x.id)
        parts = getattr(last.value, "elts", [last.value])
        return any((isinstance(p, ast.Name) and p.id in made) or makes_array(p) for p in parts)

    def _with_makers(self, source: Source, body: list[ast.stmt]) -> list[ast.stmt]:
        """A body with the statements of those kernels in place of their calls."""
        out: list[ast.stmt] = []
        for given in body:
            s = copy.deepcopy(given)
            for block in ("body", "orelse"):
                if isinstance(s, ast.For | ast.While | ast.If):
                    setattr(s, block, self._with_makers(source, getattr(s, block)))
            if isinstance(s, ast.Assign):
                before, s.value = self._without_makers(source, s.value, s)
                out += before
            out.append(s)
        return out

    def _without_makers(
        self, source: Source, value: ast.expr, where: ast.stmt
    ) -> tuple[list[ast.stmt], ast.expr]:
        """The statements of the kernels called in an expression, and what is left of that."""
        out, swap = list[ast.stmt](), _Swap()
        for n in [n for n in ast.walk(value) if isinstance(n, ast.Call)]:
            callee = self._kernel(source, n.func)
            if callee is not None and self._is_maker(self._source(callee)):
                before, swap.by[n] = self._spelled_out(source, self._source(callee), n, where)
                out += before
        return out, swap.visit(value)

    def _spelled_out(
        self, source: Source, other: Source, call: ast.Call, where: ast.stmt
    ) -> tuple[list[ast.stmt], ast.expr]:
        """Statements of a kernel with names of their own, and what it returns."""
        taken = self._inlined.setdefault(source, set())
        local = set(other.parameters) | set(stored(other.body))
        used = {n.id for n in ast.walk(source.tree) if isinstance(n, ast.Name)}
        used |= set(source.parameters) | taken
        new = {x: x if x not in used else f"{x}_{other.name}{len(taken)}" for x in local}
        taken |= set(new.values())
        part = self._with_makers(other, other.body)
        for n in (n for s in part for n in ast.walk(s) if isinstance(n, ast.Name)):
            if n.id in local:
                n.id = new[n.id]
            elif hasattr(other.module, n.id) and n.id not in ("np", "math"):
                n.id = f"{other.module.__name__}::{n.id}"
        out: list[ast.stmt] = [
            ast.Assign([ast.Name(new[p], ast.Store())], a)
            for p, a in zip(other.parameters, call.args, strict=True)
        ]
        last = part[-1]
        assert isinstance(last, ast.Return)
        assert last.value is not None
        before, value = self._without_makers(source, last.value, where)
        placed = [*out, *part[:-1], *before]
        for n in (n for s in placed for n in ast.walk(s)):
            if isinstance(n, ast.expr | ast.stmt):
                ast.copy_location(n, where)
        return placed, value


class _Swap(ast.NodeTransformer):
    """Puts other nodes in the place of some calls."""

    def __init__(self) -> None:
        self.by: dict[ast.Call, ast.expr] = {}

    def visit_Call(self, node: ast.Call) -> ast.AST:
        return self.by.get(node) or self.generic_visit(node)


class Walk:
    """Goes through the body of an instance and notes the types."""

    def __init__(self, inference: Inference, instance: Instance) -> None:
        self.inference, self.instance = inference, instance

    def block(self, statements: list[ast.stmt]) -> None:
        """Statements one after the other."""
        for s in self.instance.reached(statements):
            self._statement(s)

    def _statement(self, s: ast.stmt) -> None:
        inst = self.instance
        match s:
            case ast.Assign():
                self._bind(s.targets[0], self.of(s.value), s.value)
                self._whole_array(s, s.targets[0])
            case ast.AugAssign():
                left = ast.copy_location(copy.copy(s.target), s)
                whole = ast.copy_location(ast.BinOp(left, s.op, s.value), s)
                self._bind(s.target, self.of(whole), None)
                self._whole_array(s, s.target)
            case ast.For():
                self._bind(s.target, self._item(s.iter), None)
                self.block(s.body + s.orelse)
            case ast.If() | ast.While():
                self.of(s.test)
                taken = inst.decided(s.test) if isinstance(s, ast.If) else None
                self.block(s.body if taken is not False else [])
                self.block(s.orelse if taken is not True else [])
            case ast.Return():
                if s.value is not None:
                    inst.returned = joined(inst.returned, self.of(s.value))
            case ast.Expr():
                self.of(s.value)
            case ast.Break() | ast.Continue() | ast.Pass():
                pass
            case _:
                inst.refuse(s, f"{type(s).__name__} is not allowed")

    def _item(self, iterated: ast.expr) -> Type:
        """Type of what a loop counts, or takes from a few values."""
        if isinstance(iterated, ast.Call) and ast.unparse(iterated.func) in COUNTS:
            for a in iterated.args:
                self.of(a)
            return "int"
        t = self.of(iterated)
        if isinstance(t, Tuple):
            item: Type = None
            for other in t.items:
                item = joined(item, other)
            return item
        if isinstance(t, Array) and isinstance(t.shape[0], int):
            return t.at(1)
        self.instance.refuse(iterated, "a loop over something else", "for ... in range(...)")

    def _bind(self, target: ast.expr, t: Type, value: ast.expr | None) -> None:
        inst = self.instance
        if isinstance(target, ast.Name):
            if target.id == "_":
                return
            if isinstance(value, ast.BinOp | ast.UnaryOp) and isinstance(t, Array):
                inst.refuse(value, "a new array", "an assignment to all elements of one")
            try:
                inst.types[target.id] = joined(inst.types.get(target.id), t)
            except TypeError as error:
                inst.refuse(target, f"one name for two types, {error}", "two names")
            number = None if value is None else inst.size(value)
            if number is not None and target.id in inst.once:
                inst.known[target.id] = number
        elif isinstance(target, ast.Tuple):
            items = (
                t.items if isinstance(t, Tuple) else (t.at(1),) * len(target.elts)  # type: ignore
            )
            values = value.elts if isinstance(value, ast.Tuple) else [None] * len(items)
            for x, y, v in zip(target.elts, items, values, strict=True):
                self._bind(x, y, v)
        else:
            self.of(target)
            base = target
            while isinstance(base, ast.Subscript):
                base = base.value
            array = inst.types.get(getattr(base, "id", ""))
            if isinstance(array, Array) and array.constant:
                inst.refuse(target, "written to, but constant")

    def _whole_array(self, s: ast.Assign | ast.AugAssign, target: ast.expr) -> None:
        """Note an assignment to all elements of an array."""
        if isinstance(target, ast.Tuple):
            if isinstance(s.value, ast.Tuple):
                for x, v in zip(target.elts, s.value.elts, strict=True):
                    self._whole_array(ast.copy_location(ast.Assign([x], v), s), x)
            return
        named = isinstance(target, ast.Name) and isinstance(s, ast.Assign)
        if named or not self._is_array(target):
            return
        left, right = self.of(target), self.of(s.value)
        assert isinstance(left, Array)
        if isinstance(right, Array) and len(right.shape) != len(left.shape):
            self.instance.refuse(s, f"{told(left)} and {told(right)}", "a loop")
        sliced = isinstance(target, ast.Subscript) and isinstance(target.slice, ast.Slice)
        if None in left.shape[1:] or (
            left.shape[0] is None and not (sliced and target.slice.upper)
        ):
            self.instance.refuse(s, "an array whose length is not known", "a loop")
        self.instance.elementwise.add(target)

    def _is_array(self, n: ast.expr) -> bool:
        return isinstance(self.instance.types_of.get(n) or self.of(n), Array)

    def of(self, node: ast.expr) -> Type:
        """Type of an expression, noted for the writer."""
        t = self.instance.types_of[node] = self._of(node)
        return t

    def _of(self, n: ast.expr) -> Type:
        inst = self.instance
        match n:
            case ast.Constant():
                kinds: dict[type, Type] = {bool: "bool", int: "int", float: "float"}
                return kinds.get(type(n.value)) or inst.refuse(n, "a value of another kind")
            case ast.Name():
                if n.id in inst.types:
                    return inst.types[n.id]
                t = type_of_value(inst.source.stands_for(n))
                return t or inst.refuse(n, "a name that is not known")
            case ast.Attribute():
                if isinstance(n.value, ast.Name) and n.value.id in ("math", "np"):
                    return "float"
                if n.attr == "ndim":
                    self.of(n.value)
                    return "int"
                t = type_of_value(inst.source.stands_for(n))
                return t or inst.refuse(n, "an attribute")
            case ast.Tuple():
                return Tuple(tuple(self.of(x) for x in n.elts))
            case ast.UnaryOp():
                t = self.of(n.operand)
                if isinstance(t, Array) and isinstance(n.op, ast.USub):
                    return t
                return "bool" if isinstance(n.op, ast.Not) else joined("int", t)
            case ast.BinOp():
                return self._arithmetic(n)
            case ast.Compare():
                for x in [n.left, *n.comparators]:
                    self.of(x)
                return "bool"
            case ast.BoolOp():
                for x in n.values:
                    self.of(x)
                return "bool"
            case ast.IfExp():
                self.of(n.test)
                return joined(self.of(n.body), self.of(n.orelse))
            case ast.Subscript():
                return self._subscript(n)
            case ast.Call():
                return self._call(n)
        inst.refuse(n, f"{type(n).__name__} is not allowed")

    def _arithmetic(self, n: ast.BinOp) -> Type:
        a, b = self.of(n.left), self.of(n.right)
        if isinstance(a, Tuple) and isinstance(b, Tuple) and isinstance(n.op, ast.Add):
            return Tuple(a.items + b.items)
        array = a if isinstance(a, Array) else b
        other = b if isinstance(a, Array) else a
        if isinstance(array, Array) and isinstance(array.element, str):
            kind = other.element if isinstance(other, Array) else other
            if isinstance(kind, str) and type(n.op) in (ast.Add, ast.Sub, ast.Mult, ast.Div):
                return Array(str(joined(array.element, kind)), array.shape)
        if not (isinstance(a, str) and isinstance(b, str)):
            self.instance.refuse(n, f"arithmetic with {told(a)} and {told(b)}", "a loop")
        if isinstance(n.op, ast.Div):
            return "float"
        floor = isinstance(n.left, ast.Call) and ast.unparse(n.left.func) == "math.floor"
        if isinstance(n.op, ast.FloorDiv | ast.Mod) and floor:
            self.instance.types_of[n.left] = a = "int"
        if isinstance(n.op, ast.FloorDiv | ast.Mod) and "float" in (a, b):
            self.instance.refuse(n, "floor division of floats", "math.floor")
        if isinstance(n.op, ast.BitAnd | ast.BitOr | ast.BitXor):
            return joined(a, b)
        return joined(joined(a, b), "int")

    def _subscript(self, n: ast.Subscript) -> Type:
        inst = self.instance
        if isinstance(n.value, ast.Attribute) and n.value.attr == "shape":
            self.of(n.value.value)
            return "int"
        t = self.of(n.value)
        if isinstance(t, Record) and isinstance(n.slice, ast.Constant):
            return t.field_type(n.slice.value)
        if isinstance(t, Tuple):
            k = inst.whole(n.slice)
            return inst.refuse(n, "item of a tuple by a variable") if k is None else t.items[k]
        if not isinstance(t, Array):
            inst.refuse(n, f"an index into {told(t)}")
        index = n.slice.elts if isinstance(n.slice, ast.Tuple) else [n.slice]
        if isinstance(index[-1], ast.Slice):
            return self._slice(n, t, index[:-1], index[-1])
        for x in index:
            if isinstance(x, ast.Slice):
                inst.refuse(n, "a slice before the last index", "a loop")
            if self.of(x) not in ("int", "bool"):
                inst.refuse(n, "an index that is no whole number", "int(math.floor(x))")
        return t.at(len(index))

    def _slice(self, n: ast.Subscript, t: Array, lead: list[ast.expr], s: ast.Slice) -> Type:
        inst = self.instance
        if s.step is not None or any(isinstance(x, ast.Slice) for x in lead):
            inst.refuse(n, "a slice with a step, or before the last index", "a loop")
        for x in [*lead, s.lower, s.upper]:
            if x is not None:
                self.of(x)
        rest = t.at(len(lead))
        if not isinstance(rest, Array):
            inst.refuse(n, "too many indices")
        low = 0 if s.lower is None else inst.size(s.lower)
        high = rest.shape[0] if s.upper is None else inst.size(s.upper)
        length = high - low if isinstance(low, int) and isinstance(high, int) else None
        if low == 0:
            length = high
        if (
            s.lower is not None
            and isinstance(s.upper, ast.BinOp)
            and isinstance(s.upper.op, ast.Add)
        ) and ast.dump(s.upper.left) == ast.dump(s.lower):
            length = inst.size(s.upper.right)
        return Array(rest.element, (length, *rest.shape[1:]), rest.constant)

    def _call(self, n: ast.Call) -> Type:
        inst, name = self.instance, ast.unparse(n.func)
        if name in MAKERS:
            return self._made(n)
        if n.keywords:
            inst.refuse(n, "a keyword argument", "a positional one")
        arguments: list[Type] = []
        for a in n.args:
            if isinstance(a, ast.Starred):
                t = self.of(a.value)
                arguments += t.items if isinstance(t, Tuple) else inst.refuse(n, "starred")
            else:
                arguments.append(self.of(a))
                if isinstance(a, ast.BinOp | ast.UnaryOp) and isinstance(arguments[-1], Array):
                    inst.refuse(n, "a new array", "an assignment to one that is there")
        if name in ("abs", "max", "min"):
            t = arguments[0]
            for other in arguments[1:]:
                t = joined(t, other)
            return joined(t, "int")
        if name in INTEGERS:
            return "int"
        if name in C_FUNCTIONS:
            return "bool" if name in PREDICATES else "float"
        if isinstance(n.func, ast.Name) and isinstance(inst.types.get(n.func.id), Kernel):
            callee = inst.types[n.func.id].function  # type: ignore[union-attr]
        else:
            callee = self.inference._kernel(inst.source, n.func)
        if callee is None:
            inst.refuse(n, "a call of something else than a kernel", "a kernel, or math")
        made = self.inference._instance(self.inference._source(callee), tuple(arguments))
        inst.called[n] = made
        return made.returned

    def _made(self, n: ast.Call) -> Type:
        inst = self.instance
        shape = n.args[0].elts if isinstance(n.args[0], ast.Tuple) else [n.args[0]]
        for x in shape:
            self.of(x)
        lengths = tuple(inst.size(x) for x in shape)
        if None in lengths:
            inst.refuse(n, "an array whose shape is not known before the kernel runs")
        full = ast.unparse(n.func) == "np.full"
        if full:
            self.of(n.args[1])
        rest = n.args[2:] if full else n.args[1:]
        dtype = ast.unparse(rest[0]) if rest else "np.float64"
        return Array(ELEMENT_OF[dtype], lengths)
