"""Elementary functions: their errors in units of the last place, and the same bits compiled."""

import ctypes
import math
from random import Random

import mpmath
import numpy as np
import pytest

from dh2urdf.kernels.numbers import elementary
from dh2urdf.translate.build import FLAGS
from dh2urdf.translate.c_file import CFile
from tests.translate import replay

LARGEST = 4e5
"""Angles up to which sine and cosine are what they say [rad]."""

ULPS = {"sin": 0.69, "cos": 0.69, "atan2": 0.69, "asin": 0.69, "hypot": 0.5001}

TINY = {"atan2": 2.0**-960, "hypot": 2.0**-1021}
"""Below these the arctangent's quotient loses digits, and a length is rounded twice: 0.75."""

OURS = {
    "sin": lambda x, _: elementary.sincos(x)[0],
    "cos": lambda x, _: elementary.sincos(x)[1],
    "asin": lambda x, _: elementary.asin(x),
    "atan2": elementary.atan2,
    "hypot": elementary.hypot,
}


def wide(rng):
    """A number of any size and sign."""
    return math.ldexp(rng.random() + 0.5, rng.randrange(-1060, 1000)) * rng.choice((-1.0, 1.0))


def angle(rng):
    """An angle: anywhere, tiny, or beside a multiple of a quarter turn."""
    kind, x = rng.randrange(4), rng.uniform(-1.0, 1.0)
    if kind == 0:
        return LARGEST * x
    if kind == 1:
        return 4.0 * x
    if kind == 2:
        return math.ldexp(x, -rng.randrange(1070))
    quarters = rng.randrange(-200_000, 200_000) if rng.random() < 0.5 else rng.randrange(-8, 9)
    return quarters * elementary.QUARTER + math.ldexp(x, -rng.randrange(60))


def sine(rng):
    """A number from -1 to 1: anywhere, beside 0, 1/2 or 1."""
    x, near = rng.uniform(-1.0, 1.0), rng.choice((0.0, 0.5, 1.0))
    beside = near - math.ldexp(abs(x), -rng.randrange(1, 60))
    return rng.choice((x, min(1.0, beside) * rng.choice((-1.0, 1.0))))


def pair(rng):
    """Two numbers of like sizes, or of any, or one of them 0."""
    x, y = wide(rng), wide(rng)
    like = max(-1070, min(1000, math.frexp(x)[1])) + rng.randrange(-3, 4)
    near = math.ldexp(rng.uniform(-1.0, 1.0), like)
    return rng.choice(((near, x), (x, near), (x, y), (rng.choice((0.0, -0.0)), x), (x, 0.0)))


def arguments(name, count):
    """Arguments of a function, (count, 2)."""
    rng = Random(name)
    draw = {"sin": angle, "cos": angle, "asin": sine}.get(name, pair)
    rows = [draw(rng) for _ in range(count)]
    return rows if draw is pair else [(x, 0.0) for x in rows]


def errors(name, rows):
    """Errors in units of the last place, against arithmetic of 200 bits."""
    exact = getattr(mpmath, name)
    one = name not in ("atan2", "hypot")
    for x, y in rows:
        true = exact(mpmath.mpf(x)) if one else exact(mpmath.mpf(x), mpmath.mpf(y))
        if abs(true) < 2**1023:
            yield float(abs(OURS[name](x, y) - true) / math.ulp(float(true)))


def check_errors(name, count):
    """No result is off by more than the bound; mpmath has no negative zero."""
    rows = [(abs(x) if name == "atan2" else x, y) for x, y in arguments(name, count)]
    with mpmath.workprec(200):
        tiny = [r for r in rows if max(map(abs, r)) < TINY.get(name, 0.0)]
        assert max(errors(name, set(rows) - set(tiny))) <= ULPS[name]
        assert max(errors(name, tiny), default=0.0) <= 0.75


@pytest.mark.parametrize("name", ULPS)
def test_error_is_below_its_bound(name):
    """At 4,000 arguments: tiny, huge, beside multiples of a quarter turn."""
    check_errors(name, 4_000)


@pytest.mark.exhaustive
@pytest.mark.parametrize("name", ULPS)
def test_error_is_below_its_bound_at_many(name):
    """The same at 300,000."""
    check_errors(name, 300_000)


