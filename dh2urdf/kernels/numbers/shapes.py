"""Kinds and shapes of the arrays that entries take: names of lengths stand for any number.

The ``n`` joints of a chain, ``poses`` of a batch, ``solutions`` for which there is room.
"""

from typing import Annotated, TypeAlias

import numpy as np
from numpy.typing import NDArray

Floats: TypeAlias = NDArray[np.float64]
Integers: TypeAlias = NDArray[np.int64]
Flags: TypeAlias = NDArray[np.bool_]

Pose: TypeAlias = Annotated[Floats, 4, 4]
Poses: TypeAlias = Annotated[Floats, "poses", 4, 4]
Three: TypeAlias = Annotated[Floats, 3]

Links: TypeAlias = Annotated[Floats, "n + 1", 4, 4]
Links6: TypeAlias = Annotated[Floats, 7, 4, 4]
"""``T_base_tool = links[0] Z_1(q_1) links[1] ... Z_n(q_n) links[n]``."""

Joints: TypeAlias = Annotated[Floats, "n", 3]
Joints6: TypeAlias = Annotated[Floats, 6, 3]
"""A row a joint: 1.0 where it slides, lower bound, upper bound."""

Rows6: TypeAlias = Annotated[Floats, 6, 7]
"""A row a joint: a, cos alpha, sin alpha, d, offset, its sine, sign of the joint."""

Ends: TypeAlias = Annotated[Floats, 3, 4, 4]
"""From base to the first row's frame and from the last to the tool, both inverse; the tool."""

Solutions: TypeAlias = Annotated[Floats, "poses", "solutions", "n"]
Solutions8: TypeAlias = Annotated[Floats, "poses", 8, 6]
Values: TypeAlias = Annotated[Floats, "poses", "solutions"]
Values8: TypeAlias = Annotated[Floats, "poses", 8]
Codes: TypeAlias = Annotated[Integers, "poses", "solutions"]
Codes8: TypeAlias = Annotated[Integers, "poses", 8]
Counts: TypeAlias = Annotated[Integers, "poses"]
