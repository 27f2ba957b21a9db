"""What a results file says of each target: the figures in words, and whether they are enough."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator

from benchmarks.arms import ARMS
from benchmarks.compare import (
    arm_name,
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

__all__ = [
    "CLOSED",
    "Figure",
    "absolute",
    "batches",
    "below",
    "everything",
    "forward",
    "gain",
    "held_call",
    "importing",
    "memory",
    "non_pieper",
    "one_pose",
    "swept",
]

Figure = tuple[str, bool]
"""What was measured, in words, and whether it is enough."""

CLOSED = ("spherical wrist", "three parallel axes")


def _against(mine: Row | None, theirs: Iterable[Row], label: str, least: float) -> Iterator[Figure]:
    """Our time, and how many times as long the fastest of the other rows takes."""
    rows = [r for r in theirs if is_peer(r)]
    if mine is None or not mine.seconds or not rows:
        return
    peer = min(r.seconds or 0.0 for r in rows)
    ratio = peer / mine.seconds
    yield f"{label} {seconds(mine.seconds)}, {times(ratio)}", ratio >= least


def _of(results: Results, work: str, key: str, name: str, threads: int | None = None) -> list[Row]:
    rows = results.of(work, key)
    return [r for r in rows if r.contestant == name and threads in (None, r.threads)]


FAST = {"v3": (1.5e-7, 2.0e-7), "v4": (1.0e-7, 1.5e-7)}
"""Seconds of a Puma's and a UR's pose in a batch on one thread, by level of the processor."""


def batches(
    families: tuple[str, ...], least: float, threads: int
) -> Callable[[Results], Iterable[Figure]]:
    """Batches of arms against EAIK's."""

    def measure(results: Results) -> Iterator[Figure]:
        n = min(threads, most_threads(results))
        for arm in (a for a in ARMS if a.family in families):
            mine = own(results.of("ik batch", arm.key), n)
            theirs = _of(results, "ik batch", arm.key, "EAIK", n)
            yield from _against(mine, theirs, arm_name(arm), least)

    return measure


def absolute(results: Results) -> Iterator[Figure]:
    """Closed forms in a batch on one thread, with a bound for each class and level.

    By the code for x86-64-v3 where a better one runs, into arrays of an earlier batch.
    """
    level = results.about["versions"]["kernels"].partition(" ")[0]
    for arm in (a for a in ARMS if a.family in CLOSED):
        place = CLOSED.index(arm.family)
        rows = [own(results.of("ik batch", arm.key), 1)] if level in FAST else []
        if level != "v3":
            rows += _of(results, "limit", arm.key, "v3")
        for row in rows:
            if row and row.seconds:
                of = level if row.contestant == OURS else row.contestant
                words = f"{arm_name(arm)} {seconds(row.seconds)} on {of}"
                yield words, row.seconds <= FAST[of][place]


def gain(results: Results) -> Iterator[Figure]:
    """Two threads against one, into fresh arrays and into those of an earlier batch."""
    for arm in (a for a in ARMS if a.family in CLOSED):
        ratio = _gain(*(own(results.of("ik batch", arm.key), n) for n in (1, 2)))
        names = "batch, out", "batch, out, two threads"
        limits = (_of(results, "limit", arm.key, name) for name in names)
        again = _gain(*(next(iter(rows), None) for rows in limits))
        if ratio:
            more = f", with `out=` {times(again)}" if again else ""
            yield f"{arm_name(arm)} {times(ratio)}{more}", min(ratio, again or ratio) >= 1.8


def _gain(one: Row | None, two: Row | None) -> float | None:
    """How many times as long one thread takes."""
    return one.seconds / two.seconds if one and two and one.seconds and two.seconds else None


BARE = ("EAIK", "ik-geo", "py-opw", "spherical-wrist", "roboticstoolbox C")
"""Solvers whose bare call is compiled code."""


def one_pose(results: Results) -> Iterator[Figure]:
    """Bare calls of closed forms, at most 1.5 us."""
    for arm in (a for a in ARMS if a.family in CLOSED):
        mine = own(results.of("ik one, bare", arm.key))
        theirs = (r for r in results.of("ik one, bare", arm.key) if r.contestant in BARE)
        for words, enough in _against(mine, theirs, arm_name(arm), 2.0):
            yield words, enough and bool(mine and (mine.seconds or 1.0) <= 1.5e-6)


