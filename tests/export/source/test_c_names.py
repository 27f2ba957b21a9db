"""A C file stands beside whatever else is in a program: macros, other arms, other files."""

import shutil
import string
import subprocess

import pytest

from dh2urdf import Robot, export_solver
from tests.export.source.compiled import COMPILERS, STRICT

STANDARD = "".join(f"#include <{name}.h>\n" for name in ("math", "stdbool", "stdint", "string"))

LETTERS = "".join(f"#define {x} 7\n" for x in string.ascii_letters if x != "q")
"""All but the one that is a field of solutions."""

MACROS = f"""{STANDARD}{LETTERS}
#define pi 3.14
#define PI 3.14
#define TWO_PI 6.28
#define EPS 1
#define ACCEPT 1
#define POSE 1
#define HEAD 1
#define near
#define far
#define small char
#define min(x, y) ((x) < (y) ? (x) : (y))
#define max(x, y) ((x) > (y) ? (x) : (y))
#define abs(x) ((x) < 0 ? -(x) : (x))
#define swap 1
#define found 1
#define pose 1
#define seed 1
#define held 1
#define work 1
#define within_limits 1
#define f0 1
"""
"""What programs and operating systems define; ``windows.h`` has ``near``, ``far`` and ``small``."""

ARMS = {"puma560": None, "ur5": None, "xarm6": None, "px100": None, "franka_fer": 6}


def has(compiler):
    """A mark that a compiler is needed."""
    missing = shutil.which(COMPILERS[compiler][0]) is None
    return pytest.param(compiler, marks=pytest.mark.skipif(missing, reason=f"no {compiler}"))


COMPILED = [has(compiler) for compiler in COMPILERS]


def compiles(folder, name, compiler, *flags):
    """Compile a file of a folder without a warning."""
    command = [*COMPILERS[compiler], *STRICT, *flags, name]
    done = subprocess.run(command, cwd=folder, check=False, capture_output=True, text=True)
    assert not done.returncode, done.stderr[:4000]


@pytest.mark.parametrize("compiler", COMPILED)
@pytest.mark.parametrize("name", ARMS)
def test_macros_of_a_program_change_nothing(name, compiler, tmp_path):
    """All letters, and words that programs define, may be macros before the file is included."""
    export_solver(Robot.from_dh(name), tmp_path / "arm.h", prefix="left_arm", held=ARMS[name])
    text = f'{MACROS}#include "arm.h"\nint main(void) {{ return 0; }}\n'
    (tmp_path / "main.c").write_text(text)
    compiles(tmp_path, "main.c", compiler, "-fsyntax-only")


USES = """
#include "left.h"
#include "right.h"

int {name}(const double *T)
{{
    left_solutions some;
    right_solutions others;
    return left_ik(T, true, &some) + right_ik(T, true, &others);
}}
"""


@pytest.mark.parametrize("compiler", COMPILED)
def test_two_arms_stand_in_two_files_of_one_program(compiler, tmp_path):
    """Both headers are included in both files, which are linked."""
    for name, arm in (("left", "puma560"), ("right", "ur5")):
        export_solver(Robot.from_dh(arm), tmp_path / f"{name}.h", prefix=name)
    (tmp_path / "one.c").write_text(USES.format(name="one"))
    main = "int one(const double *T);\nint main(void)\n{\n    const double T[16] = {0};\n"
    main += "    return one(T) == two(T) && one(T) == -2 ? 0 : 1;\n}\n"
    (tmp_path / "two.c").write_text(USES.format(name="two") + main)
    compiles(tmp_path, "one.c", compiler, "two.c", "-lm", "-o", "both")
    assert subprocess.run(["./both"], cwd=tmp_path, check=False).returncode == 0


@pytest.mark.parametrize("compiler", [has("g++"), has("clang++")])
def test_a_file_stands_in_a_namespace(compiler, tmp_path):
    """After the headers that it includes it may be a part of a namespace of C++."""
    export_solver(Robot.from_dh("xarm6"), tmp_path / "arm.hpp", prefix="arm")
    text = f'{STANDARD}namespace left {{\n#include "arm.hpp"\n}}\n'
    text += "int main() { return sizeof(left::arm_solutions) == 0; }\n"
    (tmp_path / "main.cpp").write_text(text)
    compiles(tmp_path, "main.cpp", compiler, "-fsyntax-only")


@pytest.mark.skipif(shutil.which("clang") is None, reason="no clang")
@pytest.mark.parametrize("name", ARMS)
def test_nothing_is_written_that_microsofts_compiler_does_not_know(name, tmp_path):
    """No arrays of variable length, no extension, in the dialect of that compiler."""
    export_solver(Robot.from_dh(name), tmp_path / "arm.h", prefix="arm", held=ARMS[name])
    (tmp_path / "main.c").write_text('#include "arm.h"\nint main(void) { return 0; }\n')
    dialect = ("-fms-compatibility", "-fms-extensions", "-Wvla", "-Wno-literal-range")
    compiles(tmp_path, "main.c", "clang", *dialect, "-fsyntax-only")
    assert "_Complex" not in (tmp_path / "arm.h").read_text()
