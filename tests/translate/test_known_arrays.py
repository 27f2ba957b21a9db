"""What is known when a kernel is translated decides its branches, and is handed to nobody."""

import numpy as np
import pytest

from dh2urdf.export.source.c_kernels import ArmFile
from dh2urdf.translate.unused import without_unused

FORM = np.array([[1.0, 0.0, -0.0], [0.5, 2.0, 3.0]])


def slides(form):
    """Whether the first joint slides."""
    return form[0, 1] != 0.0


def turn(form, x):
    """For the arm that turns."""
    return form[1, 1] * x


def slide(form, x):
    """For the arm that slides."""
    return form[1, 2] + x


def unread(form, x):
    """Whose second value only a branch that is left out would read."""
    size, other = form[1, 0], form[1, 2]
    if slides(form) and x > 0.0:
        return slide(form, x) + other
    return turn(form, x) if form[1, 1] > 1.0 or x < 0.0 else size


def written(form, x):
    """Writes into what is known."""
    form[0, 0] = x


def rows(form, x):
    """Parts of what is known are known."""
    row = form[1]
    total = x
    for i in range(3):
        total += row[i]
    if row[0] == 0.5:
        total += 1.0
    return total


def text_of(kernel):
    """The C of a kernel of a known form and a number."""
    file = ArmFile("arm", 1)
    file.add_entry(kernel, [file.fixed("form", FORM), "float"])
    return file.text()


def test_branches_that_cannot_be_are_left_out_with_what_they_call():
    """Nothing is left of the arm that slides, nor of the values that only it reads."""
    text = text_of(unread)
    assert "return arm_turn(x);" in text
    for word in ("slide(", "slides(", " other ", "if ("):
        assert word not in text, word


def test_known_arrays_are_no_arguments():
    """Functions read them by the name that the file has for them."""
    text = text_of(unread)
    assert "static const double ARM_FORM[2][3] = {{1.0, 0.0, -0.0}, {0.5, 2.0, 3.0}};" in text
    assert "arm_turn(double x)" in text
    assert "ARM_FORM[1][1] * x" in text


def test_rows_of_known_arrays_are_known():
    """A condition on a row is decided; a variable index reads the file's array."""
    text = text_of(rows)
    assert "ARM_FORM[1][i]" in text
    assert "if (" not in text


def test_known_arrays_are_not_written_to():
    """The translator refuses it."""
    with pytest.raises(Exception, match="a constant that is written to"):
        text_of(written)


UNUSED = {
    "declared": (["const double x = y * 2.0;", "return y;"], ["return y;"]),
    "set": (["double x = 0.0;", "x = sqrt(y);", "return y;"], ["return y;"]),
    "one after the other": (
        ["const double x = y;", "const double z = x;", "return y;"],
        ["return y;"],
    ),
    "read": (["const double x = y;", "return x;"], ["const double x = y;", "return x;"]),
    "array": (["double a[3];", "return y;"], ["return y;"]),
    "call": (
        ["const int x = arm_fill(a);", "return y;"],
        ["const int x = arm_fill(a);", "(void)x;", "return y;"],
    ),
    "in a comment": (["/* x */", "const double x = y;", "return y;"], ["/* x */", "return y;"]),
}


@pytest.mark.parametrize("case", UNUSED)
def test_what_nothing_reads_is_left_out(case):
    """But for calls, which may write into arrays: their values are named."""
    before, after = UNUSED[case]
    lines = without_unused([(1, text) for text in before])
    assert [text for _, text in lines] == after
