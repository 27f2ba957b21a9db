"""A door driven by what its inputs cover, by Atheris: ``python -m tests.fuzz.guided``.

Arguments: the door, a folder for inputs that cover something new, and options of libFuzzer. Inputs
that break the door go to its corpus, one for each place where it broke.
"""

import random
import sys
import traceback
from pathlib import Path

import atheris

sys.path.insert(0, str(Path(__file__).parents[1] / "helpers"))

with atheris.instrument_imports(include=["dh2urdf"]):
    from tests.fuzz.doors import DOORS

from tests.fuzz.door import edited, some_edits
from tests.fuzz.drive import attempt, keep

NAME = sys.argv.pop(1)
DOOR = DOORS[NAME]
TOKENS = DOOR.tokens
BROKEN: set[str] = set()


def one(data: bytes) -> None:
    """Try an input; tell of it the first time that it breaks somewhere."""
    try:
        attempt(DOOR, data)
    except KeyboardInterrupt:
        raise
    except BaseException as error:
        last = traceback.extract_tb(error.__traceback__)[-1]
        place = f"{type(error).__name__} at {last.filename}:{last.lineno}"
        if place not in BROKEN:
            BROKEN.add(place)
            print(f"BROKEN {keep(NAME, data)}: {place}: {error!s:.300}", flush=True)


def changed(data: bytes, most: int, seed: int) -> bytes:
    """By edits of values and lines, or of bytes as libFuzzer does it."""
    rng = random.Random(seed)
    if rng.random() < 0.3:
        return atheris.Mutate(data, most)
    return edited(data, some_edits(rng, TOKENS))[:most]


atheris.Setup(sys.argv, one, custom_mutator=changed)
atheris.Fuzz()
