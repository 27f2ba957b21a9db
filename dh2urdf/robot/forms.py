"""A robot in other people's forms: OPW parameters, screw axes, KDL's segments."""

from collections.abc import Sequence
from typing import Self

from numpy.typing import ArrayLike

from dh2urdf.bounds import LENGTH
from dh2urdf.chain import SerialChain
from dh2urdf.chain.ortho_parallel import OrthoParallel
from dh2urdf.dh import DHTable
from dh2urdf.doors import choice, finite_array, number
from dh2urdf.exceptions import UrdfError
from dh2urdf.transforms import Array


class RobotForms:
    """How :class:`dh2urdf.Robot` is said in other forms; ``Robot.from_dh`` reads their files."""

    chain: SerialChain
    joint_names: tuple[str, ...]

    @classmethod
    def from_opw(
        cls,
        *,
        a1: float,
        a2: float,
        b: float,
        c1: float,
        c2: float,
        c3: float,
        c4: float,
        offsets: ArrayLike = (0.0,) * 6,
        signs: ArrayLike = (1,) * 6,
        name: str = "robot",
    ) -> Self:
        """A robot of OPW parameters, as :meth:`opw_parameters` has them.

        Parameters
        ----------
        a1, a2, b, c1, c2, c3, c4 : float
            Lengths [m], see :mod:`dh2urdf.chain.ortho_parallel`.
        offsets : array_like, shape (6,)
            Offsets of the joints [rad].
        signs : array_like, shape (6,)
            1 or -1.
        name : str

        Raises
        ------
        TableError, ArgumentError
        """
        from dh2urdf.conversions.forms import OPW_KEYS, read_opw

        lengths = {"a1": a1, "a2": a2, "b": b, "c1": c1, "c2": c2, "c3": c3, "c4": c4}
        each = {key: number(v, key, -LENGTH, LENGTH) for key, v in lengths.items()}
        six = (finite_array(v, "offsets or signs", "6 numbers").tolist() for v in (offsets, signs))
        content = dict(zip(OPW_KEYS, (each, *six), strict=True))
        return cls.from_dh(read_opw(content, name)[0])

    @classmethod
    def from_screws(
        cls, S: ArrayLike, M: ArrayLike, *, names: Sequence[str] | None = None, name: str = "robot"
    ) -> Self:
        """A robot of screw axes and the home pose, as :meth:`screw_axes` has them.

        Parameters
        ----------
        S : array_like, shape (n, 6)
            ``(omega, v)`` in the base at q = 0; ``Slist.T`` of *Modern Robotics*.
        M : array_like, shape (4, 4)
            ``T_base_tip`` at q = 0.
        names : sequence of str, optional
            Of the joints.
        name : str

        Raises
        ------
        UrdfError, PoseError
        """
        from dh2urdf.conversions.forms import read_axes_form

        content = {"screws": S, "tool": M, "names": names}
        return cls.from_dh(read_axes_form(content, name)[0])

    @classmethod
    def from_dh(cls, table: DHTable) -> Self:
        """A robot of a table."""
        raise NotImplementedError

    def opw_parameters(self) -> OrthoParallel:
        """The seven lengths, offsets and signs of an ortho-parallel arm with a spherical wrist.

        Raises
        ------
        NotOrthoParallelError
            An arm of another geometry; the message has every condition that fails, and by how
            much.
        """
        return OrthoParallel.of_chain(self._own_chain())

    def screw_axes(self) -> tuple[Array, Array]:
        """Screw axes in the base at q = 0 and the home pose, as in *Modern Robotics*.

        Returns
        -------
        S : array, shape (n, 6)
            ``(omega, v)``, v in [m]; their ``Slist`` is ``S.T``.
        M : array, shape (4, 4)
            ``T_base_tip`` at q = 0.
        """
        from dh2urdf.conversions.forms import screw_axes

        return screw_axes(self._own_chain())

    def to_form(self, form: str, format: str = "yaml") -> str:
        """The text of a file that says the arm in another form.

        Parameters
        ----------
        form : {"opw", "screws", "kdl"}
        format : {"yaml", "json"}

        Raises
        ------
        NotOrthoParallelError
        """
        from dh2urdf.conversions.forms import FORMS, form_text

        chosen = FORMS[choice(form, "form", FORMS)]
        content = chosen.content(self._own_chain(), self._called())
        return form_text(content, chosen.head, choice(format, "format", ("yaml", "json")))

    def _own_chain(self) -> SerialChain:
        """The chain of an arm whose joints move independently."""
        if self.is_coupled:
            raise UrdfError(
                "joints that follow others (mimic, couplings) cannot be said in this form"
            )
        return self.chain

    @property
    def is_coupled(self) -> bool:
        """True where joints follow others, or are at other angles than q."""
        raise NotImplementedError

    def _called(self) -> str:
        """Name of the arm."""
        raise NotImplementedError
