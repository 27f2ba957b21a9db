"""Findings in the Static Analysis Results Interchange Format, SARIF 2.1.0 (OASIS, 2020)."""

import json
import os
from collections.abc import Sequence
from importlib.metadata import version
from pathlib import Path
from typing import Any
from urllib.parse import quote

from dh2urdf.checks.findings import Finding, Severity
from dh2urdf.checks.formats.checked import Checked, Unread
from dh2urdf.checks.rules import RULES

SCHEMA = (
    "https://docs.oasis-open.org/sarif/sarif/v2.1.0/errata01/os/schemas/sarif-schema-2.1.0.json"
)

LEVELS = {Severity.ERROR: "error", Severity.WARNING: "warning", Severity.ADVICE: "note"}

REFUSED = "refused"
"""The rule that every program that is installed takes the file."""


def sarif_text(files: Sequence[Checked], unread: Sequence[Unread]) -> str:
    """One run over all files: a result for each finding, and for each program that refuses one."""
    names = [*RULES, REFUSED]
    results = [_result(checked.file, f, names) for checked in files for f in checked.findings]
    results += [
        {
            "ruleId": REFUSED,
            "ruleIndex": names.index(REFUSED),
            "level": "error",
            "message": {"text": f"{said.consumer} refuses the file: {said.words}"},
            "locations": [_location(checked.file)],
        }
        for checked in files
        for said in checked.refusals
    ]
    notes = [
        {"level": "error", "message": {"text": bad.error}, "locations": [_location(bad.path)]}
        for bad in unread
    ]
    invocation = {"executionSuccessful": not unread, "toolExecutionNotifications": notes}
    run = {
        "tool": {"driver": {"name": "dh2urdf", "version": version("dh2urdf"), "rules": _rules()}},
        "columnKind": "unicodeCodePoints",
        "invocations": [invocation],
        "results": results,
    }
    return json.dumps({"$schema": SCHEMA, "version": "2.1.0", "runs": [run]}, indent=2)


def _rules() -> list[dict[str, Any]]:
    """Every rule with what holds in a sound file."""
    said = {name: (rule.__doc__ or name).splitlines()[0] for name, rule in RULES.items()}
    said[REFUSED] = "Every program that is installed takes the file."
    return [{"id": name, "shortDescription": {"text": text}} for name, text in said.items()]


def _result(file: str, finding: Finding, names: list[str]) -> dict[str, Any]:
    effects = "; ".join(map(str, finding.effects))
    text = f"{finding.element} {finding.message}. {effects}. To mend: {finding.mend}"
    return {
        "ruleId": finding.rule,
        "ruleIndex": names.index(finding.rule),
        "level": LEVELS[finding.severity],
        "message": {"text": text},
        "locations": [_location(file, finding)],
    }


def _location(file: str, finding: Finding | None = None) -> dict[str, Any]:
    """A file, and the place in it."""
    path = Path(file)
    uri = path.as_uri() if path.is_absolute() else quote(os.fsencode(path.as_posix()))
    place: dict[str, Any] = {"artifactLocation": {"uri": uri}}
    if finding is not None:
        place["region"] = {"startLine": finding.line, "startColumn": finding.column}
    return {"physicalLocation": place}
