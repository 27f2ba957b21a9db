"""What is found in a URDF: where, how bad, who breaks on it, how to mend it."""

from collections.abc import Callable
from dataclasses import dataclass
from enum import StrEnum

from lxml import etree

from dh2urdf.dh_io.files import shown


class Consumer(StrEnum):
    """A program that reads URDF files."""

    PINOCCHIO = "Pinocchio"
    CHECK_URDF = "check_urdf"
    YOURDFPY = "yourdfpy"
    MUJOCO = "MuJoCo"
    PYBULLET = "PyBullet"
    DRAKE = "Drake"
    IKPY = "ikpy"
    KDL = "KDL"
    GAZEBO = "Gazebo"
    MOVEIT = "MoveIt"
    IKFAST = "IKFast"
    RVIZ = "RViz"


GROUPS = {"urdfdom": "check_urdf Pinocchio KDL Gazebo MoveIt RViz"}
"""Those that read a file through the library urdfdom, and so refuse the same ones."""

GROUPS["strict"] = f"{GROUPS['urdfdom']} MuJoCo PyBullet Drake"
"""Those that look at a tree closely before they take it."""


class Verdict(StrEnum):
    """What a consumer makes of a file."""

    ACCEPTS = "accepts"
    MISREADS = "misreads"
    """Takes the file without a word and makes something else of it."""
    COMPLAINS = "complains"
    """Takes the file, with words of its own or with numbers that are none."""
    REFUSES = "refuses"
    """Gives no model: an error, a crash, or no answer at all."""


class Severity(StrEnum):
    """How much a finding matters; the worst verdict among its effects decides."""

    ERROR = "error"
    WARNING = "warning"
    ADVICE = "advice"


@dataclass(frozen=True)
class Effect:
    """What some consumers make of a finding."""

    consumers: tuple[Consumer, ...]
    verdict: Verdict
    text: str

    def __str__(self) -> str:
        """``MuJoCo and Drake refuse the file: axis too small``."""
        names = [str(consumer) for consumer in self.consumers]
        who = names[0] if len(names) == 1 else f"{', '.join(names[:-1])} and {names[-1]}"
        s = "s" if len(names) == 1 else ""
        does = {
            Verdict.REFUSES: f" refuse{s} the file",
            Verdict.COMPLAINS: f" complain{s}",
            Verdict.MISREADS: f" misread{s} it",
            Verdict.ACCEPTS: "",
        }[self.verdict]
        return f"{who}{does}: {self.text}" if self.text else f"{who}{does}"


@dataclass(frozen=True)
class Finding:
    """One thing found.

    Parameters
    ----------
    rule : str
        Name of the rule in ``RULES``.
    line, column : int
        Where the element stands in the file, from 1; of a start tag of several lines the last.
    element : str
        The element, such as ``<link name="arm">``.
    message : str
        What is wrong with it.
    effects : tuple of Effect
        Who breaks on it, and how.
    mend : str
        What to do about it.
    """

    rule: str
    line: int
    element: str
    message: str
    effects: tuple[Effect, ...]
    mend: str
    column: int = 1

    @property
    def severity(self) -> Severity:
        """Error where someone refuses the file, warning where someone misreads it."""
        verdicts = {effect.verdict for effect in self.effects}
        if Verdict.REFUSES in verdicts:
            return Severity.ERROR
        if verdicts & {Verdict.COMPLAINS, Verdict.MISREADS}:
            return Severity.WARNING
        return Severity.ADVICE

    @property
    def consumers(self) -> tuple[Consumer, ...]:
        """Everyone whom it concerns, each once."""
        return tuple(dict.fromkeys(c for effect in self.effects for c in effect.consumers))


def _said(verdict: Verdict) -> Callable[..., Effect]:
    """What makes an effect of names or groups, as in ``"urdfdom MuJoCo"``, and what they share."""

    def effect(names: str, text: str = "") -> Effect:
        each = " ".join(GROUPS.get(name, name) for name in names.split())
        return Effect(tuple(map(Consumer, each.split())), verdict, text)

    return effect


refuse, complain = _said(Verdict.REFUSES), _said(Verdict.COMPLAINS)
misread, accept = _said(Verdict.MISREADS), _said(Verdict.ACCEPTS)


def finding(at: etree._Element, message: str, *effects: Effect | None, mend: str) -> Finding:
    """A finding before its rule is known; effects that are None are left out."""
    told = tuple(effect for effect in effects if effect)
    return Finding("", at.sourceline or 1, label(at), message, told, mend)


def label(element: etree._Element) -> str:
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
