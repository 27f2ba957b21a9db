"""Calls as C: of kernels, of the mathematical library, and of what makes arrays."""

import ast
from dataclasses import replace

from dh2urdf.translate.definitions import Instance
from dh2urdf.translate.expressions import Expressions
from dh2urdf.translate.source import MAKERS, Source
from dh2urdf.translate.types import Array, Tuple
from dh2urdf.translate.values import POSTFIX, PREFIX, Value

LIBRARY = {
    "math.sqrt": ("sqrt", 1, "float"),
    "math.copysign": ("copysign", 2, "float"),
    "math.fmod": ("fmod", 2, "float"),
    "np.floor": ("floor", 1, "float"),
    "np.ceil": ("ceil", 1, "float"),
    "np.rint": ("rint", 1, "float"),
    "math.isinf": ("isinf", 1, "bool"),
    "math.isnan": ("isnan", 1, "bool"),
    "math.isfinite": ("isfinite", 1, "bool"),
}
"""Functions whose result is the same everywhere, how many arguments they take, what they give."""

CASTS = {"float": "double", "int": "int"}

EXTREMES = {"max": "larger", "min": "smaller"}

ALLOWED = (*LIBRARY, *CASTS, *EXTREMES, "abs", "len", *MAKERS)

ELEMENT_OF = {"np.float64": "float", "np.int64": "int", "np.bool_": "bool"}

NOTHING = Tuple(())
"""What a kernel gives that returns no value."""


class Calls(Expressions):
    """Writes the calls of one kernel."""

    def _call(self, n: ast.Call) -> Value:
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
        if name in EXTREMES and len(values) > 1:
            return self._extreme(n, name, values)
        c, count, t = LIBRARY.get(name, ("fabs", 1, "float"))
        if name in EXTREMES or len(values) != count:
            wanted = "others" if name in EXTREMES else str(count)
            self.refuse(n, f"{len(values)} arguments of {name}", wanted)
        value = values[0]
        if name in CASTS:
            text = f"({CASTS[name]}){value.at(PREFIX)}"
            return value if value.type == name else Value(name, text, PREFIX)
        if name == "abs" and value.type != "float":
            return self.helper("size_int", "int", value)
        return self.helper(c, t, *values)

    def _extreme(self, n: ast.Call, name: str, values: list[Value]) -> Value:
        """The first of the largest or smallest, as Python has it."""
        found, *others = values
        if any(other.type != found.type for other in others):
            self.refuse(n, f"{name} of values of two types", "float(x) of the whole numbers")
        helper = EXTREMES[name] + "_int" * (found.type != "float")
        for other in others:
            found = self.helper(helper, found.type, found, other)
        return found

    def _kernel(self, n: ast.Call, callee: Source) -> Value:
        given = self.spread(n.args)
        if len(given) != len(callee.parameters):
            self.refuse(n, f"{len(given)} arguments", f"{len(callee.parameters)}")
        pairs = list(zip(callee.parameters, given, strict=True))
        handed = [
            self.stored(value, self.fresh(f"array_{p}") if value.maker else p)
            for p, (_, value) in pairs
        ]
        instance = self.file.instance(callee, tuple(value.type for value in handed))
        self.instance.asked |= {name for p, (name, _) in pairs if p in instance.asked}
        missing = set(instance.lengths()) - set(self.instance.lengths())
        if missing:
            self.refuse(n, f"the length {missing.pop()} is not known here", "an argument with it")
        texts = [self.text(leaf) for value in handed for leaf in value.leaves()]
        text = f"{instance.name}({', '.join([*instance.lengths(), *texts])})"
        return Value(instance.returned or NOTHING, text, POSTFIX)

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
        self.out(f"{declared}{' = {0}' if zeros and fixed else ''};")
        if zeros and not fixed:
            self.out(f"memset({name}, 0, sizeof {name});")
        return Value(t, name)

    def _array(self, n: ast.Call, maker: str) -> Value:
        shape = n.args[0].elts if isinstance(n.args[0], ast.Tuple) else n.args[:1]
        lengths = tuple(self.value(x).known for x in shape)
        if None in lengths:
            self.refuse(n, "a shape that is not known before the kernel runs", "lengths, numbers")
        dtype = ast.unparse(n.args[1]) if n.args[1:] else "np.float64"
        if dtype not in ELEMENT_OF:
            self.refuse(n, "elements of another kind", " or ".join(ELEMENT_OF))
        return Value(Array(ELEMENT_OF[dtype], lengths), maker=maker)

    def _made_by(self, n: ast.Call, callee: Source) -> Value:
        """The arrays that a kernel makes: C returns none, so that they are the caller's."""
        assert callee.made
        maker = Calls(self.file, Instance(callee, self.instance.arguments))
        for p, a in zip(callee.parameters, n.args, strict=True):
            maker.values[p] = self.value(a)
            if maker.values[p].known is None:
                self.refuse(a, "a length that is not known before the kernel runs", "a number")
        return maker.value(callee.made)
