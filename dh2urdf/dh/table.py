"""Denavit-Hartenberg tables: frozen rows of plain floats, in metres and radians.

A revolute joint puts ``sign * q + theta`` in place of theta and a prismatic joint puts
``sign * q + d`` in place of d; frame i is the product of the rows up to joint i, see
:mod:`dh2urdf.dh.motions`.
"""

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property
from itertools import islice
from typing import Any, Self

import numpy as np
from numpy.typing import ArrayLike

from dh2urdf.bounds import JOINTS, LENGTH, ROWS
from dh2urdf.dh.coupling import JointMap, joint_map, joint_ranges, problems_between, read_only
from dh2urdf.dh.mimic import ReadOnly
from dh2urdf.dh.motions import DHConvention, convention_of
from dh2urdf.dh.print import table_html, table_latex, table_text
from dh2urdf.dh.row import DHRow, JointType, Origin
from dh2urdf.doors import finite_array, found, instance, real_array, text
from dh2urdf.exceptions import ConfigurationError, TableError
from dh2urdf.transforms import Array

PARAMETERS = "theta d a alpha"
LETTERS = {kind.value[0].upper(): kind for kind in JointType}


def _rows(values: Any) -> tuple[DHRow, ...]:
    """A bounded number of rows."""
    try:
        rows = tuple(islice(values, ROWS + 1))
    except Exception:  # as of any object that is gone through
        rows = (values,)
    if len(rows) > ROWS:
        raise TableError(f"rows: more than {ROWS}; a table has at most {JOINTS} joints")
    for row in rows:
        if not isinstance(row, DHRow):
            raise TableError(
                f"rows: expected DHRow objects, got {found(row)}; of numbers "
                f'DHTable.from_array(rows, convention=..., columns="{PARAMETERS}") makes a table'
            )
    return rows


def _column_names(rows: object) -> list[str] | None:
    """Names of the columns of a data frame, a structured array or a dictionary; else None."""
    names = getattr(getattr(rows, "dtype", None), "names", None) or getattr(rows, "columns", None)
    if isinstance(rows, dict):
        names = list(rows)
    return None if names is None or callable(names) else [str(name) for name in names][:ROWS]


