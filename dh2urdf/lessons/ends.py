"""The first steps of every worked solution: whose letters, and base and tool taken off."""

import numpy as np

from dh2urdf.lessons.arm import Arm
from dh2urdf.lessons.steps import Equation, Mark, Step
from dh2urdf.transforms import Array


def letters(arm: Arm, modified: bool) -> tuple[Step, ...]:
    """Where the rows come from, if they are not the user's own."""
    if arm.own:
        return ()
    why = (
        "The arm's table is in the modified convention"
        if modified
        else "These joints have no table of standard rows whose parallel axes point one way"
    )
    words = (
        f"{why}; the steps below use the standard frames that `dh2urdf extract` gives the "
        f"same axes, with the same joint values q.\n\n{arm.table}"
    )
    return (Step("The frames", words),)


def taken_off(arm: Arm, T: Array, H: Array, place_only: bool) -> Step:
    """The pose of frame n in frame 0: what is asked of the rows themselves."""
    n = arm.n
    if place_only:
        words = "Only the place is asked for: the tool's origin o, seen from frame 0."
        return Step("The point", words, (Equation("o", "o", {}, H[:3, 3], "m"),))
    ends = [
        name
        for name, end in (("the base", arm.base), ("the tool", arm.tool))
        if np.abs(end - np.eye(4)).max() > 0.0
    ]
    if ends:
        words = (
            f"The rows lead from frame 0 to frame {n}. So {' and '.join(ends)} "
            f"{'is' if len(ends) == 1 else 'are'} taken off the pose first: "
            f"H = T_base^(-1) T T_tool^(-1) is where frame {n} has to be."
        )
    else:
        words = f"Frame 0 is the base and frame {n} the tool: the pose is H_{n}^0 itself."
    R, o = H[:3, :3], H[:3, 3]
    equations = (Equation("R", f"R_{n}^0", {}, R), Equation("o", f"o_{n}", {}, o, "m"))
    return Step("The pose", words, equations, marks=(Mark("frame", arm.base @ H, str(n)),))
