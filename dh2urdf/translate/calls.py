"""Calls as C: of kernels, of the mathematical library, and of what makes arrays."""

import ast
from collections.abc import Callable
from dataclasses import replace
from functools import reduce

from dh2urdf.translate.definitions import NUMBER, number
from dh2urdf.translate.expressions import Expressions
from dh2urdf.translate.source import MAKERS, Source
from dh2urdf.translate.types import Array, Tuple, is_fixed, type_of_value
from dh2urdf.translate.values import Binds, Value

OF_TWO = ("math.copysign", "math.fmod")

OF_ONE = (
    *("math.sqrt", "np.floor", "np.ceil", "np.rint", "math.isinf", "math.isnan", "math.isfinite"),
    *("abs", "int", "float"),
)
"""Functions of one number whose result is the same everywhere, as C names them too."""

EXTREMES = {"max": "larger", "min": "smaller"}

ALLOWED = (*OF_ONE, *OF_TWO, *EXTREMES, "len", *MAKERS)

ELEMENT_OF = {"np.float64": "float", "np.int64": "int", "np.bool_": "bool"}

SAME: dict[str, Callable[[float], float]] = {"abs": abs}
"""What is also done with a number that is known."""

NOTHING = Tuple(())
"""What a kernel gives that returns no value."""


def evaluated(found: object) -> Value:
    """What a kernel returned, as a value that is known."""
    if isinstance(found, tuple):
        parts = tuple(map(evaluated, found))
        return Value(Tuple(tuple(part.type for part in parts)), parts=parts)
    found = getattr(found, "item", lambda: found)()
    t, text = type_of_value(found), number(found)
    assert isinstance(t, str)
    known = found if isinstance(found, bool | int | float) else None
    return Value(t, text, Binds.PREFIX if text[0] == "-" else Binds.ATOM, known=known)


class Calls(Expressions):
    """Writes the calls of one kernel."""

    def _call(self, n: ast.Call) -> Value:
        for keyword in n.keywords:
            self.unknown(n, keyword)
        name = ast.unparse(n.func)
        callee = self.source.kernel(name)
        if callee is not None:
            return self._made_by(n, callee) if callee.made else self._kernel(n, callee)
        if name not in ALLOWED:
            self.refuse(n, "a call of something else", f"a kernel, or {', '.join(ALLOWED)}")
        if name in MAKERS:
            return self._array(n, name)
        if name == "len":
            return self.length(n.args[0], 0)
        return self._number(n, name, [self.number(a) for a in n.args])

    def _number(self, n: ast.Call, name: str, values: list[Value]) -> Value:
        """A call that gives a number."""
        if name in EXTREMES and len(values) > 1:  # the first of those that are equal
            if len({x.type for x in values}) > 1:
                self.refuse(n, f"{name} of values of two types", "float(x) of the whole numbers")
            c = EXTREMES[name] + "_int" * (values[0].type != "float")
            return reduce(lambda a, b: self.helper(c, a.type, a, b), values)
        wanted = "others" if name in EXTREMES else "2" if name in OF_TWO else "1"
        if str(len(values)) != wanted:
            self.refuse(n, f"{len(values)} arguments of {name}", wanted)
        value, c = values[0], name.rpartition(".")[2]
        if name in NUMBER:
            text = f"({NUMBER[name]}){value.at(Binds.PREFIX)}"
            return value if value.type == name else Value(name, text, Binds.PREFIX)
        if name == "abs" and value.type != "float":
            return self.helper("size_int", "int", value)
        t = "bool" if c.startswith("is") else "float"
        called = self.helper("fabs" if name == "abs" else c, t, *values)
        if name in SAME and isinstance(value.known, float):
            called = replace(called, known=SAME[name](abs(value.known)))
        return called

    def _kernel(self, n: ast.Call, callee: Source) -> Value:
        given = self.spread(n.args)
        if len(given) != len(callee.parameters):
            self.refuse(n, f"{len(given)} arguments", f"{len(callee.parameters)}")
        if self.file.folds:
            known = [value.meant() for _, value in given]
            if not any(x is None for x in known):
                return evaluated(self.file.definition(callee)(*known))
        pairs = list(zip(callee.parameters, given, strict=True))
        handed = [
            self.stored(value, self.fresh(f"array_{p}") if value.maker else p)
            for p, (_, value) in pairs
        ]
        instance = self.translate(callee, tuple(value.type for value in handed))
        self.asked |= {name for p, (name, _) in pairs if p in instance.asked}
        missing = set(instance.lengths()) - set(self.lengths())
        if missing:
            self.refuse(n, f"the length {missing.pop()} is not known here", "an argument with it")
        leaves = [leaf for value in handed for leaf in value.leaves()]
        texts = [self.text(leaf) for leaf in leaves if not is_fixed(leaf.type)]
        text = f"{instance.function}({', '.join([*instance.lengths(), *texts])})"
        return Value(instance.returned or NOTHING, text, Binds.POSTFIX)

    def stored(self, value: Value, name: str) -> Value:
        """A value whose arrays have names: what a maker makes is declared."""
        if value.parts:
            parts = (self.stored(part, f"{name}_{k}") for k, part in enumerate(value.parts))
            return replace(value, parts=tuple(parts))
        t = value.type
        if not value.maker or not isinstance(t, Array):
            return value
        zeros, fixed = value.maker == "np.zeros", all(isinstance(d, int) for d in t.shape)
        declared = self.file.declaration(t, name, storage=True)
        none = "{" * len(t.shape) + "0" + "}" * len(t.shape)
        self.out(f"{declared}{f' = {none}' if zeros and fixed else ''};")
        if zeros and not fixed:
            self.out(f"memset({name}, 0, sizeof {name});")
        return Value(t, name)

    def _array(self, n: ast.Call, maker: str) -> Value:
        shape = n.args[0].elts if isinstance(n.args[0], ast.Tuple) else n.args[:1]
        lengths = tuple(self.value(x).length for x in shape)
        if None in lengths:
            self.refuse(n, "a shape that is not known before the kernel runs", "lengths, numbers")
        dtype = ast.unparse(n.args[1]) if n.args[1:] else "np.float64"
        if dtype not in ELEMENT_OF:
            self.refuse(n, "elements of another kind", " or ".join(ELEMENT_OF))
        return Value(Array(ELEMENT_OF[dtype], lengths), maker=maker)

    def _made_by(self, n: ast.Call, callee: Source) -> Value:
        """The arrays that a kernel makes: C returns none, so that they are the caller's."""
        assert callee.made
        maker = Calls(self.file, callee, self.arguments, self.translate)
        for p, a in zip(callee.parameters, n.args, strict=True):
            maker.values[p] = self.value(a)
            if maker.values[p].known is None:
                self.refuse(a, "a length that is not known before the kernel runs", "a number")
        return maker.value(callee.made)
