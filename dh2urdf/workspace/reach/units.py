"""Units of a map's measures, which the arm's joints and the task decide."""

from collections.abc import Sequence

from dh2urdf.dh import JointType


def measure_units(joint_types: Sequence[str], task: str) -> dict[str, str]:
    """Unit of each measure of :func:`reach_map`, "1" where lengths and angles are added up.

    A minor of the Jacobian takes one length from each of its rows of translation, but for those
    that go to a sliding joint; ``sqrt(det(J J^T))`` has their unit where all minors have the same.
    """
    n = len(joint_types)
    slides = sum(kind == JointType.PRISMATIC for kind in joint_types)
    rows = {"position": 3, "position+axis": 5}.get(task, 6)
    translations: int | None = 3
    if task == "position":
        translations = min(n, 3)
    elif task == "pose" and n < 5:  # planar, or a SCARA: all rows but the turn about its axis
        translations = n - 1
    elif n < rows:
        translations = None
    if translations is None or (slides and n > rows):
        size = "1"
    else:
        power = translations - slides
        size = "1" if power == 0 else "m" if power == 1 else f"m{power}"
    margin = "rad" if not slides else "m" if slides == n else "rad or m"
    return {
        "manipulability": size,
        "singular_value": "m" if task == "position" and not slides else "1",
        "limit_margin": margin,
    }
