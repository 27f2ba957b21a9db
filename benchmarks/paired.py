"""``python -m benchmarks.paired REVISION``: this tree against another revision of it, in turns.

Both solve the same poses in processes of their own that run alternately; ratios of processor
times, medians over the rounds, are ours over the revision's: below 1 is faster. The processor time
of an arm's first process up to its first answers stands beside, and the size of the machine code.

Both are compiled for this; kernels of a revision that has Numba (it must be installed) compile in
the first process, with an empty cache.
"""

import argparse
import json
import os
import subprocess
import sys
import tarfile
from io import BytesIO
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np

from benchmarks.apart import ROOT
from benchmarks.compare import table

ARMS = {
    "puma560": "spherical wrist",
    "stanford": "spherical wrist",
    "ur5": "three parallel axes",
    "fanuc_crx10ia": "two parallel axes",
    "franka_fer": "seven joints, one held",
    "kuka_iiwa14": "seven joints, swept",
    "planar_rr": "planar",
    "omron_cobra600": "SCARA",
}
CHILD = """
import json, sys, time
import numpy as np
import dh2urdf
name, batch, single = sys.argv[1], int(sys.argv[2]), int(sys.argv[3])
begin = time.process_time()
robot = dh2urdf.Robot.from_dh(name)
how = {"locked": {robot.n - 1: 0.3}} if name == "franka_fer" else {}
q = np.random.default_rng(1).uniform(-2.0, 2.0, (batch, robot.n))
q[:, list(how.get("locked", ()))] = 0.3
poses = robot.fk(q)
found = robot.ik_batch(poses[:64], within_limits=False, threads=1, **how)
robot.ik(poses[0], within_limits=False, **how)
first, times = time.process_time() - begin, []
robot.ik_numeric(poses[0], solutions=4, rng=0, within_limits=False)
for rounds in range(5):
    a = time.process_time()
    found = robot.ik_batch(poses, within_limits=False, threads=1, **how)
    b = time.process_time()
    for T in poses[:single]:
        robot.ik(T, within_limits=False, **how)
    c = time.process_time()
    for T in poses[:20]:
        robot.ik_numeric(T, solutions=4, rng=0, within_limits=False)
    times.append(((b - a) / batch, (c - b) / single, (time.process_time() - c) / 20))
print(json.dumps({"first": first, "times": times}))
"""


def main() -> None:
    """Measure and print a table."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.paired", description=__doc__)
    parser.add_argument("revision", help="what git knows it by")
    parser.add_argument("--rounds", type=int, default=7)
    parser.add_argument("--poses", type=int, default=20_000)
    given = parser.parse_args()
    with TemporaryDirectory() as folder:
        other = Path(folder, "other")
        archive = subprocess.check_output(["git", "archive", given.revision], cwd=ROOT)
        with tarfile.open(fileobj=BytesIO(archive)) as tar:
            tar.extractall(other, filter="data")
        for tree in (ROOT, other):
            _build(tree)
        rows = [_row(name, other, Path(folder), given) for name in ARMS]
    head = ["arm", "class", "batch", "one call", "search", "first answer", "code"]
    print(table(head, rows))


def _build(tree: Path) -> None:
    """Compile the kernels of a tree, where it has a translator for them."""
    if (tree / "dh2urdf" / "translate").is_dir():
        words = [sys.executable, "-m", "dh2urdf.translate.build"]
        subprocess.run(words, env={**os.environ, "DH2URDF_ENGINE": "python"}, cwd=tree, check=True)


def _code(tree: Path, cache: Path) -> int:
    """Bytes of machine code: of the extension, or of what Numba has put into its cache."""
    extension = tree.glob("dh2urdf/_kernels*.so")
    return sum(path.stat().st_size for path in (*extension, *cache.rglob("*.nbc")))


def _row(name: str, other: Path, folder: Path, given: argparse.Namespace) -> list[str]:
    """What both need for an arm, and their ratios."""
    poses = given.poses // (20 if "6R" in ARMS[name] or "swept" in ARMS[name] else 1)
    sides = {"now": ROOT, "then": other}
    found: dict[str, list[dict]] = {side: [] for side in sides}
    for number in range(given.rounds + 1):
        for side in sorted(sides, reverse=number % 2 == 1):
            environment = {**os.environ, "PYTHONPATH": str(sides[side])}
            environment["DH2URDF_ENGINE"] = "compiled"
            environment["NUMBA_CACHE_DIR"] = str(folder / f"{side} {name}")
            words = [sys.executable, "-c", CHILD, name, str(poses), str(min(poses, 1000))]
            run = subprocess.run(
                words, env=environment, cwd=folder, capture_output=True, text=True, check=True
            )
            found[side].append(json.loads(run.stdout))
    times = {side: [np.min(f["times"], axis=0) for f in found[side][1:]] for side in sides}
    ratio = np.median(np.array(times["now"]) / np.array(times["then"]), axis=0)
    ours = np.median(times["now"], axis=0)
    code = {side: _code(sides[side], folder / f"{side} {name}") / 1e6 for side in sides}
    return [
        name,
        ARMS[name],
        *(f"{1e6 * t:.3g} us, {r:.3f}" for t, r in zip(ours, ratio, strict=True)),
        f"{found['then'][0]['first']:.1f} s -> {found['now'][0]['first']:.1f} s",
        f"{code['then']:.2f} MB -> {code['now']:.2f} MB",
    ]


if __name__ == "__main__":
    main()
