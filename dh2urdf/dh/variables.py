"""What moves the joint of a row, written: ``q3``, ``q3 - q2``, ``-0.5 q1``.

q1, q2 ... are the values that a robot takes; where joints follow others there are fewer of them
than joints.
"""

from collections.abc import Callable, Sequence

from dh2urdf.dh.coupling import JointMap
from dh2urdf.dh.mimic import Mimic
from dh2urdf.grids import number

MINUS = "\N{MINUS SIGN}"


def followed(mimic: Mimic) -> str:
    """What is followed and how, in words: ``joint_5 with multiplier -1``."""
    offset = f", offset {mimic.offset:g}" if mimic.offset else ""
    return f"{mimic.joint} with multiplier {mimic.multiplier:g}{offset}"


def terms(joints: JointMap | None, i: int) -> tuple[list[tuple[float, int]], float]:
    """Joint i (from 0) as ``sum of factor * q_k`` (k from 1), its own value first, plus a number.

    The number is in [rad] or [m]; ``joints`` is None where each has a value of its own.
    """
    if joints is None:
        return [(1.0, i + 1)], 0.0
    row = joints.matrix[i].tolist()
    first = joints.own.index(i) if i in joints.own else -1
    order = sorted((k for k, factor in enumerate(row) if factor), key=lambda k: k != first)
    return [(row[k], k + 1) for k in order], float(joints.offset[i])


def coupled_words(names: Sequence[str], joints: JointMap) -> str:
    """Where the joints stand that are not at a value of their own: ``joint_3 is at q3 + q2``."""
    told = []
    for i, name in enumerate(names):
        parts, constant = terms(joints, i)
        if len(parts) == 1 and parts[0][0] == 1 and i in joints.own and not constant:
            continue
        text, _ = moved_by(joints, i)
        told.append(f"{name} is at {plus(text, number(constant))}")
    return ", ".join(told)


def plus(variable: str, offset: str) -> str:
    """``variable + offset`` with zero left out and a minus sign folded in."""
    if offset == "0":
        return variable
    if offset.startswith(MINUS):
        return f"{variable} {MINUS} {offset.removeprefix(MINUS)}"
    return f"{variable} + {offset}"


def moved_by(
    joints: JointMap | None,
    i: int,
    sign: int = 1,
    symbol: Callable[[int], str] = "q{}".format,
    minus: str = MINUS,
) -> tuple[str, float]:
    """``sign`` times joint i (from 0) in symbols, and what is added to that [rad] or [m]."""
    parts, constant = terms(joints, i)
    text = ""
    for factor, k in parts:
        size = abs(factor)
        written = symbol(k) if size == 1 else f"{number(size)} {symbol(k)}"
        if text:
            text += f" {minus} {written}" if sign * factor < 0 else f" + {written}"
        else:
            text = f"{minus}{written}" if sign * factor < 0 else written
    return text or "0", sign * constant
