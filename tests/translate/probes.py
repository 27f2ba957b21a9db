"""Lines of the kernels that ran interpreted: ``python -m tests.translate.probes FILE [--missed]``.

Each stretch of statements that run one after the other begins with a mark of its own, which costs
less than tracing does. The file holds what runs have reached; each run adds to it.
"""

import argparse
import ast
import fcntl
import importlib
import inspect
import json
import pkgutil
import sys
import textwrap
from collections.abc import Iterator
from pathlib import Path
from types import CodeType, FunctionType
from typing import Any

import dh2urdf.kernels
from dh2urdf.engine import INTERPRETED

KERNELS = str(Path(dh2urdf.kernels.__file__).parent)

MARKS = "_marks_of_lines"

Key = tuple[str, str]
"""A file below the kernels, and a function of it."""


def is_kernel(code: CodeType) -> bool:
    """Whether a function is one of those that are written as C."""
    return code.co_filename.startswith(KERNELS) and not code.co_filename.endswith("/shapes.py")


def short(file: str) -> str:
    """A file below the kernels."""
    return file.removeprefix(KERNELS + "/")


def kernels() -> list[FunctionType]:
    """Every function of the kernels, each once."""
    found: dict[CodeType, FunctionType] = {}
    for name, room in list(sys.modules.items()):
        if name.startswith("dh2urdf.kernels"):
            for value in [*vars(room).values(), *INTERPRETED.values()]:
                if inspect.isfunction(value) and is_kernel(value.__code__):
                    found[value.__code__] = value
    return list(found.values())


class Marked:
    """A kernel whose stretches mark that they were reached; it stays the same function."""

    def __init__(self, function: FunctionType) -> None:
        code = function.__code__
        self.key: Key = short(code.co_filename), code.co_name
        self.stretches: list[list[int]] = []
        lines, first = inspect.getsourcelines(function)
        tree = ast.parse(textwrap.dedent("".join(lines)))
        ast.increment_lineno(tree, first - 1)
        definition = tree.body[0]
        assert isinstance(definition, ast.FunctionDef)
        definition.decorator_list = []
        self._number = len(_HITS)
        definition.body = self._marked(definition.body)
        _HITS.append(bytearray(len(self.stretches)))
        ast.fix_missing_locations(tree)
        place: dict[str, Any] = {}
        exec(compile(tree, code.co_filename, "exec"), {**function.__globals__}, place)
        function.__code__ = place[code.co_name].__code__
        function.__globals__[MARKS] = _HITS

    def _marked(self, block: list[ast.stmt]) -> list[ast.stmt]:
        """A block with marks where it begins, and after each statement that may not come back."""
        out: list[ast.stmt] = []
        stretch: list[int] | None = None
        for statement in block:
            if isinstance(statement, ast.Expr) and isinstance(statement.value, ast.Constant):
                continue  # a docstring
            if stretch is None:
                stretch = []
                out.append(self._mark(statement, stretch))
            stretch.append(statement.lineno)
            for name in ("body", "orelse"):
                if inner := getattr(statement, name, None):
                    setattr(statement, name, self._marked(inner))
            if isinstance(statement, ast.If | ast.For | ast.While):
                stretch = None
            out.append(statement)
        return out

    def _mark(self, before: ast.stmt, stretch: list[int]) -> ast.stmt:
        """What marks a stretch that begins before a statement."""
        mark = ast.parse(f"{MARKS}[{self._number}][{len(self.stretches)}] = 1").body[0]
        self.stretches.append(stretch)
        ast.increment_lineno(mark, before.lineno - 1)
        return mark

    @property
    def reached(self) -> set[int]:
        """Lines that ran."""
        hits = zip(self.stretches, _HITS[self._number], strict=True)
        return {line for lines, hit in hits if hit for line in lines}

    @property
    def lines(self) -> set[int]:
        """All lines at which a statement begins."""
        return {line for lines in self.stretches for line in lines}


_HITS: list[bytearray] = []
_MARKED: dict[Key, Marked] = {}


def mark_all() -> None:
    """Mark every kernel; those of modules that were imported since the last time, too."""
    for module in pkgutil.walk_packages(dh2urdf.kernels.__path__, "dh2urdf.kernels."):
        importlib.import_module(module.name)
    for function in kernels():
        if MARKS not in function.__code__.co_names:
            one = Marked(function)
            _MARKED[one.key] = one


def reached() -> dict[str, list[int]]:
    """Lines that ran, by file and function."""
    return {":".join(key): sorted(one.reached) for key, one in _MARKED.items() if one.reached}


def forget() -> None:
    """Begin anew: nothing was reached."""
    for hits in _HITS:
        hits[:] = bytes(len(hits))


def add(file: Path) -> None:
    """Join what ran with what a file has, under a lock: several processes may."""
    with file.open("a+") as handle:
        fcntl.flock(handle, fcntl.LOCK_EX)
        handle.seek(0)
        kept = json.loads(handle.read() or "{}")
        for key, lines in reached().items():
            kept[key] = sorted({*kept.get(key, ()), *lines})
        handle.truncate(0)
        handle.write(json.dumps(kept))


def missed(kept: dict[str, list[int]]) -> Iterator[tuple[str, int, list[str]]]:
    """For each file: how many lines it has, and those that were not reached."""
    files: dict[str, tuple[int, list[str]]] = {}
    for (file, name), one in _MARKED.items():
        left = sorted(one.lines - set(kept.get(f"{file}:{name}", ())))
        count, lost = files.get(file, (0, []))
        files[file] = count + len(one.lines), lost + [f"{name}:{line}" for line in left]
    for file, (count, lost) in sorted(files.items()):
        yield file, count, lost


def report(kept: dict[str, list[int]], *, names: bool) -> float:
    """Print what was not reached; the share that was."""
    total = left = 0
    for file, count, lost in missed(kept):
        total, left = total + count, left + len(lost)
        if lost:
            print(f"{file}: {count - len(lost)} of {count}{': ' * names}{' '.join(lost) * names}")
    print(f"{total - left} of {total} lines, {(total - left) / total:.1%}")
    return (total - left) / total


def main() -> int:
    """Tell what runs have reached."""
    parser = argparse.ArgumentParser(prog="python -m tests.translate.probes", description=__doc__)
    parser.add_argument("file", type=Path)
    parser.add_argument("--missed", action="store_true", help="list lines that were not reached")
    parser.add_argument("--least", type=float, default=0.0, help="1 below this share")
    asked = parser.parse_args()
    mark_all()
    return int(report(json.loads(asked.file.read_text()), names=asked.missed) < asked.least)


if __name__ == "__main__":
    sys.exit(main())
