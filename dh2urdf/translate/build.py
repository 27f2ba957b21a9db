"""Translate the kernels and compile them into the package: what an installation runs.

``python -m dh2urdf.translate.build`` does it in place; with the name of a kernel it prints the C.
"""

import os
import platform
import shutil
import subprocess
import sys
import sysconfig
from concurrent.futures import ThreadPoolExecutor
from functools import partial
from importlib.util import find_spec
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np

from dh2urdf import engine
from dh2urdf.translate.c_file import CFile
from dh2urdf.translate.entries import argument_types, doors, entries

FLAGS = ["-std=c99", "-O3", "-ffp-contract=off", "-fno-math-errno", "-fno-trapping-math", "-fPIC"]
FLAGS += ["-fno-tree-slp-vectorize"]
"""Contraction and whatever else reorders arithmetic stays off: all machines get the same bits.

GCC 12 fuses products with sums all the same (``vfmaddsub``) where it vectorizes straight lines.
"""

GROWTH = ["--param=inline-unit-growth=80", "-Wno-unused-command-line-argument"]
"""By how many per cent GCC may let the kernels grow as functions become parts of their callers.

By 40, as it is by itself, the last ones stay out: one call more in any kernel made others slower by
a quarter. Clang passes over it.
"""

LEVELS = {"v4": "x86-64-v4", "v3": "x86-64-v3", "any": "x86-64"}
"""Processors, best first, as compilers call them; what they must have is in ``doors.c``."""

if platform.machine() not in ("x86_64", "AMD64"):
    LEVELS = {"any": ""}

PLACE = Path(__file__).parent.parent / "_kernels.abi3.so"
"""Where the extension belongs."""


def compiler() -> list[str]:
    """The system's C compiler, or the one that comes as a wheel."""
    for name in ("cc", "gcc", "clang"):
        if path := shutil.which(name):
            return [path]
    if not find_spec("ziglang"):
        raise RuntimeError("no C compiler: there is no cc, gcc or clang, nor the package ziglang")
    return [sys.executable, "-m", "ziglang", "cc"]


def texts(names: list[str] | None = None) -> dict[str, str]:
    """The C files of all entries, or of some, by their names."""
    file = CFile()
    for name, function in entries().items():
        if names is None or name.rpartition(".")[2] in names:
            file.add_entry(function, argument_types(function))
    return {"kernels.h": file.header(), "kernels.c": file.kernels(), "doors.h": doors(file)}


def build(target: Path = PLACE) -> None:
    """Compile the extension to a file, which appears whole or not at all."""
    cc, include = compiler(), [f"-I{sysconfig.get_paths()['include']}", f"-I{np.get_include()}"]
    with TemporaryDirectory() as folder:
        for name, text in texts().items():
            Path(folder, name).write_text(text)
        sources = f'-DSOURCES="{engine.fingerprint()}"'
        doors_c = str(Path(__file__).with_name("doors.c"))
        jobs = [[*_processor("any", cc), sources, "-I.", *include, doors_c, "-o", "doors.o"]]
        for level in LEVELS:
            flags = [*_processor(level, cc), f"-DTABLE=entries_{level}", *GROWTH]
            jobs.append([*flags, "kernels.c", "-o", f"{level}.o"])
        run = partial(subprocess.run, cwd=folder, check=True)
        with ThreadPoolExecutor() as pool:
            list(pool.map(run, [[*cc, *FLAGS, "-c", *job] for job in jobs]))
        objects = [job[-1] for job in jobs]
        run([*cc, "-shared", "-s", *objects, "-o", "built.so", "-lm"])
        whole = target.with_suffix(".partial")
        shutil.copy(Path(folder, "built.so"), whole)
        whole.replace(target)


def _processor(level: str, cc: list[str]) -> list[str]:
    """A compiler's options for a level, if it has any; zig spells names its own way.

    Clang, unlike GCC, uses half of v4's vectors unless it is told to use them whole.
    """
    name = LEVELS[level].replace("-", "_" if "ziglang" in cc else "-")
    whole = ["-mprefer-vector-width=512"] if level == "v4" else []
    return [f"-march={name}", *whole] if name else []


if __name__ == "__main__":
    os.environ["DH2URDF_ENGINE"] = "python"
    if sys.argv[1:]:
        print(texts(sys.argv[1:])["kernels.c"])
    else:
        build()
