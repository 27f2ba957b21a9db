"""`dh2urdf check --format`: what build servers, browsers and pre-commit read of the findings."""

import json
import os
import re
import shlex
from pathlib import Path
from urllib.parse import unquote

import pytest
from jsonschema import Draft202012Validator
from lxml import etree, html
from ruamel.yaml import YAML
from urdf_faults import BODY, FAULTS, SOUND, arm, joint

from dh2urdf.checks import RULES, check_urdf

ROOT = Path(__file__).parents[2]


def closed(required, **properties):
    """An object with no properties but these."""
    return {
        "type": "object",
        "properties": properties,
        "required": required.split(),
        "additionalProperties": False,
    }


def many(items):
    """A list."""
    return {"type": "array", "items": items}


TEXT = closed("text", text={"type": "string", "minLength": 1})
URI = {"type": "string", "pattern": r"^(file:///)?([A-Za-z0-9._~/-]|%[0-9A-F]{2})+$"}
PLACE = {"type": "integer", "minimum": 1}
LOCATIONS = many(
    closed(
        "physicalLocation",
        physicalLocation=closed(
            "artifactLocation",
            artifactLocation=closed("uri", uri=URI),
            region=closed("startLine startColumn", startLine=PLACE, startColumn=PLACE),
        ),
    )
)
LEVEL = {"enum": ["none", "note", "warning", "error"]}
NOTE = closed("message", level=LEVEL, message=TEXT, locations=LOCATIONS)
RULE = closed("id", id={"type": "string"}, shortDescription=TEXT)
RESULT = closed(
    "message ruleId",
    ruleId={"type": "string"},
    ruleIndex={"type": "integer", "minimum": -1},
    level=LEVEL,
    message=TEXT,
    locations=LOCATIONS,
)
RUN = closed(
    "tool results",
    tool=closed(
        "driver",
        driver=closed(
            "name", name={"type": "string"}, version={"type": "string"}, rules=many(RULE)
        ),
    ),
    columnKind={"enum": ["utf16CodeUnits", "unicodeCodePoints"]},
    invocations=many(
        closed(
            "executionSuccessful",
            executionSuccessful={"type": "boolean"},
            toolExecutionNotifications=many(NOTE),
        )
    ),
    results=many(RESULT),
)
SARIF = closed(
    "version runs",
    **{"$schema": {"type": "string", "format": "uri"}},
    version={"const": "2.1.0"},
    runs=many(RUN),
)
"""The rules of SARIF 2.1.0 (OASIS, sections 3.13 to 3.58) for the properties that are written."""


@pytest.fixture
def faulty(tmp_path):
    """A file a fault, one that is sound, and names that a URI and HTML have to quote."""
    for rule, texts in FAULTS.items():
        for k, text in enumerate(texts):
            (tmp_path / f"{rule}_{k}.urdf").write_text(text)
    (tmp_path / "sound.urdf").write_text(SOUND)
    (tmp_path / "a & <b>.urdf").write_text(arm(base=BODY).replace("fore", "&lt;i>fore"))
    return sorted(path.name for path in tmp_path.iterdir())


def test_sarif_has_every_finding_with_file_line_column_rule_and_level(run, faulty, tmp_path):
    """The log follows the rules of SARIF 2.1.0, and each place is that of the start tag."""
    status, out, _ = run("check", *faulty, "--no-run", "--format", "sarif")
    log = json.loads(out)
    Draft202012Validator(SARIF).validate(log)
    (sarif,) = log["runs"]
    rules = [rule["id"] for rule in sarif["tool"]["driver"]["rules"]]
    assert status == 1
    assert len(rules) == len(set(rules)) == len(RULES) + 1
    levels = {"error": "error", "warning": "warning", "advice": "note"}
    found = []
    for result in sarif["results"]:
        assert rules[result["ruleIndex"]] == result["ruleId"]
        place = result["locations"][0]["physicalLocation"]
        name, region = unquote(place["artifactLocation"]["uri"]), place["region"]
        line = (tmp_path / name).read_text().splitlines()[region["startLine"] - 1]
        tag = re.match(r"<(\S+?)[ >]", result["message"]["text"])[1]
        assert re.match(rf"<(xacro:)?{re.escape(tag)}\b", line[region["startColumn"] - 1 :]), (
            name,
            result,
        )
        found.append((name, region["startLine"], result["ruleId"], result["level"]))
    expected = [
        (name, f.line, f.rule, levels[f.severity]) for name in faulty for f in check_urdf(name)
    ]
    assert found == expected


def test_an_element_is_found_among_others_on_its_line():
    """In a file of one line the column is that of the very joint, or of what is in it."""
    text = " ".join(arm(elbow=joint(limit="", rpy="1.5708 0 0")).split("\n"))
    path = Path("one_line.urdf")
    path.write_text(text)
    places = {f.rule: text[f.column - 1 :] for f in check_urdf(path)}
    path.unlink()
    assert places["limit-missing"].startswith('<joint name="elbow"')
    assert places["rounded-angle"].startswith('<origin xyz="0 0 1" rpy="1.5708 0 0"')


