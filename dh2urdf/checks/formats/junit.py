"""Findings as JUnit's XML, as build servers read it: a suite a file, a case a rule or program."""

from collections.abc import Sequence

from lxml import etree

from dh2urdf.checks.findings import Finding, Severity, Verdict
from dh2urdf.checks.formats.checked import Checked, Unread, told
from dh2urdf.checks.rules import RULES
from dh2urdf.dh.quoting import XML_FORBIDDEN

BAD = "\N{REPLACEMENT CHARACTER}"
"""Stands for a character that no XML document holds."""


def junit_text(files: Sequence[Checked], unread: Sequence[Unread]) -> str:
    """What was found, errors and warnings as failures, advice as what a passed case put out."""
    root = etree.Element("testsuites", name="dh2urdf check")
    for checked in files:
        suite = etree.SubElement(root, "testsuite", name=_plain(checked.file))
        for rule in RULES:
            _rule_case(suite, checked, rule)
        for said in checked.said:
            case = _case(suite, checked.file, f"{said.consumer} takes it")
            if said.verdict is Verdict.REFUSES:
                _add(case, "failure", said.words, message="refuses the file", type="error")
            elif said.words:
                _add(case, "system-out", said.words)
    for bad in unread:
        suite = etree.SubElement(root, "testsuite", name=_plain(bad.path))
        case = _case(suite, bad.path, "can be read")
        _add(case, "error", bad.error, message="cannot be read", type="error")
    for suite in (*root, root):
        for key, tag in (("tests", "testcase"), ("failures", "failure"), ("errors", "error")):
            suite.set(key, str(sum(1 for _ in suite.iter(tag))))
    return str(etree.tostring(root, encoding="unicode", pretty_print=True))


def _rule_case(suite: etree._Element, checked: Checked, rule: str) -> None:
    """One rule over one file."""
    case = _case(suite, checked.file, rule)
    groups = [group for group in checked.grouped() if group[0].rule == rule]
    worse = [group for group in groups if group[0].severity is not Severity.ADVICE]
    if worse:
        first: Finding = worse[0][0]
        text = "\n\n".join(map(told, worse))
        message = _plain(f"line {first.line}: {first.element} {first.message}")
        _add(case, "failure", text, message=message, type=str(first.severity))
    advice = [group for group in groups if group not in worse]
    if advice:
        _add(case, "system-out", "\n\n".join(map(told, advice)))


def _case(suite: etree._Element, file: str, name: str) -> etree._Element:
    return etree.SubElement(suite, "testcase", classname=_plain(file), name=name)


def _add(case: etree._Element, tag: str, text: str, **attributes: str) -> None:
    etree.SubElement(case, tag, **attributes).text = _plain(text)


def _plain(text: str) -> str:
    return XML_FORBIDDEN.sub(BAD, text)
