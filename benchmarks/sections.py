"""Rows of the tables that a results file renders to."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from benchmarks.arms import ARMS
from benchmarks.compare import (
    arm_name,
    fastest,
    is_peer,
    most_threads,
    own,
    per_solution,
    seconds,
    share,
    times,
)
from benchmarks.peers.ours import OURS
from benchmarks.results import Results, Row
from benchmarks.work.edges import EDGES

__all__ = [
    "edge_names",
    "edge_rows",
    "growth_head",
    "growth_rows",
    "ik_rows",
    "left_out_rows",
    "limit_rows",
    "other_rows",
    "part_rows",
    "solver_rows",
]

Cells = Iterator[tuple[str, ...]]


def ik_rows(results: Results) -> Cells:
    """One row an arm: ours and the fastest peer, one call and a batch."""
    for arm in ARMS:
        single = list(results.of("ik one, public", arm.key))
        if not single:
            continue
        batch = list(results.of("ik batch", arm.key))
        peers = batch + [r for r in results.of("ik one, bare", arm.key) if is_peer(r)]
        one, many = own(single), own(batch, most_threads(results))
        yield (
            arm.family,
            arm_name(arm),
            seconds(one.seconds if one else None),
            _with_ratio(one, fastest(single)),
            seconds(many.seconds if many else None),
            _with_ratio(many, fastest(peers)),
            " / ".join(_found(r) for r in (one, fastest(single)) if r),
        )


def _with_ratio(ours: Row | None, peer: Row | None) -> str:
    """A peer's time and name, and how many times ours that is."""
    if peer is None or peer.seconds is None:
        return "none"
    text = f"{seconds(peer.seconds)} {peer.contestant}"
    if ours is None or not ours.seconds:
        return text
    return f"{text}, **{times(peer.seconds / ours.seconds)}**"


def solver_rows(results: Results) -> Cells:
    """All solvers of all arms: times with their spread, recall, wrong answers, worst residual."""
    for arm in ARMS:
        for row in results.of("ik one, public", arm.key):
            bare = _like(row, results.of("ik one, bare", arm.key))
            batches = [_like(row, results.of("ik batch", arm.key), n) for n in (1, 2)]
            yield (
                arm_name(arm),
                row.contestant,
                _spread(bare),
                _spread(row),
                *(_spread(batch) for batch in batches),
                _found(row),
                str(row.wrong or 0),
                f"{row.residual or 0.0:.0e}",
            )


def _found(row: Row) -> str:
    """The share of all known solutions; a search looks for one a call."""
    one = row.extra.get("searches") and row.recall
    return "one, by search" if one else share(row.recall)


def _like(row: Row, others: Iterable[Row], threads: int | None = None) -> Row | None:
    """The same contestant's row among others."""
    same = (r for r in others if r.contestant == row.contestant)
    return next((r for r in same if threads in (None, r.threads)), None)


def _spread(row: Row | None) -> str:
    """Median, and half the way from the 10 % to the 90 % quantile."""
    if row is None or not row.seconds:
        return ""
    if row.low is None or row.high is None:
        return seconds(row.seconds)
    return f"{seconds(row.seconds)} ± {50 * (row.high - row.low) / row.seconds:.0f} %"


def other_rows(results: Results) -> Cells:
    """Forward kinematics, sweeps, building, processes, memory."""
    for key in dict.fromkeys(r.arm for r in results.of("fk one")):
        rows = list(results.of("fk one", key))
        yield _compared(f"FK, one configuration: {key}", own(rows), fastest(rows))
    for key in dict.fromkeys(r.arm for r in results.of("fk batch")):
        rows = list(results.of("fk batch", key))
        yield _compared(f"FK of a batch, per configuration: {key}", own(rows), fastest(rows))
        loop = next(r for r in rows if r.contestant == "Pinocchio loop")
        if loop is not fastest(rows):
            yield _compared(f"the same, against a Python loop: {key}", own(rows), loop)
    for key in dict.fromkeys(r.arm for r in results.of("7R sweep")):
        rows = [per_solution(r) for r in results.of("7R sweep", key)]
        yield _compared(f"7R swept, per solution: {key}", own(rows), fastest(rows))
    for key in dict.fromkeys(r.arm for r in results.of("build")):
        rows = list(results.of("build", key))
        yield _compared(f"building robot and solver: {key}", own(rows), fastest(rows))
    for row in results.of("import"):
        if row.contestant == OURS:
            yield _compared("import, beyond NumPy", row, None)
        else:
            yield "the same", "", f"{seconds(row.seconds)} {row.contestant}", ""
    for row in results.of("first call"):
        yield _compared(f"import, robot and first solutions: {row.arm}", row, None)
    for row in results.of("process"):
        verb = row.contestant in ("convert", "extract", "fk")
        name = f"`dh2urdf {row.contestant}`" if verb else row.contestant
        cells = (seconds(row.seconds), "") if verb else ("", seconds(row.seconds))
        yield f"{name}, whole process", *cells, ""
    for key in dict.fromkeys(r.arm for r in results.of("memory")):
        yield _memory(key, list(results.of("memory", key)))


