"""Joint origins and axes of the makers' robot descriptions, the referee of the tables that ship.

A chain is a string of steps ``x y z / roll pitch yaw / axis`` in metres and radians, one a joint,
separated by semicolons; the axis is ``x``, ``y`` or ``z``, ``-`` before it where the joint turns
the other way, ``P`` after it for a prismatic joint, and ``.`` for a fixed step. Numbers are written
as the sources have them, roundings such as 1.5708 included.
"""

H = "1.5707963267948966"
PI = "3.141592653589793"


def _ur(d1: str, a2: str, a3: str, d4: str, d5: str, d6: str) -> str:
    return (
        f"0 0 {d1} / 0 0 0 / z; 0 0 0 / 1.570796327 0 0 / z; {a2} 0 0 / 0 0 0 / z;"
        f"{a3} 0 {d4} / 0 0 0 / z; 0 -{d5} 0 / 1.570796327 0 0 / z; 0 {d6} 0 / {H} {PI} {PI} / z"
    )


def _straight(steps: str, tool: str = "0 0 0 / 0 0 0") -> str:
    """Write out a chain of joints ``x y z axis`` without rpy and a tool ``xyz / rpy``."""
    joints = [s.split() for s in steps.split(";")]
    return ";".join(f"{x} {y} {z} / 0 0 0 / {axis}" for x, y, z, axis in joints) + f"; {tool} / ."


ABB_TOOL = f"0 0 0 / 0 {H} 0"
FANUC_TOOL = f"0 0 0 / {PI} -{H} 0"
FRANKA = (
    f"0 0 0.333 / 0 0 0 / z; 0 0 0 / -{H} 0 0 / z; 0 -0.316 0 / {H} 0 0 / z;"
    f"0.0825 0 0 / {H} 0 0 / z; -0.0825 0.384 0 / -{H} 0 0 / z; 0 0 0 / {H} 0 0 / z;"
    f"0.088 0 0 / {H} 0 0 / z; 0 0 0.107 / 0 0 0 / ."
)
IRB140 = _straight("0 0 .104 z; .07 0 .248 y; 0 0 .36 y; .38 0 0 x; 0 0 0 y; .065 0 0 x", ABB_TOOL)
CRX = "0 0 .245 z; 0 0 0 y; 0 0 {} -y; 0 0 0 -x; .54 -.15 0 -y; .16 0 0 -x"

