"""The README's tables, written from a results file between two marks; nothing is typed."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from pathlib import Path

from benchmarks.arms import ARMS, Arm
from benchmarks.peers.ours import OURS
from benchmarks.plot import draw
from benchmarks.results import Results, Row
from benchmarks.work.edges import EDGES

__all__ = ["COMPLETE", "block", "render"]

ROOT = Path(__file__).parent.parent
README = ROOT / "README.md"
PLOT = ROOT / "benchmarks" / "results" / "time_recall.png"
BEGIN, END = "<!-- benchmarks -->", "<!-- /benchmarks -->"

COMPLETE = 0.9
"""Share of the solutions that a peer has to find to count as a row's fastest."""


def render(path: Path) -> None:
    """Rewrite the README's block and the plot from a results file."""
    results = shown(path)
    text = README.read_text()
    before, begin, rest = text.partition(BEGIN)
    _, end, after = rest.partition(END)
    if not (begin and end):
        raise SystemExit(f"{README}: no block between {BEGIN} and {END}")
    draw(results, PLOT)
    README.write_text(f"{before}{BEGIN}\n{block(results)}{END}{after}")


def shown(path: Path) -> Results:
    """The results of a file as they are shown: of a busy machine, processor times."""
    results = Results.load(path)
    return results.undisturbed() if results.busy else results


def block(results: Results) -> str:
    """The tables and what they were measured on, as Markdown."""
    kind = (
        "The machine was busy: the times are processor times on one thread."
        if results.busy
        else "Batches run on two threads."
    )
    parts = [
        "All solutions of a random reachable pose; medians of interleaved runs, per pose, with the "
        f"fastest peer that finds at least nine in ten of the known solutions. {kind}",
        _table(
            ("class", "arm", "one call", "fastest peer", "batch", "fastest peer", "found"),
            _ik_rows(results),
        ),
        f"![Time per pose against recall]({PLOT.relative_to(ROOT).as_posix()})",
        _table(("work", "dh2urdf", "fastest peer", "ratio"), _other_rows(results)),
        "Solutions of edge poses that hold within 1e-8; a one-parameter family counts once where "
        "its members are recognised as one.",
        _table(("pose", *_edge_names(results)), _edge_rows(results)),
        "What a call of ours is made of, per pose:",
        _table(("arm", "part", "time"), _parts(results)),
        _provenance(results),
    ]
    return "\n\n".join(parts) + "\n"


def seconds(value: float | None) -> str:
    """A duration with its unit, three digits."""
    if value is None:
        return "–"
    for unit, scale in (("s", 1.0), ("ms", 1e-3), ("µs", 1e-6)):
        if value >= scale:
            return f"{value / scale:.3g} {unit}"
    return f"{value / 1e-9:.3g} ns"


def times(ratio: float) -> str:
    """How many times, in two digits."""
    return f"{ratio:.2g} ×" if ratio < 100 else f"{ratio:.0f} ×"


def _table(head: Iterable[str], rows: Iterable[tuple[str, ...]]) -> str:
    columns = tuple(head)
    lines = [columns, tuple("---" for _ in columns), *rows]
    return "\n".join("| " + " | ".join(line) + " |" for line in lines)


def fastest(rows: Iterable[Row]) -> Row | None:
    """The fastest row of a peer that finds nearly everything."""
    able = [
        r
        for r in rows
        if r.contestant != OURS and r.seconds and (r.recall is None or r.recall >= COMPLETE)
    ]
    return min(able, key=lambda r: r.seconds or 0.0, default=None)


def own(rows: Iterable[Row], threads: int | None = None) -> Row | None:
    """Our row."""
    return next((r for r in rows if r.contestant == OURS and threads in (None, r.threads)), None)


def _with_ratio(ours: Row | None, peer: Row | None) -> str:
    """A peer's time and name, and how many times ours that is."""
    if peer is None or peer.seconds is None:
        return "none"
    text = f"{seconds(peer.seconds)} {peer.contestant}"
    if ours is None or not ours.seconds:
        return text
    return f"{text}, **{times(peer.seconds / ours.seconds)}**"


