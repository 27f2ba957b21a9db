"""Compiled kernels with marks: statements that ran are told, indices outside, and errors."""

import ctypes
import inspect
import json
import subprocess
from typing import Annotated

import numpy as np
import pytest
from numpy.typing import NDArray

from dh2urdf.translate.build import compiler
from dh2urdf.translate.entries import argument_types
from tests.marked.__main__ import FLAGS, ROOT, each, marked
from tests.marked.may import MAY
from tests.marked.python import NAME, mark_modules
from tests.marked.written import KINDS, RUNTIME, MarkedFile, statements


def some(n):
    return np.empty(n)


def kernel(values: Annotated[NDArray[np.float64], "n"], k: int, x: float):
    total = 0.0
    part = some(2)
    part[0] = x
    if k < 1:
        total += values[k]
    elif k > 2:
        total = 1.0 / x
    else:
        values[:k] = 2.0
    while total < 0.0:
        total += 1.0
    return total + part[0]


@pytest.fixture(scope="module")
def compiled(tmp_path_factory):
    """The kernel's C, and its marks."""
    folder, file = tmp_path_factory.mktemp("marked"), MarkedFile()
    file.add_entry(kernel, argument_types(kernel))
    text = f"#define COUNT_OF_MARKS {len(file.marks)}\n{RUNTIME}\n{file.kernels()}\n"
    text += "void *clear(void) { MARK_OF_LINE(0); "
    text += "return memset(marks_of_lines, 0, sizeof marks_of_none); }\n"
    (folder / "kernels.h").write_text(file.header())
    (folder / "kernels.c").write_text(text.replace("static double kernel(", "double kernel("))
    words = [*compiler(), *FLAGS, "-DTABLE=entries", "kernels.c", "-o", "kernels.so", "-lm"]
    subprocess.run(words, cwd=folder, check=True)
    return ctypes.CDLL(folder / "kernels.so"), list(file.marks)


def called(compiled, k, x):
    """What a call reached, its other marks by kind, each as lines without their indents."""
    library, places = compiled
    library.clear.restype = ctypes.POINTER(ctypes.c_ubyte)
    marks = np.ctypeslib.as_array(library.clear(), (len(places), KINDS))
    values = np.ones(6)
    call = library.kernel
    call(6 if k < 6 else 3, ctypes.c_void_p(values.ctypes.data), k, ctypes.c_double(x))
    seen = marks.astype(bool).copy()
    library.clear()
    texts = {}
    for f in (kernel, some):
        lines, first = inspect.getsourcelines(f)
        texts |= {first + i: line.strip() for i, line in enumerate(lines)}
    told = [texts.get(place.line, "") for place in places]
    return [{told[i] for i in np.flatnonzero(column)} - {""} for column in seen.T]


WAYS = {"total += values[k]", "total = 1.0 / x", "values[:k] = 2.0", "total += 1.0"}


@pytest.mark.parametrize(
    ("k", "x", "ways"),
    [
        (0, 1.0, {"total += values[k]"}),
        (3, 1.0, {"total = 1.0 / x"}),
        (3, -1.0, {"total = 1.0 / x", "total += 1.0"}),
        (2, 1.0, {"values[:k] = 2.0"}),
    ],
)
def test_statements_that_ran_are_told_and_no_others(compiled, k, x, ways):
    """Each way through a kernel marks its lines; makers of arrays do where they are used."""
    reached, outside, *errors = called(compiled, k, x)
    assert reached & WAYS == ways
    assert {"part = some(2)", "return np.empty(n)", "if k < 1:", "while total < 0.0:"} < reached
    assert ("elif k > 2:" in reached) == (k > 0)
    assert outside == set()
    assert not any(errors)


def test_an_index_outside_and_errors_of_numbers_are_told_by_their_lines(compiled):
    """An index below zero, a division by zero, an overflow."""
    assert called(compiled, -1, 1.0)[1] == {"total += values[k]"}
    for x, kind in ((0.0, 3), (1e-310, 4)):
        marks = called(compiled, 3, x)
        assert marks[kind], (x, marks)
        assert not marks[1]


def test_marked_modules_of_python_tell_their_statements(tmp_path):
    """Modules that are written anew do what they did, and mark what they reach."""
    package = tmp_path / "dh2urdf"
    (package / "room").mkdir(parents=True)
    text = '"""A text."""\nfrom __future__ import annotations\n\n\ndef f(x):\n    """Doc."""\n'
    text += "    try:\n        if x:\n            return 1\n        return 2\n"
    text += "    except ValueError:\n        return 3\n"
    (package / "room/one.py").write_text(text)
    places = []
    mark_modules(package, "dh2urdf/room", places)
    assert [place.line for place in places] == [7, 8, 9, 10, 12]
    space = {NAME: bytearray(100)}
    written = (package / "room/one.py").read_text()
    exec(written.replace(f"from dh2urdf.{NAME} import {NAME}", ""), space)
    assert space["f"](0) == 2
    assert [space[NAME][KINDS * k] for k in range(5)] == [1, 1, 0, 1, 0]


def test_every_statement_of_the_kernels_is_counted_once():
    """By file, function and line; docstrings are none."""
    every = statements(ROOT / "dh2urdf/kernels")
    assert len(every) == len(set(every)) > 5000


def test_what_tests_marked_is_joined_with_the_file_of_marks(tmp_path):
    """Of a run that was cut off, and went on; a test that ran twice counts once, as the last."""
    marks = np.zeros((3, KINDS), np.uint8)
    marks[1, 0] = 1
    (tmp_path / "marks").write_bytes(marks.tobytes())
    assert marked(tmp_path, 3)[0].sum() == len(each(tmp_path)) + 1 == 1
    rows = [("a", [0], []), ("b", [0, 2], [[2, 3]]), ("a", [0], [[0, 1]])]
    keys = "test", "reached", "errors"
    text = "\n".join(json.dumps(dict(zip(keys, row, strict=True))) for row in rows)
    (tmp_path / "each.jsonl").write_text(text)
    seen, tests = marked(tmp_path, 3)
    assert np.argwhere(seen).tolist() == [[0, 0], [0, 2], [1, 0], [2, 0], [2, 4]]
    assert tests == {(0, 1): "a", (2, 3): "b"}
    assert [row["test"] for row in each(tmp_path)] == ["a", "b"]


def test_errors_may_be_only_in_functions_that_there_are():
    """Each is a kernel, and has a kind of error that is told."""
    there = {f"{place.file} {place.function}" for place in statements(ROOT / "dh2urdf/kernels")}
    assert set(MAY) <= there
    assert {kind for kinds in MAY.values() for kind in kinds} <= {"invalid", "divided", "overflow"}
