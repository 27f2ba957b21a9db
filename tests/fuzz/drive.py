"""Inputs for a door: the corpus, then seeds with edits; what is found is kept small."""

import hashlib
import os
import random
import shutil
import tempfile
from pathlib import Path
from typing import NamedTuple

from hypothesis import HealthCheck, Phase, given, seed, settings

from tests.fuzz.door import CORPUS, Door, Edit, edited, some_edits
from tests.fuzz.guard import MEMORY, watched


class Run(NamedTuple):
    """What a drive of a door was."""

    door: str
    way: str
    inputs: int
    seed: int
    seconds: float
    found: str


PLACE = MEMORY if os.access(MEMORY, os.W_OK) else None
"""Where folders for inputs are made."""

POOL = 1000
"""Inputs with a shape of their own that a drive at random begins with."""


def attempt(door: Door, data: bytes) -> None:
    """One input, in a new folder, under guard."""
    with tempfile.TemporaryDirectory(prefix="fuzz-", dir=PLACE) as name, watched(Path(name)):
        door.enter(data, Path(name))


def properties(door: Door, inputs: int, start: int) -> int:
    """Try so many inputs with one seed: how many were tried; what fails is raised, made small."""
    tried = 0
    phases = [Phase.generate, Phase.shrink]
    quiet = settings(
        max_examples=inputs,
        deadline=None,
        suppress_health_check=list(HealthCheck),
        database=None,
        derandomize=False,
        phases=phases,
        print_blob=False,
        report_multiple_bugs=False,
    )

    @seed(start)
    @quiet
    @given(data=door.inputs())
    def each(data: bytes) -> None:
        nonlocal tried
        tried += 1
        last[0] = data
        attempt(door, data)

    last = [b""]
    try:
        each()
    except BaseException as error:
        error.add_note(f"{door.name}: {last[0]!r}")
        error.smallest = last[0]  # type: ignore[attr-defined]
        raise
    return tried


def at_random(door: Door, inputs: int, start: int) -> int:
    """The same without Hypothesis, which takes longer than most doors do for an input.

    Each input is a start, or one of some with a shape, with a few edits; where one fails, edits
    are left out as long as it still does.
    """
    rng, words, starts = random.Random(start), door.tokens, [door.starts]
    if door.shaped is not None:
        starts.append(shaped(door, min(POOL, inputs), start))
    folder = Path(tempfile.mkdtemp(prefix="fuzz-", dir=PLACE))
    try:
        for _ in range(inputs):
            text, edits = rng.choice(rng.choice(starts)), some_edits(rng, words)
            try:
                with watched(folder):
                    door.enter(edited(text, edits), folder)
            except BaseException as error:
                least = edited(text, fewer(door, text, edits))
                error.add_note(f"{door.name}: {least!r}")
                error.smallest = least  # type: ignore[attr-defined]
                raise
    finally:
        shutil.rmtree(folder)
    return inputs


def shaped(door: Door, count: int, start: int) -> list[bytes]:
    """Inputs of a door's own making."""
    made: list[bytes] = []
    quiet = settings(max_examples=count, database=None, phases=[Phase.generate], deadline=None)

    @seed(start)
    @quiet
    @given(data=door.shaped)
    def each(data: bytes) -> None:
        made.append(data)

    each()
    return made


def fewer(door: Door, text: bytes, edits: list[Edit]) -> list[Edit]:
    """The edits without those that a failure does not need."""
    for k in reversed(range(len(edits))):
        less = edits[:k] + edits[k + 1 :]
        try:
            attempt(door, edited(text, less))
        except Exception:
            edits = less
    return edits


def keep(door: str, data: bytes) -> Path:
    """Put an input into the corpus, named by what it holds."""
    folder = CORPUS / door
    folder.mkdir(parents=True, exist_ok=True)
    path = folder / f"found-{hashlib.sha256(data).hexdigest()[:8]}"
    path.write_bytes(data)
    return path
