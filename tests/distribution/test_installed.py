"""The package as others get it: built from its source distribution, installed outside the checkout.

Environments are new ones, made by uv from a package index: ``pytest -m install``.
"""

import json
import os
import re
import subprocess
import sys
import tarfile
import zipfile
from pathlib import Path

import pytest
from licences import PROJECT, asked
from packaging.version import Version

pytestmark = pytest.mark.install

ROOT = Path(__file__).parents[2]
EXTRAS = PROJECT["optional-dependencies"]

VIEW = """
import urllib.request, dh2urdf
from dh2urdf.viewer import view
with view(dh2urdf.Robot.from_dh("planar_rr"), port=0) as shown:
    print(urllib.request.urlopen(shown.url).status)
"""
XACRO = """<robot name="arm" xmlns:xacro="http://www.ros.org/wiki/xacro"><link name="base"/>
<link name="tip"/><joint name="j" type="revolute"><parent link="base"/><child link="tip"/>
<axis xyz="0 0 ${2 - 1}"/><limit lower="-1" upper="1" effort="1" velocity="1"/></joint></robot>"""

USES = {
    "plot": ["dh2urdf", "figure", "planar_rr", "-o", "rr.png", "--force"],
    "viewer": ["python", "-c", VIEW],
    "xacro": ["dh2urdf", "fk", "arm.xacro", "0"],
    "mjcf": ["dh2urdf", "convert", "planar_rr", "-o", "rr.xml", "--force"],
    "scale": ["dh2urdf", "map", "planar_rr", "-o", "rr.zarr", "--step", "0.5"],
    "symbolic": ["dh2urdf", "show", "planar_rr", "--symbolic"],
}
"""What each extra of the users is for, as a command."""

DEVELOPERS = {
    "test": "rm -r dh2urdf && python -m pytest -q tests/dh",
    "fuzz": "rm -r dh2urdf && python -m tests.fuzz cells --guided 5",
    "lint": "ruff check . && ruff format --check . && mypy && lint-imports --no-cache",
    "consumers": "python -c 'import ikpy, pybullet, pydrake' && dh2urdf check urdf/planar_rr.urdf",
    "bench": "rm -r dh2urdf && python -m benchmarks --quick --only building --out quick.json",
    "examples": "rm -r dh2urdf && python examples/notebooks/execute.py && "
    "for script in examples/*.py; do python $script || exit 1; done",
    "docs": "rm -r dh2urdf && sphinx-build -W -q -j 2 docs site",
}
"""What each extra of the developers is for, in the source distribution's folder."""


LOWEST = (
    "tests/dh tests/dh_io tests/cli tests/robot tests/conversions tests/figures tests/page "
    "tests/workspace tests/symbolic -k 'not test_labels'"
)
"""What is run on the lowest versions: all that calls other packages. Where letters stand in a
figure is measured with those of the current matplotlib; older ones set them otherwise."""


def uv(*argv):
    """Run uv, which has to succeed."""
    command = [sys.executable, "-m", "uv", *map(str, argv)]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    return done


class Environment:
    """A new virtual environment in a folder, with commands of its own only."""

    def __init__(self, folder, *packages, python=sys.executable):
        self.folder, self.python = folder, folder / "venv" / "bin" / "python"
        uv("venv", "-q", "--python", python, folder / "venv")
        uv("pip", "install", "-q", "--python", self.python, *packages)
        (folder / "arm.xacro").write_text(XACRO)

    def run(self, command, cwd=None):
        """A command's end, in the folder, without this checkout on any path."""
        clean = {k: v for k, v in os.environ.items() if not k.startswith(("PYTHON", "DH2URDF"))}
        clean |= {
            "PATH": f"{self.python.parent}:{os.environ['PATH']}",
            "DH2URDF_ENGINE": "compiled",
        }
        return subprocess.run(
            command,
            shell=isinstance(command, str),
            cwd=cwd or self.folder,
            env=clean,
            capture_output=True,
            text=True,
            check=False,
        )


@pytest.fixture(scope="session")
def built(tmp_path_factory):
    """The source distribution, and the wheel that is built from it alone."""
    folder = tmp_path_factory.mktemp("built")
    uv("build", "-q", "--python", sys.executable, "-o", folder, ROOT)
    (sdist,), (wheel,) = folder.glob("*.tar.gz"), folder.glob("*.whl")
    return sdist, wheel


@pytest.fixture(scope="session")
def bare(built, tmp_path_factory):
    """An environment with the wheel and no extra."""
    return Environment(tmp_path_factory.mktemp("bare"), built[1])


@pytest.fixture
def sources(built, tmp_path):
    """The source distribution, unpacked."""
    with tarfile.open(built[0]) as archive:
        archive.extractall(tmp_path, filter="data")
    (folder,) = tmp_path.glob("dh2urdf-*")
    return folder


def test_the_wheel_holds_the_package_and_nothing_else(built):
    """Compiled kernels, data and types are in the wheel; tests and benchmarks are not."""
    names = set(zipfile.ZipFile(built[1]).namelist())
    assert {"dh2urdf/_kernels.abi3.so", "dh2urdf/py.typed", "dh2urdf/page/page.html"} <= names
    here = {str(p.relative_to(ROOT)) for p in (ROOT / "dh2urdf").rglob("*.py")}
    assert here <= names
    tops = {name.split("/")[0] for name in names}
    assert sorted(top.partition("-")[0] for top in tops) == ["dh2urdf", "dh2urdf"]
    assert "-cp311-abi3-" in built[1].name


