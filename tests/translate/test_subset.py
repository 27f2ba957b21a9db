"""What the subset does not have is refused: where, what was found, and what to write instead."""

import importlib.util
import itertools
import textwrap

import pytest

from dh2urdf.translate.c_file import CFile
from dh2urdf.translate.source import SubsetError
from dh2urdf.translate.types import Array, Tuple

ARGUMENTS = {
    "x": "float",
    "n": "int",
    "b": "bool",
    "a": Array("float", (4,)),
    "i": Array("int", (4,)),
    "m": Array("float", (3, 4)),
    "t": Array("float", ("rows", "n")),
    "p": Tuple(("float", "float")),
}

BESIDE = """
import math
import numpy as np

TABLE = np.array([1.0, 2.0])
NAMES = ("a", "b")


def identity(x):
    return x


def recursive(x):
    return recursive(x - 1.0)


def array(a):
    return a


def asks(x, y=1.0):
    return x + y
"""

REFUSED = {
    "comprehension": ("y = [x for _ in range(3)]", "ListComp", "a loop"),
    "generator": ("y = abs(x for _ in range(3))", "GeneratorExp", "a loop"),
    "list": ("y = [x, x]", "List", "np.empty, or a tuple"),
    "dictionary": ("y = {1: x}", "Dict", "a record"),
    "set": ("y = {x}", "Set", "comparisons"),
    "lambda": ("y = lambda z: z", "Lambda", "a kernel of the module"),
    "closure": ("def y(): return x", "FunctionDef", "a kernel of the module"),
    "try": ("try:\n    x = 1.0\nexcept ValueError:\n    x = 2.0", "Try", "a returned status"),
    "raise": ("raise ValueError", "Raise", "a returned status"),
    "assert": ("assert x > 0.0", "Assert", "a returned status"),
    "with": ("with np.errstate():\n    x = 1.0", "With", "the statements alone"),
    "yield": ("yield x", "Yield", "into an array that is handed in"),
    "global": ("global y", "Global", "an argument"),
    "text": ("y = 'a'", "a value that is no number", "numbers only"),
    "nothing": ("y = None", "a value that is no number", "numbers only"),
    "complex": ("y = 1j * x", "a value that is no number", "numbers only"),
    "formatted text": ("y = f'{x}'", "JoinedStr", "numbers only"),
    "import": ("import os", "Import", "the import at the head of the module"),
    "delete": ("del x", "Delete", "nothing"),
    "walrus": ("if (y := x) > 0.0: x = y", "NamedExpr", "an assignment of its own"),
    "annotation": ("y: float = x", "AnnAssign", "an assignment without a type"),
    "match": ("match n:\n    case 1: x = 1.0", "Match", "if and elif"),
    "power": ("y = x ** 2", "Pow", "products, or math.sqrt"),
    "augmented power": ("x **= 2", "Pow", "products, or math.sqrt"),
    "matrix product": ("y = m @ a", "MatMult", "a loop"),
    "membership": ("y = n in (1, 2)", "In", "comparisons with =="),
    "identity": ("y = x is x", "Is", "=="),
    "keyword": ("y = identity(x=x)", "keyword", "a positional argument"),
    "two targets": ("y = z = x", "two assignments in one", "two"),
    "else of for": (
        "for _ in range(3):\n    x = 1.0\nelse:\n    x = 2.0",
        "else of a loop",
        "a flag",
    ),
    "else of while": ("while b:\n    b = False\nelse:\n    x = 2.0", "else of a loop", "a flag"),
    "pass": ("pass", "Pass", "assignments, calls, loops"),
    "expression": ("x + 1.0", "Expr", "assignments, calls, loops"),
    "loop over values": ("for y in (1.0, 2.0): x = y", "a loop over something else", "range"),
    "loop over an array": ("for y in a: x = y", "a loop over something else", "range"),
    "unknown step": ("for k in range(0, 9, n): x = 1.0", "a step", "a number"),
    "step of zero": ("for k in range(0, 9, 0): x = 1.0", "a step", "a number"),
    "range of floats": ("for k in range(x): x = 1.0", "a bound that is no whole number", "int(x)"),
    "counter assigned": ("for k in range(3): k = 1", "a counter that is more", "another name"),
    "counter after": (
        "for k in range(3): x = 1.0\nn = k",
        "a counter that is more",
        "another name",
    ),
    "two types": ("y = 1\ny = x", "one name for two types, int and float", "0.0 for 0"),
    "argument's type": ("n = x", "one name for two types, int and float", "two names"),
    "augmented type": ("n += x", "float for int", "another name"),
    "divided integer": ("n /= 2", "float for int", "another name"),
    "augmented floor": ("n //= 2", "an operator that has no such assignment", "x = x ... y"),
    "float into integers": ("i[0] = x", "float for an element of int", "int(x)"),
    "unknown name": ("y = unknown", "a name that stands for no number", "an argument"),
    "no number": ("y = NAMES", "a name that stands for no number", "an argument"),
    "name before value": ("y = z\nz = x", "a name before its value", "the assignment above"),
    "unknown call": ("y = sum(a)", "a call of something else", "a kernel, or math.sqrt"),
    "library's sine": ("y = math.sin(x)", "a call of something else", "a kernel, or math.sqrt"),
    "floor to int": ("y = math.floor(x)", "a call of something else", "np.floor"),
    "too few arguments": ("y = identity()", "0 arguments", "1"),
    "one for the largest": ("y = max(x)", "1 arguments of max", "others"),
    "two for a root": ("y = math.sqrt(x, x)", "2 arguments of math.sqrt", "1"),
    "defaults": ("y = asks(x, x)", "arguments that are not plain", "positional ones"),
    "recursion": ("y = recursive(x)", "a kernel that calls itself", "a loop"),
    "returned array": ("y = array(a)", "a returned array", "into an array that is handed in"),
    "mixed extremes": ("y = max(x, n)", "max of values of two types", "float(x)"),
    "np.full": ("y = np.full(3, x)", "a call of something else", "np.empty"),
    "copy": ("y = a.copy()", "a call of something else", "a kernel"),
    "shape by a value": ("y = np.empty(n)", "a shape that is not known", "lengths, numbers"),
    "other elements": ("y = np.empty(3, np.float32)", "elements of another kind", "np.float64"),
    "new array": ("y = a + 1.0", "where a number is needed", "a loop"),
    "array made in a branch": (
        "if b:\n    y = np.empty(3)\nelse:\n    y = np.empty(3)\nx = y[0]",
        "arrays that are made",
        "it before",
    ),
    "array as condition": ("if a: x = 1.0", "as a condition", "a comparison"),
    "index by a float": ("y = a[x]", "an index that is no whole number", "int(x)"),
    "negative index": ("y = a[-1]", "an index outside the array", "from 0 to its length less 1"),
    "index outside": ("y = a[4]", "an index outside the array", "from 0 to its length less 1"),
    "too many indices": ("y = a[0, 0]", "too many indices", "fewer"),
    "column": ("y = m[:, 0]", "a slice before the last index", "a loop"),
    "stride": ("y = a[::2]", "a slice with a step", "a loop"),
    "slice from the end": ("y = a[:-1]", "a slice that counts from the end", "from the start"),
    "slice by a float": ("y = a[:x]", "a slice that is no whole number", "int(x)"),
    "index into a number": ("y = x[0]", "an index into float", "an array or a tuple"),
    "item by a variable": ("y = p[n]", "item of a tuple by a variable", "a number"),
    "constant written": ("TABLE[0] = x", "a constant that is written to", "an array of the caller"),
    "other rank": ("a[:] = m", "where array of float (4) is needed", "a loop"),
    "part from the middle": ("a[1:3] = x", "elements from the middle", "a loop"),
    "own element": ("a *= a[0]", "an element of the array", "an assignment before"),
    "read after": ("m[0], y = a, m[0, 0]", "an array that is read after it", "two assignments"),
    "uneven tuples": ("y, z = x, x, x", "3 values for 2 names", "as many"),
    "uneven parts": ("y, z, w = p", "2 values for 3 names", "as many"),
    "no tuple": ("y, z = a", "where a tuple is needed", "its items by index"),
    "mixed choice": ("y = a if b else x", "or float", "if and else"),
    "bits of a float": ("y = x & 1", "bits or floor division of floats", "int(x)"),
    "floor of floats": ("y = x // 2.0", "floor division of floats", "np.floor"),
    "sign of a truth": ("y = -b", "a sign before true or false", "not"),
    "large integer": ("y = 3000000000", "a whole number beyond 32 bits", "a float"),
    "attribute": ("y = a.T", "an attribute", "a name of the module"),
    "call in a chain": ("b = 0.0 < identity(x) < 1.0", "a call that would be made twice", "before"),
    "statement in a branch": (
        "y = x if b else (identity(x), 1.0)[0] + (*p, *second(x))[3]",
        "what needs a statement before it",
        "an assignment before",
    ),
    "two returned types": ("if b:\n    return 1", "returned values of other types", "the same"),
    "way without a value": ("while b:\n    return x", "an end without a value", "return"),
}
"""Statements, what is found, and what to write instead."""

