"""YAML 1.2 to a document, event by event: no objects, no tags, bounded in size, aliases too."""

import re
from collections.abc import Iterator
from typing import Any

from dh2urdf.dh_io.cells.document import Items, Keys, Mark, Node, Report, Scalar
from dh2urdf.exceptions import TableFileError

_NULLS = ("~", "null", "Null", "NULL")
_NUMBER = re.compile(r"[-+]?(\.inf|\.nan|(\d+\.?\d*|\.\d+)(e[-+]?\d+)?)", re.IGNORECASE | re.ASCII)


def yaml_values(text: str, filename: str) -> Any:
    """Dictionaries, lists, numbers and texts of a YAML or JSON text, or a TableFileError."""
    report = Report.of_text(filename, text)
    values = plain_values(read_yaml(text, report), report)
    report.raise_faults()
    return values


def plain_values(node: Node, report: Report) -> Any:
    """Dictionaries, lists, numbers and texts of a document; keys given twice are faults."""
    if isinstance(node, Items):
        return [plain_values(value, report) for value in node.values]
    if isinstance(node, Keys):
        out: dict[str, Any] = {}
        for key, value in node.pairs:
            if key.text in out:
                report.fault(key.mark, key.text[:40], "given twice")
            out[key.text] = plain_values(value, report)
        return out
    if node.quoted or not node.text:
        return node.text if node.quoted else None
    if not _NUMBER.fullmatch(node.text):
        return {"true": True, "false": False}.get(node.text.lower(), node.text)
    whole = node.text.lstrip("+-").isdigit() and len(node.text) < 16
    return int(node.text) if whole else float(re.sub(r"\.(?=[in])", "", node.text.lower()))


def read_yaml(text: str, report: Report) -> Node:
    """Read one YAML document."""
    from ruamel.yaml import YAML
    from ruamel.yaml.error import MarkedYAMLError, YAMLError

    try:
        return _Builder(YAML(typ="safe", pure=True).parse(text), report).document()
    except MarkedYAMLError as error:
        where = error.problem_mark or error.context_mark
        mark = Mark(where.line + 1, where.column + 1) if where else Mark()
        report.stop(mark, f"not YAML: {error.problem or error.context}", _hint(text, mark))
    except (YAMLError, ValueError, OverflowError) as error:  # the last two of escapes
        if isinstance(error, TableFileError):
            raise
        report.stop(Mark(), f"not YAML: {str(error).splitlines()[0]:.200}")


def _hint(text: str, mark: Mark) -> str:
    lines = text.split("\n")
    line = lines[mark.line - 1] if 1 <= mark.line <= len(lines) else ""
    if "\t" in line[: len(line) - len(line.lstrip())]:
        return "indent with spaces; YAML allows no tabs there"
    return ""


class _Builder:
    """Builds nodes from ruamel's stream of events, which is lazy: a bomb stops at the bound."""

    def __init__(self, events: Iterator[Any], report: Report) -> None:
        self.events, self.report = events, report
        self.anchors: dict[str, tuple[Node, int, int]] = {}

    def document(self) -> Node:
        from ruamel.yaml import events as ev

        root: Node | None = None
        for event in self.events:
            if isinstance(event, ev.DocumentStartEvent) and root is not None:
                self.report.stop(_mark(event), "a second document; a file holds one table")
            if isinstance(event, ev.NodeEvent):
                root = self.node(event, 0)
        return root if root is not None else Scalar("")

    def node(self, event: Any, depth: int) -> Node:
        """Node that begins with this event."""
        from ruamel.yaml import events as ev

        mark = _mark(event)
        self.report.count(mark, depth)
        if isinstance(event, ev.AliasEvent):
            return self.again(str(event.anchor), mark, depth)
        if event.tag is not None:
            tag = str(event.tag).replace("tag:yaml.org,2002:", "!!")
            self.report.stop(mark, f"tag {tag:.60}: not read; write plain text and numbers")
        node: Node
        if isinstance(event, ev.ScalarEvent):
            quoted = not event.implicit[0]
            empty = not quoted and event.value in _NULLS
            node = Scalar("" if empty else event.value, mark, quoted=quoted)
        elif isinstance(event, ev.SequenceStartEvent):
            node = Items(tuple(self.inside(ev.SequenceEndEvent, depth)), mark)
        else:
            keys = self.inside(ev.MappingEndEvent, depth)
            node = Keys(tuple((self.key(key), next(keys)) for key in keys), mark)
        if event.anchor is not None:
            self.anchors[str(event.anchor)] = (node, *_size(node))
        return node

    def again(self, name: str, mark: Mark, depth: int) -> Node:
        """What an anchor above holds, counted once more."""
        if name not in self.anchors:
            self.report.stop(mark, f"alias *{name:.40}: nothing above is marked &{name:.40}")
        node, cells, height = self.anchors[name]
        self.report.count(mark, depth + height, cells - 1, f"alias *{name:.40}: ")
        return node

    def inside(self, end: type, depth: int) -> Iterator[Node]:
        """Nodes up to the end of a sequence or mapping."""
        while not isinstance(event := next(self.events), end):
            yield self.node(event, depth + 1)

    def key(self, node: Node) -> Scalar:
        if not isinstance(node, Scalar):
            self.report.stop(node.mark, "a key has to be a word")
        return node


def _size(node: Node) -> tuple[int, int]:
    """Cells of a node, and levels below it; an alias in it counts with all that it holds."""
    if isinstance(node, Scalar):
        return 1, 0
    parts = node.values if isinstance(node, Items) else [n for pair in node.pairs for n in pair]
    sizes = [_size(part) for part in parts]
    return 1 + sum(n for n, _ in sizes), 1 + max((h for _, h in sizes), default=0)


def _mark(event: Any) -> Mark:
    return Mark(event.start_mark.line + 1, event.start_mark.column + 1)
