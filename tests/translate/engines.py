"""The forms of the kernels that have to agree: compilers, their flags, what runs their programs."""

import shutil
from importlib.util import find_spec
from pathlib import Path
from sys import executable

import pytest

from dh2urdf.translate.build import FLAGS
from tests.translate import replay
from tests.translate.record import Call

NODE = (
    "const fs = require('fs'), { WASI } = require('wasi');"
    "const wasi = new WASI({ version: 'preview1', returnOnExit: true });"
    "const code = new WebAssembly.Module(fs.readFileSync(process.argv[1]));"
    "const made = new WebAssembly.Instance(code, wasi.getImportObject());"
    "process.exit(wasi.start(made));"
)
"""Runs a program for WASI."""

STRICT = "-g -fno-sanitize-recover=all -fsanitize"

TABLE = {
    "gcc -O0": ("gcc", "-O0", ""),
    "gcc -O2": ("gcc", "-O2", ""),
    "gcc -O3": ("gcc", "-O3", ""),
    "gcc -O3 v3": ("gcc", "-O3 -march=x86-64-v3", ""),
    "gcc sanitized": ("gcc", f"-O0 {STRICT}=address,undefined,float-cast-overflow", ""),
    "gcc filled": ("gcc", "-O2 -ftrivial-auto-var-init=pattern", ""),
    "clang -O0": ("clang", "-O0", ""),
    "clang -O2": ("clang", "-O2", ""),
    "clang -O3": ("clang", "-O3", ""),
    "clang -O3 v3": ("clang", "-O3 -march=x86-64-v3", ""),
    "clang sanitized": ("clang", f"-O1 {STRICT}=memory", ""),
    "clang filled with NaN": ("clang", "-O2 -ftrivial-auto-var-init=pattern", ""),
    "zig -O3": ("zig", "-O3", ""),
    "aarch64 -O3": ("aarch64-linux-gnu-gcc", "-O3 -static", "qemu-aarch64"),
    "aarch64 clang -O3": ("zig", "-O3 -target aarch64-linux-musl", "qemu-aarch64"),
    "wasm32 -O2": ("zig", "-O2 -target wasm32-wasi -Wl,-z,stack-size=8388608", "node"),
}
"""By name: the compiler, its flags, the emulator."""


def replayed(name: str, calls: list[Call], folder: Path) -> list[list]:
    """What the program of an engine leaves behind calls; tests are skipped where it cannot run."""
    compiler, flags, emulator = TABLE[name]
    if absent := [x for x in (compiler, emulator) if x and not _words(x)]:
        pytest.skip(f"not installed: {', '.join(absent)}")
    usual = [x for x in FLAGS if not x.startswith("-O")]
    words = [*_words(compiler), *usual, *flags.split(), "-DTABLE=entries_here"]
    program = folder / "replay"
    if not program.exists():
        replay.built(folder, words, program.name, "kernels.c")
    replay.written(calls, folder / "calls")
    replay.run([*_words(emulator), str(program)], folder / "calls", folder / "after")
    return replay.answers(calls, folder / "after")


def _words(tool: str) -> list[str]:
    """How a tool is called; nothing if it is not there."""
    if not shutil.which(tool):
        wheel = tool == "zig" and find_spec("ziglang")
        return [executable, "-m", "ziglang", "cc"] if wheel else []
    more = {"zig": ["cc"], "node": ["--no-warnings", "-e", NODE]}
    return [tool, *more.get(tool, [])]
