"""One problem: poses in, solutions, batches and paths out.

`problem` joins a chain, a task and a solver; `solutions` and `batch_solutions` are its answers,
`shortfall` says why there is none, `path` goes through many poses; `swept_problem` is the same with
a joint to spare, `scaled_problem` with another unit of length; `one_call` solves
usual poses in one call into the extension; `locked` reads ``locked``; `coupled_problem` counts
otherwise than the joints do, `turns_together` what turns are then.
"""

from dh2urdf.ik.problem.batch_solutions import IKBatch
from dh2urdf.ik.problem.coupled_problem import CoupledProblem, held_joints
from dh2urdf.ik.problem.locked import Locked, held_values
from dh2urdf.ik.problem.one_call import HeldCalls, PlainCalls
from dh2urdf.ik.problem.path import IKPath
from dh2urdf.ik.problem.problem import ForwardKinematics, Problem, Progress
from dh2urdf.ik.problem.scaled_problem import ScaledProblem, find_path
from dh2urdf.ik.problem.solutions import IKSolutions
from dh2urdf.ik.problem.swept_problem import SweptProblem
