"""One small kernel for each construct of the subset."""

import math
from typing import Annotated

import numpy as np
from numpy.typing import NDArray

Floats, Integers, Flags = NDArray[np.float64], NDArray[np.int64], NDArray[np.bool_]

Four = Annotated[Floats, 4]
Ints = Annotated[Integers, 4]
Bools = Annotated[Flags, 4]
Square = Annotated[Floats, 3, 3]
Rows = Annotated[Floats, "rows", "n"]

HALF, MINUS, COUNT = 0.5, -2.5, 3
"""What a kernel takes from its module."""

TABLE = np.array([[1.0, -0.0], [math.inf, 2.0]])
STEPS = (3, 1, 2)


def arithmetic(x: float, y: float, n: int):
    """Left to right, as the brackets say, whole numbers widened."""
    return x + y * n - x, x - (y - n), (x + y) * (x - y), -x * -y, -(x + y), +x - -y


def quotients(x: float, n: int, m: int):
    """Of whole numbers too, which C would cut."""
    return n / m, n / m * x, x / m / n, x / (n / m)


def floors(n: int, m: int):
    """Division towards minus infinity, whatever the signs."""
    return n // m, n % m, (n + 3) // 4, -n % 6


def extremes(x: float, y: float, n: int, m: int):
    """The first of two that compare as equal, and of which one is no number."""
    return (
        max(x, y),
        min(x, y),
        max(x, y, 0.0),
        min(0.0, x, -0.0),
        max(n, m),
        min(n, m, 2),
        max(float(n), x),
    )


def magnitudes(x: float, n: int):
    """Signs, those of zeros too."""
    return abs(x), abs(n), math.copysign(2.0, x), 0.0 * x, -0.0 + x, math.fmod(x, 3.0)


def rounded(x: float):
    """Whole numbers near a number, towards zero by int."""
    near = math.fmod(x, 1e6) if math.isfinite(x) else 0.0
    whole = int(near)
    return np.floor(near), np.ceil(near), np.rint(near), float(whole), near - np.floor(near)


def roots(x: float):
    """Roots, constants of math, what is a number."""
    return math.sqrt(abs(x)), math.pi, -math.inf, math.isnan(x), math.isinf(x), math.isfinite(x)


def comparisons(x: float, y: float, n: int):
    """Chained ones, negated ones, whole numbers with others."""
    return x < y <= 1.0, not x < y, x == y != n, n >= x, (x < y) == (n < 2), not (x > y or n == 1)


def connected(x: float, y: float, n: int, a: Four):
    """The right side is only looked at where the left one does not decide."""
    inside = 0 <= n < 4 and a[n] > x
    return inside or (x < y and n > 2), not inside and (x > y or n < 0)


def truths(x: float, n: int, b: bool):
    """A number is true unless it is zero."""
    found = 0
    if x:
        found += 1
    if not n:
        found += 2
    if b and not x < 0.0:
        found += 4
    return found, not b


def bits(n: int, m: int):
    """Of whole numbers."""
    k = abs(m) % 8
    return n & 5 | 2, (n ^ m) << 1, n >> k, ~n & 255, 1 << k | m


def flags(x: float, y: float):
    """Truths without a branch."""
    b = (x < y) & (x > 0.0)
    b &= y < 3.0
    b |= x == 1.0
    return b, b & (y > 1.0)


def choices(x: float, y: float, n: int):
    """Choices in choices, and of two values at once."""
    small, large = (x, y) if x < y else (y, x)
    return x if n > 2 else y if n > 0 else -x, small, large, (n if n > 0 else 0.5) * 2.0


def swaps(x: float, y: float, z: float, a: Four):
    """All is read before anything is written."""
    x, y, z = y, z, x
    x, y = y, x + y
    a[0], a[1] = a[1], a[0]
    a[2], x = x, a[2] - x
    return x, y, z


def counts(n: int, m: int):
    """Ranges up and down, by steps, empty, left early and passed over."""
    found = 0
    for i in range(n):
        if i == 5:
            continue
        if i > 9:
            break
        found += i
    for i in range(n, m, -3):
        found = 3 * found % 10007 + i
    for i in range(m, n, 2):
        for j in range(i, i + 3):
            if j % 5 == 4:
                break
            found = (found + i * j) % 10007
    for _ in range(COUNT):
        found += 1
    return found


def _one_more(a):
    """Raise the second number, and what it was."""
    a[1] += 1
    return a[1] - 1


def end_is_kept(n: int, a: Ints):
    """A range's end is looked at once, and worked out once."""
    found, end = 0, n
    for _ in range(end):
        end += 1
        found += 1
    a[0] = 2
    for _ in range(a[0]):
        a[0] += 1
        found += 1
    a[1] = 3
    for _ in range(_one_more(a)):
        found += 1
    return found, end


