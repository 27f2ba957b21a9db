"""UR's calibration files: the controller's deltas, and the steps that the ROS driver takes of them.

The referee is the DH product of elementary matrices, with the nominal numbers typed here.
"""

import io
import json
import math

import numpy as np
import pytest
from dh_product import shift, turn

import dh2urdf
from dh2urdf import Robot, load_table
from dh2urdf.conversions.assign import chain_to_dh
from dh2urdf.conversions.write import dh_to_chain
from dh2urdf.dh_io import parse_table
from dh2urdf.exceptions import ArgumentError, TableFileError

H = math.pi / 2
UR10 = {"d": [0.1273, 0, 0, 0.163941, 0.1157, 0.0922], "a": [0, -0.612, -0.5723, 0, 0, 0]}
UR10 |= {"theta": [0] * 6, "alpha": [H, 0, 0, H, -H, 0]}

# Of three UR10: Universal_Robots_ROS2_Driver 2.4.6, ur_calibration/test/calibration_test.cpp.
MEASURED = [
    {
        "d": "0.00065609212979853, 1.4442162376284788, 0.854147723854608, -2.2989425877563705, "
        "-1.573498686836816e-05, 1.9072435590711256e-05",
        "a": "4.6311376834935676e-05, -0.00012568315331862312, 0.00186216581161458, "
        "9.918593870679266e-05, 4.215462720453189e-06, 0",
        "theta": "-7.290070070824746e-05, -0.01713897289704999, -0.03707159413492756, "
        "0.054279462160583214, 1.488984257025741e-07, 1.551499479707493e-05",
        "alpha": "0.000211987863869334, -0.0072553625957652995, -0.013483226769541364, "
        "0.0013495820227329425, -0.001263136163679901, 0",
    },
    {
        "d": "-0.000144894975118076141, 303.469135666158195, -309.88394307789747, "
        "6.41459904397394975, -4.48232900190081995e-05, -0.00087071402790364627",
        "a": "0.000108651068627930392, 0.240324175250532346, 0.00180628180213493472, "
        "2.63076149165684402e-05, 3.96638632500012715e-06, 0",
        "theta": "1.59613525316931737e-07, -0.917209621528830232, 7.12936131346499469, "
        "0.0710299029424392298, -1.64258976526054923e-06, 9.17286101034808787e-08",
        "alpha": "-0.000444781952841921679, -0.00160215112531214153, 0.00631917793331091861, "
        "-0.00165055247340828437, 0.000763682515545038854, 0",
    },
    {
        "d": "-0.000160188285741325043, 439.140974079900957, -446.027059806332147, "
        "6.88618689642360149, -3.86588496858186748e-05, -0.00087908274257374186",
        "a": "2.12234865571205891e-05, 0.632017132627700651, 0.00229833638891230319, "
        "-4.61409023720933908e-05, -6.39280053471801522e-05, 0",
        "theta": "-2.41478068943590252e-07, 1.60233952386694556, -1.68607190752171299, "
        "0.0837331147700118711, -1.01260355871157781e-07, 3.91986209186123702e-08",
        "alpha": "-0.000650246557584166496, 0.00139416666825590402, 0.00693818880325995126, "
        "-0.000811641562390219562, 0.000411120504570705592, 0",
    },
]
LINKS = ("shoulder", "upper_arm", "forearm", "wrist_1", "wrist_2", "wrist_3")
CELLS = ("x", "y", "z", "roll", "pitch", "yaw")


def conf(deltas, more=""):
    """The controller's file, with the lines that are not read."""
    lines = [f"delta_{key} = [ {deltas[key]}]" for key in ("theta", "a", "d", "alpha")]
    lines += [
        "joint_checksum = [ 0x6e0f7bf, 0xa32a713f]",
        "calibration_status = 2 # 2 == Linearised",
    ]
    return "\n".join(["[mounting]", *lines, more, ""])


def parameters(deltas):
    """d, a, theta and alpha (6,) of a measured UR10."""
    return {key: np.array(UR10[key]) + np.fromstring(deltas[key], sep=",") for key in UR10}


def poses(p, q):
    """The DH product at configurations (k, 6), shape (k, 4, 4)."""
    out = []
    for config in q:
        T = np.eye(4)
        for i, value in enumerate(config):
            T = T @ turn(2, value + p["theta"][i]) @ shift(2, p["d"][i])
            T = T @ shift(0, p["a"][i]) @ turn(0, p["alpha"][i])
        out.append(T)
    return np.array(out)


