"""In which column of its line an element begins; lxml tells the line alone."""

import re
from collections.abc import Sequence

from dh2urdf.checks.findings import Finding

LABEL = re.compile(
    r'<(?P<tag>[^\s>]+)(?: name="(?P<name>.*?)")?>(?: of <(?P<owner>\S+) name="(?P<whose>.*)">)?'
)
"""How a finding names its element."""


def column(finding: Finding, lines: Sequence[str]) -> int:
    """Column of the finding's start tag in its line, from 1; where the line begins, without one."""
    line = lines[finding.line - 1] if finding.line <= len(lines) else ""
    label = LABEL.match(finding.element)
    start = len(line) - len(line.lstrip())
    if label is None:
        return start + 1
    owner = _find(line, label["owner"], label["whose"], 0) if label["owner"] else -1
    at = _find(line, label["tag"], label["name"], max(owner, 0))
    return (start if at < 0 else at) + 1


def _find(line: str, tag: str, name: str | None, start: int) -> int:
    """Where a start tag begins; -1 where it does not."""
    named = rf"[^>]*\bname\s*=\s*[\"']{re.escape(name)}[\"']" if name else ""
    found = re.compile(rf"<(?:[\w.-]+:)?{re.escape(tag)}\b{named}").search(line, start)
    return found.start() if found else -1
