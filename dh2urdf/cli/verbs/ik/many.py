"""The solutions of many poses: lines of CSV, or JSON, as they are found."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator, Sequence
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from dh2urdf.cli.output import SCHEMA, emit, emit_json, to_json
from dh2urdf.cli.progress import bar, note
from dh2urdf.cli.verbs.ik.answers import (
    as_data,
    joint_heads,
    names_of,
    outside,
    reason_of,
    tell_change,
    words_of,
)
from dh2urdf.cli.verbs.ik.digits import few_words, number_words, text_of, whole_words
from dh2urdf.cli.verbs.ik.poses import Poses
from dh2urdf.dh_io import atomic_write, refuse_foreign
from dh2urdf.exceptions import VerificationError
from dh2urdf.grids import grid_csv
from dh2urdf.transforms import Array

if TYPE_CHECKING:
    from dh2urdf.ik.problem import IKBatch, IKSolutions
    from dh2urdf.robot import Robot

Whole = NDArray[np.int64]

CHUNK = 2_000
"""Poses that are solved and written at once; Pinocchio measures the first that is reached."""

MEASURED = 1e-8
"""Largest residual [m or rad] that Pinocchio may find: ten times that of a solution."""

SHOWN = 5
"""Poses without a solution whose reason is told."""

LAST = ["residual", "branch", "outside"]
"""Columns behind the joints; by these a file is known as ours."""


class Asked(NamedTuple):
    """What was asked of each pose, and how it is written."""

    near: dict[str, Any]
    options: dict[str, Any]
    best: bool
    deg: bool
    words: str | None


class _Chunk(NamedTuple):
    """Solutions of poses from ``start`` on, and for each its pose and its place among others."""

    start: int
    answers: IKBatch | Sequence[IKSolutions]
    change: float
    pose: Whole
    place: Whole
    q: Array
    residual: Array
    code: Whole


class _Tally:
    """What is told in the end: solutions, poses without one, rounded rotations."""

    def __init__(self, arm: Robot, m: int) -> None:
        self.arm, self.solutions, self.change = arm, 0, 0.0
        self.reached = np.zeros(m, np.bool_)

    def add(self, chunk: _Chunk) -> None:
        """Count a chunk, and have Pinocchio measure a pose of it."""
        found = np.isfinite(chunk.residual)
        within = found & (outside(self.arm, chunk.q) == 0.0).all(axis=1)
        self.solutions += int(found.sum())
        self.reached[chunk.pose[within]] = True
        self.change = max(self.change, chunk.change)
        if not found.any():
            return
        pose = int(chunk.pose[found][0])
        if not chunk.answers[pose - chunk.start].verify().max() < MEASURED:
            raise VerificationError(f"pose {pose + 1}: a solution is none by Pinocchio")


def solve_file(
    arm: Robot, poses: Poses, asked: Asked, output: Path | None, *, force: bool, json: bool
) -> int:
    """Write all solutions of many poses, or the best; 1 if a pose has none within the limits."""
    tally = _Tally(arm, len(poses.T))
    chunks = _told(_solved(arm, poses.T, asked), tally, len(poses.T))
    to_file = output is not None and str(output) != "-"
    if to_file:
        assert output is not None
        if not force:
            refuse_foreign(output, f",{','.join(LAST)}")
        atomic_write(output, _lines(arm, chunks, asked))
    elif json:
        _write_json(arm, chunks, asked.words)
    else:
        for lines in _lines(arm, chunks, asked):
            sys.stdout.write(lines.decode())
    missed = np.flatnonzero(~tally.reached).tolist()
    found = len(poses.T) - len(missed)
    reasons = {i: reason_of(arm, poses.T[i], asked.near, asked.options) for i in missed[:SHOWN]}
    end = {"unreached": missed, "reasons": reasons}
    if to_file and json:
        emit_json("ik", path=output, poses=len(poses.T), solutions=tally.solutions, **end)
    elif to_file:
        emit(f"{output}: {tally.solutions} solutions, {found} of {len(poses.T)} poses reached")
    elif json:
        sys.stdout.write(f"{to_json(end, None)[1:]}\n")
    tell_change(tally.change)
    for i, reason in reasons.items():
        note(f"{poses.name(i)}: no solution within limits: {reason}")
    if len(missed) > SHOWN:
        note(f"... and {len(missed) - SHOWN} more of {len(poses.T)} poses without a solution")
    return 1 if missed else 0


def _told(chunks: Iterator[_Chunk], tally: _Tally, m: int) -> Iterator[_Chunk]:
    """The chunks, counted, telling how far it has come."""
    with bar("solving", m) as report:
        done = 0
        for chunk in chunks:
            tally.add(chunk)
            yield chunk
            done += len(chunk.answers)
            report(done, m)


def _solved(arm: Robot, Ts: Array, asked: Asked) -> Iterator[_Chunk]:
    """The solutions of one chunk of poses after the other."""
    from dh2urdf.ik.arm import middle

    near, options = asked.near, asked.options
    goal = middle(arm) if near["seed"] is None else near["seed"]
    for start in range(0, len(Ts), CHUNK):
        part = Ts[start : start + CHUNK]
        plain = near["seed"] is None and near["turns"] == "nearest"
        if "seed_tolerance" in near or not (plain or asked.best):
            answers = [arm.ik(T, **near, **options) for T in part]
            yield _of_answers(
                [a[:1] for a in answers] if asked.best else answers, start, arm.n, every=asked.best
            )
            continue
        batch = arm.ik_batch(part, **options)
        if asked.best:
            follow, inside = near["seed"] is None, options["within_limits"]
            batch = batch.nearest(goal, follow=follow, within_limits=inside)
            if follow and batch.solved.any():
                goal = batch.q[np.flatnonzero(batch.solved)[-1], 0]
        yield _of_batch(batch, start, every=asked.best)


def _of_batch(batch: IKBatch, start: int, *, every: bool) -> _Chunk:
    """The rows of a batch; with ``every`` one of each pose, NaN where it has no solution."""
    filled = np.arange(batch.q.shape[1]) < (1 if every else batch.count[:, None])
    filled = np.broadcast_to(filled, batch.residual.shape)
    pose, place = np.nonzero(filled)
    q, residual, code = batch.q[filled], batch.residual[filled], batch.branch_code[filled]
    change = float(batch.pose_change.max())
    return _Chunk(start, batch, change, pose + start, place, q, residual, code)


def _of_answers(answers: Sequence[IKSolutions], start: int, n: int, *, every: bool) -> _Chunk:
    """The rows of single answers; ``every`` as for a batch."""
    counts = [max(len(answer), every) for answer in answers]
    pose = np.repeat(np.arange(len(answers)), counts)
    place = np.concatenate([np.arange(k) for k in counts])
    q = np.full((len(pose), n), np.nan)
    residual, code = np.full(len(pose), np.nan), np.full(len(pose), -1)
    filled = place < np.repeat([len(answer) for answer in answers], counts)
    q[filled] = np.concatenate([answer.q for answer in answers])
    residual[filled] = np.concatenate([answer.residual for answer in answers])
    code[filled] = np.concatenate([answer.codes[0] for answer in answers])
    change = max(answer.pose_change for answer in answers)
    return _Chunk(start, answers, change, pose + start, place, q, residual, code)


def _write_json(arm: Robot, chunks: Iterator[_Chunk], words: str | None) -> None:
    """The beginning of one object, with a line for each pose."""
    sys.stdout.write(f'{{"schema": {SCHEMA}, "verb": "ik", "poses": [')
    mark = "\n"
    for chunk in chunks:
        for k in range(len(chunk.answers)):
            sys.stdout.write(mark + to_json(as_data(arm, chunk.answers[k], words), None))
            mark = ",\n"
    sys.stdout.write("\n], ")


def _lines(arm: Robot, chunks: Iterator[_Chunk], asked: Asked) -> Iterator[bytes]:
    """CSV: the heading, then a line for each solution."""
    first = ["pose"] if asked.best else ["pose", "solution"]
    last = [*LAST, "word"] if asked.words else LAST
    yield grid_csv([*first, *joint_heads(arm, deg=asked.deg), *last], []).encode()
    scale = np.where(arm.slides | (not asked.deg), 1.0, 180.0 / np.pi)
    for chunk in chunks:
        pose, over = chunk.pose, outside(arm, chunk.q) > 0.0
        names = partial(_names, arm, over)
        columns = [whole_words(pose + 1)[:, 1:]]
        if not asked.best:
            columns.append(whole_words(chunk.place + 1))
        columns.append(number_words(chunk.q * scale).reshape(len(pose), 8 * arm.n))
        columns.append(_residuals(chunk.residual))
        columns.append(few_words(chunk.code, _branches(chunk)))
        columns.append(few_words(over @ (1 << np.arange(arm.n)), names))
        if asked.words:
            columns.append(_words(chunk, asked.words, every=asked.best))
        columns.append(few_words(np.zeros_like(pose), lambda _: "\n"))
        yield text_of(columns)


def _words(chunk: _Chunk, maker: str, *, every: bool) -> NDArray[np.uint32]:
    """The cells of controllers' words; with ``every`` also of poses without a solution."""
    answers = (chunk.answers[k] for k in range(len(chunk.answers)))
    each = [word for answer in answers for word in words_of(answer, maker) or [""] * every]
    return few_words(np.arange(len(each)), lambda row: _cell(each[row]))


def _names(arm: Robot, over: NDArray[np.bool_], row: int) -> str:
    """A cell of a row: the joints outside their limits."""
    return _cell(" ".join(names_of(arm, over[row])))


def _branches(chunk: _Chunk) -> Callable[[int], str]:
    """What gives the cell of the branch of a row."""

    def cell(row: int) -> str:
        names = chunk.answers[int(chunk.pose[row]) - chunk.start].branch
        return _cell(names[int(chunk.place[row])] if names else "")

    return cell


def _residuals(values: Array) -> NDArray[np.uint32]:
    """Residuals with two digits, nothing for NaN."""
    size = np.where(values > 0.0, values, 1.0)
    decade = np.floor(np.log10(size))
    keys = 1_000.0 * decade + np.rint(size * 10.0 ** (1.0 - decade))
    keys = np.where(np.isnan(values), -1e9, np.where(values > 0.0, keys, 1e9))
    return few_words(
        keys.astype(np.int64), lambda i: "," if np.isnan(values[i]) else f",{values[i]:.1e}"
    )


def _cell(text: str) -> str:
    """A comma and a cell, in quotes where it needs them."""
    return "," + (grid_csv([text], []).rstrip("\n") if text else "")