@dataclass(frozen=True)
class DHTable:
    """A DH table: convention, rows, base and tool.

    Parameters
    ----------
    rows : tuple of DHRow
    convention : DHConvention
        No default: the two differ silently.
    name : str
    base : Origin
        Frame 0 in ``base_link``.
    tool : Origin
        ``tool0`` in frame n.
    source, checked : str
        Where the figures come from, and what they were checked against.
    couplings : mapping of str to mapping of str to float
        What adds to a joint's own value: with ``{"joint_3": {"joint_2": 1.0}}`` the third joint
        is at q3 + q2. Joints by name; plain numbers, or [rad/m] and [m/rad].

    Raises
    ------
    TableError
        No joint at all, two joints of one name, or joints that cannot follow one another so.
    """

    rows: tuple[DHRow, ...]
    convention: DHConvention
    name: str = "robot"
    base: Origin = field(default_factory=Origin)
    tool: Origin = field(default_factory=Origin)
    source: str = ""
    checked: str = ""
    couplings: Mapping[str, Mapping[str, float]] = field(default_factory=ReadOnly)

    def __post_init__(self) -> None:
        put = object.__setattr__
        put(self, "rows", _rows(self.rows))
        put(self, "convention", convention_of(self.convention, TableError))
        for key in ("name", "source", "checked"):
            put(self, key, text(getattr(self, key), key, TableError))
        for key in ("base", "tool"):
            instance(getattr(self, key), key, Origin, TableError)
        if not self.name:
            raise TableError("name: a table needs one")
        if self.n == 0:
            raise TableError("joints: a table needs at least one revolute or prismatic row")
        if self.n > JOINTS:
            raise TableError(f"joints: {self.n}; at most {JOINTS} are allowed")
        far = self.length + math.hypot(*self.base.xyz)
        if far > LENGTH:
            raise TableError(f"lengths: sum to {far:g} m; at most {LENGTH:g} m are allowed")
        names = self.joint_names
        twice = sorted({name for name in names if names.count(name) > 1})
        if twice:
            raise TableError(f"name: {', '.join(map(repr, twice))} names more than one joint")
        put(self, "couplings", read_only(self.couplings))
        wrong = problems_between(self.joints, names, self.couplings)
        if wrong:
            raise TableError(
                [
                    f"{'.'.join([names[row] if row >= 0 else 'couplings', *keys])}: {message}"
                    for row, keys, message in wrong
                ]
            )

    @classmethod
    def from_array(
        cls,
        rows: ArrayLike,
        convention: DHConvention | str,
        columns: str = PARAMETERS,
        joint_types: str | None = None,
        name: str = "robot",
    ) -> Self:
        """A table from an array, a row a joint, in [rad] and [m].

        Parameters
        ----------
        rows : array_like, shape (n, 4)
            One with named columns, such as a data frame, has these four in any order.
        convention : DHConvention
        columns : str
            What the columns hold: theta, d, a and alpha in any order.
        joint_types : str, optional
            A letter a row: ``"RRP"``, R revolute, P prismatic, F fixed. All revolute by default.
        name : str

        Raises
        ------
        TableError

        Examples
        --------
        >>> from math import pi
        >>> from dh2urdf import DHTable
        >>> arm = DHTable.from_array([[0, 0.3, 0, -pi / 2], [0, 0, 0.25, 0]], convention="standard")
        >>> arm.fk([0, 0]).round(3) + 0.0
        array([[ 1.  ,  0.  ,  0.  ,  0.25],
               [ 0.  ,  0.  ,  1.  ,  0.  ],
               [ 0.  , -1.  ,  0.  ,  0.3 ],
               [ 0.  ,  0.  ,  0.  ,  1.  ]])
        """
        keys = text(columns, "columns", TableError).replace(",", " ").split()
        if (names := _column_names(rows)) is not None:
            if sorted(names) != sorted(PARAMETERS.split()):
                raise TableError(
                    f"rows: expected the columns {PARAMETERS}, got {' '.join(names)}; of other "
                    "columns load_table(rows, convention, units) makes a table"
                )
            rows = np.stack([np.asarray(rows[key]) for key in names], -1)  # type: ignore[call-overload, index]
            keys = names
        if sorted(keys) != sorted(PARAMETERS.split()):
            raise TableError(f"columns: expected {PARAMETERS} in any order, got {columns!r}")
        expected = f"an array of shape (n, 4), n at most {ROWS}"
        array = real_array(rows, "rows", expected, TableError)
        if array.ndim != 2 or array.shape[1] != 4 or len(array) > ROWS:
            raise TableError(f"rows: expected {expected}, got shape {array.shape}")
        letters = "R" * len(array) if joint_types is None else joint_types
        kinds = text(letters, "joint_types", TableError)
        if len(kinds) != len(array):
            raise TableError(f"joint_types: expected {len(array)} letters, got {found(kinds)}")
        made = (
            DHRow(**dict(zip(keys, row, strict=True)), joint_type=LETTERS.get(kind, kind))  # type: ignore[arg-type]
            for row, kind in zip(array.tolist(), kinds, strict=True)
        )
        return cls(tuple(made), convention_of(convention, TableError), name=name)

    @cached_property
    def joints(self) -> tuple[DHRow, ...]:
        """The rows that move, in order."""
        return tuple(row for row in self.rows if row.is_joint)

    @property
    def n(self) -> int:
        """Number of joints."""
        return len(self.joints)

    @cached_property
    def joint_map(self) -> JointMap | None:
        """How the values q move the joints; None where each joint is at a value of its own."""
        if not self.couplings and all(row.mimic is None for row in self.rows):
            return None
        return joint_map(self.joints, self.joint_names, self.couplings)

    @cached_property
    def joint_ranges(self) -> tuple[tuple[float, float], ...]:
        """Bounds of the joints themselves [rad] or [m]: those of q, or what comes out of them."""
        return tuple(joint_ranges(self.joints, self.joint_names, self.couplings))

    @property
    def has_steps_between(self) -> bool:
        """True where a fixed row stands between two joints."""
        at = [i for i, row in enumerate(self.rows) if row.is_joint]
        return at[-1] - at[0] >= len(at)

    @cached_property
    def joint_names(self) -> tuple[str, ...]:
        """Names of the joints; ``joint_i`` where the row has none."""
        return tuple(row.name or f"joint_{i}" for i, row in enumerate(self.joints, 1))

    @property
    def length(self) -> float:
        """Sum of all lengths of the table [m], an upper bound of the reach at q = 0."""
        total = math.dist((0, 0, 0), self.tool.xyz)
        for row in self.rows:
            total += abs(row.a) + abs(row.d)
            total += math.dist((0, 0, 0), row.origin.xyz) if row.origin else 0.0
        return total

    def transforms(self, q: ArrayLike) -> Array:
        """``T_{i-1,i}`` for i = 1 ... n at q (n,), fixed rows folded in, shape (n, 4, 4).

        Here and in :meth:`frames` and :meth:`fk` q is where the joints themselves are, also those
        that follow or are coupled; a :class:`dh2urdf.Robot` takes the values that move them.
        A fixed row before the first joint moves frame 0 and is not part of these.
        """
        config = self._config(q)
        out: list[Array] = []
        for row in self.rows:
            if row.is_joint:
                out.append(row.transform(config[len(out)], self.convention))
            elif out:
                out[-1] = out[-1] @ row.transform(0.0, self.convention)
        return np.stack(out)

    def frames(self, q: ArrayLike) -> Array:
        """DH frames 0 ... n in ``base_link`` at q (n,), shape (n + 1, 4, 4)."""
        frames = [self.base_frame]
        for T_prev_i in self.transforms(q):
            frames.append(frames[-1] @ T_prev_i)
        return np.stack(frames)

    def fk(self, q: ArrayLike) -> Array:
        """``T_base_tool`` at q (n,): the product of all rows, shape (4, 4)."""
        T_base_tool: Array = self.frames(q)[-1] @ self.tool.matrix
        return T_base_tool

    @property
    def base_frame(self) -> Array:
        """Frame 0 in ``base_link``: base, then the fixed rows before the first joint."""
        T = self.base.matrix
        for row in self.rows:
            if row.is_joint:
                break
            T = T @ row.transform(0.0, self.convention)
        return T

    to_latex = table_latex
    _repr_html_ = table_html

    def __str__(self) -> str:
        return table_text(self)

    def _config(self, q: ArrayLike) -> list[float]:
        config = finite_array(q, "q", f"{self.n} numbers", ConfigurationError)
        if config.shape != (self.n,):
            raise ConfigurationError(
                f"q: expected shape ({self.n},) for {self.n} joints, got {config.shape}"
            )
        return config.tolist()  # type: ignore[no-any-return]
