"""Names of the robot's joints in `joint_states`, and of its outermost body."""

BASE = ("base_x", "base_y", "base_yaw")
ARM = tuple(f"joint_{i}" for i in range(1, 8))
GRIPPER = "gripper"
"""Its position is the width between the pads [m]."""
BASE_BODY = "base"
"""The body of the MJCF that carries all others of the robot."""
JOINTS = (*BASE, *ARM, GRIPPER)
"""All of them, in the order in which they are published."""
