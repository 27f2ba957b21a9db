"""The serial chain, and the geometry that most industrial arms have.

`serial_chain` is the one form that every conversion and every algorithm starts from; `coupling` how
fewer or other values move its joints, `coupled_chain` a chain that fewer values move;
`ortho_parallel` the parameters of arms with an ortho-parallel base and a spherical wrist.
"""

from dh2urdf.chain.coupled_chain import CoupledChain
from dh2urdf.chain.coupling import Coupling, coupling_of, follow, parted, resolved
from dh2urdf.chain.serial_chain import FARTHEST, SerialChain, settled_state

__all__ = [
    "FARTHEST",
    "CoupledChain",
    "Coupling",
    "SerialChain",
    "coupling_of",
    "follow",
    "parted",
    "resolved",
    "settled_state",
]
