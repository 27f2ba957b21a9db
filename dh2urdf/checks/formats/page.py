"""Findings as one HTML page that needs nothing else."""

from collections.abc import Iterator, Sequence
from html import escape

from dh2urdf.checks.findings import Finding
from dh2urdf.checks.formats.checked import Checked, Unread

STYLE = """
:root { color-scheme: light dark; --line: #8884; --pale: #8881; }
body { font: 16px/1.5 system-ui, sans-serif; max-width: 60rem; margin: 2rem auto; padding: 0 1rem; }
h1 { font-size: 1.5rem; } h2 { font-size: 1.1rem; margin: 2.5rem 0 .5rem; overflow-wrap: anywhere; }
h2 small { font-weight: normal; opacity: .8; margin-left: .5rem; }
article { border-left: .3rem solid; padding: .4rem 1rem; margin: .8rem 0; background: var(--pale); }
article p { margin: .2rem 0; } article ul { margin: .3rem 0; padding-left: 1.2rem; }
code { font: .9em ui-monospace, monospace; overflow-wrap: anywhere; }
.error { border-color: #c62828; } .warning { border-color: #d97000; }
.advice { border-color: #1f6fb2; }
b.error { color: #d32f2f; } b.warning { color: #c26500; } b.advice { color: #2a7fc4; }
.rule { float: right; opacity: .7; }
table { border-collapse: collapse; width: 100%; } td { padding: .25rem .8rem .25rem 0;
border-bottom: 1px solid var(--line); vertical-align: top; }
td:last-child { white-space: pre-wrap; }
"""


def html_page(files: Sequence[Checked], unread: Sequence[Unread]) -> str:
    """The page: what is found in each file, in its order, then what the programs said."""
    wrong = sum(checked.wrong for checked in files) + len(unread)
    total = len(files) + len(unread)
    head = f"{total} file{'s' * (total != 1)} checked, {wrong or 'none'} with something to mend"
    body = [f"<h1>{head}</h1>"]
    body += [
        f"<h2>{escape(b.path)}</h2><p><b class=error>{escape(b.error)}</b></p>" for b in unread
    ]
    body += [part for checked in files for part in _file(checked)]
    return (
        '<!DOCTYPE html>\n<html lang="en"><head><meta charset="utf-8">'
        '<meta name="viewport" content="width=device-width"><title>dh2urdf check</title>'
        f"<style>{STYLE}</style></head><body>\n" + "\n".join(body) + "\n</body></html>"
    )


def _file(checked: Checked) -> Iterator[str]:
    yield f"<h2>{escape(checked.file)} <small>{checked.summary}</small></h2>"
    for group in checked.grouped():
        yield _article(group)
    rows = "".join(
        f"<tr><td>{escape(str(t.consumer))} {escape(t.version)}</td><td>{t.verdict}</td>"
        f"<td>{escape(t.words)}</td></tr>"
        for t in checked.said
    )
    if rows:
        yield f"<table>{rows}</table>"
    if checked.not_asked:
        yield f"<p>No program was asked: {escape(checked.not_asked)}.</p>"


def _article(group: list[Finding]) -> str:
    first = group[0]
    places = "".join(
        f"<p>line {f.line}: <code>{escape(f.element)}</code> {escape(f.message)}</p>" for f in group
    )
    effects = "".join(f"<li>{escape(str(effect))}</li>" for effect in first.effects)
    return (
        f"<article class={first.severity}><code class=rule>{first.rule}</code>"
        f"<b class={first.severity}>{first.severity}</b>{places}<ul>{effects}</ul>"
        f"<p>To mend: {escape(first.mend)}</p></article>"
    )