CHAINS = {
    # Universal_Robots_ROS2_Description, config/*/default_kinematics.yaml
    "ur3e": _ur("0.15185", "-0.24355", "-0.2132", "0.13105", "0.08535", "0.0921"),
    "ur5e": _ur("0.1625", "-0.425", "-0.3922", "0.1333", "0.0997", "0.0996"),
    "ur16e": _ur("0.1807", "-0.4784", "-0.36", "0.17415", "0.11985", "0.11655"),
    "ur20": _ur("0.2363", "-0.862", "-0.7287", "0.201", "0.1593", "0.1543"),
    "ur30": _ur("0.2363", "-0.637", "-0.5037", "0.201", "0.1593", "0.1543"),
    # franka_description, robots/fr3/kinematics.yaml
    "franka_fr3": FRANKA,
    # ros-industrial/abb and abb_experimental
    "abb_irb120": _straight(
        "0 0 0 z; 0 0 .29 y; 0 0 .27 y; 0 0 .07 x; .302 0 0 y; .072 0 0 x", ABB_TOOL
    ),
    "abb_irb140": IRB140,
    "abb_irb140_modified": IRB140,
    "abb_gofa5": _straight(
        "0 0 .265 z; 0 0 0 y; 0 0 .444 y; 0 0 .11 x; .47 0 0 y; .101 0 .08 x", ABB_TOOL
    ),
    "abb_irb5400": (
        "0 0 0 / 0 0 0 / z; .3 0 .66 / 0 0 0 / y; 0 0 1.2 / 0 0 0 / y; 1.339 0 .186 / 0 0 0 / x;"
        ".0693 0 0 / 0 .6109 0 / x; .106246 0 .074394 / 0 -1.2217 0 / x;"
        ".0672 0 -.0470 / 0 .6109 0 / x; 0 0 0 / 0 1.57079632679 0 / ."
    ),
    # the arm of ros-industrial/abb_experimental on a track of robotkinematicscatalogue
    "abb_irb4600_track": _straight(
        ".6455 0 .3705 xP; 0 0 .495 z; .175 0 0 y; 0 0 1.095 y; 0 0 .175 x; 1.27 0 0 y; .135 0 0 x",
        ABB_TOOL,
    ),
    # robotkinematicscatalogue, lengths of weigao95/yaik
    "abb_irb460": _straight(
        "0 0 0 z; .26 0 .7425 y; 0 0 .945 y; 0 0 0 y; 1.025 0 0 y; .22 0 0 -z",
        f"0 0 -.2515 / 0 {PI} 0",
    ),
    # along x and y of the base, then a frame that is turned by 30 deg about x
    "cross_slide_arm": (
        "0 0 .4 / 0 0 0 / xP; 0 0 0 / 0 0 0 / yP; 0 0 0 / 0 0 0 / z; 0 0 .3 / 0 0 0 / -y;"
        f".25 -.05 0 / .5235987755982988 0 0 / -y; 0 -.2 0 / 0 0 0 / -z; .05 0 -.1 / {PI} 0 0 / ."
    ),
    # ros-industrial/fanuc
    "fanuc_r1000ia80f": _straight(
        "0 0 .45 z; .32 0 0 y; 0 0 .87 -y; 0 0 .225 -x; 1.015 0 0 -y; .175 0 0 -x", FANUC_TOOL
    ),
    "fanuc_lrmate200id": _straight(
        "0 0 .33 z; .05 0 0 y; 0 0 .33 -y; 0 0 .035 -x; .335 0 0 -y; .08 0 0 -x", FANUC_TOOL
    ),
    "fanuc_crx10ia": _straight(CRX.format(".54"), FANUC_TOOL),
    "fanuc_crx10ia_l": _straight(CRX.format(".71"), FANUC_TOOL),
    # ros-industrial/kuka_experimental
    "kuka_kr5_arc": (
        f"0 0 .4 / {PI} 0 0 / z; .18 0 0 / {H} 0 0 / z; .6 0 0 / 0 0 0 / z;"
        f"0 -.12 0 / 0 -{H} 0 / z; 0 0 -.62 / 0 {H} 0 / z; 0 0 0 / 0 -{H} 0 / z;"
        f"0 0 -.115 / 0 -{PI} -{H} / ."
    ),
    "kuka_kr6_r700": _straight(
        "0 0 .4 -z; .025 0 0 y; .315 0 0 y; 0 0 .035 -x; .365 0 0 y; .08 0 0 -x", ABB_TOOL
    ),
    "kuka_kr16_2": _straight(
        "0 0 .675 -z; .26 0 0 y; .68 0 0 y; .67 0 -.035 -x; 0 0 0 y; 0 0 0 -x",
        f".158 0 0 / 0 {H} 0",
    ),
    # lbr-stack/lbr_fri_ros2_stack; the 14 differs by its two lengths
    "kuka_iiwa7": _straight(
        "0 0 .1475 z; 0 -.0105 .1925 y; 0 .0105 .2075 z; 0 .0105 .1925 -y; 0 -.0105 .2075 z;"
        "0 -.0707 .1925 y; 0 .0707 .091 z",
        "0 0 .035 / 0 0 0",
    ),
    "kuka_iiwa14": _straight(
        "0 0 0 z; -.00043624 0 .36 y; 0 0 0 z; .00043624 0 .42 -y; 0 0 0 z; 0 0 .4 y; 0 0 0 z",
        "0 0 .126 / 0 0 0",
    ),
    # ros-industrial/motoman
    "yaskawa_gp7": _straight(
        "0 0 .33 z; .04 0 0 y; 0 0 .445 -y; .44 0 .04 -x; 0 0 0 -y; 0 0 0 -x",
        ".08 0 0 / 3.1415926 -1.570796 0",
    ),
    # DENSORobot/denso_robot_ros and denso_robot_ros2
    "denso_vs060": _straight(
        "0 0 .1815 z; 0 0 .1635 y; 0 0 .305 y; -.01 0 .1645 z; 0 0 .1355 y; 0 0 .07 z"
    ),
    "denso_hsr065": _straight("0 0 0 z; .375 0 0 z; -.375 0 0 zP; .65 0 0 z"),
    # ros-industrial/staubli_experimental
    "staubli_tx2_60": _straight("0 0 .375 z; 0 0 0 y; 0 .02 .29 y; 0 0 0 z; 0 0 .31 y; 0 0 .07 z"),
    # xArm-Developer/xarm_ros2
    "xarm5": (
        "0 0 .267 / 0 0 0 / z; 0 0 0 / -1.5708 0 0 / z; .0535 -.2845 0 / 0 0 0 / z;"
        ".0775 .3425 0 / 0 0 0 / z; .076 .097 0 / -1.5708 0 0 / z"
    ),
    "xarm6": (
        "0 0 .267 / 0 0 0 / z; 0 0 0 / -1.5708 0 0 / z; .0535 -.2845 0 / 0 0 0 / z;"
        ".0775 .3425 0 / -1.5708 0 0 / z; 0 0 0 / 1.5708 0 0 / z; .076 .097 0 / -1.5708 0 0 / z"
    ),
    "lite6": (
        "0 0 .2435 / 0 0 0 / z; 0 0 0 / 1.5708 -1.5708 3.1416 / z;"
        ".2002 0 0 / -3.1416 0 1.5708 / z; .087 -.22761 0 / 1.5708 0 0 / z;"
        "0 0 0 / 1.5708 0 0 / z; 0 .0625 0 / -1.5708 0 0 / z"
    ),
    # doosan-robotics/doosan-robot2
    "doosan_m1013": (
        "0 0 .1525 / 0 0 0 / z; 0 .0345 0 / 0 -1.571 -1.571 / z; .62 0 0 / 0 0 1.571 / z;"
        "0 -.559 0 / 1.571 0 0 / z; 0 0 0 / -1.571 0 0 / z; 0 -.121 0 / 1.571 0 0 / z"
    ),
    # TechmanRobotInc/tmr_ros2
    "techman_tm5_700": (
        "0 0 .1451 / 0 0 0 / z; 0 0 0 / -1.570796 -1.570796 0 / z; .329 0 0 / 0 0 0 / z;"
        ".3115 0 -.1222 / 0 0 1.570796 / z; 0 -.106 0 / 1.570796 0 0 / z;"
        "0 -.1144 0 / 1.570796 0 0 / z"
    ),
    # Kinovarobotics/ros_kortex and kinova-ros
    "kinova_gen3": (
        "0 0 .15643 / 3.1416 0 0 / z; 0 .005375 -.12838 / 1.5708 0 0 / z;"
        "0 -.21038 -.006375 / -1.5708 0 0 / z; 0 .006375 -.21038 / 1.5708 0 0 / z;"
        "0 -.20843 -.006375 / -1.5708 0 0 / z; 0 .00017505 -.10593 / 1.5708 0 0 / z;"
        f"0 -.10593 -.00017505 / -1.5708 0 0 / z; 0 0 -.061525 / {PI} 0 0 / ."
    ),
    "kinova_jaco2": (
        f"0 0 .15675 / 0 {PI} 0 / z; 0 .0016 -.11875 / -{H} 0 {PI} / z; 0 -.41 0 / 0 {PI} 0 / z;"
        f"0 .2073 -.0114 / -{H} 0 {PI} / z; 0 -.03703 -.06414 / 1.0471975511965976 0 {PI} / z;"
        f"0 -.03703 -.06414 / 1.0471975511965976 0 {PI} / z; 0 0 -.16 / {PI} 0 0 / ."
    ),
    # Interbotix/interbotix_ros_manipulators, interbotix_xsarm_descriptions/urdf
    "vx300s": _straight(
        "0 0 .079 z; 0 0 .04805 y; .05955 0 .3 y; .2 0 0 x; .1 0 0 y; .069744 0 0 x",
        f".042825 0 0 / 0 {H} 0",
    ),
    "wx250s": _straight(
        "0 0 .072 z; 0 0 .03865 y; .04975 0 .25 y; .175 0 0 x; .075 0 0 y; .065 0 0 x",
        f".043 0 0 / 0 {H} 0",
    ),
    "wx200": _straight(
        "0 0 .072 z; 0 0 .03865 y; .05 0 .2 y; .2 0 0 y; .065 0 0 x", f".043 0 0 / 0 {H} 0"
    ),
    "px100": _straight("0 0 .05085 z; 0 0 .04225 y; .035 0 .1 y; .1 0 0 y", f".063 0 0 / 0 {H} 0"),
    "vx250": _straight(
        "0 0 .079 z; 0 0 .04805 y; .06 0 .25 y; .25 0 0 y; .065 0 0 x", f".043 0 0 / 0 {H} 0"
    ),
    "vx300": _straight(
        "0 0 .079 z; 0 0 .04805 y; .05955 0 .3 y; .3 0 0 y; .069744 0 0 x", f".042825 0 0 / 0 {H} 0"
    ),
    "wx250": _straight(
        "0 0 .072 z; 0 0 .03865 y; .04975 0 .25 y; .25 0 0 y; .065 0 0 x", f".043 0 0 / 0 {H} 0"
    ),
    "rx150": _straight(
        "0 0 .06566 z; 0 0 .03891 y; .05 0 .15 y; .15 0 0 y; .065 0 0 x", f".043 0 0 / 0 {H} 0"
    ),
    "rx200": _straight(
        "0 0 .06566 z; 0 0 .03891 y; .05 0 .2 y; .2 0 0 y; .065 0 0 x", f".043 0 0 / 0 {H} 0"
    ),
    "px150": _straight(
        "0 0 .06566 z; 0 0 .03891 y; .05 0 .15 y; .15 0 0 y; .065 0 0 x", f".043 0 0 / 0 {H} 0"
    ),
    # NiryoRobotics/ned_ros, niryo_robot_description/urdf/ned2
    "niryo_ned2": (
        f"0 3.7961e-05 .1013 / 0 0 0 / z; 0 0 .065 / {H} -{H} 0 / z; .221 -.012 0 / 0 0 -{H} / z;"
        f".065 .0325 0 / 0 {H} 0 / z; 0 0 .17 / {PI} -{H} {PI} / z;"
        f".0197 .00925 0 / 0 {H} 0 / z; 0 0 .0215 / -{H} -{H} 0 / ."
    ),
    # elephantrobotics/mycobot_ros2, mycobot_description/urdf/mycobot_280_m5
    "mycobot_280": (
        "0 0 .13156 / 0 0 0 / z; 0 0 0 / 0 1.5708 -1.5708 / z; -.1104 0 0 / 0 0 0 / z;"
        "-.096 0 .06462 / 0 0 -1.5708 / z; 0 -.07318 0 / 1.5708 -1.5708 0 / z;"
        "0 .0456 0 / -1.5708 0 0 / z"
    ),
    # NiryoRobotics/niryo_one_ros, niryo_one_description/urdf/v2
    "niryo_one": (
        "0 0 .103 / 0 0 0 / z; 0 0 .08 / 1.570796326795 -1.570796326795 0 / z;"
        ".21004 0 0 / 0 0 -1.570796326795 / z; .037 .032 0 / 0 1.570796326795 0 / z;"
        "0 0 .18 / 0 -1.570796326795 0 / z; .018 0 0 / 0 1.570796326795 0 / z"
    ),
    # agilexrobotics/Piper_ros, src/piper_description/urdf/piper_no_gripper_description.xacro
    "piper": (
        "0 0 .123 / 0 0 0 / z; 0 0 0 / 1.5708 -.1359 -3.1416 / z; .28503 0 0 / 0 0 -1.7939 / z;"
        "-.021984 -.25075 0 / 1.5708 0 0 / z; 0 0 0 / -1.5708 0 0 / z;"
        "8.8259e-05 -.091 0 / 1.5708 0 0 / z"
    ),
    # ycheng517/ar4_ros_driver, annin_ar4_description/urdf/ar_macro.xacro
    "ar4": (
        f"0 0 0 / {PI} 0 0 / z; 0 .0642 -.16977 / 1.5708 0 -1.5708 / -z;"
        "0 -.305 .007 / 0 0 3.1416 / -z; 0 0 0 / 1.5708 0 -1.5708 / -z;"
        f"0 0 -.22263 / {PI} 0 -1.5708 / x; 0 0 .041 / 0 0 3.1416 / z"
    ),
    # TheRobotStudio/SO-ARM100, Simulation/SO100/so100.urdf
    "so100": (
        "0 -.0452 .0165 / 1.57079 0 0 / y; 0 .1025 .0306 / -1.8 0 0 / x;"
        "0 .11257 .028 / 1.57079 0 0 / x; 0 .0052 .1349 / -1 0 0 / x; 0 -.0601 0 / 0 1.57079 0 / y"
    ),
    # TheRobotStudio/SO-ARM100, Simulation/SO101/so101_new_calib.urdf
    "so101": (
        ".0207909 -.0230745 .0948817 / -3.14159 0 1.5708 / z;"
        "-.0303992 -.0182778 -.0542 / -1.5708 -1.5708 0 / z; -.11257 -.028 0 / 0 0 1.5708 / z;"
        "-.1349 .0052 0 / 0 0 -1.5708 / z; 0 -.0611 .0181 / 1.5708 -9.38083e-08 3.14159 / z;"
        "-.0079 -.000218121 -.0981274 / 1.5708 0 1.5708 / ."
    ),
}
"""Name of the table -> chain from its base_link to its tool0."""

