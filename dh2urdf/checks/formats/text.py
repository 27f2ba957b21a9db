"""Findings for a terminal."""

from collections.abc import Iterator

from dh2urdf.checks.findings import Finding
from dh2urdf.checks.formats.checked import Checked

SHOWN = 4
"""Findings of one kind that are shown in full; the rest by line."""


def plain_text(checked: Checked) -> str:
    """What is said of a file, the findings first."""
    lines = [line for group in checked.grouped() for line in _group(checked.file, group)]
    lines.append(f"{checked.file}: {checked.summary}")
    for testimony in checked.said:
        name = f"{testimony.consumer} {testimony.version}".rstrip()
        words = testimony.words.replace("\n", f"\n{' ' * 33}")
        lines.append(f"    {name:<17} {testimony.verdict:<11}{words}".rstrip())
    if checked.not_asked:
        lines.append(f"    no program was asked: {checked.not_asked}")
    return "\n".join(lines)


def _group(file: str, group: list[Finding]) -> Iterator[str]:
    """Findings of one rule and one effect: each on its line, then what they have in common."""
    for f in group[:SHOWN]:
        yield f"{file}:{f.line}: {f.severity}: {f.element} {f.message} [{f.rule}]"
    if len(group) > SHOWN:
        lines = ", ".join(str(f.line) for f in group[SHOWN : 4 * SHOWN])
        dots = ", ..." if len(group) > 4 * SHOWN else ""
        yield f"    and {len(group) - SHOWN} more of the kind, on lines {lines}{dots}"
    for effect in group[0].effects:
        yield f"    {effect}"
    yield f"    mend: {group[0].mend}\n"
