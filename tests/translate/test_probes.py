"""Marks of lines: what ran is told line by line, and functions answer as before."""

import inspect

from tests.translate.probes import Marked


def kernel(x):
    """Two ways, and a loop."""
    total = 0
    if x > 1:
        total += 5
    else:
        total -= 7
    for k in range(x):
        if k > 0:
            break
        total += 1
    return total


def test_lines_that_ran_are_told_and_no_others():
    """After a call that takes one way, the lines of the other are not reached."""
    lines, first = inspect.getsourcelines(kernel)
    marked = Marked(kernel)
    assert kernel(1) == -6
    assert marked.key[1] == "kernel"
    assert len(marked.lines) == len(lines) - 3  # without the head, the docstring and `else`
    left = {lines[n - first].strip() for n in marked.lines - marked.reached}
    assert left == {"total += 5", "break"}
    assert kernel(2) == 6
    assert marked.lines == marked.reached