ROUNDED = dict.fromkeys(("ur3e", "ur5e", "ur16e", "ur20", "ur30"), 1e-9)
ROUNDED |= {"kuka_iiwa14": 1e-3, "yaskawa_gp7": 5e-7, "xarm5": 3e-5, "xarm6": 3e-5, "lite6": 1.5e-3}
ROUNDED |= {"doosan_m1013": 1e-3, "techman_tm5_700": 2e-6, "kinova_gen3": 6e-4}
ROUNDED |= {"kinova_jaco2": 1e-4, "mycobot_280": 3e-5, "so101": 3e-5}
ROUNDED |= {"abb_irb5400": 5e-4}
ROUNDED |= {"niryo_one": 1e-11, "piper": 1.5e-4, "ar4": 3e-5, "so100": 3e-5}
"""Largest FK difference allowed where the maker's numbers are rounded; elsewhere 1e-14."""

MOVED = {
    "abb_irb460": lambda q: (*q[:2], -q[1], q[2], -q[2], q[3]),
    "abb_irb5400": lambda q: (*q[:5], -q[4], q[5]),
    "fanuc_r1000ia80f": lambda q: (*q[:2], q[2] + q[1], *q[3:]),
}
"""Arms whose controller shows other values than the joints have -> the joints of these values."""

