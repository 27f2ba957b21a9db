"""The extract verb, and tables as other people's source code."""

import io
import json
import math
import re

import numpy as np
import pytest
from axes import BOTH, chains
from dh_product import dh_frames, difference, shift, turn
from example_robots import UR5
from hypothesis import given, settings
from hypothesis import strategies as st
from test_extract_sources import BROKEN, URDF

from dh2urdf import extract_dh, load_table, urdf_text
from dh2urdf.conversions.assign.assigned_table import chain_to_dh
from dh2urdf.conversions.write.constructors import matlab_corke, matlab_rst, rtb_python
from dh2urdf.dh_io import parse_table
from dh2urdf.exceptions import TableError


@pytest.fixture
def extract(run):
    """Run the verb: status, stdout, stderr."""
    return lambda *words: run("extract", *words)


def test_the_table_is_printed_with_its_proof(extract):
    """stdout has the table, the two frames and the measured difference; stderr the warnings."""
    status, out, err = extract(UR5)
    assert status == 0
    assert "0.089159" in out
    assert re.search(r"world to tool0: largest FK difference \d\.?\d*e-1[56]", out)
    assert "nearly round" in err


@pytest.mark.parametrize("suffix", ["yaml", "toml", "json", "csv", "md"])
@BOTH
def test_written_tables_read_back(suffix, convention, tmp_path, extract):
    """Every table format gives back the parameters, whole."""
    path = tmp_path / f"ur5.{suffix}"
    status, _, err = extract(UR5, "--convention", convention, "-o", path)
    assert (status, "largest FK difference" in err) == (0, True)
    found = extract_dh(UR5, convention=convention)
    again = load_table(path)
    assert again.convention == convention
    assert (again.base, again.tool) == (found.table.base, found.table.tool)
    for old, new in zip(found.table.rows, again.rows, strict=True):
        assert (new.theta, new.d, new.a, new.alpha) == (old.theta, old.d, old.a, old.alpha)
        assert (new.name, new.lower, new.mass) == (old.name, old.lower, old.mass)


def test_latex_and_stdout(extract):
    """LaTeX goes to stdout with booktabs rules."""
    status, out, _ = extract(UR5, "--format", "latex", "-o", "-")
    assert status == 0
    assert r"\toprule" in out
    assert "extracted by dh2urdf" in out


def test_explained(extract):
    """--explain prints a paragraph a frame before the table."""
    status, out, _ = extract(UR5, "--explain")
    assert status == 0
    assert [f"Frame {i}." in out for i in range(7)] == [True] * 7
    assert out.index("Case 2") < out.index("standard DH\n")


def test_json_holds_everything(extract):
    """One object: frames, proof, table in metres and radians, steps, changes with costs."""
    status, out, _ = extract(UR5, "--base", "base", "--snap", "1e-10", "--json")
    data = json.loads(out)
    assert status == 0
    assert (data["schema"], data["verb"]) == (1, "extract")
    assert (data["base"], data["tip"]) == ("base", "tool0")
    assert data["max_error"] < 1e-10
    assert [row["a"] for row in data["table"]["joints"]][1:3] == [-0.425, -0.39225]
    assert len(data["steps"]) == 7
    assert data["changes"][0]["cost"] < 1e-10


def test_foreign_files_are_not_written_over(written, extract, refused):
    """An existing file is kept unless dh2urdf extracted it, or --force."""
    path = written("notes.yaml", "mine: 1\n")
    assert "--force" in refused("extract", UR5, "-o", path)
    assert path.read_text() == "mine: 1\n"
    for more in (["--force"], []):
        assert extract(UR5, "-o", path, *more)[0] == 0


def test_an_unknown_suffix_is_told(tmp_path, refused):
    """A suffix that means nothing is bad usage, and nothing is written."""
    assert "suffix tells no format" in refused("extract", UR5, "-o", tmp_path / "ur5.xlsx")
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("fault", BROKEN)
def test_broken_files_exit_with_2(fault, written, refused):
    """One line on stderr, nothing on stdout, no traceback."""
    old, new, _ = BROKEN[fault]
    path = written("broken.urdf", URDF.replace(old, new, 1))
    err = refused("extract", path, "--base", "root", "--tip", "hand")
    assert len(err.splitlines()) == 1
    assert err.startswith(f"dh2urdf: {path}")


