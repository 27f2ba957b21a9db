"""The task ``position+axis``: the tool may turn about its own z.

A virtual joint about the tool's z makes it a full pose of a chain with one joint more.
"""

from dataclasses import replace
from typing import Any

import numpy as np

from dh2urdf.chain import CoupledChain, SerialChain
from dh2urdf.dh import JointType
from dh2urdf.exceptions import NoSolverError
from dh2urdf.ik.arm import (
    Others,
    Outputs,
    Solver,
    SolverBase,
    Task,
    branch_words_of,
    select_solver,
    spare_joints,
)
from dh2urdf.transforms import Array


def with_tool_joint(chain: SerialChain) -> SerialChain:
    """The chain with a joint about the tool's z at its end."""
    longer: dict[str, Any] = {
        "links": np.concatenate([chain.links, np.eye(4)[None]]),
        "joint_types": (*chain.joint_types, JointType.REVOLUTE),
        "names": (*chain.names, "about the tool"),
        "lower": np.append(chain.lower, -np.inf),
        "upper": np.append(chain.upper, np.inf),
    }
    if isinstance(chain, CoupledChain):
        longer["leaders"] = (*chain.leaders, chain.n)
        longer["factors"] = np.append(chain.factors, 1.0)
        longer["kinds"] = (*chain.kinds, JointType.REVOLUTE)
        longer["turns"] = (*chain.turns, 1.0)
    return replace(chain, **longer)


class ToolAxis(SolverBase):
    """Position of the tool and direction of its z, by the full pose of a longer chain."""

    name = "tool axis"
    solves = Task.POSITION_AXIS
    if_spare = "some joints can move while the tool's origin and axis stay"
    needs = "task position+axis: a virtual joint about the tool's z makes a chain that is covered"

    def __init__(
        self, chain: SerialChain, task: Task = Task.POSITION_AXIS, others: Others = ()
    ) -> None:
        super().__init__(chain, task, others)
        self.inner: Solver = select_solver(with_tool_joint(chain), Task.POSE)
        self.kmax = self.inner.kmax
        self.branch_words = branch_words_of(self.inner)

    @classmethod
    def misfit(cls, chain: SerialChain, tolerance: float) -> str | None:
        """Say what keeps the virtual joint from helping; None if nothing does."""
        if spare_joints(chain, cls.solves):
            return cls.if_spare
        try:
            select_solver(with_tool_joint(chain), Task.POSE)
        except NoSolverError:
            return "with a joint about the tool's z no solver covers the full pose"
        return None

    def details(self) -> str:
        """Name the solver of the longer chain."""
        return f"with a virtual joint about the tool's z: {self.inner}"

    def solve_batch(self, Ts: Array, within_limits: bool, out: Outputs) -> None:
        """Solve poses Ts (m, 4, 4) into the caller's arrays; the virtual joint is left out."""
        n = self.chain.n
        q = np.empty((len(Ts), self.kmax, n + 1))
        self.inner.solve_batch(Ts, within_limits, out._replace(q=q))
        out.q[:] = q[:, :, :n]
        out.free[:] &= (1 << n) - 1
