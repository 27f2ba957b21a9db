"""Real roots of trigonometric polynomials whose roots are known by construction."""

import math

import numpy as np
import pytest
from margins import assert_margin

from dh2urdf.kernels.general_6r.arc_roots import roots_on_arcs
from dh2urdf.kernels.general_6r.arc_samples import (
    TERMS,
    arc_tan,
    circle_arcs,
    lanes_of,
    table_shapes,
    tables_of,
    window_arc,
    window_nodes,
)
from dh2urdf.kernels.general_6r.arc_shapes import CENTRE, LEFT, RIGHT
from dh2urdf.kernels.general_6r.arm import ARM_6R, record, root_order, root_work
from dh2urdf.kernels.general_6r.roots import PAIRS
from dh2urdf.kernels.two_parallel.poses import APART

CIRCLE = 2 * math.pi * np.arange(24) / 24


def product(q, roots):
    """``prod sin((q - r) / 2)`` over sixteen roots, complex ones in pairs: degree 8."""
    values = np.prod([np.sin((q - r) / 2) for r in roots], axis=0)
    assert_margin(np.imag(values), 1e-12)
    return np.real(values)


def filled(dtype):
    """A record of a degree with its tables."""
    arm = np.zeros(1, dtype)[0]
    if dtype is not ARM_6R:
        for name, table in tables_of(len(arm["turned"]) // 2).items():
            arm[name] = table
    return arm


def roots_around(samples, pairs, dtype=ARM_6R):
    """Roots and slopes of all arcs of the circle, the noise, the largest coefficient."""
    arm, lanes = filled(dtype), len(samples)
    arm["determinant"], terms = samples, len(arm["turned"])
    noise, largest = circle_arcs(arm)
    arm["arcs"][terms + LEFT], arm["arcs"][terms + RIGHT] = -arc_tan(arm), arc_tan(arm)
    arm["arcs"][terms + CENTRE] = 2 * math.pi / lanes * np.arange(lanes)
    count = roots_on_arcs(lanes, noise, pairs, 0, arm)
    return arm["roots"][:count], arm["slopes"][:count], noise, largest


class Strict(np.ndarray):
    """An array that is not read from its end."""

    def __getitem__(self, index):
        assert min(index if isinstance(index, tuple) else (index,)) >= 0
        return super().__getitem__(index)


def test_arcs_are_read_from_no_negative_index():
    """The arc before the first one is the last one, by its own index."""
    arrays = {"series": np.zeros(24), "turned": np.zeros((TERMS, 24)), "arcs": np.zeros((24, 24))}
    samples = {"determinant": product(CIRCLE, np.linspace(-3, 3, 16))}
    circle_arcs(samples | {name: a.view(Strict) for name, a in arrays.items()})
    assert arrays["arcs"][0, 0] == arrays["arcs"][TERMS - 1, 23] != 0.0


@pytest.mark.parametrize("degree", [16, 48])
def test_a_polynomial_of_a_higher_degree_has_all_its_roots(degree):
    rng = np.random.default_rng(degree)
    dtype, lanes = record(root_order(degree), root_work(degree)), lanes_of(degree)
    for _ in range(4):
        roots = np.sort(rng.uniform(-math.pi, math.pi, degree))
        others = rng.uniform(-math.pi, math.pi, degree // 2) + 0.3j
        samples = product(2 * math.pi * np.arange(lanes) / lanes, [*roots, *others, *others.conj()])
        q, slopes, noise, largest = roots_around(samples / np.abs(samples).max(), PAIRS, dtype)
        found = np.remainder(q[slopes > 0] + math.pi, 2 * math.pi) - math.pi
        gap = np.abs(found[:, None] - roots)
        apart = np.diff([*roots, roots[0] + 2 * math.pi]).min()
        if apart > 1e-3 and noise < 1e-12 * largest:
            assert len(found) == degree
            assert_margin(np.minimum(gap, 2 * math.pi - gap).min(axis=1), 1e-4)


@pytest.mark.parametrize("half_tan", [0.1, 0.03, 0.01])
@pytest.mark.parametrize("degree", [16, 48])
def test_rounding_of_a_window_of_a_higher_degree_is_told(degree, half_tan):
    """Where f is 1e-12 of what it is at the ends it is off by no more than the noise."""
    rng, arm = np.random.default_rng(degree), filled(record(root_order(degree), root_work(degree)))
    near = 1.0 + 0.1 * half_tan * (rng.normal(size=7) + 1j * rng.normal(size=7))
    others = rng.uniform(2.0, 6.0, degree - 8) + 1j * rng.uniform(0.1, 1.0, degree - 8)
    roots = [*near, *near.conj(), *others, *others.conj(), 1.0 - 1e-3, 1.0 + 1e-3]
    window_nodes(1.0, half_tan, arm)
    f = product(np.arctan2(arm["hidden"][1], arm["hidden"][0]), roots)
    arm["determinant"] = f
    noise, x = window_arc(half_tan, arm), np.linspace(0.3, 0.7, 101)
    row = arm["arcs"][: 2 * degree + 1, :1] * np.ones_like(x)
    while len(row) > 1:
        row = row[:-1] * (1.0 - x) + row[1:] * x
    t = half_tan * (2.0 * x - 1.0)
    expected = product(1.0 + 2.0 * np.arctan(t), roots) * (1.0 + t * t) ** degree
    assert np.abs(expected).min() < 1e-9 * np.abs(f).max()
    assert np.abs(row[0] - expected).max() < 10.0 * noise
    assert noise < 1e-6 * np.abs(f).max()


def nodes_of(middle, half_tan):
    """Cosines and sines of a window's nodes."""
    arm = filled(ARM_6R)
    window_nodes(middle, half_tan, arm)
    return arm["hidden"]


def arc_of(samples, half_tan):
    """Bernstein coefficients on a window, and their noise."""
    arm = filled(ARM_6R)
    arm["determinant"] = samples
    noise = window_arc(half_tan, arm)
    return arm["arcs"][:TERMS], noise


def found_roots(roots, pairs=PAIRS):
    """Roots and slopes that the arcs of the whole circle give."""
    q, slopes, noise, largest = roots_around(product(CIRCLE, roots), pairs)
    # The noise is the rounding of sixteen factors and of their sum, half of this: no ten times.
    assert_margin(noise, 1e-14 * largest, 1)
    return np.mod(q, 2 * math.pi), slopes


@pytest.mark.parametrize("pairs", [PAIRS, APART])
def test_sixteen_real_roots_are_found(pairs):
    """Of 400 draws sixteen real roots, at least 0.01 rad apart, are all found, and no other."""
    away = np.empty((400, 16))
    for seed, row in enumerate(away):
        roots = np.cumsum(np.random.default_rng(seed).uniform(0.02, 1.0, 16))
        roots *= 6.2 / roots[-1]
        q, slopes = found_roots(roots, pairs)
        assert len(q) == 16
        assert (slopes > 0).all()
        row[:] = np.sort(q) - np.sort(np.mod(roots, 2 * math.pi))
    assert_margin(np.abs(away), 1e-6)


def test_complex_roots_are_not_reported():
    """Six real roots among ten complex ones, 0.1 or more from the axis, are found alone."""
    away = np.empty((400, 6))
    for seed, row in enumerate(away):
        rng = np.random.default_rng(seed)
        real = np.sort(rng.uniform(0, 2 * math.pi, 6))
        pairs = rng.uniform(0, 2 * math.pi, 5) + 1j * rng.uniform(0.1, 1.0, 5)
        q, slopes = found_roots([*real, *pairs, *pairs.conj()])
        assert len(q) == 6
        assert (slopes > 0).all()
        row[:] = np.sort(q) - real
    assert_margin(np.abs(away), 1e-6)


@pytest.mark.parametrize("gap", [1e-2, 1e-3, 1e-4, 1e-5])
@pytest.mark.parametrize("place", [0.1, 0.1309, 3.0])
@pytest.mark.parametrize("pairs", [PAIRS, APART])
def test_close_roots_are_told_apart(gap, place, pairs):
    """Two roots closer than an arc by far are two simple roots, also across an arc's end."""
    others = [0.7, 1.4, 2.2, 4.0, 4.9, 5.5]
    complex_ones = [2.5 + 0.4j, 3.6 + 0.7j, 4.4 + 0.3j, 5.9 + 1.0j]
    close = [place - gap / 2, place + gap / 2]
    q, slopes = found_roots([*others, *close, *complex_ones, *np.conj(complex_ones)], pairs)
    near = np.sort(q[np.abs(q - place) < 0.02])
    assert len(q) == 8
    assert_margin(np.abs(near - close), 0.05 * gap)
    assert (slopes > 0).all()


@pytest.mark.parametrize("imaginary", [1e-2, 1e-3, 1e-5, 0.0])
@pytest.mark.parametrize("place", [0.1, 3.0])
def test_complex_pairs_near_the_axis_count_as_double_roots(imaginary, place):
    """A pair that almost touches the real axis is reported, once, with slope zero."""
    others = [0.7, 1.4, 2.2, 4.0, 4.9, 5.5]
    pairs = [place + 1j * imaginary, 2.5 + 0.4j, 3.6 + 0.7j, 4.4 + 0.3j, 5.9 + 1.0j]
    q, slopes = found_roots([*others, *pairs, *np.conj(pairs)])
    assert (slopes > 0).sum() + 2 * (slopes == 0).sum() >= 8
    assert_margin(np.abs(q - place).min(), 1e-2)


def test_a_window_gives_the_same_polynomial():
    """Bernstein coefficients from samples of a window evaluate to the polynomial at its ends."""
    roots = [0.7, 1.4, 2.2, 4.0, 4.9, 5.5, 2.5 + 1j, 2.5 - 1j, *np.linspace(0.1, 6.0, 8)]
    half_tan, middle = 0.1, 1.9
    c, s = nodes_of(middle, half_tan)
    arcs, noise = arc_of(product(np.arctan2(s, c), roots), half_tan)
    ends = middle + 2 * np.arctan(np.array([-half_tan, half_tan]))
    expected = product(ends, roots) * (1 + half_tan**2) ** 8
    assert_margin(np.abs(arcs[[0, TERMS - 1], 0] / expected - 1.0), 1e-9)
    assert_margin(noise, 1e-12 * np.abs(arcs).max())


@pytest.mark.parametrize("degree", [16, 48])
def test_shapes_that_a_record_reserves_are_those_of_the_tables(degree):
    """They are stated, in the order of the record, so that no import makes the tables."""
    made = {name: table.shape for name, table in tables_of(degree).items()}
    assert list(table_shapes(degree).items()) == list(made.items())
