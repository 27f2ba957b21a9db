"""The serial chain: forward kinematics and Jacobian, one configuration and many.

`forward` is the product of links and joints, `lanes` the same for a block of configurations side
by side, `held_joint` holds one joint at a value.
"""

from dh2urdf.kernels.chain.forward import (
    applied,
    applied_inverse,
    chain_fk,
    chain_fk_batch,
    chain_frames_batch,
    chain_jacobian,
    chain_jacobian_batch,
    jacobian_rows,
    joint_times_link,
    load_pose,
    store_pose,
    times_link,
    turned,
    turned_back,
)
from dh2urdf.kernels.chain.held_joint import (
    held_links,
    held_pose,
    held_poses,
    insert_held,
    insert_held_batch,
    inverse_pose,
)