def kinematics(p, quirk=False):
    """The driver's file: origins 2 to 4 moved along their axes to where the arm is.

    With the ``quirk`` angles are given as Eigen may, half a turn from the small ones.
    """
    steps, slide = [], 0.0
    for i in range(6):
        step = shift(2, -slide)
        if i > 0:
            step = step @ shift(0, p["a"][i - 1]) @ turn(0, p["alpha"][i - 1])
        step = step @ turn(2, p["theta"][i]) @ shift(2, p["d"][i])
        slide = -p["d"][i] if i == 1 else -step[2, 3] / step[2, 2] if i in (2, 3) else 0.0
        if i == 3:  # what is left of the way is the arm's own
            slide = 0.0
        steps.append(step @ shift(2, slide))
    rows = {}
    for link, T in zip(LINKS, steps, strict=True):
        angles = [math.atan2(-T[1, 2], T[2, 2]), math.asin(T[0, 2]), math.atan2(-T[0, 1], T[0, 0])]
        if quirk:
            angles = [angles[0] + math.pi, math.pi - angles[1], angles[2] + math.pi]
        rows[link] = dict(zip(CELLS, [*T[:3, 3].tolist(), *angles], strict=True))
    return {"kinematics": {**rows, "hash": "calib_14698139022496758595"}}


def draws(k=20):
    return np.random.default_rng(1).uniform(-2 * math.pi, 2 * math.pi, (k, 6))


def test_extract_takes_the_model_that_its_message_asks_for(tmp_path, run, refused):
    """Deltas that fit every UR are refused with a hint that works; elsewhere a model is refused."""
    (tmp_path / "calibration.conf").write_text(conf(dict.fromkeys(UR10, "0, 0, 0, 0, 0, 0")))
    assert "--model ur3" in refused("extract", "calibration.conf")
    status, out, _ = run("extract", "calibration.conf", "--model", "ur10")
    assert (status, "0.1639" in out) == (0, True)
    (tmp_path / "arm.urdf").write_text(dh2urdf.urdf_text("planar_rr"))
    assert "model" in refused("extract", "arm.urdf", "--model", "ur10")


@pytest.mark.parametrize("deltas", MEASURED)
def test_deltas_add_to_the_nominal_table(tmp_path, deltas):
    """FK of the file is the DH product of the sums, though frames are 446 m away."""
    (tmp_path / "calibration.conf").write_text(conf(deltas))
    table = load_table(tmp_path / "calibration.conf", model="ur10")
    np.testing.assert_allclose(
        Robot.from_dh(table).fk(draws()), poses(parameters(deltas), draws()), atol=2e-12, rtol=0
    )
    assert table.source == "calibration.conf, deltas added to the nominal table of ur10"
    (tmp_path / "calibration.conf").write_text(conf(deltas, "model = ur10"))
    assert load_table(tmp_path / "calibration.conf") == table


@pytest.mark.parametrize("quirk", [False, True])
@pytest.mark.parametrize("deltas", MEASURED)
def test_the_steps_of_the_driver_give_the_arm_of_the_controller(deltas, quirk):
    """FK of calibration.yaml is that of the DH parameters that it was taken from."""
    p = parameters(deltas)
    given = kinematics(p, quirk)
    assert all(abs(given["kinematics"][link][key]) < 1 for link in LINKS for key in "xyz")
    table, notes, _ = parse_table(json.dumps(given), "json", "my_ur10.json")
    np.testing.assert_allclose(
        Robot.from_dh(table).fk(draws()), poses(p, draws()), atol=2e-12, rtol=0
    )
    assert table.length < 10.0, "no frame is hundreds of metres away"
    assert table.joint_names == load_table("ur10").joint_names
    assert [row.velocity for row in table.joints] == [r.velocity for r in load_table("ur10").joints]
    assert "the lengths are those of ur10" in notes[-1]


def test_what_the_order_of_a_urdf_would_change_is_told():
    """The distance of the note is that of the two readings, measured by products of their own."""
    given = kinematics(parameters(MEASURED[0]))
    _, notes, _ = parse_table(json.dumps(given), "json", "my_ur10.json")
    told = float(notes[0].split("up to ")[1].split(" mm")[0])
    apart = 0.0
    for q in np.random.default_rng(0).uniform(-math.pi, math.pi, (16, 6)):
        A = B = np.eye(4)
        for link, value in zip(LINKS, q, strict=True):
            row = given["kinematics"][link]
            r, p, y = (turn(k, row[key]) for k, key in enumerate(CELLS[3:]))
            at = shift(0, row["x"]) @ shift(1, row["y"]) @ shift(2, row["z"])
            A, B = (T @ at @ R @ turn(2, value) for T, R in ((A, r @ p @ y), (B, y @ p @ r)))
        apart = max(apart, np.linalg.norm((A - B)[:3, 3]))
    assert told == pytest.approx(apart * 1000, rel=0.06)


