"""Some kernels as WebAssembly, for pages: clang and lld suffice, there is no library below it.

It asks for ``js.fmod``, which is ``(x, y) => x % y``. It exports its memory, ``__heap_base`` from
where on that is free, and the table of the kernels, ``entries``: at that address stands ``leave``,
then one number for each kernel, by which ``__indirect_function_table`` has it. Arguments are those
of the C function: lengths, numbers, addresses of arrays.
"""

import shutil
import subprocess
from pathlib import Path
from tempfile import TemporaryDirectory

from dh2urdf.translate.c_file import CFile
from dh2urdf.translate.entries import argument_types, entries

FLAGS = ["--target=wasm32", "-mbulk-memory", "-std=c99", "-O2", "-ffreestanding", "-nostdlib"]
FLAGS += ["-ffp-contract=off", "-fno-math-errno", "-fno-trapping-math", "-w", "-DTABLE=entries"]

STACK = 256 * 1024
"""Bytes of the stack; the largest kernel, the general 6R solver, keeps its arrays in its record."""

LINKED = ["--no-entry", "--export-table", "--strip-all", "--stack-first", f"-z,stack-size={STACK}"]
LINKED += [f"--export={name}" for name in ("entries", "__heap_base")]

HEADERS = {
    "math.h": ("fabs", "sqrt", "floor", "ceil", "rint", "copysign"),
    "string.h": ("memcpy", "memset", "memmove"),
}
"""What kernels take of C's library: each is an instruction."""

MORE = """\
#define INFINITY __builtin_inf()
#define NAN __builtin_nan("")
__attribute__((import_module("js"), import_name("fmod"))) double fmod(double x, double y);
"""
"""The rest of ``math.h``; JavaScript's ``x % y`` is C's remainder."""


def compiler() -> str | None:
    """The compiler, if it and its linker are there."""
    return shutil.which("clang") if shutil.which("wasm-ld") else None


def wasm(names: list[str]) -> tuple[bytes, list[str]]:
    """The module of the entries of some names, and the names in the order of the table.

    Raises
    ------
    RuntimeError
        No compiler.
    """
    clang = compiler()
    if clang is None:
        raise RuntimeError("no compiler for WebAssembly: install clang and lld")
    file = CFile()
    for name, function in entries().items():
        if name.rpartition(".")[2] in names:
            file.add_entry(function, argument_types(function))
    with TemporaryDirectory() as folder:
        place = Path(folder)
        for header, taken in HEADERS.items():
            lines = [f"#define {name} __builtin_{name}\n" for name in taken]
            lines += [MORE] if header == "math.h" else []
            place.joinpath(header).write_text("".join(lines))
        place.joinpath("kernels.h").write_text(file.header())
        place.joinpath("kernels.c").write_text(file.kernels())
        linked = [f"-Wl,{option}" for option in LINKED]
        words = [clang, *FLAGS, "-isystem", ".", *linked, "kernels.c", "-o", "kernels.wasm"]
        subprocess.run(words, cwd=folder, check=True)
        return place.joinpath("kernels.wasm").read_bytes(), [e.function for e in file.entries]
