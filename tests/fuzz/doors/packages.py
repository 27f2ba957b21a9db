"""What `export` makes of a table: a ROS 2 package, each file of which is of its language."""

import ast
from pathlib import Path

from hostile import outcome
from lxml import etree
from ruamel.yaml import YAML

from dh2urdf import DHTable
from dh2urdf.dh_io import parse_table
from dh2urdf.export.ros2 import Ros2Package, ros2_package
from tests.fuzz.door import CORPUS, Door
from tests.fuzz.guard import unwatched

XML = (".xml", ".urdf", ".srdf")


def write(data: bytes, _: Path) -> None:
    """A table is a package of whole files, which name the robot alike, or is refused."""
    text = data.decode("utf-8", "replace")
    table = outcome(parse_table, text, "yaml")
    if not isinstance(table, tuple):
        return
    package = outcome(ros2_package, table.table, "arm_description", plugin=len(data) % 8 == 0)
    if isinstance(package, Ros2Package):
        with unwatched():
            check(package, table.table)


def check(package: Ros2Package, table: DHTable) -> None:
    """Each file as its reader takes it; a file stands below the package."""
    roots = {}
    for place, text in package.files.items():
        assert not Path(place).is_absolute()
        assert ".." not in Path(place).parts
        if place.endswith(XML):
            roots[Path(place).suffix] = etree.fromstring(text.encode())
        elif place.endswith((".yaml", ".rviz")):
            reader = YAML(typ="safe", pure=True)
            reader.version = (1, 1)
            reader.load(text)
        elif place.endswith(".py"):
            ast.parse(text)
    assert roots[".urdf"].get("name") == roots[".srdf"].get("name")
    named = {joint.get("name") for joint in roots[".urdf"].iter("joint")}
    assert set(table.joint_names) <= named


SEEDS = tuple(path.read_bytes() for path in sorted((CORPUS / "yaml").glob("*")))

DOORS = [Door("packages", write, ("tables",), SEEDS, usual=1000)]
