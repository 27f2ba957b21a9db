"""A file checked, and what its findings share."""

from collections import Counter
from collections.abc import Iterable
from typing import NamedTuple

from dh2urdf.checks.ask_consumers import Testimony
from dh2urdf.checks.findings import Effect, Finding, Severity, Verdict


class Checked(NamedTuple):
    """What is said of one file, and why no consumer was asked, where none was."""

    file: str
    findings: tuple[Finding, ...]
    said: tuple[Testimony, ...] = ()
    not_asked: str = ""

    @property
    def wrong(self) -> bool:
        """True where there is more than advice, or a consumer refuses the file."""
        return any(f.severity is not Severity.ADVICE for f in self.findings) or bool(self.refusals)

    @property
    def refusals(self) -> tuple[Testimony, ...]:
        """What those said who refuse the file."""
        return tuple(t for t in self.said if t.verdict is Verdict.REFUSES)

    @property
    def summary(self) -> str:
        """``2 errors, 1 warning``."""
        counts = Counter(f.severity for f in self.findings)
        words = (
            f"{counts[s]} {s}{'s' * (counts[s] > 1 and s is not Severity.ADVICE)}"
            for s in Severity
            if counts[s]
        )
        return ", ".join(words) or "nothing to mend"

    def grouped(self) -> list[list[Finding]]:
        """Findings of one rule and one effect together."""
        alike: dict[tuple[str, tuple[Effect, ...]], list[Finding]] = {}
        for finding in self.findings:
            alike.setdefault((finding.rule, finding.effects), []).append(finding)
        return list(alike.values())


class Unread(NamedTuple):
    """A file that could not be read, and why."""

    path: str
    error: str


def told(findings: Iterable[Finding]) -> str:
    """What findings of one rule and one effect say, each on its line, and what is to be done."""
    findings = tuple(findings)
    lines = [f"line {f.line}: {f.element} {f.message}" for f in findings]
    return "\n".join([*lines, *map(str, findings[0].effects), f"mend: {findings[0].mend}"])
