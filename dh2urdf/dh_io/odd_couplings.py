"""What is allowed between the joints of a table and probably not meant; told, never changed."""

from collections.abc import Iterator

from dh2urdf.dh import DHTable, JointType
from dh2urdf.dh.coupling import clashes_of, condition_of

STEEP = 1e3
"""Condition of couplings from which on they are told of; those of arms are below ten."""


def odd_couplings(table: DHTable) -> Iterator[tuple[str, str]]:
    """Paths of cells, ``joints[3].mimic``, and what looks odd about them."""
    joints = table.joint_map
    if joints is None:
        return
    paths = [f"joints[{number}]" for number, row in enumerate(table.rows, 1) if row.is_joint]
    for path, row in zip(paths, table.joints, strict=True):
        if row.mimic is not None and row.mimic.multiplier == 0.0:
            text = "0: the joint stands still; a row of type fixed says so, and has no q"
            yield f"{path}.mimic.multiplier", text
    for name, terms in table.couplings.items():
        for other, ratio in terms.items():
            if ratio == 0.0:
                yield f"couplings.{name}.{other}", "0: it adds nothing, as if it were not there"
    condition = condition_of(joints)
    if table.couplings and condition > STEEP:
        text = f"a turn of a joint is up to {condition:.1e} turns of q; so many digits are lost"
        yield "couplings", text
    for clash in clashes_of(table.joints, joints):
        leader = joints.own[clash.value]
        slides = table.joints[leader].joint_type is JointType.PRISMATIC
        yield f"{paths[clash.joint]}.mimic", clash.words(table.joint_names[leader], slides)
