"""``convert``, ``show`` and ``extract`` write all of a table, in the format that is asked for."""

import io
import json

import mujoco
import pytest
from dh_product import difference
from example_robots import UR5
from test_json import schema

import dh2urdf
from dh2urdf.dh import DHConvention
from dh2urdf.dh_io import Units, parse_table, read_table, table_to_text

PANDA = dh2urdf.load_table("franka_fer")
READ = ["yaml", "toml", "json", "csv", "md", "xml", "urdf"]
SILENT = "theta,d,a,alpha\n0,100,0,90\n0,0,250,0\n"


@pytest.mark.parametrize("suffix", READ)
@pytest.mark.parametrize("name", ["franka_fer", "stanford", "rpr_by_inspection"])
def test_what_is_written_converts_back_to_the_same_table(run, tmp_path, name, suffix):
    """Through every format that is read, MJCF and URDF too, nothing of a table is lost."""
    status, out, _ = run("convert", name, "-o", f"arm.{suffix}")
    assert status == 0
    said = {"xml": "MuJoCo and the DH product", "urdf": "Pinocchio and the DH product"}
    assert said.get(suffix, "reads back as the same table") in out
    assert run("convert", f"arm.{suffix}", "-o", "back.json")[0] == 0
    assert dh2urdf.load_table(tmp_path / "back.json") == dh2urdf.load_table(name)
    assert dh2urdf.load_table(tmp_path / f"arm.{suffix}") == dh2urdf.load_table(name)


def test_the_suffix_xml_is_an_mjcf(run, tmp_path):
    """MuJoCo compiles what is written to .xml, and to stdout with --format mjcf."""
    assert run("convert", "ur5", "-o", "ur5.xml")[0] == 0
    text = run("convert", "ur5", "-o", "-", "--format", "mjcf")[1]
    assert text == (tmp_path / "ur5.xml").read_text()
    model = mujoco.MjModel.from_xml_string(text)
    assert tuple(model.joint(k).name for k in range(6)) == dh2urdf.load_table("ur5").joint_names


@pytest.mark.parametrize("format", ["mjcf", "urdf", "csv"])
def test_what_stdout_gives_stdin_takes(run, monkeypatch, format):
    """A pipe from convert to convert loses nothing."""
    text = run("convert", "franka_fer", "-o", "-", "--format", format)[1]
    monkeypatch.setattr("sys.stdin", io.StringIO(text))
    status, out, _ = run("convert", "-", "--format", "yaml", "-o", "-")
    assert (status, parse_table(out, "yaml").table) == (0, PANDA)


def test_a_robot_description_is_shown_as_the_table_that_extract_finds(run):
    """``show`` of somebody's URDF prints its table and how it was found."""
    status, out, err = run("show", UR5, "--format", "csv", "--units", "mm,deg")
    assert (status, parse_table(out, "csv").table.rows[2].a) == (0, 0.39225)
    assert "was extracted" in err


@pytest.mark.parametrize("convention", DHConvention)
@pytest.mark.parametrize("units", ["mm,deg", "in,rad"])
def test_convention_and_units_choose_what_is_written(run, tmp_path, convention, units):
    """The same arm in the convention and units that were asked for."""
    argv = ["-o", "arm.csv", "--convention", convention, "--units", units]
    status, out, _ = run("convert", "franka_fer", *argv)
    table, _, found = read_table(tmp_path / "arm.csv")
    assert (status, table.convention, ",".join(found)) == (0, convention, units)
    assert table == dh2urdf.to_convention(PANDA, convention)
    assert (f"{convention} convention, tool within" in out) == (convention != PANDA.convention)
    q = [0.1, -0.4, 0.2, -1.9, 0.1, 1.6, 0.5]
    assert difference(table.fk(q), PANDA.fk(q)) < 1e-14


def test_units_of_the_file_are_kept(run, tmp_path):
    """A file in mm and degrees stays so; one that says nothing is read in what is asked for."""
    table = dh2urdf.load_table("puma560")
    (tmp_path / "arm.yaml").write_text(table_to_text(table, "yaml", Units("mm", "deg")))
    run("convert", "arm.yaml", "-o", "arm.csv")
    assert "# units: mm, deg\n" in (tmp_path / "arm.csv").read_text()
    (tmp_path / "silent.csv").write_text(SILENT)
    argv = ["convert", "silent.csv", "-o", "said.csv", "--convention", "standard"]
    assert run(*argv)[0] == 2
    assert run(*argv, "--units", "mm,deg")[0] == 0
    said = read_table(tmp_path / "said.csv")
    assert said.units == ("mm", "deg")
    assert said.table.rows[1].a == 0.25
    run("convert", "said.csv", "-o", "metres.md", "--units", "m,rad")
    assert read_table(tmp_path / "metres.md").units == ("m", "rad")


