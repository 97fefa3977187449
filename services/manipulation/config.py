"""Parameters of manipulation."""

from common.config import Config
from common.messages import CameraName


class ManipulationConfig(Config, frozen=True):
    """Lengths in metres, speeds in rad/s or m/s, forces in newtons, times in seconds.

    Whoever leads the arm, a policy (docs/LEARNING.md) or a person, keeps within `workspace` and ends at `led_force`.
    """

    max_candidates: int = 4
    """Grasps tried before it gives up [count]."""
    reach: float = 1.0
    """From the base's centre to an object in reach, at most."""
    joint_speed: float = 1.0
    """Largest speed of a joint."""
    joint_acceleration: float = 2.5
    """Largest acceleration of a joint [rad/s2]."""
    approach_distance: float = 0.10
    """From the pre-grasp pose to the grasp."""
    lift_height: float = 0.10
    """How far a held object is lifted before it is carried."""
    grip_effort: float = 25.0
    """Force of a closing finger."""
    slip_width: float = 0.004
    """Change of the gripper's width from which on what it held has slipped or turned."""
    blocked_error: float = 0.12
    """Error of a joint from which on the arm is blocked [rad]."""
    planning_seconds: float = 0.5
    """What a plan takes in lockstep."""
    state_timeout: float = 0.5
    """Silence of the joints after which a goal fails."""
    settle: float = 0.3
    """Rest after the fingers have closed or opened."""
    fresh: float = 1.5
    """Age up to which a sighting of the object is good."""
    look_patience: float = 3.0
    """How long a newer sighting is waited for."""
    aim_patience: float = 1.0
    """How long the wrist camera's sighting is waited for, with the hand before the object."""
    aim_least: float = 0.002
    """Shift from which on that sighting corrects the grasp."""
    aim_most: float = 0.03
    """Shift from which on it has the grasp planned anew."""
    aim_turn: float = 0.15
    """Turn of a flat-sided object from which on it has the grasp planned anew [rad]."""
    policy: str = ""
    """`package.module:name` of a callable that grabs instead of the planner; "" for none."""
    policy_rate: float = 20.0
    """How often it is called [Hz]."""
    policy_cameras: tuple[CameraName, ...] = ("head", "wrist")
    """Whose pictures it gets."""
    policy_seconds: float = 60.0
    """Time that it has."""
    policy_patience: float = 0.2
    """Delay of an action at which the arm holds."""
    policy_late: float = 2.0
    """Delay of an action at which the goal ends."""
    workspace: tuple[float, float, float, float, float, float] = (-0.8, 1.1, -0.9, 0.9, 0.03, 1.7)
    """x, y, z from and to, of the pinch point in the base's frame."""
    led_force: float = 30.0
    """Force on the hand at which leading ends."""
