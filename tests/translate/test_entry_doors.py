"""What an entry is handed is looked at before it runs: kinds, numbers and all lengths."""

import os
import platform
from collections import Counter
from pathlib import Path

import numpy as np
import pytest

from dh2urdf import engine
from dh2urdf.kernels.certificate import measure_all
from dh2urdf.kernels.spherical_wrist import solve_common_wrist
from dh2urdf.translate.entries import argument_types
from dh2urdf.translate.types import Array, Tuple

pytestmark = pytest.mark.skipif(not engine._COMPILED, reason="kernels are interpreted")

SIZES = {"poses": 3, "solutions": 2, "n": 4, "n + 1": 5, "frames": 5, "moves": 4}
KINDS = {"float": np.float64, "int": np.int64, "bool": np.bool_}
ENTRIES = [solve_common_wrist, measure_all]


def types(entry):
    """Names of an entry's arguments, and their types as they are declared."""
    function = engine.INTERPRETED[entry.__name__.replace("__", ".")]
    return dict(zip(function.__code__.co_varnames, argument_types(function), strict=False))


def good(t):
    """A value of a type."""
    if isinstance(t, Tuple):
        return tuple(map(good, t.items))
    if isinstance(t, Array):
        return np.zeros([SIZES.get(d, d) for d in t.shape], KINDS[t.element])
    return {"float": 1.0, "int": 0, "bool": True}[t]


def lengths(t):
    """Names of the lengths of a type's arrays."""
    if isinstance(t, Tuple):
        return [name for item in t.items for name in lengths(item)]
    return [str(d).partition(" ")[0] for d in t.shape] if isinstance(t, Array) else []


def others(name, t, value, free):
    """Values that are not of the type: of which part, the error, what is handed instead.

    Lengths that are ``free`` belong to one argument alone.
    """
    yield name, TypeError, "text" if t != "bool" else np.zeros(2)
    if t == "int":
        yield name, TypeError, 2**31
        yield name, TypeError, 1.0
    if isinstance(t, Tuple):
        yield name, TypeError, value[:-1]
        for i, item in enumerate(t.items):
            for part, error, other in others(f"{name}[{i}]", item, value[i], free):
                yield part, error, (*value[:i], other, *value[i + 1 :])
    if isinstance(t, Array):
        yield name, TypeError, value.tolist()
        yield name, TypeError, value[None]
        yield name, TypeError, value.astype(np.float32)
        yield name, TypeError, np.repeat(value, 2, -1)[..., ::2]
        for axis in (k for k, length in enumerate(t.shape) if length not in free):
            yield "", ValueError, np.delete(value, 0, axis)
            yield "", ValueError, np.concatenate([value, value.take([0], axis)], axis)


@pytest.mark.parametrize("entry", ENTRIES)
def test_what_is_declared_is_taken(entry):
    """The arguments of the other tests are good ones but for what they change."""
    assert not entry(*map(good, types(entry).values()))  # nothing, or that no pose is in doubt


@pytest.mark.parametrize("entry", ENTRIES)
def test_anything_else_is_refused_by_name(entry):
    """The message names the argument and what it has to be: every length, every kind."""
    arguments = [good(t) for t in types(entry).values()]
    uses = Counter(length for t in types(entry).values() for length in lengths(t))
    free = [length for length, count in uses.items() if count == 1 and not length.isdigit()]
    for i, (name, t) in enumerate(types(entry).items()):
        for part, error, other in others(name, t, arguments[i], free):
            given = [*arguments[:i], other, *arguments[i + 1 :]]
            with pytest.raises(error) as refusal:
                entry(*given)
            told, _, wanted = str(refusal.value).partition(": expected ")
            assert wanted, refusal
            assert told == (part or told)


def test_nothing_is_written_where_one_output_is_too_short():
    """The others are as they were."""
    *arguments, outputs = (good(t) for t in types(solve_common_wrist).values())
    for array in outputs:
        array.fill(5)
    with pytest.raises(ValueError, match=r"outputs\[4\]: expected array of int \(poses, 8\)"):
        solve_common_wrist(*arguments, (*outputs[:4], outputs[4][:2]))
    assert all((array == 5).all() for array in outputs)


@pytest.mark.parametrize("count", [0, 3, 5])
def test_other_counts_of_arguments_are_refused(count):
    """Too few and too many."""
    given = [*map(good, types(solve_common_wrist).values()), 0.0][:count]
    with pytest.raises(TypeError, match=f"expected 4 arguments, got {count}"):
        solve_common_wrist(*given)


CPUINFO = Path("/proc/cpuinfo")


@pytest.mark.skipif(not CPUINFO.exists(), reason="only Linux says what the processor has")
@pytest.mark.skipif(platform.machine() != "x86_64", reason="other processors have one level")
@pytest.mark.skipif(bool(os.environ.get("DH2URDF_LEVEL")), reason="a level was asked for")
def test_the_level_is_the_best_that_the_processor_has():
    """Whatever compiled the extension, the system's compiler or that of the wheel."""
    flags = set(next(x for x in CPUINFO.read_text().splitlines() if x[:5] == "flags").split())
    v4 = {"avx512f", "avx512cd", "avx512bw", "avx512dq", "avx512vl"}
    v3 = {"avx2", "bmi1", "bmi2", "fma"}
    best = "any" if not v3 <= flags else "v3" if not v4 <= flags else "v4"
    assert best == engine._COMPILED.LEVEL