class Link:
    """A link of robotics-toolbox-python: T = Rz(q + offset) ... by its documented meaning."""

    def __init__(self, slides, modified, flip=False, offset=0.0, **values):
        self.slides, self.modified, self.flip, self.offset = slides, modified, flip, offset
        self.values = values

    def matrix(self, q):
        """The link at q."""
        q = (-q if self.flip else q) + self.offset
        theta = self.values.get("theta", 0.0) if self.slides else q
        d = q if self.slides else self.values.get("d", 0.0)
        joint = turn(2, theta) @ shift(2, d)
        link = shift(0, self.values["a"]) @ turn(0, self.values["alpha"])
        return link @ joint if self.modified else joint @ link


class Toolbox:
    """As much of robotics-toolbox-python as the constructors use."""

    class ET:
        """Elementary transforms, each a list of one function of the values still unused."""

        SE3 = staticmethod(lambda T: [lambda q: np.array(T)])
        tx = staticmethod(lambda v: [lambda q: shift(0, v)])
        Rx = staticmethod(lambda v: [lambda q: turn(0, v)])

        @staticmethod
        def _z(make, value, flip):
            if value is not None:
                return [lambda q: make(2, value)]
            return [lambda q: make(2, -q.pop(0) if flip else q.pop(0))]

        @staticmethod
        def Rz(value=None, flip=False, qlim=None):
            """Rotation about z, a joint without a value."""
            return Toolbox.ET._z(turn, value, flip)

        @staticmethod
        def tz(value=None, flip=False, qlim=None):
            """Translation along z, a joint without a value."""
            return Toolbox.ET._z(shift, value, flip)

    RevoluteDH = staticmethod(lambda **v: Link(False, False, **v))
    RevoluteMDH = staticmethod(lambda **v: Link(False, True, **v))
    PrismaticDH = staticmethod(lambda **v: Link(True, False, **v))
    PrismaticMDH = staticmethod(lambda **v: Link(True, True, **v))

    class DHRobot:
        """Links in a row between base and tool."""

        def __init__(self, links, name, base=None, tool=None):
            self.links, self.name = links, name
            self.base = np.eye(4) if base is None else np.array(base)
            self.tool = np.eye(4) if tool is None else np.array(tool)

        def fkine(self, q):
            """FK at q."""
            T = self.base
            for link, value in zip(self.links, q, strict=True):
                T = T @ link.matrix(value)
            return T @ self.tool

    class Robot:
        """Elementary transforms in a row."""

        def __init__(self, ets, name):
            self.ets = ets

        def fkine(self, q):
            """FK at q."""
            T, values = np.eye(4), list(q)
            for step in self.ets:
                T = T @ step(values)
            return T


class Steps(list):
    """Elementary transforms that multiply by following each other."""

    def __mul__(self, other):
        return Steps([*self, *other])


def run_python(source, q):
    """FK of the robot that a Python constructor makes, the toolbox by its documented meaning."""
    body = re.sub(r"^(import|from) .*$", "", source, flags=re.M)
    body = re.sub(r"rtb\.ET\.(\w+)\(", r"ET('\1')(", body)
    space = {
        "rtb": Toolbox,
        "SE3": lambda T, check: T,
        "ET": lambda name: lambda *v, **k: Steps(getattr(Toolbox.ET, name)(*v, **k)),
    }
    exec(body, space)
    return space["robot"].fkine(q)


def matrix_of(text):
    rows = [[float(v) for v in row.split()] for row in text.strip("[]").split(";")]
    return np.array(rows if len(rows) > 1 else rows[0])


def run_rst(source, q):
    """FK of a rigidBodyTree: T = JointToParent Z(q) ChildToJoint, as MathWorks documents."""
    T, values, kind, axis = np.eye(4), list(q), "", 1.0
    before, after = np.eye(4), np.eye(4)
    for line in source.splitlines():
        if found := re.match(r"jnt = rigidBodyJoint\('.*', '(\w+)'\)", line):
            kind, axis = found.group(1), 1.0
        elif found := re.match(r"setFixedTransform\(jnt, (\[.*\])(?:, '(m?dh)')?\)", line):
            numbers, name = matrix_of(found.group(1)), found.group(2)
            before, after = np.eye(4), np.eye(4)
            if name is None:
                before = numbers
                continue
            a, alpha, d, theta = numbers
            # The parameter that the joint moves is ignored.
            joint = shift(2, d) if kind == "revolute" else turn(2, theta)
            link = shift(0, a) @ turn(0, alpha)
            if name == "dh":
                after = joint @ link
            else:
                before = link @ joint
        elif "JointAxis" in line:
            axis = -1.0
        elif line.startswith("addBody"):
            motion = np.eye(4)
            if kind != "fixed":
                motion = (turn if kind == "revolute" else shift)(2, axis * values.pop(0))
            T = T @ before @ motion @ after
    return T


