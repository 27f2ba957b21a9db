"""``--json``: what every verb prints follows its schema in ``docs/schemas``, errors too."""

import copy
import json
import subprocess
import sys
from pathlib import Path

import pytest
from jsonschema import Draft202012Validator

import dh2urdf
from dh2urdf import exceptions
from dh2urdf.cli import VERBS

FOLDER = Path(__file__).parents[2] / "docs" / "schemas"

POSE = ["--xyz", "0.4", "0", "0.3", "--rpy", "0", "180", "0", "--deg"]

ANSWERS = {
    "list": ["list"],
    "fk": ["fk", "ur5", "0", "-1", "1", "0", "0", "7"],
    "show": ["show", "planar_rr", "--symbolic", "--q", "1", "2"],
    "show a hole": ["show", "rpr_new_frame"],
    "show a format": ["show", "ur5", "--format", "csv"],
    "convert": ["convert", "ur5", "-o", "ur5.urdf"],
    "convert to stdout": ["convert", "ur5", "-o", "-"],
    "convert many": ["convert", "ur5", "nowhere", "--out-dir", "."],
    "extract": ["extract", "arm.urdf", "--no-embedded", "--snap", "1e-3"],
    "extract to stdout": ["extract", "arm.urdf", "-o", "-"],
    "extract a format": ["extract", "arm.urdf", "--format", "csv"],
    "export": ["export", "planar_rr", "-o", "rr.h"],
    "export with tests": ["export", "planar_rr", "-o", "rr.h", "--tests", "rr_test.c"],
    "export Python": ["export", "planar_rr", "-o", "rr.py"],
    "export to stdout": ["export", "planar_rr", "-o", "-"],
    "check": ["check", "arm.urdf", "bad.urdf", "nowhere.urdf", "--no-run"],
    "check asked": ["check", "arm.urdf"],
    "check --fix": ["check", "bad.urdf", "--fix", "mended.urdf"],
    "compare": ["compare", "ur5", "ur5e", "rpr_new_frame", "ur5", "nowhere"],
    "compare tools": ["compare", "franka_fer", "kuka_iiwa14"],
    "ik": ["ik", "denso_vs6556", *POSE],
    "ik marked": ["ik", "denso_vs6556", *POSE, "--no-within-limits"],
    "ik out of reach": ["ik", "denso_vs6556", "--xyz=9,0,0", "--rpy=0,0,0"],
    "ik singular": ["ik", "puma560", "--xyz=0.4,-0.15,0.3", "--rpy=0,pi,0"],
    "ik explained": ["ik", "denso_vs6556", *POSE, "--explain", "--solution", "2"],
    "ik explained by a polynomial": ["ik", "xarm6", "--xyz=.3,0,.3", "--rpy=pi,0,0", "--explain"],
    "ik explained to the end": ["ik", "ur5", "--xyz=9,0,0", "--rpy=0,0,0", "--explain"],
    "ik symbolic": ["ik", "denso_vs6556", "--symbolic"],
    "ik csv": ["ik", "denso_vs6556", "--csv", "poses.csv"],
    "ik csv best": ["ik", "denso_vs6556", "--csv", "poses.csv", "--best"],
    "ik csv to a file": ["ik", "denso_vs6556", "--csv", "poses.csv", "-o", "joints.csv"],
    "path": ["path", "denso_vs6556", "poses.csv"],
    "path to a file": ["path", "denso_vs6556", "poses.csv", "-o", "q.csv", "--figure", "q.svg"],
    "place": ["place", "planar_rr", "poses.csv", "--task", "position", "--yaw", "0"],
    "place two": ["place", "ur5", "poses.csv", "--yaw=0", "--against", "ur3", "-o", "map.svg"],
    "figure": ["figure", "planar_rr", "-o", "rr.svg", "--branches", "--q=1,1"],
    "workspace": ["workspace", "planar_rr", "-o", "rr.svg", "--points", "5"],
    "workspace exact": ["workspace", "denso_vs6556", "--exact", "-o", "exact.svg"],
    "workspace exact of 7": ["workspace", "franka_fer", "--exact", "--no-limits"],
    "map": ["map", "planar_rr", "-o", "rr.zarr", "--step", "0.5"],
    "export a ROS 2 package": ["export", "ur5", "--ros2", "ur5_description"],
    "view -o": ["view", "planar_rr", "-o", "rr.html"],
}