def test_programs_that_refuse_and_files_that_are_none_are_in_the_log(run, tmp_path):
    """A refusal is a result of its own; a file that cannot be read fails the invocation; 2."""
    (tmp_path / "arm.urdf").write_text(arm(elbow=joint(limit="")))
    status, out, err = run("check", "arm.urdf", "nowhere.urdf", "--format", "sarif")
    log = json.loads(out)
    Draft202012Validator(SARIF).validate(log)
    (sarif,) = log["runs"]
    refused = [r["message"]["text"] for r in sarif["results"] if r["ruleId"] == "refused"]
    assert any(text.startswith("Pinocchio refuses the file: ") for text in refused)
    (invocation,) = sarif["invocations"]
    assert (status, invocation["executionSuccessful"]) == (2, False)
    message = invocation["toolExecutionNotifications"][0]["message"]["text"]
    assert err.splitlines()[-1] == f"dh2urdf: {message}"


def test_junit_counts_its_cases_and_fails_those_with_errors_or_warnings(run, faulty):
    """A suite a file, a case a rule; advice is put out by a case that passes."""
    status, out, _ = run("check", *faulty, "nowhere.urdf", "--no-run", "--format", "junit")
    root = etree.fromstring(out)
    assert (status, root.tag, len(root)) == (2, "testsuites", len(faulty) + 1)
    for element in (root, *root):
        for key, tag in (("tests", "testcase"), ("failures", "failure"), ("errors", "error")):
            assert int(element.get(key)) == len(list(element.iter(tag)))
    by_name = {suite.get("name"): suite for suite in root}
    assert by_name["nowhere.urdf"].find("testcase/error").text.endswith("no such file")
    for name in faulty:
        expected = {f.rule for f in check_urdf(name) if f.severity != "advice"}
        failed = {c.get("name") for c in by_name[name] if c.find("failure") is not None}
        advised = {c.get("name") for c in by_name[name] if c.find("system-out") is not None}
        assert failed == expected
        assert failed | advised == {f.rule for f in check_urdf(name)}
    failure = by_name["limit-missing_0.urdf"].find("testcase/failure")
    assert failure.get("message").startswith('line 7: <joint name="elbow"> has no <limit>')
    assert "mend: write <limit" in failure.text


def test_html_is_one_page_that_asks_for_nothing_and_runs_nothing(run, faulty):
    """Every message is on it as text, names too; no script, link or picture."""
    status, out, _ = run("check", *faulty, "--no-run", "--format", "html")
    page = html.document_fromstring(out)
    assert status == 1
    assert not page.xpath("//script | //link | //img | //iframe | //@src | //@href | //@style")
    assert "url(" not in out
    assert "@import" not in out
    text = " ".join(page.text_content().split())
    assert "a & <b>.urdf" in text
    for name in faulty:
        for f in check_urdf(name):
            assert " ".join(f"line {f.line}: {f.element} {f.message}".split()) in text
            assert " ".join(f"To mend: {f.mend}".split()) in text
    colours = {a.get("class") for a in page.xpath("//article")}
    assert colours == {"error", "warning", "advice"}


def test_json_is_a_format_too_and_an_unknown_one_is_refused(run, refused, tmp_path):
    """``--format json`` is ``--json``; what is none of the formats is told with those there are."""
    (tmp_path / "arm.urdf").write_text(SOUND)
    same = [run("check", "arm.urdf", "--no-run", *f) for f in (["--json"], ["--format", "json"])]
    assert same[0] == same[1]
    assert "sarif" in refused("check", "arm.urdf", "--format", "xml")


@pytest.mark.parametrize("form", ["text", "junit", "sarif", "html", "json"])
def test_a_file_whose_name_is_no_text_is_told_in_every_format(run, form):
    """Linux lets any bytes be a name: of a file that is checked, and of one that is not there."""
    odd, gone = os.fsdecode(b"arm-\xff.urdf"), os.fsdecode(b"\xfe")
    Path(odd).write_text(SOUND)
    status, out, err = run("check", odd, gone, "--no-run", "--format", form)
    assert status == 2
    assert "Traceback" not in err
    assert out.encode("utf-8", "surrogateescape")
    if form == "junit":
        suites = etree.fromstring(out.encode())
        assert [suite.get("name") for suite in suites] == ["arm-\ufffd.urdf", "\ufffd"]
    if form == "sarif":
        assert '"uri": "%FE"' in out


def test_the_hook_of_pre_commit_checks_the_files_that_it_is_given(run, tmp_path):
    """Its entry is a call of the command line, its pattern takes URDF files and no others."""
    (hook,) = YAML(typ="safe").load(ROOT / ".pre-commit-hooks.yaml")
    assert (hook["id"], hook["language"]) == ("dh2urdf-check", "python")
    assert [bool(re.search(hook["files"], f)) for f in ("a/b.urdf", "b.urdf.xacro")] == [
        True,
        False,
    ]
    program, *argv = shlex.split(hook["entry"])
    assert program == "dh2urdf"
    (tmp_path / "sound.urdf").write_text(SOUND)
    (tmp_path / "bad.urdf").write_text(arm(fore=""))
    assert run(*argv, "sound.urdf")[0] == 0
    assert run(*argv, "sound.urdf", "bad.urdf")[0] == 1