def test_a_robot_description_is_extracted(run, tmp_path):
    """A URDF of somebody else, a table out: the same FK, and a note of what was done."""
    status, _, err = run("convert", UR5, "-o", "ur5.yaml", "--convention", "modified")
    assert status == 0
    assert "the chain from world to tool0 was extracted" in err
    table, _, units = read_table(tmp_path / "ur5.yaml")
    assert (table.convention, units) == ("modified", ("m", "rad"))
    robot = dh2urdf.Robot.from_urdf(UR5, tip="tool0")
    q = [0.1, -1.2, 0.3, 0.4, 0.5, 0.6]
    assert difference(table.fk(q), robot.fk(q)) < 1e-12


def test_digits_say_what_they_cost(run, tmp_path):
    """Rounded limits move no arm; rounded lengths do, and the report says how far."""
    short = ["convert", "franka_fer", "--units", "mm,deg", "--digits", "1", "-o", "short.yaml"]
    assert "rounded to 1 decimals, the arm is the same" in run(*short)[1]
    assert "lower: -166, upper: 166" in (tmp_path / "short.yaml").read_text()
    short = ["convert", "ur5", "--digits", "3", "--units", "m,deg", "-o", "short.csv", "--json"]
    result = json.loads(run(*short)[1])
    assert list(schema("convert").iter_errors(result)) == []
    made = result["files"][0]
    again = dh2urdf.load_table(tmp_path / "short.csv")
    q = [0.1, -1.2, 0.3, 0.4, 0.5, 0.6]
    off = difference(again.fk(q)[:3, 3], dh2urdf.load_table("ur5").fk(q)[:3, 3])
    assert 1e-4 < off < 2 * made["max_error"] < 4e-3
    assert "rounded to 3 decimals, the arm is up to" in made["checked"]


def test_digits_that_leave_no_arm_are_refused(refused, tmp_path):
    """Nothing is written where rounding spoils the arm."""
    err = refused("convert", "ur5", "--digits", "0", "--units", "m,deg", "-o", "x.csv")
    assert "give more digits" in err
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize("suffix", ["tex", "html", "xml"])
def test_pages_are_written_over_only_where_they_are_ours(run, refused, tmp_path, suffix):
    """A page or MJCF of dh2urdf is replaced, another file stays."""
    path = tmp_path / f"arm.{suffix}"
    for name in ("ur5", "puma560"):
        assert run("convert", name, "-o", path)[0] == 0
    assert "puma560" in path.read_text()
    path.write_text("theirs")
    assert "--force" in refused("convert", "ur5", "-o", path)
    assert path.read_text() == "theirs"


def test_a_folder_of_tables_in_one_format(run, tmp_path):
    """--format and --out-dir write each arm to a file of that format's suffix."""
    argv = ["ur5", "puma560", "--out-dir", "out", "--format", "markdown", "--units", "mm,deg"]
    assert run("convert", *argv)[0] == 0
    assert sorted(p.name for p in (tmp_path / "out").iterdir()) == ["puma560.md", "ur5.md"]
    assert dh2urdf.load_table(tmp_path / "out" / "ur5.md") == dh2urdf.load_table("ur5")


@pytest.mark.parametrize("format", ["yaml", "toml", "json", "csv", "markdown"])
def test_show_keeps_all_of_a_table(run, format):
    """What show prints in a format reads back equal: the Panda keeps its flange."""
    status, out, _ = run("show", "franka_fer", "--format", format)
    assert (status, parse_table(out, format).table) == (0, PANDA)
    out = run("show", "franka_fer", "--format", format, "--units", "mm,deg")[1]
    assert parse_table(out, format).units == ("mm", "deg")
    out = run("show", "franka_fer", "--format", format, "--convention", "standard")[1]
    assert parse_table(out, format).table == dh2urdf.to_convention(PANDA, "standard")


def test_show_speaks_the_units_asked_for(run):
    """The text too, and its modified columns say i-1."""
    out = run("show", "franka_fer", "--units", "mm,deg", "--digits", "1")[1]
    assert "aᵢ₋₁ [mm]" in out
    assert "tool: xyz (0, 0, 107) mm" in out
    assert "-166 to 166 deg" in out


@pytest.mark.parametrize("suffix", ["yaml", "toml", "json", "csv", "md", "tex", "html"])
def test_extract_keeps_all_of_a_table(run, tmp_path, suffix):
    """A file of an extracted table has base, tool, convention and the units asked for."""
    dh2urdf.write_urdf(PANDA, tmp_path / "panda.urdf")
    argv = ["extract", "panda.urdf", "--convention", "modified", "-o", f"panda.{suffix}"]
    assert run(*argv, "--units", "mm,deg")[0] == 0
    text = (tmp_path / f"panda.{suffix}").read_text()
    assert "107" in text
    assert "modified" in text
    if suffix not in ("tex", "html"):
        found = read_table(tmp_path / f"panda.{suffix}")
        assert (found.table, found.units) == (PANDA, ("mm", "deg"))
