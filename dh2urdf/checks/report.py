"""What a rule yields: the element and what is to be said of it."""

from __future__ import annotations

from lxml import etree

from dh2urdf.checks.findings import Effect, Finding
from dh2urdf.dh_io.files import shown

__all__ = ["Found"]


class Found:
    """A finding before it is placed in its file; the arguments are the fields of ``Finding``.

    Effects that are None are left out.
    """

    def __init__(
        self, at: etree._Element, message: str, *effects: Effect | None, mend: str
    ) -> None:
        self.at, self.message, self.mend = at, message, mend
        self.effects = tuple(effect for effect in effects if effect)

    def placed(self, rule: str) -> Finding:
        """The finding of a rule."""
        line = self.at.sourceline or 1
        return Finding(rule, line, _label(self.at), self.message, self.effects, self.mend)


def _label(element: etree._Element) -> str:
    """``<link name="arm">``; an element without a name says whose it is."""
    tag = etree.QName(element).localname
    name = element.get("name")
    if name is not None:
        return f'<{tag} name="{shown(name)}">'
    owner = element.getparent()
    while owner is not None and owner.get("name") is None:
        owner = owner.getparent()
    if owner is None or owner.getparent() is None:
        return f"<{tag}>"
    name = shown(owner.get("name"))
    return f'<{tag}> of <{etree.QName(owner).localname} name="{name}">'