numbers = itertools.count()


def kernel(folder, statements, end="return x"):
    """A kernel with some statements, and the line of their first one."""
    head = (
        f"{BESIDE}\n\ndef second(x):\n    return x, x\n\n\ndef refused({', '.join(ARGUMENTS)}):\n"
    )
    path = folder / f"refused_{next(numbers)}.py"
    path.write_text(head + textwrap.indent(f"{statements}\n{end}\n", "    "))
    spec = importlib.util.spec_from_file_location(f"{path.stem}.kernels", path)
    module = importlib.util.module_from_spec(spec)
    importlib.sys.modules[spec.name] = module
    spec.loader.exec_module(module)
    return module.refused, head.count("\n") + 1


@pytest.mark.parametrize("what", REFUSED)
def test_what_is_refused_is_told(what, tmp_path):
    """The file, the line, the kernel, what was found there, and what to write instead."""
    statements, found, instead = REFUSED[what]
    end = "x = 1.0" if what == "way without a value" else "return x"
    function, line = kernel(tmp_path, statements, end)
    with pytest.raises(SubsetError) as refusal:
        CFile().add_entry(function, list(ARGUMENTS.values()))
    message = str(refusal.value)
    path, place, _ = message.split(":", 2)
    assert path.endswith(".py")
    assert found in message
    assert instead in message.partition("; write ")[2]
    elsewhere = what in ("defaults", "recursion", "returned array")
    assert elsewhere or line <= int(place) <= line + statements.count("\n") + 1


def test_an_entry_without_types_is_refused():
    """Types of arguments come from annotations."""
    from dh2urdf.translate.entries import argument_types

    def entry(x: float, y):
        return x

    with pytest.raises(SubsetError, match="no type for y"):
        argument_types(entry)


def test_every_kernel_of_the_package_is_in_the_subset():
    """The package's own entries translate."""
    from dh2urdf.translate.build import texts

    assert set(texts()) == {"kernels.h", "kernels.c", "doors.h"}
