"""A robot in other people's forms: OPW parameters, screw axes, KDL's segments."""

from dh2urdf.chain import SerialChain
from dh2urdf.chain.ortho_parallel import OrthoParallel
from dh2urdf.conversions.forms import FORMS, form_text, screw_axes
from dh2urdf.doors import choice
from dh2urdf.exceptions import UrdfError
from dh2urdf.transforms import Array


class RobotForms:
    """How :class:`dh2urdf.Robot` is said in other forms; ``Robot.from_dh`` reads their files."""

    chain: SerialChain
    joint_names: tuple[str, ...]

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
        chosen = FORMS[choice(form, "form", FORMS)]
        content = chosen.content(self._own_chain(), self._called())
        return form_text(content, chosen.head, choice(format, "format", ("yaml", "json")))

    def _own_chain(self) -> SerialChain:
        """The chain of an arm whose joints move independently."""
        if len(self.joint_names) != self.chain.n:
            raise UrdfError("joints that follow others (mimic) cannot be said in this form")
        return self.chain

    def _called(self) -> str:
        """Name of the arm."""
        raise NotImplementedError
