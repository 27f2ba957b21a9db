"""Arrays of every make at every method: read by value, or refused by name."""

import tempfile
from fractions import Fraction

import numpy as np
import pytest
from hostile import hostile, outcome
from hypothesis import strategies as st

from dh2urdf import Robot, transforms, wrist_centre
from dh2urdf.exceptions import ConfigurationError, Dh2UrdfError, PoseError

ARM = Robot.from_dh("puma560")
SEVEN = Robot.from_dh("franka_fer")
SLIDES = Robot.from_dh("gantry_wrist")


class Foreign:
    """An array of another library, by NumPy's protocol."""

    def __init__(self, values):
        self.values = values

    def __array__(self, dtype=None, copy=None):
        return np.array(self.values, dtype)


class Interface:
    """An array of another library, by its memory."""

    def __init__(self, values):
        self.values = np.array(values)
        self.__array_interface__ = self.values.__array_interface__


class Number:
    """A number of another library."""

    def __init__(self, value):
        self.value = value

    def __float__(self):
        return float(self.value)


def misaligned(a):
    """The same array, one byte off every boundary."""
    raw = np.frombuffer(b"x" + a.tobytes(), np.uint8)[1:]
    return raw.view(a.dtype).reshape(a.shape)


def mapped(a):
    """The same array in a file, read-only."""
    with tempfile.NamedTemporaryFile() as file:
        np.save(file, a)
        file.flush()
        return np.load(file.name, mmap_mode="r")


def read_only(a):
    """The same array, protected."""
    a = a.copy()
    a.flags.writeable = False
    return a


MAKES = {
    "big-endian": lambda a: a.astype(">f8"),
    "little-endian": lambda a: a.astype("<f8"),
    "big float32": lambda a: a.astype(">f4"),
    "float16": lambda a: a.astype(np.float16),
    "longdouble": lambda a: a.astype(np.longdouble),
    "object": lambda a: a.astype(object),
    "fractions": np.vectorize(Fraction, otypes=[object]),
    "numbers": np.vectorize(Number, otypes=[object]),
    "lists": lambda a: a.tolist(),
    "fortran": np.asfortranarray,
    "transposed": lambda a: a.T.copy().T,
    "negative": lambda a: a[..., ::-1].copy()[..., ::-1],
    "gaps": lambda a: np.repeat(a, 3, axis=-1)[..., ::3],
    "big gaps": lambda a: np.repeat(a.astype(">f8"), 2, axis=-1)[..., ::2],
    "a column": lambda a: np.stack([a, a], axis=-1)[..., 1],
    "broadcast": lambda a: np.broadcast_to(a, (2, *a.shape))[1],
    "read-only": read_only,
    "mapped": mapped,
    "misaligned": misaligned,
    "unmasked": np.ma.masked_array,
    "foreign": Foreign,
    "interface": Interface,
    "field": lambda a: np.rec.fromarrays([a, a], names="x,q").q,
    "unpickled": lambda a: a.astype(np.dtype("f8", copy=True)),
}

CALLS = {
    "fk": lambda x: ARM.fk(x["q"]),
    "fk of many": lambda x: ARM.fk(x["qs"]),
    "fk of slides": lambda x: SLIDES.fk(x["q"]),
    "frames": lambda x: ARM.frames(x["q"]),
    "jacobian": lambda x: ARM.jacobian(x["q"]),
    "jacobian of many": lambda x: ARM.jacobian(x["qs"]),
    "model_configuration": lambda x: ARM.model_configuration(x["q"]),
    "chain_configuration": lambda x: ARM.chain_configuration(x["qs"]),
    "ik": lambda x: ARM.ik(x["T"]).q,
    "ik seed": lambda x: ARM.ik(x["T"], seed=x["q"]).q,
    "nearest": lambda x: ARM.ik(x["T"]).nearest(x["q"]),
    "ik of 7": lambda x: SEVEN.ik(x["T"], locked={2: x["one"]}).q,
    "ik_batch": lambda x: ARM.ik_batch(x["Ts"]).q,
    "ik_batch of 7": lambda x: SEVEN.ik_batch(x["Ts"], locked={2: x["two"]}).q,
    "ik_path": lambda x: ARM.ik_path(x["Ts"], start=x["q"]).q,
    "ik_numeric": lambda x: ARM.ik_numeric(x["T"], seed=x["q"]).q,
    "why_unreachable": lambda x: ARM.why_unreachable(x["T"]),
    "check_pose": lambda x: transforms.check_pose(x["Ts"]),
    "wrist_centre": lambda x: wrist_centre(x["Ts"], 0.1),
}

EXACT = np.array([0.25, -1.0, 0.5, 0.75, -0.5, 1.25])
"""A configuration that every type of number holds exactly."""

TURNED = np.array([[0.0, 1, 0, 0.25], [1, 0, 0, -0.25], [0, 0, -1, 0.125], [0, 0, 0, 1]])
"""So is this pose, which both arms reach."""


