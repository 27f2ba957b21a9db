"""From a tree, a Pinocchio model or typed axes to the serial chain between two links.

`extract_source` takes whatever there is: `tree_chain`, `model_chain`, `typed_axes`; `carried`
is drives, bodies and frames that ride on joints, `referee` Pinocchio's word.
"""

from dh2urdf.conversions.chains.carried import (
    carried_dh_frames,
    carried_joint_frames,
    carry,
    following,
    following_alike,
)
from dh2urdf.conversions.chains.extract_source import read_source
from dh2urdf.conversions.chains.model_chain import (
    ChainPath,
    chain_path,
    frame_id,
    is_continuous,
    model_to_chain,
    with_locked,
)
from dh2urdf.conversions.chains.referee import configurations, table_poses, turn_slide
from dh2urdf.conversions.chains.typed_axes import axes_to_chain, typed_to_chain
