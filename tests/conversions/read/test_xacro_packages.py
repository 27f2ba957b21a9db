"""xacro as makers ship it: arguments, packages, YAML files, and what a missing one is told."""

import json
import os

import numpy as np
import pytest
from xacro_packages import MODELS, ROBOT, WRONG, write_package, write_workspace

import dh2urdf
from dh2urdf.bounds import XACRO_ARGS
from dh2urdf.checks import locate
from dh2urdf.cli import main
from dh2urdf.conversions.read import description_bytes, find_package, xacro_given
from dh2urdf.exceptions import ArgumentError, Dh2UrdfError, UrdfError

CHOOSE = "give --xacro-arg arm_type:=VALUE, one of mini3, mini5, mini10e"


@pytest.fixture(scope="module")
def top(tmp_path_factory):
    """The top file of a workspace whose packages lie side by side."""
    return write_workspace(tmp_path_factory.mktemp("workspace"))


@pytest.fixture
def alone(tmp_path, monkeypatch):
    """A description whose other package is in no folder that is looked into, and that package."""
    for variable in ("ROS_PACKAGE_PATH", "AMENT_PREFIX_PATH"):
        monkeypatch.delenv(variable, raising=False)
    top = write_workspace(tmp_path / "a/b/c/d/here", resources="../../../../far/off")
    return top, tmp_path / "a/far/off/mini_resources"


def run(capsys, *words):
    """Exit status of a command line, and what it printed."""
    with pytest.raises(SystemExit) as done:
        main([str(word) for word in words])
    return done.value.code, capsys.readouterr()


@pytest.mark.parametrize("model", MODELS)
def test_an_argument_chooses_the_arm(top, model):
    """Lengths by the model's YAML file, limits by its tag and by an expression."""
    robot = dh2urdf.Robot.from_urdf(top, xacro_args={"arm_type": model, "tool": True})
    first, second = MODELS[model]
    np.testing.assert_allclose(robot.fk([0, 0])[:3, 3], [first + second + 0.05, 0, 0.1])
    np.testing.assert_allclose(np.degrees(robot.upper), [170, 150])
    assert robot.joint_names == ("joint_1", "joint_2")
    assert robot.model.name == "mini"


@pytest.mark.parametrize("verb", ["fk", "ik", "extract", "check", "figure"])
def test_every_verb_that_reads_a_urdf_takes_arguments(top, verb, capsys, tmp_path):
    """Without the argument each names its values and exits with 2."""
    more = {
        "fk": ["0", "0"],
        "ik": ["--xyz", "0.6", "0.3", "0.1", "--task", "position"],
        "extract": [],
        "check": ["--no-run"],
        "figure": ["-o", tmp_path / "arm.svg"],
    }[verb]
    code, said = run(capsys, verb, top, *more)
    assert code == 2
    assert CHOOSE in said.err
    given = ["--xacro-arg", "arm_type:=mini5", "--xacro-arg", "prefix:=left_"]
    code, said = run(capsys, verb, top, *more, *given)
    assert code == (1 if verb == "check" else 0)
    assert CHOOSE not in said.err
    assert "left_" in said.out or verb in ("ik", "figure")


def test_other_forms_are_extracted_of_a_xacro(top, capsys):
    """Segments of the model that was chosen."""
    given = ["--xacro-arg", "arm_type:=mini5"]
    code, said = run(capsys, "extract", top, "--format", "kdl", *given)
    assert code == 0
    assert "0.5" in said.out


def test_extraction_takes_arguments_and_packages(alone):
    """Base and tip by the prefix, joints by the model."""
    top, package = alone
    found = dh2urdf.extract_dh(
        top, xacro_args={"arm_type": "mini3", "prefix": "r_"}, packages={"mini_resources": package}
    )
    assert (found.base, found.tip) == ("world", "r_flange")
    assert [row.a for row in found.table.rows] == pytest.approx([0.3, 0.2])
    assert found.max_error < 1e-12


def test_a_default_that_names_nothing_names_the_values(tmp_path):
    """A missing file whose path holds an argument's value tells the other values."""
    with pytest.raises(UrdfError, match="one of mini3, mini5, mini10e, not minix") as caught:
        description_bytes(write_workspace(tmp_path, WRONG))
    assert "config/minix/kinematics.yaml" in str(caught.value)


def test_an_argument_that_no_file_knows_is_refused(top):
    """A slip does nothing silently."""
    given = xacro_given({"arm_type": "mini5", "prefx": "a_"}, None)
    with pytest.raises(UrdfError, match="no argument 'prefx'; did you mean prefix"):
        description_bytes(top, given)


