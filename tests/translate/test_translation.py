"""Each construct of the subset says in C what it says in Python, bit for bit."""

import ctypes
import inspect
import struct

import numpy as np
import pytest
from hypothesis import HealthCheck, assume, given, settings
from hypothesis import strategies as st

from dh2urdf.translate.build import FLAGS
from dh2urdf.translate.c_file import CFile
from dh2urdf.translate.entries import argument_types
from dh2urdf.translate.types import Array
from tests.translate import replay, sample_kernels

KERNELS = {
    name: function
    for name, function in vars(sample_kernels).items()
    if inspect.isfunction(function) and function.__annotations__
}
C_TYPES = {"float": ctypes.c_double, "int": ctypes.c_int, "bool": ctypes.c_bool}
D_TYPES = {"float": np.float64, "int": np.int64, "bool": np.bool_}
WARNINGS = ["-Wall", "-Wextra", "-Werror", "-pedantic"]

FLOATS = st.floats(-100.0, 100.0) | st.sampled_from(
    [0.0, -0.0, 0.5, 1.0, -1.0, 3.0, 1e-320, 1e200, -1e308, np.inf, -np.inf, np.nan]
)
NUMBERS = {"float": FLOATS, "int": st.integers(-12, 12), "bool": st.booleans()}
SIZES = {"rows": 3, "n": 4}


@pytest.fixture(scope="module")
def compiled(tmp_path_factory):
    """The kernels' C, compiled without a warning, and the instances in it."""
    folder, file = tmp_path_factory.mktemp("sample"), CFile()
    instances = {name: file.add_entry(f, argument_types(f)) for name, f in KERNELS.items()}
    (folder / "kernels.h").write_text(file.header())
    (folder / "kernels.c").write_text(file.kernels())
    words = [*replay.cc(), *FLAGS, *WARNINGS, "-DTABLE=entries_here", "-shared", "kernels.c"]
    library = ctypes.CDLL(str(replay.compiled(folder, words, "sample.so")))
    _, *table = (ctypes.c_void_p * (len(instances) + 1)).in_dll(library, "entries_here")
    return dict(zip(instances, table, strict=True)), instances


def c_type(t):
    """What ctypes calls a type."""
    if t is None or isinstance(t, str):
        return C_TYPES.get(t)
    fields = [(f"f{i}", c_type(x)) for i, x in enumerate(t.items)]
    return type("Struct", (ctypes.Structure,), {"_fields_": fields})


def flat(value):
    """Numbers of an answer, one after the other, as they are in memory."""
    if isinstance(value, ctypes.Structure):
        value = tuple(getattr(value, name) for name, *_ in value._fields_)
    if isinstance(value, tuple):
        return [x for part in value for x in flat(part)]
    if isinstance(value, float | np.floating):
        return ["nan" if np.isnan(value) else struct.pack("d", value)]
    return [] if value is None else [int(value)]


def arguments(types):
    """Values for the arguments of a kernel."""
    return st.tuples(*map(_argument, types))


def _argument(t):
    if not isinstance(t, Array):
        return NUMBERS[t]
    shape = [SIZES.get(d, d) for d in t.shape]
    count = int(np.prod(shape))
    items = st.lists(NUMBERS[t.element], min_size=count, max_size=count)
    return items.map(lambda x: np.array(x, D_TYPES[t.element]).reshape(shape))


def in_c(address, instance, values):
    """Call the compiled kernel."""
    sizes = [ctypes.c_int(SIZES[length]) for length in instance.lengths()]
    handed = [
        ctypes.c_void_p(x.ctypes.data) if isinstance(t, Array) else C_TYPES[t](x)
        for t, x in zip(instance.arguments, values, strict=True)
    ]
    kinds = [type(x) for x in (*sizes, *handed)]
    function = ctypes.CFUNCTYPE(c_type(instance.returned), *kinds)(address)
    return function(*sizes, *handed)


@pytest.mark.parametrize("name", KERNELS)
def test_c_says_what_python_says(name, compiled):
    """Every number that is returned or written has the same bits."""
    address, instance = (part[name] for part in compiled)

    @settings(max_examples=150, deadline=None, suppress_health_check=list(HealthCheck))
    @given(arguments(argument_types(KERNELS[name])))
    def check(values):
        ours = [x.copy() if isinstance(x, np.ndarray) else x for x in values]
        with np.errstate(all="ignore"):
            try:
                expected = KERNELS[name](*values)
            except (ZeroDivisionError, OverflowError, ValueError):
                assume(False)
        found = in_c(address, instance, ours)
        assert flat(found) == flat(expected)
        for ours_, theirs in zip(ours, values, strict=True):
            if isinstance(theirs, np.ndarray):
                assert list(map(flat, ours_.ravel())) == list(map(flat, theirs.ravel()))

    check()


def test_text_reads_as_the_kernel_does():
    """Docstring, names, comments and formulas are in the C, in lines of at most 100 letters."""
    file = CFile()
    for function in KERNELS.values():
        file.add_entry(function, argument_types(function))
    text = file.kernels()
    assert "/* Left to right, as the brackets say, whole numbers widened. */" in text
    assert "static const double MINUS = -2.5;" in text
    assert "/* What a kernel takes from its module. */" in text
    assert (
        "static inline double length(double x, double y)\n{\n    return x * x + y * y;\n}" in text
    )
    assert max(map(len, text.splitlines())) <= 100


def test_a_kernel_is_written_once_for_each_list_of_types():
    """Arrays of other lengths share a function that does not ask for the length."""
    file = CFile()
    file.add_entry(sample_kernels.groups, argument_types(sample_kernels.groups))
    file.add_entry(sample_kernels.views, argument_types(sample_kernels.views))
    names = [kernel.function for kernel in file.order]
    assert names == ["fill", "groups", "total", "total_sample_kernels", *names[4:]]
    assert len(set(names)) == len(names)