def held_call(results: Results) -> Iterator[Figure]:
    """One pose of an arm of seven joints with one held."""
    for arm in (a for a in ARMS if a.family == "7R, one held"):
        mine = own(results.of("ik one, bare", arm.key))
        theirs = _of(results, "ik one, bare", arm.key, "EAIK")
        yield from _against(mine, theirs, arm_name(arm), 1.0)


def swept(results: Results) -> Iterator[Figure]:
    """Arms of seven joints with nothing held, for each solution; at most 1 us."""
    for key in dict.fromkeys(r.arm for r in results.of("7R sweep")):
        rows = [per_solution(r) for r in results.of("7R sweep", key)]
        mine = own(rows)
        for words, enough in _against(mine, rows, key, 1.0):
            yield words, enough and bool(mine and (mine.seconds or 1.0) <= 1e-6)


def non_pieper(results: Results) -> Iterator[Figure]:
    """Batches on one thread, at most 12 us a pose."""
    for arm in (a for a in ARMS if a.family == "non-Pieper 6R"):
        mine = own(results.of("ik batch", arm.key), 1)
        theirs = _of(results, "ik one, bare", arm.key, "crx-kinematics")
        quick = bool(mine and (mine.seconds or 1.0) <= 1.2e-5)
        if theirs:
            for words, enough in _against(mine, theirs, arm_name(arm), 1.3):
                yield words, enough and quick
        elif mine:
            yield f"{arm_name(arm)} {seconds(mine.seconds)}", quick


def everything(results: Results) -> Iterator[Figure]:
    """The least recall, the wrong answers and the worst residual of ours."""
    rows = [
        r for w in ("ik one, public", "ik batch") for r in results.of(w) if r.contestant == OURS
    ]
    if rows:
        worst = max(r.residual or 0.0 for r in rows)
        least = min(r.recall or 0.0 for r in rows)
        wrong = sum(r.wrong or 0 for r in rows)
        words = f"{share(least)} at least, {wrong} wrong, worst residual {worst:.0e}"
        yield words, least == 1.0 and not wrong


def forward(results: Results) -> Iterator[Figure]:
    """Batches of forward kinematics against a Python loop."""
    for key in dict.fromkeys(r.arm for r in results.of("fk batch")):
        mine = own(results.of("fk batch", key))
        loop = _of(results, "fk batch", key, "Pinocchio loop")
        for words, enough in _against(mine, loop, key, 10.0):
            error = mine.residual if mine and mine.residual is not None else 1.0
            yield f"{words}, off by {error:.0e}", enough and error <= 1e-13


def below(
    bound: float, work: str, name: str = OURS, what: str = ""
) -> Callable[[Results], Iterable[Figure]]:
    """The longest time of a contestant against a bound [s]."""

    def measure(results: Results) -> Iterator[Figure]:
        rows = [r for r in results.of(work) if r.contestant == name and r.seconds]
        worst = max(rows, key=lambda r: r.seconds or 0.0, default=None)
        if worst and worst.seconds:
            least = min(r.seconds or 0.0 for r in rows)
            span = f"{seconds(least)} to " if len(rows) > 1 else ""
            place = f" ({worst.arm})" if len(rows) > 1 else ""
            yield f"{what}{span}{seconds(worst.seconds)}{place}", worst.seconds < bound

    return measure


def memory(results: Results) -> Iterator[Figure]:
    """What a batch takes beside its arrays."""
    for row in results.of("memory"):
        if row.contestant == OURS:
            used, arrays = row.extra["bytes"], row.extra["arrays"]
            words = f"{row.arm} {used:.0f} B a pose, its arrays {arrays:.0f} B"
            yield words, used <= 1.1 * arrays


def importing(results: Results) -> Iterator[Figure]:
    """What comes with ``import dh2urdf``."""
    for row in results.of("import"):
        if row.contestant == OURS:
            loaded = row.extra.get("loaded", [])
            words = f"{seconds(row.seconds)}, loads {', '.join(loaded) or 'nothing heavy'}"
            yield words, (row.seconds or 1.0) < 0.25 and not loaded