def bits(values):
    """Bits of numbers, all NaN the same."""
    a = np.array(values, float)
    return np.where(np.isnan(a), np.nan, a).view(np.uint64)


HARNESS = """
void all(int f, int count, const double (*from)[2], double *to)
{
    for (int i = 0; i < count; i++) {
        const double x = from[i][0], y = from[i][1];
        to[i] = f == 0 ? sincos_(x).f0 : f == 1 ? sincos_(x).f1 : f == 2 ? asin_(x)
            : f == 3 ? atan2_(x, y) : hypot_(x, y);
    }
}
"""


@pytest.fixture(scope="module", params=["-O0", "-O3", "-O3 -march=native"])
def compiled(request, tmp_path_factory):
    """The functions as the translator and a compiler make them."""
    folder, file = tmp_path_factory.mktemp("elementary"), CFile()
    made = {}
    for name in ("sincos", "asin", "atan2", "hypot"):
        function = getattr(elementary, name)
        made[name] = file.add_entry(function, ["float"] * function.__code__.co_argcount)
    text = file.kernels() + HARNESS
    for name, entry in made.items():
        text = text.replace(f"{name}_(", f"{entry.function}(")
    folder.joinpath("kernels.h").write_text(file.header())
    folder.joinpath("some.c").write_text(text)
    words = [*replay.cc(), *FLAGS, *request.param.split(), "-DTABLE=entries_here", "-w"]
    replay.compiled(folder, [*words, "-shared", "some.c"], "some.so")
    return ctypes.CDLL(str(folder / "some.so"))


@pytest.mark.parametrize("name", OURS)
def test_compiled_functions_give_the_same_bits(name, compiled):
    """Interpreted or compiled, at 40,000 arguments, infinite ones and NaN."""
    odd = (0.0, -0.0, 1.0, -1.0, 2.0, 0.5, math.nan, 5e-324)
    odd = odd if name in ("sin", "cos") else (*odd, math.inf, -math.inf, 1.7e308)
    rows = [*arguments(name, 40_000), *((x, y) for x in odd for y in odd)]
    given, found = np.array(rows), np.empty(len(rows))
    address = (ctypes.c_void_p(a.ctypes.data) for a in (given, found))
    compiled.all(list(OURS).index(name), len(rows), *address)
    assert (bits(found) == bits([OURS[name](x, y) for x, y in rows])).all()


def test_exact_points():
    """Zeros with their signs, ones, axes and the edges are exact, or the nearest number."""
    e, pi = elementary, math.pi
    assert e.sincos(0.0) == (0.0, 1.0)
    assert [e.asin(x) for x in (1.0, 0.0, -1.0)] == [pi / 2, 0.0, -pi / 2]
    for y, x in [(y, x) for y in (0.0, -0.0, 1.0, -1.0) for x in (0.0, -0.0, 1.0, -1.0)]:
        assert bits([e.atan2(y, x)]) == bits([math.atan2(y, x)])
    assert [e.hypot(3.0, -4.0), e.hypot(0.0, -0.0), e.hypot(0.0, 5e-324)] == [5.0, 0.0, 5e-324]


def test_symmetries():
    """Signs of the arguments change signs of the results, and no other bit."""
    e = elementary
    for x, _ in arguments("sin", 2_000):
        (s, c), (t, d) = e.sincos(x), e.sincos(-x)
        assert (t, d) == (-s, c)
    for x, _ in arguments("asin", 2_000):
        assert e.asin(-x) == -e.asin(x)
    for y, x in arguments("atan2", 2_000):
        assert bits([e.atan2(-y, x)]) == bits([-e.atan2(y, x)])
        assert e.hypot(x, y) == e.hypot(y, x) == e.hypot(-x, y)


def test_what_is_no_number_stays_none():
    """NaN passes; infinities, and sines beyond 1, give NaN."""
    e, nan, inf = elementary, math.nan, math.inf
    found = [*e.sincos(nan), e.asin(nan), e.asin(1.0 + 2**-52), e.asin(-2.0)]
    found += [f(*pair) for f in (e.atan2, e.hypot) for pair in ((nan, 1.0), (1.0, nan), (inf, inf))]
    assert np.isnan(found).all()
