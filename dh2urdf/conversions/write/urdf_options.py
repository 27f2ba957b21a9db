"""What may be chosen about a written URDF."""

from dataclasses import dataclass

from dh2urdf.doors import flag, integer, number


@dataclass(frozen=True)
class UrdfOptions:
    """What may be chosen about the file.

    Parameters
    ----------
    dh_frames : bool
        Write the DH frames as fixed links ``dh_0 ... dh_n``.
    collision : bool
        Write the drawn bodies as collision geometry too.
    density : float
        Density [kg/m^3] of the drawn bodies where a row has no mass. Half that of aluminium,
        as arms are hollow: it puts a UR5 at 21 kg (maker: 20.6) and an iiwa 14 at 28 kg (29.9).
    balance_inertia : bool
        Raise the small moments of published tensors that no body could have, so that every
        consumer accepts them (with a warning); off keeps them as published.
    digits : int or None
        Round origins and limits to so many decimals, for IKFast users; None writes all floats
        whole.
    embed_table : bool
        Keep the table itself in a ``<dh2urdf>`` element.

    Raises
    ------
    ArgumentError
    """

    dh_frames: bool = True
    collision: bool = False
    density: float = 1350.0
    balance_inertia: bool = True
    digits: int | None = None
    embed_table: bool = True

    def __post_init__(self) -> None:
        for key in ("dh_frames", "collision", "balance_inertia", "embed_table"):
            object.__setattr__(self, key, flag(getattr(self, key), key))
        density = number(self.density, "density", 1e-3, 1e6, unit="kg/m^3")
        object.__setattr__(self, "density", density)
        if self.digits is not None:
            object.__setattr__(self, "digits", integer(self.digits, "digits", 0, 17))
