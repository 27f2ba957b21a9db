"""Time per pose and recall of every solver, one panel an arm, from a results file."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from benchmarks.arms import ARMS, Arm
from benchmarks.peers.ours import OURS
from benchmarks.results import Results, Row

__all__ = ["draw"]

OWN, PEER, INK, FAINT = "#0b5fa5", "#6d737d", "#2b2f36", "#e4e6ea"
LOST = "#b3261e"
"""Colour of a share of solutions below nine in ten."""


def draw(results: Results, path: Path) -> None:
    """Draw the panels to a file."""
    import matplotlib as mpl

    mpl.use("Agg")
    import matplotlib.pyplot as plt

    arms = [arm for arm in ARMS if any(results.of("ik one, public", arm.key))]
    sizes = [len(_solvers(results, arm)) for arm in arms]
    left = range(0, len(arms), 2)
    heights = [max(sizes[i : i + 2]) + 1.6 for i in left]
    figure, axes = plt.subplots(
        len(heights),
        2,
        figsize=(10.5, 0.27 * sum(heights) + 0.7),
        sharex=True,
        squeeze=False,
        gridspec_kw={"height_ratios": heights},
    )
    for i, ax in enumerate(axes.flat):
        if i < len(arms):
            _panel(ax, results, arms[i], int(max(sizes[i - i % 2 : i - i % 2 + 2])))
        else:
            ax.axis("off")
    kind = "processor time" if results.busy else "time"
    for ax in axes[-1]:
        ax.set_xlabel(f"{kind} per pose [µs]", fontsize=8.5, color=INK)
        ax.tick_params(axis="x", labelbottom=True)
    figure.suptitle(
        f"●  one pose a call     ◆  batch on {'one thread' if results.busy else 'two threads'}     "
        "%  share of all known solutions found, one: a search for one",
        fontsize=9.5,
        color=INK,
    )
    figure.tight_layout(h_pad=0.6, w_pad=1.5)
    path.parent.mkdir(parents=True, exist_ok=True)
    figure.savefig(path, dpi=140)
    plt.close(figure)


def _solvers(results: Results, arm: Arm) -> list[tuple[Row, Row | None]]:
    """Single and batch rows of each solver of an arm, the fastest first."""
    threads = 1 if results.busy else 2
    batch = {r.contestant: r for r in results.of("ik batch", arm.key) if r.threads == threads}
    pairs = [(r, batch.get(r.contestant)) for r in results.of("ik one, public", arm.key)]
    return sorted(pairs, key=lambda pair: min(r.seconds or 1.0 for r in pair if r))


def _panel(ax: Any, results: Results, arm: Arm, lines: int) -> None:
    solvers = _solvers(results, arm)
    ax.set_xscale("log")
    ax.set_xlim(0.1, 400_000)
    ax.set_ylim(lines - 0.4, -0.7)
    ax.set_yticks(range(len(solvers)), [one.contestant for one, _ in solvers], fontsize=8.5)
    ax.set_title(f"{arm.key.replace('_urdf', ' (URDF)')}: {arm.family}", loc="left", fontsize=9)
    ax.grid(axis="x", which="major", color=FAINT, lw=0.8)
    ax.set_axisbelow(True)
    for side in ("top", "right", "left"):
        ax.spines[side].set_visible(False)
    ax.tick_params(axis="y", length=0)
    ax.tick_params(axis="x", labelsize=8, colors=INK)
    for line, (one, many) in enumerate(solvers):
        mine = one.contestant == OURS
        colour = OWN if mine else PEER
        times = [1e6 * (r.seconds or 0.0) for r in (one, many) if r]
        ax.plot(times, [line] * len(times), color=colour, lw=1.0, alpha=0.5, zorder=1)
        for time, marker in zip(times, "oD", strict=False):
            ax.plot(time, line, marker, ms=6 if marker == "o" else 5.5, color=colour, zorder=2)
        label = ax.get_yticklabels()[line]
        label.set_color(colour if mine else INK)
        label.set_weight("bold" if mine else "normal")
        share, search = one.recall or 0.0, one.extra.get("searches")
        ax.annotate(
            "one" if search else f"{100 * share:.4g} %",
            (1.0, line),
            xycoords=("axes fraction", "data"),
            ha="right",
            va="center",
            fontsize=8,
            color=LOST if share < 0.9 and not search else INK,
        )
