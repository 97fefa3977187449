"""What a demonstration's frames are made of: written by the recorder, and seen and answered by policies."""

from common.robot.joints import ARM, JOINTS

STATE = JOINTS
"""Names of `observation.state`: the base's pose by its wheels [m, m, rad], joints [rad], the gripper's width [m]."""
ACTION = ("base_vx", "base_vy", "base_omega", *ARM, "gripper_closed")
"""Names of `action`: velocity in the robot's frame [m/s, m/s, rad/s], joint targets [rad], 0 open to 1 closed."""
PICTURE_SIZE = (320, 240)
"""Width and height of pictures [pixels]."""
