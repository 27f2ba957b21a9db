"""A text field over the whole width of the panel, and small scripts for it and for the page.

viser's own fields are two to six lines high, beside their label. What is around them is HTML of
ours, which may carry style and, in an image's ``onload``, a script; texts go in by ``data-``.
"""

import json
from html import escape
from typing import Any

PIXEL = "data:image/gif;base64,R0lGODlhAQABAAAAACH5BAEKAAEALAAAAAABAAEAAAICTAEAOw=="

STYLE = """<div class="dh-{0}" style="padding:0 10px 2px;font-size:12px;color:#868e96">{1}</div>
<style>
div:has(> .dh-{0}) + div > div {{ display: block }}
div:has(> .dh-{0}) + div > div > div:first-child {{ display: none }}
div:has(> .dh-{0}) + div textarea {{
  min-height: {2}px; padding: 4px 6px !important;
  font: 12px/1.5 ui-monospace, "DejaVu Sans Mono", monospace; white-space: pre; overflow: auto;
}}
</style>"""

FIND = "document.querySelector('div:has(> .dh-{0}) + div textarea')"

CARET = r"""const t = {0}, d = JSON.parse(this.dataset.given);
if (t && d.button.includes(document.activeElement?.textContent.trim())) {{
  const lines = t.value.split('\n'), at = lines.slice(0, d.line - 1).join('\n').length
    + (d.line > 1) + d.column - 1;
  t.focus(); t.setSelectionRange(at, at + t.value.slice(at).match(/^[^\s,}}\]]*/)[0].length);
  t.scrollLeft = (d.column - 12) * t.scrollWidth / Math.max(...lines.map(l => l.length));
  t.scrollTop = Math.max(0, (d.line - 3) * t.scrollHeight / lines.length);
}}"""

COPY = """const t = {0}, b = this, say = () => {{ b.textContent = 'Copied';
  setTimeout(() => b.textContent = 'Copy', 1500); }};
const old = () => {{ t.select(); document.execCommand('copy') && say(); }};
navigator.clipboard ? navigator.clipboard.writeText(t.value).then(say, old) : old();"""


def editor(gui: Any, name: str, label: str, height: int) -> Any:
    """A field of many lines, ``height`` pixels high; ``name`` is what scripts find it by."""
    gui.add_html(STYLE.format(name, escape(label), height))
    return gui.add_text(label, "", multiline=True)


def run(script: str, given: object) -> str:
    """HTML that runs a script of ours once it is shown; what is given is read as data."""
    data, code = escape(json.dumps(given)), escape(script)
    return f'<img alt="" style="display:none" src="{PIXEL}" data-given="{data}" onload="{code}">'


def caret(name: str, line: int, column: int, button: str) -> str:
    """HTML that marks the word at a place of a field, in the page where the button was pressed."""
    return run(CARET.format(FIND.format(name)), {"line": line, "column": column, "button": button})


def copy_button(name: str) -> str:
    """A button that copies all of a field."""
    script = escape(COPY.format(FIND.format(name)))
    style = (
        "margin:0 10px 6px;padding:2px 12px;font-size:12px;cursor:pointer;color:#228be6;"
        "border:1px solid #228be6;background:none"
    )
    return f'<button type="button" style="{style}" onclick="{script}">Copy</button>'


def page_title(title: str) -> str:
    """HTML that names the page."""
    return run("document.title = JSON.parse(this.dataset.given)", title)