REFUSALS = {
    "table": (["show", "bad.yaml"], 2, "TableFileError", ("bad.yaml", 1, 1)),
    "poses": (["ik", "ur5", "--csv", "bad.csv"], 2, "PoseError", ("bad.csv", 2, None)),
    "option": (["ik", "ur5", "--xyz=1,2"], 2, "PoseError", ("--xyz", None, None)),
    "name": (["fk", "nowhere", "0"], 2, "NameNotFoundError", ("nowhere", None, None)),
    "usage": (["fk", "ur5", "--what"], 2, "Dh2UrdfError", None),
    "no verb": (["what"], 2, "Dh2UrdfError", None),
    "empty": (["workspace", "planar_rr", "-o", "x.png", "--at", "9"], 1, "UnreachedError", None),
}


def schema(name):
    """A validator of a schema file."""
    return Draft202012Validator(json.loads((FOLDER / f"{name}.json").read_text()))


def strict(text):
    """One JSON object; NaN and Infinity, which JSON has not, are errors."""

    def refuse(word):
        raise AssertionError(f"{word} is no JSON")

    return json.loads(text, parse_constant=refuse)


@pytest.fixture
def files(tmp_path):
    """The files that the verbs above read."""
    dh2urdf.write_urdf("rpr_new_frame", tmp_path / "arm.urdf")
    joint = '<joint name="j" type="revolute"><parent link="a"/><child link="b"/></joint>'
    (tmp_path / "bad.urdf").write_text(
        f'<robot name="r"><link name="a"/><link name="b"/>{joint}</robot>'
    )
    (tmp_path / "poses.csv").write_text("0.4,0,0.3,0,3.1,0\n9,0,0,0,0,0\n")
    (tmp_path / "bad.csv").write_text("x,y,z,roll,pitch,yaw\n1,2,3,0,0,nil\n")
    (tmp_path / "bad.yaml").write_text("name: x\nconvention: standrd\njoints: [{a: 3x}]\n")


@pytest.mark.usefixtures("files")
@pytest.mark.parametrize("case", ANSWERS)
def test_what_a_verb_prints_follows_its_schema(run, case):
    """One object, strict JSON, every key described; a schema that lost a key would be found."""
    argv = ANSWERS[case]
    _, out, _ = run(*argv, "--json")
    answer = strict(out)
    validator = schema(argv[0])
    validator.validate(answer)
    assert not validator.is_valid({**answer, "more": 1})
    for key in ("schema", "verb"):
        assert not validator.is_valid({k: v for k, v in answer.items() if k != key})


def test_every_verb_has_a_schema_and_every_schema_a_verb():
    """A verb without a schema, or a schema that says nothing of a key, is an omission."""
    assert {path.stem for path in FOLDER.glob("*.json")} == {*VERBS, "errors"}
    for path in FOLDER.glob("*.json"):
        found = json.loads(path.read_text())
        Draft202012Validator.check_schema(found)
        assert all(body["additionalProperties"] is False for body in found.get("oneOf", [found])), (
            path.name
        )


@pytest.mark.usefixtures("files")
@pytest.mark.parametrize("case", REFUSALS)
def test_an_error_is_one_object_with_place_and_kind_and_the_same_status(run, case):
    """The status and stderr are those without --json; the object has the message and the place."""
    argv, status, kind, where = REFUSALS[case]
    plain = run(*argv)
    got, out, err = run(*argv, "--json")
    answer = strict(out)
    schema("errors").validate(answer)
    assert (got, plain[0], plain[1]) == (status, status, "")
    assert (err, answer["message"]) == (plain[2], err.removeprefix("dh2urdf: ").rstrip("\n"))
    assert answer["kind"] == kind
    assert issubclass(getattr(exceptions, kind), exceptions.Dh2UrdfError)
    assert answer["where"] == (where and dict(zip(("place", "line", "column"), where, strict=True)))
    for key in answer:
        short = copy.deepcopy(answer)
        del short[key]
        assert not schema("errors").is_valid(short)


@pytest.mark.usefixtures("files")
def test_every_fault_of_a_table_is_told_with_its_place(run):
    """Of a file with several faults each has its line and column."""
    faults = strict(run("show", "bad.yaml", "--json")[1])["problems"]
    assert {f["where"]["line"] for f in faults} == {1, 2, 3}
    assert all(f["where"]["place"] == "bad.yaml" for f in faults)


def test_what_follows_two_hyphens_is_no_option(run):
    """``-- --json`` asks for nothing."""
    assert run("fk", "nowhere", "--", "--json")[1] == ""


def test_the_address_of_a_view_follows_its_schema(tmp_path):
    """``view --json`` prints one object and then serves."""
    argv = [sys.executable, "-m", "dh2urdf", "view", "planar_rr", "--no-open", "--port=0", "--json"]
    with subprocess.Popen(argv, cwd=tmp_path, stdout=-1, stderr=-1, text=True) as process:
        try:
            lines = [next(process.stdout)]
            while lines[-1] != "}\n":
                lines.append(next(process.stdout))
        finally:
            process.kill()
    schema("view").validate(strict("".join(lines)))