def arguments(make):
    """What the calls take, in one make of array."""
    plain = {
        "q": EXACT,
        "qs": np.stack([EXACT, -EXACT, 0.5 * EXACT]),
        "T": TURNED,
        "Ts": np.stack([TURNED, TURNED]),
        "one": np.array([0.25]),
        "two": np.array([0.25, 0.5]),
    }
    return {key: make(value) for key, value in plain.items()}


@pytest.mark.parametrize("call", CALLS)
@pytest.mark.parametrize("make", MAKES)
def test_an_array_is_read_by_its_values_however_it_is_stored(make, call):
    """Type, order of bytes, stride and owner change nothing in the answer."""
    expected = CALLS[call](arguments(np.array))
    assert np.size(expected)
    nan = {} if isinstance(expected, str) else {"equal_nan": True}
    assert np.array_equal(CALLS[call](arguments(MAKES[make])), expected, **nan)


def test_a_stored_batch_compiles_nothing_anew():
    """A kernel has one form: a read-only or mapped stack reaches it as any other does."""
    from dh2urdf.kernels.chain import chain_fk_batch, chain_jacobian_batch
    from dh2urdf.kernels.numbers.poses import first_bad_pose

    for make in MAKES.values():
        given = arguments(make)
        ARM.fk(given["qs"]), ARM.jacobian(given["qs"]), ARM.ik_batch(given["Ts"])
    for kernel in (chain_fk_batch, chain_jacobian_batch, first_bad_pose):
        assert len(getattr(kernel, "signatures", [0])) == 1


@pytest.mark.parametrize("bad", [np.nan, np.inf, -np.inf])
@pytest.mark.parametrize(
    "name", ["puma560", "franka_fer", "gantry", "gantry_wrist", "cylindrical", "stanford", "xarm5"]
)
def test_a_configuration_that_is_not_finite_is_refused_whichever_joint_it_is_of(name, bad):
    """No NaN comes out of fk, frames or the Jacobian, of one configuration or of many."""
    robot = Robot.from_dh(name)
    for i in range(robot.n):
        q = np.full(robot.n, 0.3)
        q[i] = bad
        for call in (robot.fk, robot.jacobian, robot.frames, robot.model_configuration):
            for given in (q, q.tolist(), q.astype(">f8")):
                with pytest.raises(ConfigurationError, match=rf"q\[{i}\].*NaN or infinity"):
                    call(given)
            with pytest.raises(ConfigurationError, match=rf"q\[1, {i}\].*NaN or infinity"):
                call(np.stack([np.zeros(robot.n), q]))


NO_NUMBERS = st.one_of(
    st.none(),
    st.text(max_size=3),
    st.binary(max_size=3),
    st.complex_numbers(allow_nan=False),
    st.dates(),
    st.sampled_from([np.ma.masked, np.datetime64("now"), ..., object()]),
    st.sampled_from([10**400, Fraction(10**400), Fraction(1, 10**400) ** -1, np.nan, np.inf]),
    st.sampled_from([np.longdouble("1e400"), float, [], {}, np.zeros(2), set(), b"\xff" * 9]),
)
"""What no number is."""


@hostile(bad=NO_NUMBERS, k=st.integers(0, 5), call=st.sampled_from(sorted(CALLS)))
def test_what_is_no_number_is_refused_by_every_method(bad, k, call):
    """One cell that is no finite number, in a list: refused in the words of the package."""
    given = arguments(lambda a: a.tolist())
    for key in ("q", "qs", "T", "Ts"):
        row = given[key]
        while isinstance(row[0], list):
            row = row[0]
        row[k % len(row)] = bad
    given["one"], given["two"] = bad, [0.25, bad]
    got = outcome(CALLS[call], given)
    assert isinstance(got, (ConfigurationError, PoseError)), got


NO_ARRAYS = {
    "masked": lambda a: np.ma.masked_array(a, mask=np.arange(a.size).reshape(a.shape) == 0),
    "complex": lambda a: a.astype(complex),
    "text": lambda a: a.astype(str),
    "bytes": lambda a: a.astype(bytes),
    "truth": lambda a: a > 0,
    "times": lambda a: a.astype("m8[s]"),
    "records": lambda a: np.rec.fromarrays([a, a], names="x,y"),
    "foreign": lambda a: Foreign(a.astype(complex)),
    "iterator": lambda a: iter(a.tolist()),
    "ragged": lambda a: [*a.tolist(), "x", [[1.0]]],
}


@pytest.mark.parametrize("call", CALLS)
@pytest.mark.parametrize("make", NO_ARRAYS)
def test_arrays_without_real_numbers_are_refused_by_every_method(make, call):
    """Masked entries, complex numbers, text, truth values, times, records."""
    assert isinstance(outcome(CALLS[call], arguments(NO_ARRAYS[make])), Dh2UrdfError)
