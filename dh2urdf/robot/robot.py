"""A robot: a Pinocchio model, the serial chain between two of its frames, and their agreement."""

import os
import threading
from collections.abc import Mapping
from functools import cached_property
from pathlib import Path
from typing import cast

import numpy as np
import pinocchio as pin
from numpy.typing import ArrayLike

from dh2urdf.bounds import JOINTS
from dh2urdf.chain import coupling_of, follow, settled_state
from dh2urdf.conversions.chains import (
    carried_dh_frames,
    carried_joint_frames,
    chain_path,
    frame_id,
    model_to_chain,
    with_locked,
)
from dh2urdf.conversions.read import NOTHING, TEXT, Xacro, read_description, xacro_given
from dh2urdf.conversions.write import LinkFrames, add_masses, dh_to_chain, link_frames, table_model
from dh2urdf.dh import DHTable, Mimic
from dh2urdf.dh_io import TableLike, as_table
from dh2urdf.doors import flag, real_array
from dh2urdf.exceptions import ConfigurationError, UrdfError, VerificationError
from dh2urdf.kernels.chain import (
    chain_fk,
    chain_fk_batch,
    chain_frames_batch,
    chain_jacobian,
    chain_jacobian_batch,
)
from dh2urdf.robot.another_table import RobotOfAnotherTable
from dh2urdf.robot.explained import RobotExplained
from dh2urdf.robot.formulas import RobotFormulas
from dh2urdf.robot.lazily import is_lazy, lazy_fk
from dh2urdf.robot.pictures import RobotPictures
from dh2urdf.transforms import Array

AGREEMENT = 1e-12
"""Largest difference between Pinocchio and the chain when a robot is built [rad, and m per m of
all lengths on the way]: both are products of the same rigid transforms, of no more than 200."""

TRIALS = np.random.default_rng(0).random((2, JOINTS))
"""Configurations at which they are compared, as shares of the joints' ranges."""


class _Working(threading.local):
    """Pinocchio's working memory for a model: ``data``, another one in every thread."""

    def __init__(self, model: pin.Model) -> None:
        self._model, self.data = model, model.createData()

    def __reduce__(self) -> "tuple[type[_Working], tuple[pin.Model]]":
        """Pickle by the model."""
        return _Working, (self._model,)


