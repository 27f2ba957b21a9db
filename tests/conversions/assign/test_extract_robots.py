"""Every serial chain of every robot of example-robot-data, in both conventions.

The referee is Pinocchio's model of the whole untouched file. Each file prints its figures.
"""

import math
from itertools import pairwise

import numpy as np
import pinocchio as pin
import pytest
from example_robots import ROBOTS, fk_between
from lxml import etree

from dh2urdf import extract_dh
from dh2urdf.dh import DHConvention
from dh2urdf.exceptions import UrdfError
from dh2urdf.transforms import pose_error

FILES = sorted(ROBOTS.rglob("*.urdf"))

ALLOWED = 1e-10
JOINTS = range(2, 13)
TIPS = 3

NO_CHAIN = {
    "ur3.urdf": ("a robot element with nothing but comments", "has no links"),
    "iris.urdf": ("a quadrotor: four rotors of one joint each", "4 chains of 1 joints"),
    "iris_simple.urdf": ("a quadrotor without moving rotors", "no revolute, continuous or prism"),
    "quadrotor_base.urdf": ("a quadrotor of one link", "has no joints"),
}
"""Files without a chain of 2 to 12 joints, why, and what the message says."""


class Tree:
    """Links and joints read with nothing of the package."""

    def __init__(self, path):
        self.root = etree.parse(str(path)).getroot()
        self.parent = {}
        for joint in self.root.findall("joint"):
            child = joint.find("child").get("link")
            self.parent[child] = (joint.find("parent").get("link"), joint)
        parents = {parent for parent, _ in self.parent.values()}
        links = [link.get("name") for link in self.root.findall("link")]
        self.leaves = [link for link in links if link not in parents and link in self.parent]

    def moving(self, link):
        """Moving joints from the root down to a link."""
        joints = []
        while link in self.parent:
            link, joint = self.parent[link]
            if joint.get("type") != "fixed":
                joints.append(joint.get("name"))
        return joints[::-1]

    def tips(self):
        """Up to three leaves of different last joints with 2 to 12 moving joints, spread out."""
        by_chain = {}
        for leaf in self.leaves:
            by_chain.setdefault(tuple(self.moving(leaf)), leaf)
        fit = [leaf for chain, leaf in by_chain.items() if len(chain) in JOINTS]
        if len(fit) <= TIPS:
            return fit
        return [fit[round(k * (len(fit) - 1) / (TIPS - 1))] for k in range(TIPS)]

    def across(self, tips):
        """Pairs of tips with 2 to 12 joints between them: the base lies below the ancestor."""
        return [
            (a, b)
            for a, b in pairwise(tips)
            if len(set(self.moving(a)) ^ set(self.moving(b))) in JOINTS
        ]


def chain_error(model, path, base, tip, convention):
    found = extract_dh(path, base, tip, convention)
    rng = np.random.default_rng(11)
    errors = [found.max_error]
    for _ in range(6):
        q = rng.uniform(-math.pi, math.pi, found.table.n)
        by_name = dict(zip(found.table.joint_names, q, strict=True))
        truth = fk_between(model, base, tip, by_name)
        errors.append(pose_error(found.table.fk(q), truth))
    return found.table.n, max(errors)


@pytest.mark.parametrize("path", FILES, ids=lambda p: f"{p.parents[1].name}/{p.stem}")
def test_every_chain_of_a_file(path, capsys):
    """Both conventions reproduce every chain of the file from base to tip within 1e-10."""
    if path.name in NO_CHAIN:
        _, message = NO_CHAIN[path.name]
        with pytest.raises(UrdfError, match=message):
            extract_dh(path)
        return
    tree, model = Tree(path), pin.buildModelFromXML(path.read_text())
    root = next(link for link in tree.root.iter("link") if link.get("name") not in tree.parent)
    tips = tree.tips()
    ends = [(root.get("name"), tip) for tip in tips] + tree.across(tips)
    assert ends, "a file without a chain must be named above"
    figures = [
        (*chain_error(model, path, base, tip, convention), base, tip)
        for base, tip in ends
        for convention in DHConvention
    ]
    worst = max(error for _, error, _, _ in figures)
    with capsys.disabled():
        joints = sorted({n for n, *_ in figures})
        print(
            f"\n{path.parents[1].name}/{path.name}: {len(ends)} chains of "
            f"{', '.join(map(str, joints))} joints, largest difference {worst:.1e}",
            end=" ",
        )
    assert worst <= ALLOWED


def test_the_sweep_is_not_empty():
    """The data hold dozens of files, the ones named above among them."""
    assert len(FILES) > 50
    assert set(NO_CHAIN) <= {path.name for path in FILES}