def _compared(label: str, ours: Row | None, peer: Row | None) -> tuple[str, ...]:
    mine, theirs = (r.seconds if r else None for r in (ours, peer))
    ratio = times(theirs / mine) if mine and theirs else ""
    name = f"{seconds(theirs)} {peer.contestant}" if peer else ""
    return label, seconds(mine), name, ratio


def _memory(key: str, rows: list[Row]) -> tuple[str, ...]:
    ours = own(rows)
    peers = [r for r in rows if r.contestant != OURS]
    least = min(peers, key=lambda r: r.extra["bytes"], default=None)
    mine = (
        f"{ours.extra['bytes']:.0f} B, its arrays are {ours.extra['arrays']:.0f} B" if ours else "–"
    )
    theirs = f"{least.extra['bytes']:.0f} B {least.contestant}" if least else ""
    return f"memory of a batch, per pose: {key}", mine, theirs, ""


def growth_head(results: Results) -> list[str]:
    """Columns of :func:`growth_rows`: contestant, threads and arm."""
    return [f"{arm}, {name}, {threads} thr." for arm, name, threads in _series(results)]


def growth_rows(results: Results) -> Cells:
    """Time per pose by the number of poses."""
    found = {(r.arm, r.contestant, r.threads, r.size): r for r in results.of("scaling")}
    for size in sorted({r.size for r in results.of("scaling")}):
        cells = (found.get((*series, size)) for series in _series(results))
        yield f"{size:,}", *(seconds(r.seconds) if r else "" for r in cells)


def _series(results: Results) -> list[tuple[str, str, int]]:
    rows = results.of("scaling")
    return sorted(
        {(r.arm, r.contestant, r.threads) for r in rows},
        key=lambda s: (s[0], s[1] != OURS, s[1], s[2]),
    )


def edge_names(results: Results) -> list[str]:
    """Contestants that were given edge poses."""
    return list(dict.fromkeys(r.contestant for r in results.of("ik edge")))


def edge_rows(results: Results) -> Cells:
    """Number of exact solutions of each edge pose."""
    for edge in EDGES:
        rows = {r.contestant: r for r in results.of("ik edge", edge.key)}
        counts = (
            str(rows[name].extra["solutions"]) if name in rows else ""
            for name in edge_names(results)
        )
        if rows:
            yield (f"{edge.key}: {edge.words}", *counts)


def part_rows(results: Results) -> Cells:
    """What a call of ours is made of."""
    for row in results.of("breakdown"):
        yield row.arm, row.contestant, seconds(row.seconds)


BOUNDS = {
    "one pose": ("one pose, `robot.ik`", ("entry", "batch, out")),
    "batch, out": ("a pose of a batch, `out=`", ("arctangents", "memory")),
    "batch": ("a pose of a batch", ("arctangents", "fresh memory")),
    "fk": ("a configuration of a batch of FK", ("fk: memory",)),
}
"""Work, and what it cannot do without."""


def limit_rows(results: Results) -> Cells:
    """How far from what no program could do without."""
    for key in dict.fromkeys(row.arm for row in results.of("limit")):
        found = {row.contestant: row.seconds or 0.0 for row in results.of("limit", key)}
        for name, (words, needs) in BOUNDS.items():
            bound = sum(found[part] for part in needs)
            named = {"batch, out": "a pose of a batch"}
            said = (f"{named.get(p, p.removeprefix('fk: '))} {seconds(found[p])}" for p in needs)
            yield words, key, seconds(found[name]), " + ".join(said), times(found[name] / bound)


def left_out_rows(results: Results) -> Cells:
    """Peers that took no part somewhere, the arms by reason."""
    grouped: dict[tuple[str, str], list[str]] = {}
    for key, reason in results.left_out.items():
        name, _, where = key.partition(", ")
        grouped.setdefault((name, reason), []).append(where or "everywhere")
    for (name, reason), places in grouped.items():
        yield name, reason, ", ".join(places)
