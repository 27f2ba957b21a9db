"""Run tests on kernels with marks: ``python -m tests.marked DIRECTORY [PATH...] [--missed]``.

The repository is copied into the directory, where kernels are compiled that mark each statement
that runs and each index outside its array, and then the tests of the paths run, by default the
default suite. What they marked is added to the directory's ``marks`` and told; with ``--told``
nothing runs. Ends with 1 where an index was outside, where floating-point errors were elsewhere
than they may be, and where fewer lines were reached than ``--least`` says.
"""

import argparse
import json
import os
import shutil
import subprocess
import sys
import sysconfig
from collections import Counter
from datetime import UTC, datetime
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np
from numpy.typing import NDArray

from benchmarks.machine import commit
from tests.marked.may import MAY
from tests.marked.python import mark_modules
from tests.marked.written import KINDS, Place, statements, texts

ROOT = Path(__file__).parents[2]
PAGE, MARK = Path(__file__).with_name("README.md"), "<!-- run -->\n"

FLAGS = ["-std=gnu99", "-O1", "-ffp-contract=off", "-fno-math-errno", "-fPIC", "-w", "-shared"]
FLAGS += ["-fsanitize=signed-integer-overflow,shift,integer-divide-by-zero,float-cast-overflow"]
"""What the compiler checks beside: its messages go to files ``undefined.*``."""

ERRORS = "outside", "invalid", "divided", "overflow"
"""After whether a statement ran, what its mark holds."""


def copied(place: Path) -> None:
    """The files of the repository as they are, without what is built."""
    words = ["git", "ls-files", "-z", "--cached", "--others", "--exclude-standard"]
    listed = subprocess.run(words, cwd=ROOT, capture_output=True, check=True)
    for name in filter(None, listed.stdout.decode().split("\0")):
        if not (ROOT / name).exists():
            continue
        (place / name).parent.mkdir(parents=True, exist_ok=True)
        shutil.copy2(ROOT / name, place / name, follow_symlinks=False)


def compiled(place: Path) -> list[Place]:
    """Write the extension with marks into a copy of the package."""
    from dh2urdf import engine
    from dh2urdf.translate.build import compiler

    written, marks = texts()
    include = [f"-I{sysconfig.get_paths()['include']}", f"-I{np.get_include()}", "-I."]
    same = ["-Wl,--defsym=entries_v3=entries_any", "-Wl,--defsym=entries_v4=entries_any"]
    with TemporaryDirectory() as folder:
        for name, text in written.items():
            Path(folder, name).write_text(text)
        sources = [f'-DSOURCES="{engine.fingerprint()}"', "-DTABLE=entries_any"]
        files = ["kernels.c", str(ROOT / "dh2urdf/translate/doors.c"), "-o", "built.so", "-lm"]
        subprocess.run(
            [*compiler(), *FLAGS, *include, *sources, *files, *same], cwd=folder, check=True
        )
        shutil.copy(Path(folder, "built.so"), place / "dh2urdf/_kernels.abi3.so")
    return marks


def prepared(place: Path, modules: str | None = None) -> None:
    """A copy with its kernels, and marks that nothing has reached; of Python modules, too."""
    copied(place)
    marks = compiled(place)
    if modules:
        mark_modules(place / "dh2urdf", modules, marks)
    (place / "places.json").write_text(json.dumps(marks))
    (place / "commit").write_text(commit())
    (place / "marks").write_bytes(bytes(KINDS * len(marks)))


def run(place: Path, words: list[str]) -> int:
    """Run pytest there."""
    keys = {
        "PYTHONPATH": str(place),
        "KERNEL_MARKS": str(place / "marks"),
        "DH2URDF_ENGINE": "compiled",
        "UBSAN_OPTIONS": f"log_path={place}/undefined",
    }
    command = [sys.executable, "-m", "pytest", "-q", "-p", "no:cacheprovider", *words]
    return subprocess.run(command, cwd=place, env=os.environ | keys, check=False).returncode


