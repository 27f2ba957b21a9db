"""Recorded calls replayed by C: a program that reads calls, makes them, and writes what is after.

The same program runs anywhere: linked with kernels of any compiler and flags, under an emulator,
or as a library that is handed the tables of the extension's levels.
"""

import subprocess
from functools import cache
from pathlib import Path

import numpy as np
import pytest

from dh2urdf.translate.build import compiler
from dh2urdf.translate.c_file import CFile
from dh2urdf.translate.entries import argument_types, entries
from dh2urdf.translate.statements import Body
from dh2urdf.translate.types import Array, Tuple, Type, inside
from tests.translate.record import Call, interpreted, leaves

HEAD = r"""
#include <stdio.h>
#include <stdlib.h>
#include "kernels.h"
#ifdef TABLE
extern const Entries TABLE;
#endif

static FILE *calls, *answers;

static void read(void *to, size_t size)
{
    if (size > 0 && fread(to, size, 1, calls) != 1) {
        exit(3);
    }
}

static void write(const void *from, size_t size)
{
    if (size > 0 && fwrite(from, size, 1, answers) != 1) {
        exit(4);
    }
}

static int64_t whole(void) { int64_t x; read(&x, 8); return x; }
static double real(void) { double x; read(&x, 8); return x; }
static void give_whole(int64_t x) { write(&x, 8); }
static void give_real(double x) { write(&x, 8); }

static void *array(size_t *size)
{
    *size = (size_t)whole();
    void *made = malloc(*size);
    read(made, *size);
    return made;
}

static void give_array(void *made, size_t size)
{
    write(made, size);
    free(made);
}
"""

TAIL = r"""
static void all(const Entries *table)
{
    int64_t entry;
    while (fread(&entry, 8, 1, calls) == 1) {
        replays[entry](table);
    }
    fflush(answers);
}

int replay(const Entries *table, const char *from, const char *to)
{
    calls = fopen(from, "rb"), answers = fopen(to, "wb");
    if (calls == NULL || answers == NULL) {
        return 1;
    }
    all(table);
    return fclose(calls) + fclose(answers);
}

#ifdef TABLE
int main(void)
{
    calls = stdin, answers = stdout;
    all(&TABLE);
    return 0;
}
#endif
"""


@cache
def translated() -> CFile:
    """The kernels in C."""
    file = CFile()
    with interpreted():
        for function in entries().values():
            file.add_entry(function, argument_types(function))
    return file


@cache
def files() -> dict[str, str]:
    """The kernels' C, and the program's, whose entries have the order of their names."""
    file = translated()
    own = [HEAD, *(_replay(file, e, k) for k, e in enumerate(file.entries))]
    names = ", ".join(f"replay_{k}" for k in range(len(file.entries)))
    own.append(f"static void (*replays[])(const Entries *) = {{{names}}};")
    program = "\n".join(own) + TAIL
    return {"kernels.h": file.header(), "kernels.c": file.kernels(), "replay.c": program}


def text() -> str:
    """The kernels in C."""
    return files()["kernels.c"]


def _replay(file: CFile, e: Body, k: int) -> str:
    """A function that makes one call of an entry."""
    lines = [f"static void replay_{k}(const Entries *table)", "{"]
    lines += [f"    const int {x} = (int)whole();" for x in e.lengths()]
    after: list[str] = []
    handed = [_taken(file, t, f"a{i}", lines, after) for i, t in enumerate(e.arguments)]
    call = f"table->{e.function}({', '.join([*e.lengths(), *handed])});"
    if e.returned is None:
        return "\n".join([*lines, f"    {call}", *after, "}", ""])
    lines.append(f"    const {file.declaration(e.returned, 'found')} = {call}")
    items = e.returned.items if isinstance(e.returned, Tuple) else (e.returned,)
    for i, t in enumerate(items):
        part = f"found.f{i}" if isinstance(e.returned, Tuple) else "found"
        lines.append(f"    give_{'real' if t == 'float' else 'whole'}({part});")
    return "\n".join([*lines, *after, "}", ""])


def _taken(file: CFile, t: Type, name: str, lines: list[str], after: list[str]) -> str:
    """Lines that read an argument, and what stands for it."""
    if isinstance(t, Tuple):
        parts = [_taken(file, x, f"{name}_{i}", lines, after) for i, x in enumerate(t.items)]
        return ", ".join(parts)
    if isinstance(t, Array):
        lines += [f"    size_t {name}_size;", f"    void *{name} = array(&{name}_size);"]
        after.append(f"    give_array({name}, {name}_size);")
    else:
        kind = "double" if t == "float" else "int64_t"
        lines.append(f"    const {kind} {name} = {'real' if t == 'float' else 'whole'}();")
    return name


def written(calls: list[Call], path: Path) -> None:
    """Write calls as the program reads them: entry, lengths, then the arguments."""
    order = list(entries())
    with path.open("wb") as out:
        for call in calls:
            k = order.index(call.entry)
            e, given, lengths = translated().entries[k], leaves(call.given), dict[str, int]()
            types = [t for _, t in inside("", Tuple(e.arguments)) if not isinstance(t, Tuple)]
            for t, value in zip(types, given, strict=True):
                shape = zip(t.shape, value.shape, strict=True) if isinstance(t, Array) else ()
                lengths |= {d: n for d, n in shape if isinstance(d, str) and d.isidentifier()}
            out.write(np.array([k, *(lengths[x] for x in e.lengths())], np.int64).tobytes())
            for t, value in zip(types, given, strict=True):
                if isinstance(t, Array):
                    out.write(np.int64(value.nbytes).tobytes() + value.tobytes())
                else:
                    out.write(np.array(value, np.float64 if t == "float" else np.int64).tobytes())


def answers(calls: list[Call], path: Path) -> list[list[np.ndarray]]:
    """What the program wrote, in the shapes of what each call had left behind."""
    data, at, out = path.read_bytes(), 0, []
    path.unlink()
    for call in calls:
        found = []
        for x in call.after:
            like = np.asarray(x)
            dtype = np.int64 if isinstance(x, bool) else like.dtype
            one = np.frombuffer(data, dtype, like.size, at).reshape(like.shape)
            at += one.nbytes
            found.append(one)
        out.append(found)
    assert at == len(data)
    return out


def built(folder: Path, words: list[str], out: str, *more: str) -> Path:
    """What a compiler makes of the program, and with ``kernels.c`` among ``more`` of all."""
    for name, text in files().items():
        folder.joinpath(name).write_text(text)
    return compiled(folder, [*words, "-w", "replay.c", *more], out)


def cc() -> list[str]:
    """The compiler of the build; tests are skipped where an installation has none."""
    try:
        return compiler()
    except RuntimeError as none:
        pytest.skip(str(none))


def compiled(folder: Path, words: list[str], out: str) -> Path:
    """What a compiler makes of C in a folder."""
    some = [*words, "-o", out, "-lm"]
    done = subprocess.run(some, cwd=folder, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    return folder / out


def run(program: list[str], calls: Path, to: Path) -> None:
    """Run the program, under an emulator if words before it say so."""
    with calls.open("rb") as given, to.open("wb") as out:
        done = subprocess.run(program, stdin=given, stdout=out, stderr=subprocess.PIPE, check=False)
    assert done.returncode == 0, done.stderr.decode()[-2000:]
