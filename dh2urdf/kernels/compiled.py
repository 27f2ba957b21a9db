"""How kernels are compiled: the options that they share.

Division by zero gives an infinity, as in C, instead of a test at every division; nothing here
raises. Compiled code is cached, and the interpreter lock is not held.
"""

from __future__ import annotations

from numba import njit

__all__ = ["block_kernel", "helper_kernel", "inlined_kernel", "inner_kernel", "kernel"]

kernel = njit(cache=True, nogil=True, error_model="numpy", no_cfunc_wrapper=True)
"""For functions that Python calls; not C, whose entry would be compiled too."""

inner_kernel = njit(
    cache=True, nogil=True, error_model="numpy", no_cpython_wrapper=True, no_cfunc_wrapper=True
)
"""For functions that only kernels call: without the entry from Python, half the compile time."""

inlined_kernel = njit(
    inline="always",
    nogil=True,
    error_model="numpy",
    no_cpython_wrapper=True,
    no_cfunc_wrapper=True,
)
"""For large functions with one caller: as functions, they and all that they call would go through
the optimiser once more. Takes no starred arguments."""

block_kernel = njit(
    cache=True,
    nogil=True,
    error_model="numpy",
    fastmath={"contract"},
    no_cpython_wrapper=True,
    no_cfunc_wrapper=True,
)
"""For inner functions that are to become vector code, with fused multiply-add."""

helper_kernel = njit(
    cache=True,
    nogil=True,
    error_model="numpy",
    forceinline=True,
    no_cpython_wrapper=True,
    no_cfunc_wrapper=True,
)
"""For a few lines that many kernels share: always inlined, by LLVM, not statement by statement."""
