"""``python -m benchmarks.vectorised``: which loops over lanes compilers make vector code of.

The C of each block kernel is compiled for each level of processors; a line says how many of its
loops whose turns are independent became vector instructions, and where others are: in which
function, and the compiler's reason. GCC's report and Clang's, of what is installed; Zig's is
Clang's.
"""

import argparse
import re
import subprocess
import sys
from importlib.util import find_spec
from pathlib import Path
from shutil import which
from tempfile import TemporaryDirectory
from typing import NamedTuple

from benchmarks.compare import table
from dh2urdf.translate.build import FLAGS, LEVELS, texts

KERNELS = ("solve_common_wrist", "solve_common_parallel", "solve_held_blocks", "chain_fk_batch")
"""Spherical wrist, three parallel axes, seven joints of which one is held, forward kinematics."""

GCC = re.compile(r"kernels\.c:(\d+):\d+: (optimized|missed): +(.*)")
CLANG = re.compile(r"kernels\.c:(\d+):\d+: remark: (vectorized loop.*|loop not vectorized.*)")

MARK = "SIDE_BY_SIDE"
"""In the C, the line before a loop whose turns are independent."""


class Loop(NamedTuple):
    """A loop over lanes: in which function, whether it is vector code, why not."""

    function: str
    vectorised: bool
    why: str


def reports(text: str, remarks: list[tuple[int, bool, str]]) -> list[Loop]:
    """What a compiler said of each loop over lanes in some C."""
    lines, function, found = text.splitlines(), "", []
    for number, line in enumerate(lines, 1):
        if begins := re.match(r"(?:static |inline )*\w+ \**(\w+)\(", line):
            function = begins[1]
        if line.strip() != MARK:
            continue
        said = [remark for remark in remarks if number < remark[0] <= number + 2]
        reasons = [why for _, good, why in said if not good and "vectorize" not in why]
        found.append(Loop(function, any(good for _, good, _ in said), "".join(reasons[:1])))
    return found


def compiled(command: list[str], level: str, kernel: str) -> list[Loop]:
    """Loops over lanes of a kernel, by a compiler for a level of processors."""
    of_gcc = command == ["gcc"]
    said = ["-fopt-info-vec-optimized-missed"]
    if not of_gcc:
        said = [f"-Rpass{kind}=loop-vectorize" for kind in ("", "-missed", "-analysis")]
    name = LEVELS[level].replace("-", "_" if "ziglang" in command else "-")
    processor = [f"-march={name}"] if name else []
    with TemporaryDirectory() as folder:
        for file, text in texts([kernel]).items():
            Path(folder, file).write_text(text)
        flags = [*command, *FLAGS, *processor, *said, "-DTABLE=entries", "-c", "kernels.c"]
        told = subprocess.run(flags, check=False, cwd=folder, capture_output=True, text=True)
        text = Path(folder, "kernels.c").read_text()
    if told.returncode:
        raise SystemExit(f"{' '.join(command)}: {told.stderr[-500:]}")
    said_of = (GCC if of_gcc else CLANG).finditer(told.stderr)
    remarks = [(int(m[1]), m[2].startswith(("optimized", "vectorized")), m[0]) for m in said_of]
    short = [(n, good, why.partition(" [-R")[0].rpartition(": ")[2]) for n, good, why in remarks]
    return reports(text, short)


def compilers() -> list[list[str]]:
    """Those that are installed."""
    found = [[name] for name in ("gcc", "clang") if which(name)]
    return [*found, *([[sys.executable, "-m", "ziglang", "cc"]] if find_spec("ziglang") else [])]


def main() -> None:
    """Compile and print a table."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.vectorised", description=__doc__)
    parser.add_argument("kernels", nargs="*", default=KERNELS)
    given = parser.parse_args()
    rows = []
    for kernel in given.kernels:
        for command in compilers():
            for level in LEVELS:
                loops = compiled(command, level, kernel)
                left = {f"{one.function}: {one.why}": None for one in loops if not one.vectorised}
                done = sum(one.vectorised for one in loops)
                rows.append([kernel, command[-2 if "ziglang" in command else 0], level])
                rows[-1] += [f"{done} of {len(loops)}", "; ".join(left)]
    print(table(["kernel", "compiler", "for", "vector code", "not"], rows))


if __name__ == "__main__":
    main()
