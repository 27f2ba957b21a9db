"""Poses of an arm with one joint to spare: what is nearest to a seed lies between the samples."""

import numpy as np

from dh2urdf.ik.arm import turned_to
from dh2urdf.ik.problem.problem import Problem
from dh2urdf.ik.problem.solutions import IKSolutions
from dh2urdf.ik.redundant import SweptJoint, nearest_members, reach_intervals
from dh2urdf.transforms import Array


class SweptProblem(Problem):
    """A problem whose solver sweeps a joint."""

    solver: SweptJoint

    def arranged(self, found: IKSolutions, seed: Array, within_limits: bool = True) -> IKSolutions:
        """The nearest members to the seed (n,) on all self-motions, then the samples."""
        near = nearest_members(self.solver, found.T, seed, within_limits)
        q = np.concatenate([near, turned_to(self.chain, found.q, seed)])
        order = np.argsort(np.linalg.norm(q - seed, axis=1), kind="stable")
        branch, free = found.codes
        arranged = IKSolutions.of(
            self,
            found.T,
            q[order],
            np.empty(len(q)),
            np.concatenate([np.full(len(near), -1), branch])[order],
            np.concatenate([np.zeros(len(near), np.int64), free])[order],
        )
        return self._accepted(self._at(arranged, q[order]))

    def intervals(self, T: Array, within_limits: bool) -> Array:
        """Intervals of the swept joint in which a pose (4, 4) is reached, shape (k, 2)."""
        return reach_intervals(self.solver, T, within_limits)
