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


PINOCCHIO, CHECK_URDF, YOURDFPY, MUJOCO, PYBULLET, DRAKE = list(Consumer)[:6]
IKPY, KDL, GAZEBO, MOVEIT, IKFAST, RVIZ = list(Consumer)[6:]

URDFDOM = (CHECK_URDF, PINOCCHIO, KDL, GAZEBO, MOVEIT, RVIZ)
"""Those that read a file through the library urdfdom, and so refuse the same ones."""

STRICT = (*URDFDOM, MUJOCO, PYBULLET, DRAKE)
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


@dataclass(frozen=True)
class Finding:
    """One thing found.

    Parameters
    ----------
    rule : str
        Name of the rule in ``RULES``.
    line : int
        Line of the element in the file.
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
    def effect(*consumers: Consumer, text: str = "") -> Effect:
        return Effect(consumers, verdict, text)

    return effect


refuse = _said(Verdict.REFUSES)
complain = _said(Verdict.COMPLAINS)
misread = _said(Verdict.MISREADS)
accept = _said(Verdict.ACCEPTS)
"""What some consumers make of a file, and in what words."""


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
