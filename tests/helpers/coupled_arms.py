"""Arms whose joints follow others: a palletiser, a hollow wrist, a controller's angles."""

from math import pi

from dh2urdf import DHRow, DHTable, Mimic

H = pi / 2


def palletiser(**changes):
    """Two rods keep the tool level; as in a URDF, each follower has one joint that it follows."""
    rows = (
        DHRow(d=0.131305, alpha=-H),
        DHRow(theta=-H, a=0.135, lower=-0.2, upper=1.5),
        DHRow(theta=H, a=0.147, lower=-1.5, upper=1.5),
        DHRow(mimic=Mimic("joint_2", -1.0)),
        DHRow(a=0.06, alpha=H, mimic=Mimic("joint_3", -1.0)),
        DHRow(),
    )
    return DHTable(rows, "standard", name="palletiser", **changes)


def driven_palletiser():
    """The same with a third rod: J3 is the angle to the horizontal."""
    return palletiser(couplings={"joint_3": {"joint_2": -1.0}})


def painter():
    """Joint 6 always turns by minus joint 5: the hollow wrist of a painter."""
    bend = 0.610865238198015
    rows = (
        DHRow(d=0.66, a=0.3, alpha=-H),
        DHRow(theta=-H, a=1.2),
        DHRow(a=0.186, alpha=-H),
        DHRow(d=1.4083, alpha=bend),
        DHRow(d=0.079169, alpha=-2 * bend),
        DHRow(d=0.079169, alpha=bend, mimic=Mimic("joint_5", -1.0)),
        DHRow(d=0.082),
    )
    return DHTable(rows, "standard", name="painter")


def pendant(ratio=1.0):
    """J3 as a pendant shows it, that is without what J2 adds; joint 3 turns the other way."""
    rows = (
        DHRow(d=0.45, a=0.32, alpha=-H),
        DHRow(theta=-H, a=0.87),
        DHRow(a=0.225, alpha=-H, sign=-1),
        DHRow(d=1.015, alpha=H, sign=-1),
        DHRow(alpha=-H, sign=-1),
        DHRow(d=0.175, sign=-1),
    )
    couplings = {"joint_3": {"joint_2": ratio}}
    return DHTable(rows, "standard", name="pendant", couplings=couplings)


COUPLED = {table().name + suffix: table for table, suffix in (
    (palletiser, ""), (driven_palletiser, " driven"), (painter, ""), (pendant, ""),
)}  # fmt: skip
