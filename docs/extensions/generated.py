"""Parts of pages that are made from the code: each function returns Markdown."""

import ast
import json
import tempfile
from collections.abc import Iterable
from pathlib import Path
from typing import Any

import dh2urdf
from benchmarks import render, sections
from benchmarks.compare import table
from benchmarks.results import Results
from benchmarks.targets import target_rows
from dh2urdf.checks import RULES, Finding, check_urdf
from tests.helpers import licences as installed
from tests.helpers import urdf_faults

__all__ = ["arms", "commands", "examples", "licences", "measured", "rules", "schemas"]

ROOT = Path(__file__).parents[2]
SUBJECTS = {
    "tree": "Names, links, joints, the tree",
    "reading": "How numbers and attributes are written",
    "rounding": "Rounded angles",
    "joints": "Joints, axes, limits",
    "inertia": "Masses and inertias",
    "geometry": "Shapes, meshes, materials",
}


def rules() -> str:
    """Every rule of ``check`` by subject, with what its consumers make of a file that breaks it."""
    parts, subject = [], ""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "arm.urdf"
        urdf_faults.write_meshes(path.parent)
        for name, rule in RULES.items():
            if (about := SUBJECTS[rule.__module__.rpartition(".")[2]]) != subject:
                parts.append(f"## {about}")
                subject = about
            found: list[Finding] = []
            for text in urdf_faults.FAULTS[name]:
                path.write_text(text, encoding="utf-8")
                found += [f for f in check_urdf(path) if f.rule == name]
            parts.append(_rule(name, rule.__doc__ or "", found))
    return "\n\n".join(parts)


def _rule(name: str, says: str, found: list[Finding]) -> str:
    """One rule: what holds, who breaks where it does not, the cure."""
    effects = _once(f"- {_plain(str(effect))}." for f in found for effect in f.effects)
    mends = "; or ".join(_once(_plain(f.mend) for f in found))
    kind = max((f.severity for f in found), key=["advice", "warning", "error"].index)
    says = _plain(says.strip())
    return "\n".join([f"### `{name}`", "", f"{says} ({kind})", "", *effects, f"- Mend: {mends}."])


def _once(texts: Iterable[str]) -> list[str]:
    return list(dict.fromkeys(texts))


def _plain(text: str) -> str:
    """A text whose angle brackets and stars are no markup."""
    for sign in "\\<*_[$":
        text = text.replace(sign, "\\" + sign)
    return text


def commands() -> str:
    """The command line, from the signatures and docstrings of its verbs."""
    from cyclopts import App, Parameter

    from dh2urdf.cli import ROOMS, VERBS

    app = App(name="dh2urdf", default_parameter=Parameter(negative=()), version="")
    for verb in VERBS:
        app.command(f"dh2urdf.cli.verbs.{ROOMS.get(verb, verb)}:{verb}_", name=verb)
    text = app.generate_docs()
    return text[text.index("## dh2urdf ") :].replace("```console", "```text")


def schemas() -> str:
    """The schemas of ``--json``: what they say of themselves, their keys, the files."""
    parts = []
    for path in sorted((ROOT / "docs" / "schemas").glob("*.json")):
        schema = json.loads(path.read_text(encoding="utf-8"))
        parts += [f"## {path.stem}", f"{_plain(schema['title'])}. {_plain(schema['description'])}"]
        for one in _alternatives(schema):
            rows = [(f"`{key}`", *_described(value, schema)) for key, value in one.items()]
            parts.append(table(("key", "type", "what it is"), rows))
        parts.append(f"[{path.name}](../schemas/{path.name})")
    return "\n\n".join(parts)


def _alternatives(schema: dict[str, Any]) -> list[dict[str, Any]]:
    """The properties of an object, of each of several that it may be."""
    return [_resolved(one, schema)["properties"] for one in schema.get("oneOf", [schema])]


def _resolved(value: dict[str, Any], schema: dict[str, Any]) -> dict[str, Any]:
    name = value.get("$ref", "").rpartition("/")[2]
    return {**schema["$defs"][name], **value} if name else value


def _described(value: dict[str, Any], schema: dict[str, Any]) -> tuple[str, str]:
    """Type and description of a key."""
    value = _resolved(value, schema)
    kinds = value.get("type", "")
    kind = " or ".join(kinds) if isinstance(kinds, list) else kinds
    items = _resolved(value.get("items", {}), schema)
    if isinstance(items.get("type"), str):
        kind = f"{kind} of {items['type']}s"
    if "const" in value:
        kind = f"`{json.dumps(value['const'])}`"
    if "enum" in value:
        kind = ", ".join(f"`{json.dumps(word)}`" for word in value["enum"])
    return kind, _plain(value.get("description", ""))


def licences() -> str:
    """What the users' extras bring, each with its licence and what asks for it."""
    rows = [(one.name, one.licence, one.needed_by) for one in installed.licences("all")]
    return table(("package", "licence", "needed by"), rows)


def measured(part: str) -> str:
    """A part of the benchmark's results file."""
    results = render.shown(ROOT / "benchmarks" / "results" / "latest.json")
    text = _PARTS[part](results)
    return "This run did not measure it." if text.startswith("|") and text.count("\n") < 2 else text


def _edges(results: Results) -> str:
    return table(("pose", *sections.edge_names(results)), sections.edge_rows(results))


_PARTS = {
    "arms": lambda results: table(
        ("class", "arm", "one call", "fastest peer", "batch", "fastest peer", "found"),
        sections.ik_rows(results),
    ),
    "solvers": lambda results: table(
        (
            *("arm", "solver", "bare call", "public call", "1 thread", "2 threads"),
            *("found", "wrong", "worst residual"),
        ),
        sections.solver_rows(results),
    ),
    "targets": lambda results: table(("work", "at least", "measured", ""), target_rows(results)),
    "others": lambda results: table(
        ("work", "dh2urdf", "fastest peer", "ratio"), sections.other_rows(results)
    ),
    "edges": _edges,
    "limits": lambda results: table(
        ("work", "arm", "measured", "limit", "ratio"), sections.limit_rows(results)
    ),
    "left_out": lambda results: table(("peer", "reason", "where"), sections.left_out_rows(results)),
    "machine": render.provenance,
}


def examples() -> str:
    """The scripts of ``examples/``, each by its docstring and in full."""
    parts = []
    for path in sorted((ROOT / "examples").glob("*.py")):
        source = path.read_text(encoding="utf-8")
        told = ast.get_docstring(ast.parse(source)) or ""
        title, _, rest = told.partition("\n\n")
        code = source.split('"""', 2)[2].strip()
        parts += [
            f"## {title.rstrip('.')}",
            rest,
            f"```{{code-block}} python\n:caption: {path.name}\n\n{code}\n```",
        ]
    return "\n\n".join(parts)


def arms() -> str:
    """The tables that ship: joints, convention, solver, source."""
    rows = []
    for name in dh2urdf.list_tables():
        shipped = dh2urdf.load_table(name)
        robot = dh2urdf.Robot.from_dh(shipped)
        kind, source = shipped.convention.value, _plain(shipped.source or "")
        rows.append((f"`{name}`", str(robot.n), kind, str(robot.solver), source))
    return table(("name", "joints", "convention", "solver", "source"), rows)
