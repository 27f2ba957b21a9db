"""The table of solvers, best first, and the choice of one for a chain."""

from dataclasses import dataclass

from dh2urdf.chain import SerialChain
from dh2urdf.exceptions import NoSolverError
from dh2urdf.ik.arm.mobility import hardly_moves
from dh2urdf.ik.arm.solver import Others, Solver, SolverBase, Task, imported


@dataclass(frozen=True)
class SolverRow:
    """One row of :data:`SOLVERS`: a family, what it needs, and where its class is."""

    name: str
    needs: str
    where: str

    def load(self) -> type[SolverBase]:
        """Import the class, when it is first wanted."""
        family: type[SolverBase] = imported(self.where)
        return family


SOLVERS: tuple[SolverRow, ...] = (
    SolverRow(
        "spherical wrist",
        "six joints, the last three revolute with axes through one point",
        "dh2urdf.ik.families.spherical_wrist:SphericalWrist",
    ),
    SolverRow(
        "three parallel axes",
        "six revolute joints, axes 1, 2, 3 or 2, 3, 4 parallel",
        "dh2urdf.ik.families.three_parallel:ThreeParallel",
    ),
    SolverRow(
        "spherical shoulder",
        "six joints, the first three revolute with axes through one point",
        "dh2urdf.ik.families.reversed_chain:SphericalShoulder",
    ),
    SolverRow(
        "three parallel axes, from the tool",
        "six revolute joints, axes 3, 4, 5 or 4, 5, 6 parallel",
        "dh2urdf.ik.families.reversed_chain:ThreeParallelReversed",
    ),
    SolverRow(
        "planar arm",
        "two or three revolute joints with parallel axes",
        "dh2urdf.ik.families.planar:PlanarArm",
    ),
    SolverRow(
        "three slides",
        "three sliding joints and two or three turning ones",
        "dh2urdf.ik.families.three_slides:ThreeSlides",
    ),
    SolverRow(
        "short chain",
        "one to five joints of any kind, each of which moves the tool",
        "dh2urdf.ik.families.short:ShortChain",
    ),
    SolverRow(
        "position arm",
        "task position: one to three joints of any kind, each of which moves the tool's origin",
        "dh2urdf.ik.families.short_position:ShortPosition",
    ),
    SolverRow(
        "tool axis",
        "task position+axis: a virtual joint about the tool's z makes a chain that is covered",
        "dh2urdf.ik.families.tool_axis:ToolAxis",
    ),
    SolverRow(
        "nearly a family",
        "six revolute joints, rounded or calibrated: nearly one of the first four rows",
        "dh2urdf.ik.families.near_family:NearFamily",
    ),
    SolverRow(
        "general 6R", "six revolute joints, any axes", "dh2urdf.ik.families.general_6r:General6R"
    ),
    SolverRow(
        "swept joint",
        "seven joints, one of which can be held so that a row above covers the others",
        "dh2urdf.ik.redundant.swept:SweptJoint",
    ),
    SolverRow(
        "joints to spare",
        "one or two joints that can move while the task stays satisfied; they are held",
        "dh2urdf.ik.redundant.redundancy:RedundantChain",
    ),
)
"""Families, best first; a chain gets the first that has no obstacle."""

SEARCHED = "dh2urdf.ik.redundant.searched:SearchedSolver"
"""What helps the solver of an arm that hardly moves in some direction."""


def select_solver(chain: SerialChain, task: Task | str = Task.POSE) -> Solver:
    """Build the best solver that covers the chain for the task.

    Raises
    ------
    NoSolverError
        No family covers it; the message lists each with what stood in its way.
    """
    task = Task(task)
    others: Others = ()
    for row in SOLVERS:
        family = row.load()
        obstacle = family.obstacle(chain, task)
        if obstacle is None:
            solver = family(chain, task, others)
            return _searched(solver) if hardly_moves(chain, task) else solver
        others += ((row.name, obstacle),)
    listing = "\n".join(
        f"  {row.name} ({row.needs}): {obstacle}"
        for row, (_, obstacle) in zip(SOLVERS, others, strict=True)
    )
    raise NoSolverError(
        f"no solver finds all solutions for task {task.value!r} of this {chain.n}-joint chain; "
        f"ik_numeric finds some. The classes that exist, and what keeps them from it:\n{listing}"
    )


def _searched(solver: Solver) -> Solver:
    """The solver, helped by a search for poses that it loses."""
    helped: Solver = imported(SEARCHED)(solver)
    return helped
