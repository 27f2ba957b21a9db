"""What a row says of others: which joint it follows; and the mapping in which couplings stand."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import TypeVar

from dh2urdf.bounds import LENGTH, RATIO
from dh2urdf.doors import number, text
from dh2urdf.exceptions import ArgumentError, TableError

V = TypeVar("V")


class ReadOnly(Mapping[str, V]):
    """A mapping that does not change, and so can be hashed."""

    __slots__ = ("_items",)

    def __init__(self, items: Mapping[str, V] | None = None) -> None:
        self._items = dict(items or {})

    def __getitem__(self, key: str) -> V:
        return self._items[key]

    def __iter__(self) -> Iterator[str]:
        return iter(self._items)

    def __len__(self) -> int:
        return len(self._items)

    def __hash__(self) -> int:
        return hash(frozenset(self._items.items()))

    def __repr__(self) -> str:
        return repr(self._items)


Couplings = ReadOnly[ReadOnly[float]]
"""Joint, other joint, number: ``{"joint_3": {"joint_2": 1.0}}``."""


@dataclass(frozen=True)
class Mimic:
    """What a joint follows: its value is ``multiplier * (that of the joint) + offset``.

    Parameters
    ----------
    joint : str
        Name of the joint that leads.
    multiplier : float
        A plain number; [rad/m] or [m/rad] between joints of which one slides and one turns.
    offset : float
        [rad] or [m], as the joint that follows has it.

    Raises
    ------
    TableError
    """

    joint: str
    multiplier: float = 1.0
    offset: float = 0.0

    def __post_init__(self) -> None:
        problems = []
        for key, most in (("joint", 0.0), ("multiplier", RATIO), ("offset", LENGTH)):
            value, what = getattr(self, key), f"mimic.{key}"
            try:
                read = number(value, what, -most, most) + 0.0 if most else text(value, what)
                object.__setattr__(self, key, read)
            except ArgumentError as error:
                problems.append(str(error))
        if problems:
            raise TableError(problems)
