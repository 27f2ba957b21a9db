"""Two arms compared: the same or not, up to what, and where not.

`arms` takes what is given, `relation` is what makes one arm another: `alignment` lays the joint
axes on each other within what `freedom` leaves, `refine` draws them together, `relate` measures.
`cells` and `mistakes` are what tables differ in, `diagnose` which of them it was; `result` says it,
`between` is the entry.
"""

from dh2urdf.comparison.between import TOLERANCE, TOLERANCES, compare
from dh2urdf.comparison.cells import Difference
from dh2urdf.comparison.mistakes import Mistake
from dh2urdf.comparison.result import Comparison