def main_jobs():
    """The README's main job, the two commands after the installation."""
    (setup,) = re.findall(
        r"<!-- set-up -->\n```sh\n(.*?)```", (ROOT / "README.md").read_text(), re.S
    )
    return [job.strip().replace(".venv/bin/", "") for job in setup.split("&&")[2:]]


def test_the_main_job_runs_from_the_wheel(bare, built):
    """The README's two commands succeed where only the wheel is, with compiled kernels."""
    convert, ik = main_jobs()
    done = bare.run(convert)
    assert done.returncode == 0, done.stderr
    assert (bare.folder / "denso.urdf").is_file()
    done = bare.run(ik)
    assert done.returncode == 0, done.stderr
    assert "shoulder left, elbow up, wrist no flip" in done.stdout
    assert bare.run("dh2urdf --version").stdout.strip() in built[1].name.split("-")


def test_every_extra_is_tried_here():
    """A new extra has to say what it is for; `all` is those of the users."""
    assert set(EXTRAS) == {*USES, *DEVELOPERS, "all"}
    assert set(re.findall(r"\w+", EXTRAS["all"][0])[1:]) == set(USES)


@pytest.mark.parametrize("extra", USES)
def test_an_extra_is_enough_for_its_purpose(bare, built, tmp_path, extra):
    """With the extra alone its purpose is served; without it, the message names it."""
    refused = bare.run(USES[extra])
    assert refused.returncode == (1 if extra == "viewer" else 2), refused
    assert f"pip install 'dh2urdf[{extra}]'" in refused.stderr
    done = Environment(tmp_path, f"{built[1]}[{extra}]").run(USES[extra])
    assert done.returncode == 0, done.stderr


def test_all_serves_every_purpose(built, tmp_path):
    """The extra `all` is enough for every extra's purpose."""
    environment = Environment(tmp_path, f"{built[1]}[all]")
    for command in USES.values():
        done = environment.run(command)
        assert done.returncode == 0, done.stderr


@pytest.mark.parametrize("extra", DEVELOPERS)
def test_an_extra_for_developers_is_enough(built, sources, tmp_path, extra):
    """In the source distribution, the extra alone runs what it is for."""
    environment = Environment(tmp_path, f"{built[1]}[{extra}]")
    done = environment.run(DEVELOPERS[extra], sources)
    assert done.returncode == 0, (done.stdout[-2000:], done.stderr[-2000:])


def lowest(folder, wheel, *extras):
    """An environment with the lowest version of each package that pyproject.toml names."""
    named = sorted(set(asked(extras)))
    environment = Environment(folder, "--resolution", "lowest-direct", *named)
    uv("pip", "install", "-q", "--no-deps", "--python", environment.python, wheel)
    listed = uv("pip", "list", "--format", "json", "--python", environment.python).stdout
    versions = {package["name"]: Version(package["version"]) for package in json.loads(listed)}
    assert Version("4") <= versions["pin"] < Version("4.1"), "these are not the lowest versions"
    return environment


def test_the_lowest_versions_that_are_allowed_are_enough(built, sources, tmp_path):
    """The tests pass on the oldest of everything that pyproject.toml names; old ones may warn."""
    environment = lowest(tmp_path, built[1], "test")
    run = "rm -r dh2urdf && python -m pytest -q -n 2 -W ignore::DeprecationWarning"
    done = environment.run(f"{run} {LOWEST}", sources)
    assert done.returncode == 0, done.stdout[-4000:]


def test_the_wheel_serves_every_purpose_on_the_lowest_versions(built, tmp_path):
    """What each extra is for succeeds on the oldest of everything that users' extras name."""
    environment = lowest(tmp_path, built[1], "all")
    for command in USES.values():
        done = environment.run(command)
        assert done.returncode == 0, done.stderr


def audited(packages, folder):
    """What pip-audit says of packages with their versions; skipped where it cannot say."""
    (folder / "packages.txt").write_text("\n".join(packages))
    tool = (
        f"{sys.executable} -m uv tool run pip-audit -r packages.txt --no-deps --disable-pip -f json"
    )
    done = subprocess.run(
        tool.split(), cwd=folder, capture_output=True, text=True, check=False, timeout=300
    )
    if not done.stdout.startswith("{"):
        pytest.skip(f"no database of advisories in reach: {done.stderr[-200:]}")
    found = json.loads(done.stdout)["dependencies"]
    if all("skip_reason" in package for package in found):
        pytest.skip(f"this package index tells no advisories: {found[0]['skip_reason']}")
    return [package for package in found if package.get("vulns")]


def test_no_advisory_stands_against_what_users_install(built, tmp_path):
    """pip-audit finds nothing against the newest versions of all that `all` brings."""
    audited(["numpy==2.0.0"], tmp_path)  # one first: is there an answer at all?
    environment = Environment(tmp_path, f"{built[1]}[all]")
    listed = uv("pip", "freeze", "--python", environment.python).stdout.splitlines()
    packages = [line for line in listed if "==" in line and not line.startswith("dh2urdf")]
    assert audited(packages, tmp_path) == []


def test_the_citation_is_valid():
    """cffconvert finds CITATION.cff valid by the schema that it names."""
    uv("tool", "run", "-q", "cffconvert", "--validate", "-i", ROOT / "CITATION.cff")
