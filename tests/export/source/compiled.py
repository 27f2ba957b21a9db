"""Exported C files compiled and run: solutions of many poses as arrays."""

import subprocess
from pathlib import Path

import numpy as np

from dh2urdf.export.source import exported

MAIN = """
#include "{name}"

#include <stdio.h>

int main(int argc, char **argv)
{{
    FILE *in = fopen(argv[1], "rb"), *out = fopen(argv[2], "wb");
    double line[16 + 1 + {n}], T[16], J[6 * {n}];
    arm_solutions found;
    {prepare}
    if (argc != 3 || !in || !out) {{
        return 1;
    }}
    memset(&found, 0, sizeof found);
    while (fread(line, sizeof line, 1, in) == 1) {{
        const double *q = line + 17;
        arm_fk(q, T);
        arm_jacobian(q, J);
        fwrite(T, sizeof T, 1, out);
        fwrite(J, sizeof J, 1, out);
        arm_ik(line, {held}true, {work}&found);
        fwrite(&found, sizeof found, 1, out);
        arm_ik(line, {held}false, {work}&found);
        fwrite(&found, sizeof found, 1, out);
        arm_ik_near(line, {held}q, true, {work}&found);
        fwrite(&found, sizeof found, 1, out);
    }}
    return fclose(in) || fclose(out);
}}
"""

STRICT = ("-Wall", "-Wextra", "-Werror", "-pedantic")

COMPILERS = {
    "gcc": ("gcc", "-std=c99"),
    "g++": ("g++", "-std=c++17", "-xc++"),
    "clang": ("clang", "-std=c99"),
    "clang++": ("clang++", "-std=c++17", "-xc++"),
}


class Arm:
    """The file of a robot, written to a folder."""

    def __init__(self, robot, folder, held=None):
        self.robot, self.folder, self.held = robot, Path(folder), held
        self.made = exported(robot, language="c", prefix="arm", held=held)
        Path(folder, "arm.h").write_text(self.made.text)
        given = "line[16], " if held is not None else ""
        needs = "arm_prepare(" in self.made.text
        prepare = "static arm_workspace work;\n    arm_prepare(&work);" if needs else ""
        work = "&work, " if needs else ""
        main = MAIN.format(name="arm.h", n=robot.n, held=given, prepare=prepare, work=work)
        Path(folder, "main.c").write_text(main)
        k, n = self.made.solutions, robot.n
        fields = [("count", "i8"), ("q", "f8", (k, n)), ("residual", "f8", k), ("branch", "i8", k)]
        one = np.dtype([*fields, ("free", "i8", k), ("complete", "?")], align=True)
        self.line = np.dtype(
            [("T", "f8", (4, 4)), ("J", "f8", (6, n)), ("inside", one), ("any", one), ("near", one)]
        )

    def compile(self, *flags, compiler="gcc"):
        """Compile it without a warning."""
        command = [*COMPILERS[compiler], *STRICT, *flags, "main.c", "-o", "main", "-lm"]
        done = subprocess.run(command, check=False, cwd=self.folder, capture_output=True, text=True)
        assert not done.returncode, done.stderr[:4000]

    def run(self, q, Ts=None):
        """What it answers at the poses of configurations (m, n), or at other poses."""
        Ts = self.robot.fk(q) if Ts is None else Ts
        held = q[:, self.held or 0]
        lines = np.concatenate([Ts.reshape(-1, 16), held[:, None], q], axis=1)
        lines.tofile(self.folder / "in")
        command = ["./main", "in", "out"]
        done = subprocess.run(command, check=False, cwd=self.folder, capture_output=True, text=True)
        assert not done.returncode, done.stderr[:4000]
        return np.fromfile(self.folder / "out", self.line)


def configurations(robot, rng, m):
    """Configurations (m, n) within the limits: any, multiples of 45 degrees, and beside them."""
    low, high = robot.bounded(1.0, np.pi)
    q = rng.uniform(low, high, (m, robot.n))
    grid = np.pi / 4.0 * np.round(q / (np.pi / 4.0))
    beside = grid + 10.0 ** rng.uniform(-9.0, -2.0, q.shape) * rng.choice([-1, 1], q.shape)
    kind = np.arange(m)[:, None] % 3
    some = ~robot.slides & (rng.random(q.shape) < 0.6)
    q = np.where(some & (kind == 1), grid, np.where(some & (kind == 2), beside, q))
    return np.clip(q, low, high)


def edges(robot, rng, m):
    """Configurations (m, n) at multiples of 90 degrees, with joints at limits, at home, beside."""
    low, high = robot.bounded(1.0, np.pi)
    q = rng.uniform(low, high, (m, robot.n))
    square = 0.5 * np.pi * np.round(q / (0.5 * np.pi))
    limit = np.where(rng.random(q.shape) < 0.5, low, high)
    kind, other = np.arange(m)[:, None] % 6, rng.random(q.shape) < 0.4
    turned = np.where(robot.slides, q, square)
    at = np.where(kind % 3 == 0, turned, np.where(kind % 3 == 1, np.where(other, limit, q), 0.0))
    at[2::3] = np.where(other[2::3], turned[2::3], 0.0)
    beside = at + 1e-9 * rng.choice([-1, 1], q.shape)
    return np.clip(np.where(kind < 3, at, beside), low, high)
