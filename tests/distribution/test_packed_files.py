"""What a wheel and a source distribution hold, and what they say of themselves."""

import re
import tomllib
from pathlib import Path

import pytest
from ruamel.yaml import YAML

import dh2urdf

ROOT = Path(__file__).parents[2]
CHANGES = (ROOT / "CHANGELOG.md").read_text(encoding="utf-8")


@pytest.fixture(scope="module")
def builders():
    """Hatchling's builders of this checkout."""
    from hatchling.builders.sdist import SdistBuilder
    from hatchling.builders.wheel import WheelBuilder

    return {"wheel": WheelBuilder(str(ROOT)), "sdist": SdistBuilder(str(ROOT))}


def files_of(builder):
    """Paths inside the archive that a builder would write."""
    return {Path(file.distribution_path) for file in builder.recurse_included_files()}


def ours(*folders):
    """Files of folders of the checkout, what tools leave there aside."""
    return {
        file.relative_to(ROOT)
        for folder in folders
        for file in (ROOT / folder).rglob("*")
        if file.is_file()
        and "__pycache__" not in file.parts
        and file.suffix not in (".so", ".pyc", ".partial")
    }


def test_the_wheel_is_the_package_with_its_data(builders):
    """Every file of the package is in the wheel, and none from elsewhere."""
    held = files_of(builders["wheel"])
    assert held == ours("dh2urdf")
    assert Path("dh2urdf/py.typed") in held
    shipped = {path.stem for path in held if path.match("dh2urdf/robots/*.yaml")}
    assert shipped == set(dh2urdf.list_tables())


def test_the_source_distribution_has_what_builds_and_tests_it(builders):
    """The package, its tests and what they read are in the source distribution."""
    held = files_of(builders["sdist"])
    assert ours("dh2urdf", "urdf", "tests") <= held
    tops = {"README.md", "LICENSE", "CITATION.cff", "hatch_build.py", ".ci/run"}
    assert {Path(name) for name in tops} <= held


def test_the_version_is_said_once(run, builders):
    """Metadata, the command line, the citation and the newest entry of the changelog agree."""
    citation = YAML(typ="safe").load(ROOT / "CITATION.cff")
    newest, date = re.search(r"^## \[(\S+)\] - (\S+)$", CHANGES, re.MULTILINE).groups()
    assert str(citation["date-released"]) == date
    status, out, _ = run("--version")
    assert (status, out.strip()) == (0, dh2urdf.__version__)
    versions = {newest, citation["version"], builders["wheel"].metadata.version}
    assert versions == {dh2urdf.__version__}
    assert "version" not in tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]


def test_the_changelog_has_the_usual_parts():
    """Every entry has a version and a date, newest first, and parts of known names."""
    heads = re.findall(r"^## (.*)$", CHANGES, re.MULTILINE)
    entries = [re.fullmatch(r"\[(\d+)\.(\d+)\.(\d+)\] - \d{4}-\d\d-\d\d", head) for head in heads]
    versions = [tuple(map(int, entry.groups())) for entry in entries]
    assert versions == sorted(versions, reverse=True)
    known = {"Added", "Changed", "Deprecated", "Removed", "Fixed", "Security"}
    assert set(re.findall(r"^### (.*)$", CHANGES, re.MULTILINE)) <= known
