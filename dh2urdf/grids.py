"""How a grid of cells is printed: text, Markdown, HTML, CSV, LaTeX."""

import csv
import html
import io
from collections.abc import Collection, Sequence

Grid = Sequence[Sequence[str]]

HTML_COLOURS = {"theta": "#c2188b", "d": "#00808a", "a": "#d97000", "alpha": "#6a3fbf"}
"""One colour per DH quantity, the same in tables, figures and the browser view."""

PAGE_STYLE = (
    "body{font:16px/1.45 system-ui,sans-serif;margin:2em;color:#222}"
    "table{font-variant-numeric:tabular-nums;margin-bottom:1.5em}"
    "caption{white-space:pre-line;padding-bottom:.6em}"
    "thead tr{border-bottom:1px solid #999}p{max-width:46em;color:#555}"
)


def number(value: float, *, minus: str = "\N{MINUS SIGN}") -> str:
    """Shortest decimal that reads back as the same float, with a true minus sign."""
    if value == 0:
        return "0"
    text = repr(float(value))
    text = text.removesuffix(".0")
    return text.replace("-", minus)


def grid_matrix(rows: Grid) -> str:
    """Columns without a header, aligned to the right and indented."""
    widths = [max(map(len, column)) for column in zip(*rows, strict=True)]
    lines = ("  ".join(map(str.rjust, row, widths)) for row in rows)
    return "\n".join(f"  {line}" for line in lines)


def grid_text(header: Sequence[str], rows: Grid, *, left: Collection[int] = ()) -> str:
    """Columns padded to their widest cell, a rule under the header.

    Cells stand to the right, in the columns ``left`` to the left.
    """
    table = [list(header), *[list(r) for r in rows]]
    widths = [max(len(r[k]) for r in table) for k in range(len(header))]
    lines = [
        "  ".join(
            c.ljust(w) if k in left else c.rjust(w)
            for k, (c, w) in enumerate(zip(r, widths, strict=True))
        )
        for r in table
    ]
    lines.insert(1, "─" * len(lines[0]))
    return "\n".join(line.rstrip() for line in lines)


def grid_markdown(header: Sequence[str], rows: Grid) -> str:
    """A pipe table, columns aligned to the right; cells are Markdown already."""
    table = [list(r) for r in [header, *rows]]
    widths = [max(3, *(len(r[k]) for r in table)) for k in range(len(header))]
    lines = [
        "| " + " | ".join(c.rjust(w) for c, w in zip(r, widths, strict=True)) + " |" for r in table
    ]
    lines.insert(1, "|" + "|".join("-" * (w + 1) + ":" for w in widths) + "|")
    return "\n".join(lines)


def grid_csv(header: Sequence[str], rows: Grid, delimiter: str = ",") -> str:
    """Values separated by commas, or by another sign, with a header line."""
    out = io.StringIO()
    csv.writer(out, delimiter=delimiter, lineterminator="\n").writerows([header, *rows])
    return out.getvalue()


def grid_latex(header: Sequence[str], rows: Grid) -> str:
    """A ``tabular`` with ``booktabs`` rules; cells are LaTeX already."""
    head, *body = (" & ".join(row) + r" \\" for row in (header, *rows))
    begin = r"\begin{tabular}{" + "r" * len(header) + "}"
    ends = r"\bottomrule", r"\end{tabular}"
    return "\n".join([begin, r"\toprule", head, r"\midrule", *body, *ends])


def grid_html(header: Sequence[str], rows: Grid, *, keys: Sequence[str], caption: str) -> str:
    """A table for notebooks: DH quantities in their colours, zeros in light grey."""
    cell = "text-align:right;padding:2px 10px;"
    head = "".join(
        f'<th style="{cell}color:{HTML_COLOURS.get(k, "inherit")}">{html.escape(h)}</th>'
        for k, h in zip(keys, header, strict=True)
    )
    body = []
    for row in rows:
        cells = []
        for key, text in zip(keys, row, strict=True):
            zero = text in {"0", "0°"}
            colour = "#b0b0b0" if zero else HTML_COLOURS.get(key, "inherit")
            cells.append(f'<td style="{cell}color:{colour}">{html.escape(text)}</td>')
        body.append("<tr>" + "".join(cells) + "</tr>")
    return (
        f'<table style="border-collapse:collapse"><caption style="text-align:left">'
        f"{html.escape(caption)}</caption><thead><tr>{head}</tr></thead>"
        f"<tbody>{''.join(body)}</tbody></table>"
    )


def paragraph(text: str) -> str:
    """A paragraph of plain text."""
    return f"<p>{html.escape(text)}</p>"


def html_page(heading: str, parts: Sequence[str]) -> str:
    """A page of its own, of parts that are HTML already."""
    return (
        '<!DOCTYPE html>\n<html lang="en">\n<head>\n<meta charset="utf-8">\n'
        '<meta name="viewport" content="width=device-width, initial-scale=1">\n'
        f"<title>{html.escape(heading)}</title>\n<style>{PAGE_STYLE}</style>\n</head>\n<body>\n"
        + "\n".join(parts)
        + "\n</body>\n</html>"
    )
