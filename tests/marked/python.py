"""Python modules whose statements mark that they ran, for processes that have ``KERNEL_MARKS``."""

import ast
from pathlib import Path

from tests.marked.written import KINDS, Place

NAME = "marks_of_lines"

SHARED = f"""
import mmap
import os

if "KERNEL_MARKS" in os.environ:
    with open(os.environ["KERNEL_MARKS"], "r+b") as file:
        {NAME} = mmap.mmap(file.fileno(), 0)
else:
    {NAME} = bytearray(10**6)
"""


def mark_modules(package: Path, under: str, places: list[Place]) -> None:
    """Write the modules below a folder of a copied package anew; their statements get places."""
    (package / "marks_of_lines.py").write_text(SHARED)
    for path in sorted((package.parent / under).rglob("*.py")):
        tree = ast.parse(path.read_text())
        name = str(path.relative_to(package.parent))
        for f in ast.walk(tree):
            if isinstance(f, ast.FunctionDef):
                mark_function(f, name, places)
        early = [s for s in tree.body if getattr(s, "module", "") == "__future__"]
        first = tree.body.index(early[0]) + 1 if early else ast.get_docstring(tree) is not None
        tree.body.insert(first, ast.parse(f"from dh2urdf.{NAME} import {NAME}").body[0])
        path.write_text(ast.unparse(ast.fix_missing_locations(tree)) + "\n")


def mark_function(f: ast.FunctionDef, file: str, places: list[Place]) -> None:
    """Put a mark before each statement of a function; those of functions in it are their own."""

    def marked(block: list[ast.stmt]) -> list[ast.stmt]:
        out: list[ast.stmt] = []
        for s in block:
            if isinstance(s, ast.Expr) and isinstance(s.value, ast.Constant):
                out.append(s)  # a docstring
                continue
            out.append(ast.parse(f"{NAME}[{KINDS * len(places)}] = 1").body[0])
            places.append(Place(file, f.name, s.lineno))
            if not isinstance(s, ast.FunctionDef):
                inside(s)
            out.append(s)
        return out

    def inside(s: ast.AST) -> None:
        for name in ("body", "orelse", "finalbody"):
            if block := getattr(s, name, None):
                setattr(s, name, marked(block))
        for part in [*getattr(s, "handlers", ()), *getattr(s, "cases", ())]:
            inside(part)

    f.body = marked(f.body)
