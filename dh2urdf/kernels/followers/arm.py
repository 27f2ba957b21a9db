"""What the solver of followers knows of an arm, and the arrays that it works in: one record."""

from dh2urdf.kernels.general_6r import MOST, record, root_order, root_work
from dh2urdf.kernels.numbers import COLUMN, LANES

MOTIONS = 10
"""Most joints: five free ones, a leader and four followers."""

ALWAYS = 2
"""Most places where an elimination's polynomial has roots at every pose."""

_INTEGERS = {
    "trials": (),  # number of eliminations
    "choices": (MOST, 2),  # where each cuts the loop, and in which direction
    "motions": (),  # number of joints
    "factors": MOTIONS,  # by how much the leader moves each, 0 for a free one
    "values": MOTIONS,  # which value moves each
    "leader": (),  # the value that moves more than one
    "kinds": MOTIONS,  # factors along the loop
    "slides": 6,  # none of the free joints slides
}

_FLOATS = {
    "size": (),  # longest of the short links [m]
    "ends": (2, 4, 4),  # inverses of the first and the last of the short links
    "zeros": 6,  # of the values inside the solver [rad]
    "always": (MOST, ALWAYS, 3),  # roots at every pose: cosine, sine, half of how many they are
    "chain": (MOTIONS, 3, 4),  # short links in between, in parts of the size; then the target
    "target": (3, 4),
    "loop": (MOTIONS, 3, 4),  # closed loop
    "outer": (6, 3, 4),  # of it what comes after joints 1, 2 and 6
    "samples": (14, 9),  # of the right side's fourteen functions
    "right": (9, 14),  # right side and its reflectors
    "basis": (14, 14),  # its orthogonal basis
    "reflectors": 16,  # their factors
    "lines": 54 * LANES,  # axis 6 for nine values of joints 4 and 5
    "functions": (14, LANES),
    "equations": 54 * LANES,  # six, in nine powers of joints 4 and 5
    "block": (2, LANES),  # cosine and sine of the leader
    "determinants": LANES,
    "A": 9 * COLUMN,  # lanes of 6 x 9 matrices
    "W": 9 * COLUMN,  # lanes of 6 x 6 matrices
    "V": COLUMN,  # reflector
    "beta": LANES,  # its factor
    "null": COLUMN,  # null vectors
    "second": COLUMN,  # second null vectors
    "cosines": COLUMN,  # of joints 1, 2, 4, 5 and 6
    "sines": COLUMN,
    "loop_cosines": MOTIONS * LANES,  # of all joints
    "loop_sines": MOTIONS * LANES,
    "frames": 7 * 12 * LANES,
    "pairs": 4 * LANES,  # joints 1 and 2
    "q": 6,
    "first": 2,  # error of the seeds, spans of doubt in the first trial
}


def _record(degree):
    lanes = 2 * degree + 8
    more = {"doubles": lanes, "bends": lanes, "seen": lanes, "kept": lanes}
    return record({**_INTEGERS, **root_order(degree)}, {**_FLOATS, **root_work(degree), **more})


FOLLOWERS_16, FOLLOWERS_48 = _record(16), _record(48)
"""The records, by the degree of the polynomial; while one is in use, another thread needs a copy.
"""