@pytest.mark.parametrize(
    ("write", "fk"), [(rtb_python, run_python), (matlab_rst, run_rst)], ids=["rtb", "matlab-rst"]
)
@BOTH
@settings(max_examples=60)
@given(chain=chains(max_joints=5), data=st.data())
def test_constructors_make_the_arm(write, fk, convention, chain, data):
    """Signs, offsets, slides, base, tool and fixed rows arrive in the toolbox's own terms.

    What MATLAB's setFixedTransform ignores stands in bodies of its own.
    """
    signs = data.draw(st.lists(st.sampled_from([1, -1]), min_size=chain.n, max_size=chain.n))
    table = chain_to_dh(chain, convention, signs=signs).table
    q = np.random.default_rng(1).uniform(-2, 2, chain.n)
    assert difference(fk(write(table), q), dh_frames(table, q)[-1]) <= 1e-12


@BOTH
def test_corkes_links(convention):
    """One Link a joint with offset, limits and convention; fixed rows are refused in words."""
    found = extract_dh(UR5, "base", "tool0", convention, snap=True, flip=["elbow_joint"])
    source = matlab_corke(found.table)
    links = [line for line in source.splitlines() if line.startswith("L(")]
    assert len(links) == 6
    assert all(f"'{convention}');" in line for line in links)
    assert ["'flip'" in line for line in links] == [False, False, True, False, False, False]
    for row, line in zip(found.table.joints, links, strict=True):
        cells = dict(re.findall(r"'(\w+)', (-?[\d.e-]+)", line))
        keys = ("offset", "d", "a", "alpha")
        assert [float(cells[key]) for key in keys] == [row.theta, row.d, row.a, row.alpha]
    nearly = [[[0, 0, 1], [0, 0, 0]], [[1e-3, 0, 1], [1, 0, 0]]]
    with pytest.raises(TableError, match="no fixed rows; use matlab-rst"):
        matlab_corke(extract_dh(nearly, tool=np.eye(4)).table)


def test_masses_reach_matlab():
    """Inertia of a rigidBody is about its frame's origin, and other bodies weigh nothing."""
    found = extract_dh(URDF, convention="standard")
    source = matlab_rst(found.table)
    assert [float(v) for v in re.findall(r"body\.Mass = (.*);", source) if float(v)] == [2.0, 1.0]
    row = found.table.joints[1]
    first = re.findall(r"body\.Inertia = (\[.*\]);", source)[-1]
    com = np.array(row.com)
    ixx = row.inertia[0] + row.mass * (com[1] ** 2 + com[2] ** 2)
    assert matrix_of(first)[0] == pytest.approx(ixx, rel=1e-14)
    assert math.isclose(row.mass, 1.0)


def test_stdin_and_stdout(extract, monkeypatch):
    """A URDF on stdin and a table on stdout: a filter."""
    monkeypatch.setattr("sys.stdin", io.StringIO(URDF))
    status, out, _ = extract("-", "-o", "-")
    assert status == 0
    assert parse_table(out, "yaml", "out").table.n == 2
    monkeypatch.setattr("sys.stdin", io.StringIO("name: x"))
    assert extract("-")[0] == 2


def test_a_base_beside_the_arm():
    """A base that nothing hangs on is reached through the root: the chain of UR's base frame."""
    assert extract_dh(UR5, base="base").tip == "tool0"


def test_our_own_files_are_explained_too(written, extract):
    """--explain assigns frames even where the file carries its table."""
    path = written("denso.urdf", urdf_text(load_table("denso_vs6556")))
    status, out, _ = extract(path, "--explain")
    assert (status, "Frame 6." in out) == (0, True)
    assert "carries the table" in extract_dh(path).explain()
