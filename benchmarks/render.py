"""Two pages and a plot, written from a results file between two marks; nothing is typed."""

from __future__ import annotations

from pathlib import Path

from benchmarks import sections
from benchmarks.apart import ROOT
from benchmarks.compare import table
from benchmarks.plot import draw
from benchmarks.results import Results
from benchmarks.targets import target_rows

__all__ = ["PAGES", "between", "figures", "provenance", "render", "shown", "speed"]

PLOT = ROOT / "benchmarks" / "results" / "time_recall.png"
BEGIN, END = "<!-- benchmarks -->\n", "<!-- /benchmarks -->"


def render(path: Path) -> None:
    """Rewrite the blocks of both pages and the plot from a results file."""
    results = shown(path)
    draw(results, PLOT)
    for page, block in PAGES.items():
        text = page.read_text()
        page.write_text(text.replace(between(text), block(results)))


def between(text: str) -> str:
    """A page's block, marks included."""
    begin, end = text.find(BEGIN), text.find(END)
    if begin < 0 or end < begin:
        raise SystemExit(f"no block between {BEGIN.strip()} and {END}")
    return text[begin : end + len(END)]


def shown(path: Path) -> Results:
    """The results of a file as they are shown: of a busy machine, processor times."""
    results = Results.load(path)
    return results.undisturbed() if results.busy else results


def speed(results: Results) -> str:
    """The block of the main README."""
    picture = PLOT.relative_to(ROOT).as_posix()
    parts = [
        "## Speed",
        "All solutions of a random reachable pose; medians of interleaved runs, per pose, with the "
        "fastest peer that finds at least nine in ten of the known solutions. One call is "
        "`robot.ik(T).q` and what the peer's user does for the same array; found is the share of "
        f"all known solutions, ours and the peer's of one call. {_kind(results)}",
        table(
            ("class", "arm", "one call", "fastest peer", "batch", "fastest peer", "found"),
            sections.ik_rows(results),
        ),
        f"![Time per pose against recall]({picture})",
        f"{_where(results)}. `python -m benchmarks --render` wrote the table and `{picture}`. "
        "All figures, the method, the limits and where we lose: "
        "[benchmarks](benchmarks/README.md).",
    ]
    return _marked(parts)


def figures(results: Results) -> str:
    """The block of ``benchmarks/README.md``."""
    parts = [
        f"{provenance(results)} {_kind(results)}",
        "### What was aimed at",
        table(("work", "at least", "measured", ""), target_rows(results)),
        "### All solvers",
        "Per pose; median and half the distance between the 10 % and 90 % quantiles.",
        table(
            (
                "arm",
                "solver",
                "bare call",
                "public call",
                "batch, 1 thread",
                "batch, 2 threads",
                "found",
                "wrong",
                "worst residual",
            ),
            sections.solver_rows(results),
        ),
        "### All other work",
        table(("work", "dh2urdf", "fastest peer", "ratio"), sections.other_rows(results)),
        "### Growth",
        "Time per pose by the number of poses of a call.",
        table(("poses", *sections.growth_head(results)), sections.growth_rows(results)),
        "### Edge poses",
        "Solutions that hold within 1e-8; a one-parameter family counts once where its members "
        "are recognised as one.",
        table(("pose", *sections.edge_names(results)), sections.edge_rows(results)),
        "### How far from the limit",
        "One thread; beside our own time what no program could do without, and how many times as "
        "long ours takes. `benchmarks/work/limits.py` says what each is.",
        table(("work", "arm", "measured", "limit", "ratio"), sections.limit_rows(results)),
        "### Parts of a call",
        table(("arm", "part", "time per pose"), sections.part_rows(results)),
        "### Left out",
        table(("peer", "reason", "where"), sections.left_out_rows(results)),
    ]
    return _marked(parts)


def _marked(parts: list[str]) -> str:
    return f"{BEGIN}\n" + "\n\n".join(parts) + f"\n\n{END}"


def _kind(results: Results) -> str:
    return (
        "Others were using the machine: the times are processor times on one thread."
        if results.busy
        else "Batches run on two threads."
    )


def _where(results: Results) -> str:
    """Processor, system and commit."""
    machine = results.about["machine"]
    return (
        f"{machine['processor']}, {machine['cores']} cores, {machine['system']}, Python "
        f"{machine['python']}, commit {results.about['commit']}"
    )


def provenance(results: Results) -> str:
    """Machine, versions, duration, and what else used the machine."""
    about = results.about
    names = ", ".join(f"{k} {v}" for k, v in about["versions"].items())
    return (
        f"{_where(results)}; memory {about['machine']['memory']}; {names}. The run took "
        f"{about['seconds']} s; other programs used {about['others']} cores meanwhile."
    )


PAGES = {ROOT / "README.md": speed, ROOT / "benchmarks" / "README.md": figures}
"""Pages with a block, and what goes there."""
