"""YAML 1.2 to a document, event by event: no objects, no tags, no aliases, bounded in size."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from dh2urdf.dh_io.document import MAX_DEPTH, MAX_NODES, Items, Keys, Mark, Node, Report, Scalar

if TYPE_CHECKING:
    from collections.abc import Iterator

__all__ = ["read_yaml"]

_NULLS = ("~", "null", "Null", "NULL")


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
    except YAMLError as error:
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
        self.events, self.report, self.count = events, report, 0

    def document(self) -> Node:
        from ruamel.yaml import events as ev

        root: Node | None = None
        for event in self.events:
            if isinstance(event, ev.DocumentStartEvent) and root is not None:
                self.report.stop(_mark(event), "a second document; a file holds one table")
            if not isinstance(
                event,
                ev.StreamStartEvent
                | ev.StreamEndEvent
                | ev.DocumentStartEvent
                | ev.DocumentEndEvent,
            ):
                root = self.node(event, 0)
        return root if root is not None else Scalar("")

    def node(self, event: Any, depth: int) -> Node:
        """Node that begins with this event."""
        from ruamel.yaml import events as ev

        self.count += 1
        mark = _mark(event)
        if self.count > MAX_NODES:
            self.report.stop(mark, f"more than {MAX_NODES} cells; a DH table is smaller")
        if depth > MAX_DEPTH:
            self.report.stop(mark, f"nested deeper than {MAX_DEPTH} levels")
        if isinstance(event, ev.AliasEvent):
            self.report.stop(mark, f"alias *{event.anchor:.40}: not read; write the value out")
        if event.tag is not None:
            tag = str(event.tag).replace("tag:yaml.org,2002:", "!!")
            self.report.stop(mark, f"tag {tag:.60}: not read; write plain text and numbers")
        if isinstance(event, ev.ScalarEvent):
            plain = event.implicit[0]
            return Scalar("" if plain and event.value in _NULLS else event.value, mark)
        if isinstance(event, ev.SequenceStartEvent):
            return self.sequence(mark, depth)
        return self.mapping(mark, depth)

    def sequence(self, mark: Mark, depth: int) -> Items:
        from ruamel.yaml.events import SequenceEndEvent

        values = []
        while not isinstance(event := next(self.events), SequenceEndEvent):
            values.append(self.node(event, depth + 1))
        return Items(tuple(values), mark)

    def mapping(self, mark: Mark, depth: int) -> Keys:
        from ruamel.yaml.events import MappingEndEvent

        pairs = []
        while not isinstance(event := next(self.events), MappingEndEvent):
            key = self.node(event, depth + 1)
            if not isinstance(key, Scalar):
                self.report.stop(key.mark, "a key has to be a word")
            pairs.append((key, self.node(next(self.events), depth + 1)))
        return Keys(tuple(pairs), mark)


def _mark(event: Any) -> Mark:
    return Mark(event.start_mark.line + 1, event.start_mark.column + 1)