def _ik_rows(results: Results) -> Iterator[tuple[str, ...]]:
    for arm in ARMS:
        single = list(results.of("ik one, public", arm.key))
        if not single:
            continue
        batch = list(results.of("ik batch", arm.key))
        peers = batch or list(results.of("ik one, bare", arm.key))
        peers += [r for r in results.of("ik one, bare", arm.key) if r.contestant != OURS]
        one, many = own(single), own(batch, threads=1 if results.busy else 2)
        yield (
            arm.family,
            _arm_name(arm),
            seconds(one.seconds if one else None),
            _with_ratio(one, fastest(single)),
            seconds(many.seconds if many else None),
            _with_ratio(many, fastest(peers)),
            _found(one, fastest(single)),
        )


def _arm_name(arm: Arm) -> str:
    return arm.key.replace("_urdf", " (URDF)")


def _found(ours: Row | None, peer: Row | None) -> str:
    parts = [f"{100 * r.recall:.4g} %" for r in (ours, peer) if r and r.recall is not None]
    return " / ".join(parts)


def _other_rows(results: Results) -> Iterator[tuple[str, ...]]:
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
        rows = [_per_solution(r) for r in results.of("7R sweep", key)]
        yield _compared(f"7R swept, per solution: {key}", own(rows), fastest(rows))
    yield _range("building robot and solver, all arms", results.of("build"))
    imports = list(results.of("import"))
    if ours := own(imports):
        yield _compared("import, beyond NumPy", ours, None)
    for work in ("first call, compiling", "first call, cached"):
        for row in results.of(work):
            yield _compared(f"{work}: {row.arm}", row, None)
    for row in results.of("process"):
        if row.contestant in ("convert", "extract", "fk"):
            yield _compared(f"`dh2urdf {row.contestant}`, whole process", row, None)
    for key in dict.fromkeys(r.arm for r in results.of("memory")):
        yield _memory(key, list(results.of("memory", key)))


def _compared(label: str, ours: Row | None, peer: Row | None) -> tuple[str, ...]:
    mine, theirs = (r.seconds if r else None for r in (ours, peer))
    ratio = times(theirs / mine) if mine and theirs else ""
    name = f"{seconds(theirs)} {peer.contestant}" if peer else ""
    return label, seconds(mine), name, ratio


def _range(label: str, rows: Iterable[Row]) -> tuple[str, ...]:
    """Smallest and largest time, ours and the peers'."""
    ours: list[float] = []
    peers: list[float] = []
    for row in rows:
        (ours if row.contestant == OURS else peers).append(row.seconds or 0.0)
    spans = [f"{seconds(min(v))} to {seconds(max(v))}" if v else "–" for v in (ours, peers)]
    return label, *spans, ""


def _per_solution(row: Row) -> Row:
    values = {**vars(row)}
    values["seconds"] = (row.seconds or 0.0) / max(row.extra["solutions"], 1e-9)
    return Row(**values)


def _memory(key: str, rows: list[Row]) -> tuple[str, ...]:
    ours = own(rows)
    peers = [r for r in rows if r.contestant != OURS]
    least = min(peers, key=lambda r: r.extra["bytes"], default=None)
    mine = (
        f"{ours.extra['bytes']:.0f} B, of which q, residual, count {ours.extra['arrays']:.0f} B"
        if ours
        else "–"
    )
    theirs = f"{least.extra['bytes']:.0f} B {least.contestant}" if least else ""
    return f"memory of a batch, per pose: {key}", mine, theirs, ""


def _edge_names(results: Results) -> list[str]:
    return list(dict.fromkeys(r.contestant for r in results.of("ik edge")))


def _edge_rows(results: Results) -> Iterator[tuple[str, ...]]:
    for edge in EDGES:
        rows = {r.contestant: r for r in results.of("ik edge", edge.key)}
        counts = (
            str(rows[name].extra["solutions"]) if name in rows else ""
            for name in _edge_names(results)
        )
        if rows:
            yield (f"{edge.key}: {edge.words}", *counts)


def _parts(results: Results) -> Iterator[tuple[str, ...]]:
    for row in results.of("breakdown"):
        yield row.arm, row.contestant, seconds(row.seconds)


def _provenance(results: Results) -> str:
    about = results.about
    machine = about["machine"]
    names = ", ".join(f"{k} {v}" for k, v in about["versions"].items())
    load = " to ".join(str(v[0]) for v in about["load_average"])
    return (
        f"Commit {about['commit']}; {machine['processor']}, {machine['cores']} cores, "
        f"{machine['memory']}, {machine['system']}, Python {machine['python']}; {names}; load "
        f"average {load}. Method, limits and where we lose: [benchmarks](benchmarks/README.md). "
        f"Written by `python -m benchmarks --render`."
    )
