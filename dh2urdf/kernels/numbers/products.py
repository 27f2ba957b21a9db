"""Products of small matrices, in one order of sums."""

from typing import Annotated

from dh2urdf.engine import entry
from dh2urdf.kernels.shapes import Floats


@entry()
def multiply(
    first: Annotated[Floats, "stack", "m", "k"],
    second: Annotated[Floats, "stack", "k", "n"],
    out: Annotated[Floats, "stack", "m", "n"],
):
    """``out[i] = first[i] second[i]``, summed from the first term to the last."""
    for i in range(first.shape[0]):
        for r in range(first.shape[1]):
            for c in range(second.shape[2]):
                value = first[i, r, 0] * second[i, 0, c]
                for k in range(1, first.shape[2]):
                    value += first[i, r, k] * second[i, k, c]
                out[i, r, c] = value