def test_positions_that_the_maker_published_are_reached(tmp_path):
    """Two joint vectors and positions of a simulated UR10, of the maker's own test."""
    zero = dict.fromkeys(UR10, "0, 0, 0, 0, 0, 0")
    (tmp_path / "calibration.conf").write_text(conf(zero))
    arm = Robot.from_dh(load_table(tmp_path / "calibration.conf", model="ur10"))
    published = {
        (-0.179925914147547, -0.606869755162764, 0.230789102067257): "-1.6007002035724 "
        "-1.7271001974688 -2.2029998938189 -0.8079999128924 1.5951000452041 -0.0309999624835",
        (0.3992298800328, 0.5968836506934, -0.6677819040276): "1.3264502286911 2.4260077476501 "
        "5.9515728950500 1.2740904092789 -0.5410521666156 0.1221730485558",
    }
    for position, q in published.items():
        np.testing.assert_allclose(arm.fk(np.array(q.split(), float))[:3, 3], position, atol=1e-9)


@pytest.mark.parametrize("deltas", MEASURED)
@pytest.mark.parametrize("name", ["calibration.conf", "calibration.yaml"])
def test_all_solutions_of_a_calibrated_arm_from_the_command_line(run, tmp_path, deltas, name):
    """Every answer reaches the pose by the DH product, and the one it was made from is there."""
    p, q = parameters(deltas), np.array([0.4, -1.2, 1.5, -0.6, 1.1, 0.3])
    T = poses(p, q[None])[0]
    text = conf(deltas, "model = ur10") if name.endswith("conf") else json.dumps(kinematics(p))
    (tmp_path / name).write_text(text)
    matrix = [repr(v) for v in T[:3].ravel().tolist()]
    status, out, err = run("ik", name, "--matrix", *matrix, "--json")
    found = np.array([s["q"] for s in json.loads(out)["solutions"]])
    assert (status, len(found)) == (0, 8)
    assert np.abs(poses(p, found) - T).max() < 1e-11
    assert np.abs(np.angle(np.exp(1j * (found - q)))).max(axis=1).min() < 1e-9
    assert "warning: calibration: " in err


@pytest.mark.parametrize("name", ["calibration.conf", "calibration.yaml"])
def test_extract_assigns_frames_near_the_arm(run, tmp_path, name):
    """In both conventions, without frames hundreds of metres away."""
    p = parameters(MEASURED[2])
    more = "model = ur10"
    text = conf(MEASURED[2], more) if name.endswith("conf") else json.dumps(kinematics(p))
    (tmp_path / name).write_text(text)
    for convention in ("standard", "modified"):
        assert run("extract", name, "--convention", convention, "-o", "arm.yaml")[0] == 0
        table = load_table(tmp_path / "arm.yaml")
        assert table.convention == convention
        assert table.length < 10.0
        np.testing.assert_allclose(
            Robot.from_dh(table).fk(draws()), poses(p, draws()), atol=1e-11, rtol=0
        )


@pytest.mark.parametrize(
    "text", [conf(MEASURED[0], "model = ur10"), json.dumps(kinematics(parameters(MEASURED[0])))]
)
def test_calibrations_come_on_stdin_too(run, monkeypatch, text):
    """Both files in a pipe; a model for the one that has its own lengths is refused."""
    monkeypatch.setattr("sys.stdin", io.TextIOWrapper(io.BytesIO(text.encode())))
    status, out, _ = run("fk", "-", *"000000", "--json")
    T = poses(parameters(MEASURED[0]), np.zeros((1, 6)))[0]
    assert status == 0
    np.testing.assert_allclose(json.loads(out)["T_base_tip"], T, atol=1e-12)
    monkeypatch.setattr("sys.stdin", io.TextIOWrapper(io.BytesIO(text.encode())))
    status, _, err = run("fk", "-", *"000000", "--model", "ur10")
    told = "model: only a calibration.conf needs it, not <stdin>"
    assert (status, told in err) == ((2, True) if text.startswith("{") else (0, False))


def test_the_model_is_asked_for_where_more_than_one_fits(refused, tmp_path):
    """A UR10's deltas say nothing of e-Series or not; the message has how near both are."""
    (tmp_path / "calibration.conf").write_text(conf(MEASURED[2]))
    err = refused("fk", "calibration.conf", *"000000")
    assert "does not say of which UR" in err
    assert "ur10 " in err
    assert "ur10e " in err
    assert "ur5" not in err
    assert "hint: --model ur10, or a line 'model = ur10' in the file" in err


