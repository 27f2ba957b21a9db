"""A C program that says whether an exported solver, as compiled there, finds what is found here."""

import os
from pathlib import Path

import numpy as np

from dh2urdf.dh_io import atomic_write, refuse_foreign
from dh2urdf.export.blanks import filled
from dh2urdf.export.source import MARK, Exported
from dh2urdf.robot import Robot
from dh2urdf.transforms import Array

POSES = 40
"""Poses of random configurations within the limits."""

SEED = 1

HELD = "\n/* The value of the held joint. */\nstatic const double values[POSES] = {{{}}};\n"


def write_self_test(
    robot: Robot,
    made: Exported,
    source: Path,
    path: Path,
    *,
    held: int | str | None = None,
    force: bool = False,
) -> None:
    """Write the program of an exported file ``source``, as :func:`self_test_text` makes it.

    Raises
    ------
    OutputError, OutputExistsError
    """
    header = Path(os.path.relpath(source, path.parent)).as_posix()
    text = self_test_text(robot, made, header, held)
    if not force:
        refuse_foreign(path, MARK, same=text.encode())
    atomic_write(path, text)


def self_test_text(robot: Robot, made: Exported, header: str, held: int | str | None = None) -> str:
    """The program, in C99, that includes a header and returns 0 where it is right.

    Parameters
    ----------
    robot : Robot
    made : Exported
        What the header holds.
    header : str
        The name by which it is included.
    held : int or str, optional
        Index or name of the joint of which the header's functions take the value.
    """
    from dh2urdf import __version__

    q = _configurations(robot)
    joint = robot.joint_names.index(held) if isinstance(held, str) else held
    Ts, counts, rows = robot.fk(q), list[int](), list[list[float]]()
    for T, one in zip(Ts, q, strict=True):
        found = robot.ik(T, locked=None if joint is None else {joint: float(one[joint])})
        singular = any(found.free_joints) or not len(found) or bool(_crowded(found.q, robot))
        counts.append(-1 if singular else len(found))
        rows += [] if singular else found.q.tolist()
    Ts = np.concatenate([Ts, Ts[:1]])
    Ts[-1, :3, 3] += 1e3 * robot.chain.size  # out of reach
    counts.append(0)
    works = has_workspace(made)
    arguments = ["poses[m]", *["values[m]"] * (joint is not None), "true", *["&work"] * works]
    values = "" if joint is None else HELD.format(_numbers([*q[:, joint], q[0, joint]]))
    blanks = {
        "HEADER": header,
        "VERSION": __version__,
        "POSES": str(len(Ts)),
        "SOLUTIONS": str(len(rows)),
        "JOINTS": str(robot.n),
        "SLIDES": ", ".join("true" if slides else "false" for slides in robot.slides),
        "TARGETS": _lines(Ts.reshape(-1, 16)),
        "VALUES": values,
        "COUNTS": ", ".join(map(str, counts)),
        "CONFIGURATIONS": _lines(rows),
        "PREFIX": made.prefix,
        "WORKSPACE": f"static {made.prefix}_workspace work;\n\n" if works else "",
        "PREPARE": f"    {made.prefix}_prepare(&work);\n" if works else "",
        "ARGUMENTS": ", ".join(arguments),
    }
    return filled(__package__, "self_test.c", blanks)


def has_workspace(made: Exported) -> bool:
    """Whether the functions of a file work in memory that their caller has prepared."""
    return f"{made.prefix}_workspace;" in made.text


def _configurations(robot: Robot) -> Array:
    """Configurations within the limits (m, n), of which the first is where most are zero."""
    low, high = robot.bounded(max(robot.chain.size, 0.1), np.pi)
    random = np.random.default_rng(SEED).uniform(low, high, (POSES, robot.n))
    random[-1] = np.clip(0.0, low, high)
    return random


def _crowded(q: Array, robot: Robot) -> bool:
    """Whether two solutions q (k, n) are so near that rounding may unite them."""
    gaps = q[:, None] - q
    turned = np.abs(np.remainder(gaps + np.pi, 2.0 * np.pi) - np.pi)
    far = np.where(robot.slides, np.abs(gaps), turned).max(axis=2)
    return bool((far[np.triu_indices(len(q), 1)] < 1e-2).any())


def _numbers(values: Array | list[float]) -> str:
    return ", ".join(repr(float(v)) for v in values)


def _lines(rows: Array | list[list[float]]) -> str:
    """Rows of numbers as C has them, one a line."""
    return ",\n".join(f"    {{{_numbers(row)}}}" for row in rows)