PACKAGED = {
    "ur3": "ur_description/urdf/ur3_robot.urdf base tool0 0 0 0 1e-10",
    "ur5": "ur_description/urdf/ur5_robot.urdf base tool0 0 0 0 1e-10",
    "ur10": "ur_description/urdf/ur10_robot.urdf base tool0 0 0 0 1e-10",
    "franka_fer": "panda_description/urdf/panda.urdf panda_link0 panda_link8 0 0 0 1e-13",
    "xarm7": "xarm_description/urdf/xarm7.urdf link_base link_eef 0 0 0 5e-5",
    "unitree_z1": "z1_description/urdf/z1.urdf link00 link06 0 90 0 1e-13",
    "kinova_jaco2_spherical": "kinova_description/robots/kinova.urdf j2s6s200_link_base "
    "j2s6s200_end_effector 90 0 90 1e-9",
}
"""Table -> URDF, base, tip, roll, pitch, yaw of tool0 in the tip [deg], largest FK difference."""

PEDESTAL = 26.45 * 0.0254
POSES = [
    ("denso_vs6556", (0, -90, 0, 0, 0, 0), (0.450, 0, 0.695)),
    ("denso_vs6556", (0, -90, -90, 0, 0, 0), (-0.015, 0, 0.980)),
    ("puma560", (0, 0, 0, 0, 0, 0), (0.4521, -0.15005, PEDESTAL + 0.4318)),
    ("puma560", (0, 90, -90, 0, 0, 0), (0.0203, -0.15005, PEDESTAL + 0.8636)),
    ("puma560_modified", (0, 0, 0, 0, 0, 0), (0.4115, 0.1501, PEDESTAL + 0.4331)),
    ("puma560_modified", (0, 0, 90, 0, 0, 0), (0.8649, 0.1501, PEDESTAL + 0.0203)),
    ("mecademic_meca500", (0, 0, 0, 0, 0, 0), (0.190, 0, 0.308)),
    ("ur10e", (0, 0, 0, 0, 0, 0), (-1.18425, -0.2907, 0.06085)),
]
"""Table, configuration [deg], published or drawn position of tool0 [m]."""

MODIFIED_BY_MAKER = {
    "xarm7": (
        "0 267 0 0; 0 0 -90 0; 0 293 90 0; 0 0 90 52.5; 0 342.5 90 77.5; 0 0 90 0; 0 97 -90 76"
    ),
    "lite6": "0 243.3 0 0; -90 0 -90 0; -90 0 180 200; 0 227.6 90 87; 0 0 90 0; 0 61.5 -90 0",
    "uf850": "0 364 0 0; 90 0 90 0; 90 0 180 390; 0 426 -90 150; 0 0 -90 0; 0 90 90 0",
}
"""UFACTORY's modified tables of the same arms: theta, d, alpha, a in degrees and millimetres."""
