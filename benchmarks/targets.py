"""What was aimed at before anything was measured, and what came of it."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass

from benchmarks.arms import ARMS
from benchmarks.compare import arm_name, is_peer, most_threads, own, seconds, share, times
from benchmarks.peers.ours import OURS
from benchmarks.results import Results, Row

__all__ = ["TARGETS", "Target", "target_rows"]

Figure = tuple[str, bool]
"""What was measured, in words, and whether it is enough."""

CLOSED = ("spherical wrist", "three parallel axes")


@dataclass(frozen=True)
class Target:
    """A bound, how it is measured, and what stands in the way where it is missed."""

    what: str
    bound: str
    measure: Callable[[Results], Iterable[Figure]]
    obstacle: Callable[[Results], str]


def target_rows(results: Results) -> Iterator[tuple[str, ...]]:
    """Target, bound, measured, met or missed and why."""
    for target in TARGETS:
        figures = list(target.measure(results))
        if not figures:
            yield target.what, target.bound, "not measured", "–"
            continue
        met = all(enough for _, enough in figures)
        verdict = "met" if met else f"**missed**: {target.obstacle(results)}"
        yield target.what, target.bound, "; ".join(words for words, _ in figures), verdict


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


def _batches(families: tuple[str, ...], least: float) -> Callable[[Results], Iterable[Figure]]:
    """Batches of arms against EAIK's."""

    def measure(results: Results) -> Iterator[Figure]:
        n = most_threads(results)
        for arm in (a for a in ARMS if a.family in families):
            mine = own(results.of("ik batch", arm.key), n)
            theirs = _of(results, "ik batch", arm.key, "EAIK", n)
            yield from _against(mine, theirs, arm_name(arm), least)

    return measure


def _one_pose(results: Results) -> Iterator[Figure]:
    for arm in (a for a in ARMS if a.family in CLOSED):
        mine = own(results.of("ik one, public", arm.key))
        theirs = _of(results, "ik one, public", arm.key, "EAIK")
        yield from _against(mine, theirs, arm_name(arm), 1.0)


def _non_pieper(results: Results) -> Iterator[Figure]:
    for arm in (a for a in ARMS if a.family == "non-Pieper 6R"):
        mine = own(results.of("ik batch", arm.key), 1)
        theirs = _of(results, "ik one, bare", arm.key, "ssik prebuilt")
        if theirs:
            yield from _against(mine, theirs, arm_name(arm), 7.0)
        elif mine:
            yield f"{arm_name(arm)} {seconds(mine.seconds)}, not among ssik's", True


def _everything(results: Results) -> Iterator[Figure]:
    rows = [
        r for w in ("ik one, public", "ik batch") for r in results.of(w) if r.contestant == OURS
    ]
    if rows:
        worst = max(r.residual or 0.0 for r in rows)
        least = min(r.recall or 0.0 for r in rows)
        wrong = sum(r.wrong or 0 for r in rows)
        words = f"{share(least)} at least, {wrong} wrong, worst residual {worst:.0e}"
        yield words, least == 1.0 and not wrong


def _forward(results: Results) -> Iterator[Figure]:
    for key in dict.fromkeys(r.arm for r in results.of("fk batch")):
        mine = own(results.of("fk batch", key))
        loop = _of(results, "fk batch", key, "Pinocchio loop")
        for words, enough in _against(mine, loop, key, 10.0):
            error = mine.residual if mine and mine.residual is not None else 1.0
            yield f"{words}, off by {error:.0e}", enough and error <= 1e-13


