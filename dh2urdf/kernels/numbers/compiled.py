"""How kernels are compiled: the options that they share.

Division by zero gives an infinity, as in C, instead of a test at every division; nothing here
raises. Compiled code is cached, and the interpreter lock is not held.
"""

from typing import Any

from numba import njit

UNCACHED: dict[str, Any] = {"nogil": True, "error_model": "numpy", "no_cfunc_wrapper": True}
INNER = {**UNCACHED, "cache": True, "no_cpython_wrapper": True}
VECTOR = {"fastmath": {"contract"}}

kernel = njit(cache=True, **UNCACHED)
"""For functions that Python calls; not C, whose entry would be compiled too."""

inner_kernel = njit(**INNER)
"""For functions that only kernels call: without the entry from Python, half the compile time."""

inlined_kernel = njit(inline="always", no_cpython_wrapper=True, **UNCACHED)
"""For large functions with one caller: as functions, they and all that they call would go through
the optimiser once more. Takes no starred arguments."""

block_kernel = njit(**INNER, **VECTOR)
"""For inner functions that are to become vector code, with fused multiply-add."""

helper_kernel = njit(forceinline=True, **INNER)
"""For a few lines that many kernels share: always inlined, by LLVM, not statement by statement."""

lane_kernel = njit(forceinline=True, **INNER, **VECTOR)
"""The same for vector code: a few lines of a lane that many block kernels share."""
