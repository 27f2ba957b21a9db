"""The joint values of a robot: what q means, and how it is read."""

import numpy as np
import pinocchio as pin
from numpy.typing import ArrayLike, NDArray

from dh2urdf.chain import Coupling, SerialChain
from dh2urdf.conversions.chains import ChainPath, is_continuous
from dh2urdf.dh import Mimic
from dh2urdf.doors import finite_array, generator, real_array
from dh2urdf.exceptions import ConfigurationError
from dh2urdf.transforms import Array


class RobotConfigurations:
    """What :class:`dh2urdf.Robot` knows of its joint values."""

    _model: pin.Model
    chain: SerialChain
    _path: ChainPath
    _coupling: Coupling | None

    def model_configuration(self, q: ArrayLike) -> Array:
        """The same configuration as Pinocchio's model wants it, shape (..., model.nq).

        Continuous joints become cosine and sine, mimicking joints are filled in.
        """
        flat, shape = self._flat(q)
        out = np.zeros((len(flat), self._model.nq))
        for k, i in enumerate(self._path.ids):
            at = self._model.joints[i].idx_q
            if is_continuous(self._model, i):
                out[:, at], out[:, at + 1] = np.cos(flat[:, k]), np.sin(flat[:, k])
            else:
                out[:, at] = flat[:, k]
        return out.reshape(*shape, self._model.nq)

    def chain_configuration(self, q: ArrayLike) -> Array:
        """The same configuration with every joint of the chain, followers too, (..., chain.n)."""
        flat, shape = self._flat(q)
        return flat.reshape(*shape, self.chain.n)

    def random_configuration(self, rng: np.random.Generator | int | None = None) -> Array:
        """A configuration within the limits, one turn where there are none, shape (n,).

        Parameters
        ----------
        rng : numpy.random.Generator or int, optional
        """
        return generator(rng).uniform(*self.bounded(1.0, np.pi))

    def bounded(self, length: float, angle: float) -> tuple[Array, Array]:
        """Bounds of q (n,), each so far [m or rad] from the other or from zero where missing."""
        far = np.where(self.slides, length, angle)
        low = np.where(np.isfinite(self.lower), self.lower, np.minimum(-far, self.upper - far))
        high = np.where(np.isfinite(self.upper), self.upper, np.maximum(far, low + far))
        return low, high

    @property
    def slides(self) -> NDArray[np.bool_]:
        """True where a value of q is a length, shape (n,)."""
        return (self._coupling or self.chain).prismatic

    def _flat(self, q: ArrayLike, finite: bool = True) -> tuple[Array, tuple[int, ...]]:
        """Chain configurations (m, chain.n) as kernels take them, and the leading shape.

        Where they need not be ``finite``, the caller asks the result.
        """
        door = finite_array if finite else real_array
        config = door(q, "q", "finite numbers", ConfigurationError)
        if config.ndim == 0 or config.shape[-1] != self.n:
            raise ConfigurationError(
                f"q: expected {self.n} values ({', '.join(self.joint_names)}) on the last axis, "
                f"got shape {config.shape}"
            )
        flat = config.reshape(-1, self.n)
        if self._coupling is not None:
            flat = self._coupling.joints(flat)
        return np.require(flat, requirements=["C", "A", "W"]), config.shape[:-1]

    def _values(self) -> tuple[Array, Array, NDArray[np.bool_]]:
        """Matrix (chain.n, n) and offset (chain.n,) from q to the chain's joints; which slide."""
        if self._coupling is None:
            return np.eye(self.n), np.zeros(self.n), self.slides
        return self._coupling.matrix, self._coupling.offset, self.slides

    @property
    def is_coupled(self) -> bool:
        """True where joints follow others, or are at other angles than q."""
        return self._coupling is not None

    @property
    def coupling(self) -> Coupling | None:
        """By which values q move the joints of the chain; None where each has its own."""
        return self._coupling

    def joint_ranges(self) -> tuple[Array, Array]:
        """Between which values each joint of the chain stays, (chain.n,) each, limits kept."""
        low, high = self.chain.lower, self.chain.upper
        if self._coupling is None:
            return low, high
        ends = self._coupling.ranges(self.lower, self.upper)
        return np.maximum(low, ends[0]), np.minimum(high, ends[1])

    def moved_by_several(self) -> NDArray[np.bool_]:
        """True where a joint of the chain moves by several values of q, shape (chain.n,)."""
        if self._coupling is None:
            return np.zeros(self.chain.n, np.bool_)
        several: NDArray[np.bool_] = (self._coupling.matrix != 0.0).sum(axis=1) > 1
        return several

    def moved_alone(self, joint: int) -> int | None:
        """Which value of q moves a joint of the chain by itself, one for one, and no other."""
        if self._coupling is None:
            return joint
        row = self._coupling.matrix[joint]
        value = int(np.abs(row).argmax())
        column = self._coupling.matrix[:, value]
        alone = np.count_nonzero(row) == np.count_nonzero(column) == 1 and abs(row[value]) == 1.0
        return value if alone else None

    def followed_joints(self) -> tuple[Mimic | None, ...]:
        """What each joint of the chain follows of the others; empty where none does."""
        coupling, names = self._coupling, self.chain.names
        if coupling is None:
            return ()
        out: list[Mimic | None] = []
        for name, row, offset in zip(names, coupling.matrix, coupling.offset, strict=True):
            (moving, *more), own = np.flatnonzero(row), name in coupling.names
            leader = coupling.names[moving]
            follows = not own and not more and leader in names
            out.append(Mimic(leader, float(row[moving]), float(offset)) if follows else None)
        return tuple(out)

    def _bounds(self) -> None:
        """Names and limits of the values."""
        leads = self._coupling or self.chain
        self.joint_names, self.n = leads.names, len(leads.names)
        self.lower, self.upper = leads.lower, leads.upper