def _below(
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


def _memory(results: Results) -> Iterator[Figure]:
    for row in results.of("memory"):
        if row.contestant == OURS:
            used, arrays = row.extra["bytes"], row.extra["arrays"]
            words = f"{row.arm} {used:.0f} B a pose, its arrays {arrays:.0f} B"
            yield words, used <= 1.1 * arrays


def _import(results: Results) -> Iterator[Figure]:
    for row in results.of("import"):
        if row.contestant == OURS:
            loaded = row.extra.get("loaded", [])
            words = f"{seconds(row.seconds)}, loads {', '.join(loaded) or 'nothing heavy'}"
            yield words, (row.seconds or 1.0) < 0.25 and not loaded


def _part(results: Results, arm: str, name: str, work: str = "breakdown") -> str:
    """A figure that explains another."""
    rows = (r for r in results.of(work, arm) if r.contestant == name)
    return seconds(next((r.seconds for r in rows), None))


def _why_batch(results: Results) -> str:
    return (
        f"one thread takes {_part(results, 'puma560', 'solver, a pose of many')} (puma560) in the "
        f"kernel, and filling fresh memory of a pose's answer alone takes "
        f"{_part(results, 'puma560', 'filling fresh memory of its answer')}"
    )


def _why_one_pose(results: Results) -> str:
    whole, entry, arrays, solver = (
        _part(results, "puma560", name)
        for name in ("robot.ik", "solver, no pose", "arrays of the answer", "solver, one pose")
    )
    return (
        f"of {whole} (puma560) the solver takes {solver}, {entry} of it without a pose, and the "
        f"arrays of the answer {arrays}; the rest checks the pose and makes Python objects"
    )


def _why_held(results: Results) -> str:
    parts = []
    for arm in ("franka_fer", "kuka_iiwa14"):
        for threads in (1, 2):
            mine = _of(results, "ik batch", arm, OURS, threads)
            peer = _of(results, "ik batch", arm, "EAIK", threads)
            if mine and peer and mine[0].seconds and peer[0].seconds:
                ratio = times(peer[0].seconds / mine[0].seconds)
                parts.append(f"{arm} on {threads}: {seconds(mine[0].seconds)}, {ratio}")
    return (
        "on one thread it is met; of the second one ours gains less than EAIK, arm on threads: "
        f"{'; '.join(parts)}"
    )


def _why_first(results: Results) -> str:
    return f"importing Pinocchio takes {_part(results, '', 'Pinocchio', 'import')} of it"


def _why_convert(results: Results) -> str:
    alone = _part(results, "ur5", "Python, NumPy, Pinocchio", "process")
    return f"Python with NumPy and Pinocchio takes {alone} of it"


def _see(words: str) -> Callable[[Results], str]:
    """An explanation that is in another table."""
    return lambda results: words


TARGETS = (
    Target(
        "closed-form 6R, batch of 100,000 poses",
        "8 times EAIK's batch, same threads",
        _batches(CLOSED, 8.0),
        _why_batch,
    ),
    Target(
        "closed-form 6R, one pose, `robot.ik`",
        "faster than EAIK's call with its solutions as an array",
        _one_pose,
        _why_one_pose,
    ),
    Target(
        "non-Pieper 6R, one thread",
        "7 times ssik's native arms",
        _non_pieper,
        _see("determinants and their roots are arithmetic, see the solver's times below"),
    ),
    Target(
        "7R at a held value, batch",
        "8 times EAIK with the joint held",
        _batches(("7R, one held",), 8.0),
        _why_held,
    ),
    Target(
        "every solution of every arm",
        "all that anybody finds, none wrong",
        _everything,
        _see("all solvers' shares are below"),
    ),
    Target(
        "FK of a batch",
        "10 times a Python loop over Pinocchio, equal to 1e-13",
        _forward,
        _see("cosines and sines are among the parts of a call below"),
    ),
    Target(
        "building robot and solver, any class",
        "under 50 ms",
        _below(0.05, "build"),
        _see("it includes the robot's check against its Pinocchio model and a first solution"),
    ),
    Target(
        "a new process: import, robot and first solutions",
        "under 0.4 s",
        _below(0.4, "first call"),
        _why_first,
    ),
    Target(
        "`dh2urdf convert`, whole process",
        "under 1 s",
        _below(1.0, "process", "convert"),
        _why_convert,
    ),
    Target(
        "memory of a batch",
        "its arrays and at most a tenth more",
        _memory,
        _see("the rest is between the steps of the kernels"),
    ),
    Target(
        "`import dh2urdf` beyond NumPy",
        "under 0.25 s, no Pinocchio",
        _import,
        _see("see what is loaded"),
    ),
)
