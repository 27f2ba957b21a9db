"""Calls as C: of kernels, of the mathematical library, and of what makes arrays."""

import ast
from dataclasses import replace

from dh2urdf.translate.definitions import Instance
from dh2urdf.translate.expressions import Expressions
from dh2urdf.translate.source import MAKERS, Source
from dh2urdf.translate.types import Array, Tuple
from dh2urdf.translate.values import POSTFIX, PREFIX, Value, sized

LIBRARY = {
    "math.sqrt": ("sqrt", 1),
    "math.copysign": ("copysign", 2),
    "math.fmod": ("fmod", 2),
    "np.floor": ("floor", 1),
    "np.ceil": ("ceil", 1),
    "np.rint": ("rint", 1),
}
"""Functions whose result is the same everywhere, and how many arguments they take."""

PREDICATES = {"math.isinf": "isinf", "math.isnan": "isnan", "math.isfinite": "isfinite"}

CASTS = {"float": "double", "int": "int"}

ELEMENT_OF = {"np.float64": "float", "np.int64": "int", "np.bool_": "bool"}

NOTHING = Tuple(())
"""What a kernel gives that returns no value."""


class Calls(Expressions):
    """Writes the calls of one kernel."""

    def call(self, n: ast.Call) -> Value:
        """A call."""
        name = ast.unparse(n.func)
        callee = self.source.kernel(name)
        if callee is not None:
            return self._made_by(n, callee) if callee.made else self._kernel(n, callee)
        if name in MAKERS:
            return self._array(n, name)
        if name == "len":
            length = self.size(n)
            if length is None:
                self.refuse(n, "a length that is not known", "an argument for it")
            return sized(length)
        if name not in ALLOWED:
            self.refuse(n, "a call of something else", f"a kernel, or {', '.join(ALLOWED)}")
        values = [self.number(a) for a in n.args]
        if name in ("min", "max") and len(values) > 1:
            if len({value.type for value in values}) > 1:
                self.refuse(n, f"{name} of values of two types", "float(x) of the whole numbers")
            return self._extreme(name, values)
        if name == "abs" and len(values) == 1:
            if values[0].type != "float":
                return self.helper("size_int", "int", *values)
            return Value("float", f"fabs({values[0].text})", POSTFIX)
        if name in CASTS and len(values) == 1:
            if values[0].type == name:
                return values[0]
            return Value(name, f"({CASTS[name]}){values[0].at(PREFIX)}", PREFIX)
        c, arguments = LIBRARY.get(name) or (PREDICATES.get(name, ""), 1)
        if not c or len(values) != arguments:
            self.refuse(n, f"{len(values)} arguments of {name}", f"{arguments if c else 'others'}")
        kind = "bool" if name in PREDICATES else "float"
        return Value(kind, f"{c}({', '.join(value.text for value in values)})", POSTFIX)

    def _extreme(self, name: str, values: list[Value]) -> Value:
        """The first of the largest or smallest, as Python has it."""
        found = values[0]
        helper = {"max": "larger", "min": "smaller"}[name] + "_int" * (found.type != "float")
        for other in values[1:]:
            found = self.helper(helper, str(found.type), found, other)
        return found

    def _kernel(self, n: ast.Call, callee: Source) -> Value:
        given = self.spread(n.args)
        if len(given) != len(callee.parameters):
            self.refuse(n, f"{len(given)} arguments", f"{len(callee.parameters)}")
        handed = [
            self.stored(value, self.fresh(f"array_{name}") if value.maker else name)
            for name, (_, value) in zip(callee.parameters, given, strict=True)
        ]
        instance = self.file.instance(callee, tuple(value.type for value in handed))
        for p, (name, _) in zip(callee.parameters, given, strict=True):
            if p in instance.asked:
                self.instance.asked.add(name)
        missing = set(instance.lengths()) - set(self.instance.lengths())
        if missing:
            self.refuse(n, f"the length {missing.pop()} is not known here", "an argument with it")
        texts = [self.text(leaf) for value in handed for leaf in value.leaves()]
        text = f"{instance.name}({', '.join([*instance.lengths(), *texts])})"
        return Value(instance.returned or NOTHING, text, POSTFIX)

    def stored(self, value: Value, name: str) -> Value:
        """A value whose arrays have names."""
        if value.maker:
            return self.storage(value, name)
        if value.parts:
            parts = (self.stored(part, f"{name}_{k}") for k, part in enumerate(value.parts))
            return replace(value, parts=tuple(parts))
        return value

    def storage(self, value: Value, name: str) -> Value:
        """The array that a maker makes, by its name."""
        t = value.type
        assert isinstance(t, Array)
        declared = self.file.declaration(t, name, storage=True)
        fixed = all(isinstance(length, int) for length in t.shape)
        zeros = value.maker == "np.zeros"
        self.out(f"{declared}{' = {0}' if zeros and fixed else ''};")
        if zeros and not fixed:
            self.out(f"memset({name}, 0, sizeof {name});")
        return Value(t, name)

    def _array(self, n: ast.Call, maker: str) -> Value:
        shape = n.args[0].elts if isinstance(n.args[0], ast.Tuple) else n.args[:1]
        lengths = tuple(self.size(x) for x in shape)
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
            size = self.size(a)
            if size is None:
                self.refuse(a, "a length that is not known before the kernel runs", "a number")
            maker.known[p] = size
        return maker.value(callee.made)


ALLOWED = (*LIBRARY, *PREDICATES, *CASTS, "abs", "min", "max", "len", *MAKERS)