def until(x: float, n: int):
    """A loop that ends by its condition, or by break."""
    steps = 0
    while steps < 20 and abs(x) > HALF:
        x *= HALF
        steps += 1
        if steps == n:
            break
    return x, steps


def returns_early(x: float, n: int):
    """Each way returns."""
    for i in range(n):
        if i > x:
            return i
    if x > 3.0:
        return -1
    elif x > 2.0:
        return -2
    else:
        found = n - 100
    return found


def blocks(x: float, n: int):
    """Names that get their value in several blocks, before them, or in one only."""
    if n > 0:
        y, z = x + 1.0, 2.0
    else:
        z = x
        y = z * x
    for _ in range(2):
        w = y * z
        y = w - 1.0
    if n > 3:
        w = 0.5
        z = w + y
    return y, z


def augmented(x: float, n: int, a: Four):
    """Operators with an assignment."""
    x -= x - 1.0
    x *= 2.0 + n
    x /= 3.0
    n -= 2
    n *= n
    a[1] += x
    a[2] /= 7.0
    return x, n


def whole_arrays(x: float, a: Four, b: Square):
    """All elements, one after the other."""
    c = np.empty(4)
    c[:] = a
    a[:] = c * x - a / 3.0
    a *= 2.0
    b[1] = 0.25
    b[2] = b[0] - x
    c[:2] = x
    b[0] += -b[1]
    return c[0], c[3]


def views(n: int, a: Four, b: Square):
    """Parts of arrays as arrays."""
    k = abs(n) % 3
    row, part = b[k], a[1:3]
    row[0], part[1] = 7.0, 8.0
    b[0, 1:3][0] = a[k : k + 2][1]
    return row[2], part[0], total(a[:2]), total(a[2:]), total(b[k]), len(a), b.shape[1]


def total(a):
    """Sum of an array of any length."""
    found = 0.0
    for i in range(len(a)):
        found += a[i]
    return found


def makes(x: float, n: int):
    """Arrays of its own, by numbers and by names, of whole numbers and truths."""
    size = COUNT + 1
    a, b = np.zeros((size, 2)), np.zeros(size, np.int64)
    work, (left, right) = scratch(size)
    c = np.empty(2, np.bool_)
    c[0], c[1] = x > 0.0, n > 0
    for i in range(size):
        b[i], left[i], right[i], work[i, 1] = n, x, -x, i
        a[i, 1] += left[i] * b[i] + work[i, 1]
    return a[0, 0], a[3, 1], b[3], c[0], c[1], total(right)


def scratch(n):
    """Arrays that a kernel makes for its caller."""
    return np.empty((n, 2)), (np.empty(n), np.empty(n))


def tuples(x: float, y: float, n: int):
    """Kept, changed, taken apart, nested, handed on and joined."""
    point, ((a, b), c) = (x, y), nested(x, n)
    for _ in range(3):
        point = turned(point)
    k, _ = (n, 0) if x > 0.0 else (n + 1, 1)
    first = turned((a, c))
    both = *point, *turned(point)
    return *first, both[0], both[3], length(*point), b, point[1], k


def nested(x, n):
    """Tuples in a tuple."""
    return (x, n), x * 2.0


def turned(p):
    """A point turned by a right angle."""
    x, y = p
    return -y, x


def length(x, y):
    """Sum of squares."""
    return x * x + y * y


def groups(x: float, a: Four, b: Square):
    """Arrays that travel together."""
    work = a, (b[1], b[2]), x
    fill(work, 1)
    for i in range(2):
        pair = b[i], a
        pair[0][2] = pair[1][i + 1]
    return a[0], b[1, 1], b[2, 0]


def fill(work, k):
    """Write into arrays that came together."""
    a, (first, second), x = work
    a[0], first[k], second[k - 1] = x, 2.0 * x, work[2] + 1.0


def ranks(x: float, a: Four, b: Square):
    """A kernel for arrays of one and of two dimensions."""
    return corner(a) + x, corner(b)


def corner(a):
    """The last element."""
    if a.ndim == 1:
        return a[len(a) - 1]
    return a[len(a) - 1, a.shape[1] - 1]


def constants(n: int, x: float):
    """Numbers and tables of the module."""
    k = n % 2
    return TABLE[k, 1], TABLE[1, k], STEPS[n % 3], STEPS[0], x * MINUS, x - MINUS, len(STEPS)


def lengths(a: Rows, out: Rows):
    """Lengths that are known when the kernel runs."""
    rows, n = a.shape[0], a.shape[1]
    sums, twice = np.zeros(n), np.empty((rows, 2 * n))
    for i in range(rows):
        for j in range(n):
            sums[j] += a[i, j]
            twice[i, n + j] = a[i, j]
    for i in range(rows):
        out[i] = twice[i, n : n + n] - sums


def register(double: float, near: int, floor: float):
    """Names that mean something else in C."""
    int64_t, auto = double + near, floor
    return auto * int64_t