class Robot(RobotExplained, RobotPictures, RobotFormulas, RobotOfAnotherTable):
    """Kinematics of the chain from ``base`` to ``tip`` of a Pinocchio model.

    Made by :meth:`from_dh` or :meth:`from_urdf`. Any number of threads may call it at once.

    Attributes
    ----------
    model : pin.Model
        The joints of the chain; all other joints of the file are locked at neutral.
    chain : SerialChain
        The same chain as constant links between z axes.
    table : DHTable or None
        The table the robot was made from.
    n : int
        Number of joint values in q.
    joint_names : tuple of n str
    lower, upper : array, shape (n,)
        Bounds of q [rad] or [m], infinite where there are none.
    base, tip : str
        Names of the two frames; ``T_base_tip`` is what ``fk`` and ``ik`` speak of.
    source : Path or None
        The robot description that the robot was made from.
    warnings : tuple of str
        What was mended in memory while loading, each with its element and line.
    """

    source: Path | None = None
    xacro: Xacro = NOTHING
    warnings: tuple[str, ...] = ()
    __getstate__ = settled_state

    def __init__(
        self,
        model: pin.Model,
        base: str,
        tip: str,
        *,
        table: DHTable | None = None,
        frames: LinkFrames | None = None,
        mimics: dict[str, Mimic] | None = None,
    ) -> None:
        self.table = table
        base_id, tip_id = frame_id(model, base), frame_id(model, tip)
        path = chain_path(model, base_id, tip_id)
        others = [i for i in range(1, model.njoints) if i not in path.ids]
        if others:
            model = with_locked(model, others)
            path = chain_path(model, frame_id(model, base), frame_id(model, tip))
        self._model, self.base, self.tip = model, base, tip
        self._path = path
        if table and frames:
            self.chain, self._carried = dh_to_chain(table, frames), carried_dh_frames(table, frames)
            self._coupling = coupling_of(table, self.chain)
        else:
            self.chain = model_to_chain(model, path)
            self._carried = carried_joint_frames(model, path, self.chain)
            self._coupling = follow(self.chain, mimics or {})
        self._bounds()
        self._plain = (self.n,) if self._coupling is None else None
        self._working = _Working(model)
        self._check_agreement()

    @classmethod
    def from_dh(cls, table: TableLike) -> "Robot":
        """A robot of a DH table, a table file, or the name of a table that ships.

        Raises
        ------
        TableFileError, NameNotFoundError

        Examples
        --------
        >>> from dh2urdf import Robot
        >>> robot = Robot.from_dh("ur5")
        >>> robot.n, str(robot.solver)
        (6, 'three parallel axes')
        """
        given = as_table(table)
        frames = link_frames(given)
        model = table_model(given, frames)
        robot = cls(model, "base_link", "tool0", table=given, frames=frames)
        if robot._coupling is not None:
            robot.warnings = robot._coupling.warnings
        return robot

    @cached_property
    def model(self) -> pin.Model:
        """The joints of the chain, all others held at neutral, with the masses of the links."""
        if self.table is not None:
            add_masses(self._model, self.table, self.chain)
        return self._model

    @classmethod
    def from_urdf(
        cls,
        path: str | os.PathLike[str],
        base: str | None = None,
        tip: str | None = None,
        *,
        strict: bool = False,
        xacro_args: Mapping[str, object] | None = None,
        packages: Mapping[str, str | os.PathLike[str]] | None = None,
    ) -> "Robot":
        """A robot of a URDF (``.xacro`` with the extra, MJCF) between two of its links.

        Parameters
        ----------
        path : path
        base, tip : str, optional
            Links anywhere in the tree. Without them: the root, and the end of the longest chain.
        strict : bool
            Refuse a file in which something had to be mended, which ``warnings`` tells.
        xacro_args : dict, optional
            Arguments of a xacro: ``{"ur_type": "ur5e"}``.
        packages : dict, optional
            Folders of ROS packages by name; others are looked for in ``ROS_PACKAGE_PATH`` and
            beside the file.

        Raises
        ------
        UrdfError, NameNotFoundError
        """
        given = xacro_given(xacro_args, packages)
        found = read_description(path, base, tip, strict=flag(strict, "strict"), given=given)
        mimics = {joint.name: joint.mimic for joint in found.tree.joints if joint.mimic}
        robot = cls(found.model, found.base_frame, found.tip, mimics=mimics)
        coupled = robot._coupling.warnings if robot._coupling else ()
        if strict and coupled:
            raise UrdfError("\n".join(coupled))
        robot.source = None if found.tree.where == TEXT else Path(path)
        robot.xacro = given
        robot.warnings = (*found.mends, *coupled)
        return robot

    def fk(self, q: ArrayLike) -> Array:
        """Pose of the tip in the base, ``T_base_tip``.

        Parameters
        ----------
        q : array_like, shape (n,) or (..., n)
            Configuration [rad] or [m]; an array of Dask gives one of Dask.

        Returns
        -------
        array, shape (4, 4) or (..., 4, 4)

        Raises
        ------
        ConfigurationError
            Last axis is not n long, or not all are finite numbers.

        Examples
        --------
        >>> from dh2urdf import Robot
        >>> Robot.from_dh("planar_rr").fk([[0, 0], [0, 1.5707963267948966]])[:, :2, 3].round(6)
        array([[1.7, 0. ],
               [1. , 0.7]])
        """
        if type(q) is not np.ndarray and is_lazy(q):
            return cast("Array", lazy_fk(self, q))
        config = real_array(q, "q", "finite numbers", ConfigurationError)
        if config.shape == self._plain and config.flags.c_contiguous:
            T = np.empty((4, 4))
            if chain_fk(self.chain.links, self.chain.prismatic, config, T):
                return T
        flat, shape = self._flat(config, finite=False)
        T = np.empty((len(flat), 4, 4))
        if not chain_fk_batch(self.chain.links, self.chain.prismatic, flat, T):
            self._flat(config)
        return T.reshape(*shape, 4, 4)

    def frames(self, q: ArrayLike) -> Array:
        """DH frames 0 ... n in the base, or the base and the joint frames of a URDF.

        Parameters
        ----------
        q : array_like, shape (n,) or (..., n)

        Returns
        -------
        array, shape (..., n + 1, 4, 4)
            For a robot made from a URDF: entry 0 is the base itself, entry i the frame of
            joint i as Pinocchio places it, after its motion.
        """
        flat, shape = self._flat(q)
        T = np.empty((len(flat), self.chain.n + 1, 4, 4))
        chain_frames_batch(self.chain.links, self.chain.prismatic, self._carried, flat, T)
        return T.reshape(*shape, self.chain.n + 1, 4, 4)

    def jacobian(self, q: ArrayLike) -> Array:
        """Geometric Jacobian at the tip, linear over angular, in base axes.

        Pinocchio's ``LOCAL_WORLD_ALIGNED`` with the base as world.

        Parameters
        ----------
        q : array_like, shape (n,) or (..., n)

        Returns
        -------
        array, shape (6, n) or (..., 6, n)

        Examples
        --------
        >>> from dh2urdf import Robot
        >>> Robot.from_dh("planar_rr").jacobian([0, 0])[[0, 1, 5]].round(6)
        array([[0. , 0. ],
               [1.7, 0.7],
               [1. , 1. ]])
        """
        config = real_array(q, "q", "finite numbers", ConfigurationError)
        if config.shape == self._plain and config.flags.c_contiguous:
            J = np.empty((6, self.n))
            if chain_jacobian(self.chain.links, self.chain.prismatic, config, J):
                return J
        flat, shape = self._flat(config)
        out = np.empty((len(flat), 6, self.chain.n))
        chain_jacobian_batch(self.chain.links, self.chain.prismatic, flat, out)
        if self._coupling is not None:
            out = out @ self._coupling.matrix
        return out.reshape(*shape, 6, self.n)

    def _placements(self, q: Array) -> Array:
        """``T_base_tip`` of configurations (k, n) by Pinocchio, shape (k, 4, 4)."""
        T, data = np.empty((len(q), 4, 4)), self._working.data
        for k, config in enumerate(self.model_configuration(q)):
            pin.framesForwardKinematics(self._model, data, config)
            M_world_base = data.oMf[self._path.base]
            T[k] = (M_world_base.inverse() * data.oMf[self._path.tip]).homogeneous
        return T

    def _check_agreement(self) -> None:
        """Compare the chain's product with Pinocchio's frame placement."""
        low, high = self.bounded(1.0, np.pi)
        q = low + TRIALS[:, : self.n] * (high - low)
        joints, T = self._flat(q)[0], np.empty((len(q), 4, 4))
        chain_fk_batch(self.chain.links, self.chain.prismatic, joints, T)
        off = np.abs(T - self._placements(q))
        angle, length = float(off[:, :3, :3].max()), float(off[:, :3, 3].max())
        reach = np.abs(self.chain.links[:, :3, 3]).sum()
        travel = np.abs(joints[:, self.chain.prismatic]).sum(axis=1).max()
        allowed = AGREEMENT * max(1.0, self._model.nframes / 200)
        size = max(1.0, float(reach + travel))
        if not (angle <= allowed and length <= allowed * size):
            raise VerificationError(
                f"the chain from {self.base} to {self.tip} differs from Pinocchio by "
                f"{max(angle, length):.3g} (allowed {allowed:.2g} rad, {allowed * size:.2g} m)"
            )

    def _called(self) -> str:
        return self.table.name if self.table else self._model.name

    def __repr__(self) -> str:
        return f"<Robot {self._model.name}: {self.n} joints, {self.base} to {self.tip}>"
