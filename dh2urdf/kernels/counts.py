"""Counts of solutions: one below zero says that the pose is in doubt, ``-1 - n``, with n so far."""

DEEP = 64
"""Added to n by a closed form where many starts are to search."""


def how_many(count):
    """The solutions that a count tells of, in doubt or not."""
    return count if count >= 0 else (-1 - count) % DEEP
