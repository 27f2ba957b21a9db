"""The table of solvers, best first, and the choice of one for a chain."""

from dh2urdf.chain import CoupledChain, SerialChain
from dh2urdf.exceptions import NoSolverError
from dh2urdf.ik.arm.solver import Others, Solver, SolverBase, imported
from dh2urdf.ik.arm.task import Task, hardly_moves

SOLVERS = (
    "dh2urdf.ik.families.spherical_wrist:SphericalWrist",
    "dh2urdf.ik.families.closed_form:ThreeParallel",
    "dh2urdf.ik.families.reversed_chain:SphericalShoulder",
    "dh2urdf.ik.families.reversed_chain:ThreeParallelReversed",
    "dh2urdf.ik.families.planar:PlanarArm",
    "dh2urdf.ik.families.short:ThreeSlides",
    "dh2urdf.ik.families.short:ShortChain",
    "dh2urdf.ik.families.short_position:ShortPosition",
    "dh2urdf.ik.families.tool_axis:ToolAxis",
    "dh2urdf.ik.families.near_family:NearFamily",
    "dh2urdf.ik.families.two_parallel:TwoParallel",
    "dh2urdf.ik.families.general_6r:General6R",
    "dh2urdf.ik.redundant.swept:SweptJoint",
    "dh2urdf.ik.redundant.held_at_rest:RedundantChain",
)
"""Modules and classes of the families, best first, imported when wanted; each class says what it
needs, and a chain gets the first that has no obstacle."""

FOLLOWED = (
    "dh2urdf.ik.families.straightened:Straightened",
    "dh2urdf.ik.families.followers:Followers",
    "dh2urdf.ik.families.tool_axis:ToolAxis",
    "dh2urdf.ik.redundant.held_at_rest:RedundantChain",
)
"""The same for chains whose joints follow fewer values."""

SEARCHED = "dh2urdf.ik.redundant.searched:SearchedSolver"
"""What helps the solver of an arm that hardly moves in some direction."""


def select_solver(chain: SerialChain, task: Task | str = Task.POSE) -> Solver:
    """Build the best solver that covers the chain for the task.

    Raises
    ------
    NoSolverError
        No family covers it; the message lists each with what stood in its way.
    """
    task, listing = Task(task), ""
    others: Others = ()
    for where in FOLLOWED if isinstance(chain, CoupledChain) else SOLVERS:
        family: type[SolverBase] = imported(where)
        obstacle = family.obstacle(chain, task)
        if obstacle is None:
            solver: Solver = family(chain, task, others)
            if hardly_moves(chain, task):
                solver = imported(SEARCHED)(solver)
            return solver
        others += ((family.name, obstacle),)
        listing += f"\n  {family.name} ({family.needs}): {obstacle}"
    remedy = next((f": {why}" for _, why in others if "hold some" in why), "")
    raise NoSolverError(
        f"no solver finds all solutions for task {task.value!r} of this {chain.n}-joint chain"
        f"{remedy}; ik_numeric finds some. The classes that exist, and what keeps them from it:"
        f"{listing}"
    )
