"""Drake reads a generated URDF and agrees on where the tool is."""

import sys
import tempfile
from pathlib import Path

import numpy as np

import dh2urdf

try:
    from pydrake.multibody.parsing import Parser
    from pydrake.multibody.plant import MultibodyPlant
except ImportError as error:
    print(f"not run: {error}; pip install drake")
    sys.exit(0)

robot = dh2urdf.Robot.from_dh("ur5e")
path = Path(tempfile.mkdtemp()) / "ur5e.urdf"
dh2urdf.write_urdf(robot.table, path)

plant = MultibodyPlant(time_step=0.0)
Parser(plant).AddModels(str(path))
plant.WeldFrames(plant.world_frame(), plant.GetFrameByName(robot.base))
plant.Finalize()
context = plant.CreateDefaultContext()

worst = 0.0
for seed in range(20):
    q = robot.random_configuration(seed)
    plant.SetPositions(context, q)
    T = plant.GetFrameByName(robot.tip).CalcPoseInWorld(context).GetAsMatrix4()
    worst = max(worst, float(np.abs(T - robot.fk(q)).max()))
print(f"Drake's tool and ours differ by {worst:.0e} at most, 20 configurations")
assert worst < 1e-12
