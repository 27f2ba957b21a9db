"""Where floating-point errors may occur in kernels, and why: what comes of them is bounded."""

WHY = {
    "Joint values of callers that are no numbers, or huge: the poses are none either, and nobody "
    "else's (tests/kernels/test_chain_batch.py, test_elementary.py).": """
        numbers/elementary.py few_turns: invalid
        numbers/elementary.py sincos: invalid overflow
        rigid.py _slid: invalid
        chain.py _slide: invalid
        chain.py jacobian_rows: invalid
    """,
    "Poses and seeds of callers that are no numbers fail comparisons, and are refused "
    "(tests/ik/test_given_poses.py, test_one_call.py).": """
        numbers/poses.py _rigid: invalid
        certificate/arrange.py arrange_plain: invalid
    """,
    "Poses so far away that squares are infinite: no comparison holds, so that nothing is within "
    "reach (tests/ik/test_ik_contract.py).": """
        rigid.py dot: invalid
        parallel_axes/blocks.py _shoulders: invalid overflow
        blocks.py planar_arm: invalid
        numbers/trig.py arctangent: invalid
    """,
    "Roots whose null vectors, or loops whose links, make no seed: such lanes go through Newton "
    "steps beside others, are not kept, and count as far off, so that doubt is told "
    "(tests/kernels/general_6r/test_follow.py).": """
        general_6r/resultant.py as_length: invalid
        general_6r/resultant.py two_joints: invalid
        general_6r/resultant.py _pencil: invalid divided overflow
        general_6r/resultant.py split_pairs: invalid overflow
        general_6r/resultant.py outer_joints: invalid divided
        general_6r/follow.py polish_lanes: invalid
        general_6r/follow.py keep_lane: invalid
        general_6r/follow.py follow: invalid
        newton/lanes.py pose_error: invalid
        newton/lanes.py newton_step: invalid
        numbers/lanes.py _make_reflector: invalid
        numbers/elementary.py atan2: invalid
    """,
    "What rounding left over pivots that are none: the pivots stay what they are raised to, and a "
    "determinant that is no number is zero (tests/kernels/test_lost_directions.py).": """
        newton/steps.py factor: overflow
    """,
    "The square of a ratio that is huge: the turn is by zero, as it is but for rounding.": """
        certificate/directions.py decompose: overflow
    """,
}

LINES = [line.strip() for lines in WHY.values() for line in lines.strip().splitlines()]

MAY = {where: tuple(kinds.split()) for where, _, kinds in (line.partition(": ") for line in LINES)}
"""Functions, by file and name, and which errors."""
