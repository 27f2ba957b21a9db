"""Inputs for a door: the corpus, then seeds with edits; what is found is kept small."""

import hashlib
import tempfile
from pathlib import Path
from typing import NamedTuple

from hypothesis import HealthCheck, Phase, given, seed, settings

from tests.fuzz.door import CORPUS, Door
from tests.fuzz.guard import watched


class Run(NamedTuple):
    """What a drive of a door was."""

    door: str
    way: str
    inputs: int
    seed: int
    seconds: float
    found: str


def attempt(door: Door, data: bytes) -> None:
    """One input, in a new folder, under guard."""
    with tempfile.TemporaryDirectory(prefix="fuzz-") as name, watched(Path(name)):
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


def keep(door: str, data: bytes) -> Path:
    """Put an input into the corpus, named by what it holds."""
    folder = CORPUS / door
    folder.mkdir(parents=True, exist_ok=True)
    path = folder / f"found-{hashlib.sha256(data).hexdigest()[:8]}"
    path.write_bytes(data)
    return path
