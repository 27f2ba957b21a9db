"""A robot like another one: calibrated, or within tolerances."""

from typing import Self

from dh2urdf.chain import SerialChain
from dh2urdf.dh_io import TableLike
from dh2urdf.exceptions import ArgumentError


class RobotOfAnotherTable:
    """How :class:`dh2urdf.Robot` is made like another one."""

    chain: SerialChain
    joint_names: tuple[str, ...]

    @classmethod
    def from_dh(cls, table: TableLike) -> Self:
        """A robot of a table."""
        raise NotImplementedError

    def with_table(self, table: TableLike) -> Self:
        """The robot of a table that differs little: as calibrated, or within tolerances.

        The solver is chosen when something is first solved: the same one where it covers the other
        table, as it does unless axes that met or were parallel are so no longer.

        Parameters
        ----------
        table : DHTable, path or name
            With the same joints in the same order; all numbers of it may differ.

        Raises
        ------
        TableFileError, NameNotFoundError
        ArgumentError
            Other joints.

        Examples
        --------
        >>> from dataclasses import replace
        >>> from dh2urdf import Robot, load_table
        >>> table = load_table("puma560")
        >>> first, *others = table.rows
        >>> longer = replace(table, rows=(replace(first, d=first.d + 0.0005), *others))
        >>> robot = Robot.from_dh(table)
        >>> (robot.with_table(longer).fk([0] * 6) - robot.fk([0] * 6))[:3, 3].round(6)
        array([0.    , 0.    , 0.0005])
        """
        other = self.from_dh(table)
        found, own = _kinds(other.chain), _kinds(self.chain)
        if found != own:
            raise ArgumentError(f"table: its joints are {found}; those of this robot are {own}")
        if other.joint_names != self.joint_names:
            found, own = ", ".join(other.joint_names), ", ".join(self.joint_names)
            raise ArgumentError(f"table: q is ({found}); that of this robot is ({own})")
        return other


def _kinds(chain: SerialChain) -> str:
    """Names and kinds of the joints of a chain."""
    pairs = zip(chain.names, chain.joint_types, strict=True)
    return ", ".join(f"{name} ({kind})" for name, kind in pairs)
