"""Jitted pure functions on floats and arrays; they import NumPy, Numba and one another only."""