def test_the_only_model_that_fits_is_taken_and_told(run, tmp_path):
    """Deltas of a tilted UR16e, whose frames are tens of metres away, fit no other."""
    nominal = load_table("ur16e")
    tilted = nominal.rows[1].__class__(d=0.0, a=-0.4784, alpha=0.004)
    chain = dh_to_chain(
        dh2urdf.DHTable((nominal.rows[0], tilted, *nominal.rows[2:]), "standard", "tilted")
    )
    links = chain.links.copy()
    links[2] = links[2] @ turn(1, 0.003)
    measured = chain_to_dh(
        dh2urdf.SerialChain(links, chain.joint_types, chain.names, chain.lower, chain.upper),
        compact=False,
    ).table
    deltas = {
        key: ", ".join(
            repr(getattr(a, key) - getattr(b, key))
            for a, b in zip(measured.rows, nominal.rows, strict=True)
        )
        for key in UR10
    }
    assert max(abs(row.d) for row in measured.rows) > 30
    (tmp_path / "calibration.conf").write_text(conf(deltas))
    status, _, err = run("show", "calibration.conf")
    assert status == 0
    assert "nominal table of ur16e (the only UR that the deltas fit)" in err


def test_deltas_of_another_model_are_doubted(tmp_path, run):
    """Given as a UR5's, they move the tool by more than a calibration does."""
    (tmp_path / "calibration.conf").write_text(conf(MEASURED[2]))
    status, _, err = run("fk", "calibration.conf", "--model", "ur5", *"000000")
    assert status == 0
    assert "are they of another model?" in err


GOOD = {link: dict.fromkeys(CELLS, 0.1) for link in LINKS}


@pytest.mark.parametrize(
    ("kinematics", "message"),
    [
        ("none", "kinematics: expected keys shoulder, upper_arm, "),
        ({k: v for k, v in GOOD.items() if k != "forearm"}, "kinematics.forearm: expected keys "),
        (GOOD | {"elbow": {}}, "kinematics: 'elbow' is not known; allowed: shoulder, "),
        (GOOD | {"wrist_1": {"x": 1}}, "kinematics.wrist_1.y: expected a number, got None"),
        (GOOD | {"wrist_1": dict.fromkeys(CELLS, "a")}, "kinematics.wrist_1.x: 'a': "),
        (GOOD | {"wrist_1": dict.fromkeys(CELLS, 1e12)}, "wrist_1.x: expected a number up to "),
    ],
)
def test_a_calibration_that_is_none_is_refused(kinematics, message):
    """One message with the file, the key, what was found and what is allowed."""
    with pytest.raises(TableFileError, match=r"^c\.json: ") as caught:
        parse_table(json.dumps({"kinematics": kinematics}), "json", "c.json")
    assert message in str(caught.value)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("delta_a = [0]", "not a calibration.conf: File contains no section headers"),
        ("[mounting]\n", "delta_theta: missing; six numbers in brackets"),
        (conf(MEASURED[0] | {"d": "1, 2, 3"}), "delta_d: expected six numbers in brackets"),
        (conf(MEASURED[0] | {"d": "1, 2, x"}), "delta_d: expected six numbers in brackets"),
        (conf(MEASURED[0], "delta_d = [0]"), "already exists"),
        (conf(MEASURED[0], "model = ur7"), "model: expected 'ur3' or 'ur3e'"),
        (conf(MEASURED[0] | {"d": "1e300, 0, 0, 0, 0, 0"}, "model = ur10"), "d: "),
    ],
)
def test_a_conf_that_is_none_is_refused(tmp_path, text, message):
    """Its key and what is expected; no traceback of the parser."""
    (tmp_path / "c.conf").write_text(text)
    with pytest.raises(TableFileError) as caught:
        load_table(tmp_path / "c.conf")
    assert str(caught.value).startswith(f"{tmp_path}/c.conf: ")
    assert message in str(caught.value)


def test_what_is_told_of_a_table_says_nothing_of_a_calibration(tmp_path):
    """No model for a table, no convention and units for a calibration."""
    with pytest.raises(ArgumentError, match=r"only a calibration\.conf needs it, not ur10"):
        load_table("ur10", model="ur10")
    (tmp_path / "c.conf").write_text(conf(MEASURED[0]))
    with pytest.raises(TableFileError, match="in metres and radians, and no convention"):
        load_table(tmp_path / "c.conf", units="mm,deg", model="ur10")