def test_a_package_that_is_nowhere_says_how_to_give_it(alone):
    """And it is found by its folder, by ROS_PACKAGE_PATH and by AMENT_PREFIX_PATH."""
    top, _ = alone
    with pytest.raises(UrdfError, match="give --package mini_resources=DIR") as caught:
        description_bytes(top, xacro_given({"arm_type": "mini5"}, None))
    assert "beside the file: mini_description" in str(caught.value)


def test_a_package_in_a_folder_of_another_name_is_named(tmp_path):
    """A copy without package.xml: the folder that holds what is wanted is told, and works."""
    line = '<xacro:include filename="$(find arm_support)/urdf/part.xacro"/>'
    files = {"urdf/arm.xacro": f'{ROBOT} name="a">{line}</robot>', "urdf/part.xacro": f"{ROBOT}/>"}
    folder = write_package(tmp_path / "my_copy", "", files, manifest=False).resolve()
    with pytest.raises(UrdfError) as caught:
        description_bytes(folder / "urdf/arm.xacro")
    assert str(caught.value).endswith(f"--package arm_support={folder}")
    given = xacro_given(None, {"arm_support": folder})
    assert b"<robot" in description_bytes(folder / "urdf/arm.xacro", given)[0]


@pytest.mark.parametrize("how", ["given", "ROS", "ROS itself", "ament", "beside", "above"])
def test_a_package_is_found(how, alone, monkeypatch):
    """By whatever way its folder is told."""
    top, package = alone
    given = {"mini_resources": str(package)} if how == "given" else {}
    if how.startswith("ROS"):
        path = package.parents[1] if how == "ROS" else package
        monkeypatch.setenv("ROS_PACKAGE_PATH", f"{os.sep}nowhere{os.pathsep}{path}")
    if how == "ament":
        package.parents[1].joinpath("share").mkdir()
        package = package.rename(package.parents[1] / "share/mini_resources")
        monkeypatch.setenv("AMENT_PREFIX_PATH", str(package.parents[1]))
    if how == "beside":
        package = package.rename(top.parents[2] / "Another_Name")
    if how == "above":
        file = write_package(package, "mini_resources", {"deep/down/arm.xacro": ""})
        top = file / "deep/down/arm.xacro"
    assert find_package("mini_resources", top, given) == package


def test_meshes_of_packages_are_found_by_the_same_ways(alone):
    """For the view and for check."""
    top, package = alone
    name = "package://mini_resources/meshes/upper.stl"
    assert locate(name, top) is None
    assert locate(name, top, {"mini_resources": str(package)}) == package / "meshes/upper.stl"
    data = [d for d in dh2urdf.check_urdf(
        top, xacro_args={"arm_type": "mini5"}, packages={"mini_resources": package}
    ) if d.rule == "mesh-missing"]  # fmt: skip
    assert len(data) == 1  # fore.stl, which is not there
    assert "fore.stl" in data[0].message


SHAPES = {
    "compared": (
        "<xacro:property name='m' value='$(arg kind)'/>".replace("'", '"')
        + "<xacro:if value=\"${m == 'small'}\"/><xacro:if value=\"${m in ['big', 'huge']}\"/>",
        "big, huge, small",
    ),
    "quoted": ("<xacro:if value=\"${'$(arg kind)' == 'small'}\"/>", "small"),
    "truth": ('<xacro:if value="$(arg kind)"/>', "true, false"),
    "files": ('<xacro:include filename="inc/$(arg kind)_macro.xacro"/>', "one, two"),
}


@pytest.mark.parametrize("shape", SHAPES)
def test_values_of_an_argument_are_found(shape, tmp_path):
    """By what it is compared with, and by the files that it names."""
    lines, values = SHAPES[shape]
    inc = {f"inc/{name}_macro.xacro": f"{ROBOT}/>" for name in ("one", "two")}
    folder = write_package(tmp_path, "p", {"a.xacro": f'{ROBOT} name="a">{lines}</robot>', **inc})
    with pytest.raises(UrdfError, match=f"give --xacro-arg kind:=VALUE, one of {values}$"):
        description_bytes(folder / "a.xacro")