def marked(place: Path, count: int) -> tuple[NDArray[np.bool_], dict[tuple[int, int], str]]:
    """What was marked of each place, and a test that marked an error, by place and kind.

    What each test marked counts, too: of a run that was cut off nothing else may be left.
    """
    seen = np.frombuffer((place / "marks").read_bytes(), bool).reshape(count, KINDS).copy()
    tests: dict[tuple[int, int], str] = {}
    for row in each(place):
        seen[row["reached"], 0] = True
        for k, kind in row["errors"]:
            seen[k, 1 + kind] = True
            tests.setdefault((k, kind), row["test"])
    return seen, tests


def each(place: Path) -> list[dict[str, Any]]:
    """What the plugin ``each`` wrote, a test that ran twice once."""
    path = place / "each.jsonl"
    rows = map(json.loads, path.read_text().splitlines()) if path.exists() else ()
    return list({row["test"]: row for row in rows}.values())


def told(place: Path, *, missed: bool, record: bool) -> tuple[float, int]:
    """Print what was marked; the share of lines that ran, and how many errors must not be."""
    places = [Place(*row) for row in json.loads((place / "places.json").read_text())]
    seen, tests = marked(place, len(places))
    reached = {p for p, row in zip(places, seen, strict=True) if row[0]}
    functions = {(p.file, p.function) for p in places}
    whole = statements(place / "dh2urdf/kernels")
    every = [p for p in whole if (p.file, p.function) in functions]
    print("not compiled:", *sorted({f"{p.file}:{p.function}" for p in {*whole} - {*every}}))
    left = [p for p in every if p not in reached]
    count, lost = Counter(p.file for p in every), Counter(p.file for p in left)
    for file in lost:
        print(f"{file}: {count[file] - lost[file]} of {count[file]}")
        if missed:
            print(*(f"  {p.function}:{p.line}" for p in left if p.file == file), sep="\n")
    wrong = 0
    for kind, column in zip(ERRORS, seen.T[1:], strict=True):
        for k in np.flatnonzero(column[1:]) + 1:
            may = kind in MAY.get(f"{places[k].file} {places[k].function}", "")
            wrong += not may
            at = f"{places[k].file}:{places[k].line} {places[k].function}"
            by = tests.get((int(k), ERRORS.index(kind)), "")
            print(f"{kind}{' (may be)' * may}: {at} {by}")
    for path in sorted(place.glob("undefined.*")):
        wrong += 1
        print(path.read_text())
    share = 1 - len(left) / len(every)
    counts = [
        f"{int(column.sum())} {kind}" for kind, column in zip(ERRORS, seen.T[1:], strict=True)
    ]
    line = f"{len(every) - len(left)} of {len(every)} lines, {share:.1%}; {', '.join(counts)}"
    print(line)
    if record:
        made = f"- {datetime.now(UTC):%Y-%m-%d}, commit {(place / 'commit').read_text()}, "
        text, _, runs = PAGE.read_text().partition(MARK)
        kept = [run for run in runs.splitlines() if not run.startswith(made)]
        runs = "\n".join([f"{made}{len(each(place)) or 'all'} tests: {line}", *kept])
        PAGE.write_text(f"{text}{MARK}{runs}\n")
    return share, wrong


def main() -> int:
    """Prepare, run, tell."""
    parser = argparse.ArgumentParser(prog="python -m tests.marked", description=__doc__)
    parser.add_argument("place", type=Path)
    parser.add_argument("--missed", action="store_true", help="list lines that were not reached")
    parser.add_argument("--told", action="store_true", help="only tell what was marked before")
    parser.add_argument("--record", action="store_true", help="write the figures into README.md")
    parser.add_argument("--modules", help="folder of Python modules that mark their lines, too")
    parser.add_argument("--least", type=float, default=0.0, help="1 below this share")
    asked, words = parser.parse_known_args()
    if not (asked.place / "marks").exists():
        prepared(asked.place.resolve(), asked.modules)
    status = 0 if asked.told else run(asked.place.resolve(), words)
    share, wrong = told(asked.place, missed=asked.missed, record=asked.record)
    return int(share < asked.least or wrong > 0 or status > 1)


if __name__ == "__main__":
    sys.exit(main())
