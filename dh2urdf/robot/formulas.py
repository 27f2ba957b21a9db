"""The inverse kinematics of a robot as formulas."""

from __future__ import annotations

from typing import TYPE_CHECKING

from dh2urdf.robot.forms import RobotForms

if TYPE_CHECKING:
    from dh2urdf.dh import DHTable
    from dh2urdf.symbolic.inverse import SymbolicIK


class RobotFormulas(RobotForms):
    """What :class:`dh2urdf.Robot` says in letters."""

    table: DHTable | None

    def symbolic_ik(self) -> SymbolicIK:
        """All solutions as formulas in the letters of the arm's table (extra ``symbolic``).

        An arm without a table, or with fixed steps between its joints, gets the table that frame
        assignment finds: ``symbolic_ik().table``.

        Returns
        -------
        SymbolicIK
            With ``text``, ``latex`` and ``python``; see :func:`dh2urdf.symbolic.symbolic_ik`.

        Raises
        ------
        NoSolverError
            An arm without closed formulas; the message says which families have them.
        UrdfError
            Joints that follow others.
        MissingExtraError
            sympy is not installed.
        """
        from dh2urdf.symbolic import symbolic_ik

        table = self.table
        if table is None or table.has_steps_between:
            from dh2urdf.conversions.assign import chain_to_dh

            table = chain_to_dh(self._own_chain(), name=self._called(), compact=False).table
        return symbolic_ik(table)