def test_a_yaml_file_is_loaded_by_its_package_within_an_expression(top):
    """As makers do it whose arms have one file each."""
    path = top.with_name("direct.xacro")
    yaml = "${xacro.load_yaml('$(find mini_description)/config/mini3/kinematics.yaml')}"
    line = f'<xacro:property name="c" value="{yaml}"/>'
    path.write_text(
        f'{ROBOT} name="a">{line}<link name="l${{c.kinematics.lengths.first}}"/></robot>'
    )
    assert b'"l0.3"' in description_bytes(path)[0]


@pytest.mark.parametrize(
    ("yaml", "says"),
    [
        ("a: !!python/object/apply:os.system [ls]", "could not determine a constructor"),
        ("a: &a [x,x,x,x,x,x,x,x]\n" + "".join(f"b{i}: &b{i} [*{'b' + str(i - 1) if i else 'a'}]\n"
         for i in range(3)) + "w: !degrees __import__('os')", "not allowed"),
        ("w: !degrees '().__class__'", "not allowed"),
    ],
)  # fmt: skip
def test_a_yaml_file_runs_nothing(tmp_path, yaml, says):
    """Tags make no objects, and expressions in it are held to arithmetic, too."""
    (tmp_path / "c.yaml").write_text(yaml)
    line = '<xacro:property name="c" value="${xacro.load_yaml(\'c.yaml\')}"/>'
    path = tmp_path / "a.xacro"
    path.write_text(f'{ROBOT} name="a">{line}<link name="l${{c}}"/></robot>')
    with pytest.raises(UrdfError, match=says):
        description_bytes(path)


@pytest.mark.parametrize(
    ("line", "says"),
    [
        ('<link name="$(env NOT_SET)"/>', "xacro: environment variable 'NOT_SET' is not set"),
        ('<link name="$(eval 1+)"/>', r"xacro: invalid syntax \(<unknown>, line 1\)"),
        ('<xacro:include filename="none.xacro"/>', "none.xacro: No such file or directory"),
        ("<xacro:none/>", "xacro: unknown macro name: xacro:none"),
    ],
)
def test_other_faults_are_told_once(tmp_path, line, says):
    """In the words of the package, without the names of its classes."""
    path = tmp_path / "a.xacro"
    path.write_text(f'{ROBOT} name="a">{line}</robot>')
    with pytest.raises(UrdfError, match=f"{says}$"):
        description_bytes(path)


@pytest.mark.parametrize(
    ("args", "packages", "says"),
    [
        ({"a": None}, None, "xacro_args: expected a text, got None for 'a'"),
        ({1: "a"}, None, "xacro_args: expected a text"),
        ("a:=1", None, "xacro_args: expected at most"),
        ({f"a{i}": 1 for i in range(XACRO_ARGS + 1)}, None, "xacro_args: expected at most"),
        ({"a": "x" * 3000}, None, "over 2000 characters"),
        (None, {"p": 3.5j}, "packages: expected a text"),
    ],
)
def test_arguments_are_checked(args, packages, says):
    """Names, texts and their number."""
    with pytest.raises(ArgumentError, match=says):
        xacro_given(args, packages)


@pytest.mark.parametrize(
    ("words", "says"),
    [
        (["--xacro-arg", "a=1"], "--xacro-arg: expected NAME:=VALUE, got 'a=1'"),
        (["--xacro-arg", "a:=1", "--xacro-arg", "a:=2"], "--xacro-arg: a is given twice"),
        (["--package", "a"], "--package: expected NAME=VALUE, got 'a'"),
        (["--xacro-arg", "a:=1"], "--xacro-arg does nothing for a table"),
        (["--package", "a=b"], "--package does nothing for a table"),
    ],
)
def test_options_of_the_command_line_are_checked(words, says, capsys):
    """One message, exit status 2."""
    code, said = run(capsys, "fk", "planar_rr", "0", "0", *words)
    assert code == 2
    assert says in said.err


def test_arguments_for_a_urdf_are_refused(tmp_path):
    """A URDF takes none."""
    dh2urdf.write_urdf("planar_rr", tmp_path / "a.urdf")
    with pytest.raises(Dh2UrdfError, match="arguments are for a"):
        dh2urdf.Robot.from_urdf(tmp_path / "a.urdf", xacro_args={"a": 1})


def test_json_of_fk_has_the_links_of_the_prefix(top, capsys):
    """The chain ends where the prefix says."""
    words = ["--xacro-arg", "arm_type:=mini5", "--xacro-arg", "prefix:=left_", "--json"]
    code, said = run(capsys, "fk", top, "0", "0", *words)
    assert code == 0
    assert json.loads(said.out)["tip"] == "left_flange"
