"""Parameters of manipulation."""

from common.config import Config
from common.messages import CameraName


class ManipulationConfig(Config, frozen=True):
    """Lengths in metres, speeds in rad/s or m/s, forces in newtons, times in seconds.

    A sighting of the object is good for `fresh` seconds; a newer one is waited for at most `look_patience`.
    With the hand in front of it the wrist camera's sighting is waited for `aim_patience`; a shift between
    `aim_least` and `aim_most` corrects the grasp; more, or a turn of a flat-sided object by `aim_turn` [rad], has it
    planned anew.

    `policy`: `package.module:name` of a callable that grabs instead of the planner (docs/LEARNING.md), called
    `policy_rate` times a second with the pictures of `policy_cameras`, at most for `policy_seconds`; an action that is
    `policy_patience` late has the arm hold, one of `policy_late` ends the goal. Whoever leads the arm, a policy or a
    person, keeps within `workspace` (x, y, z from and to, of the pinch point in the base frame) and ends at `led_force`
    on the hand.
    """

    max_candidates: int = 4
    reach: float = 1.0
    joint_speed: float = 1.0
    joint_acceleration: float = 2.5
    approach_distance: float = 0.10
    lift_height: float = 0.10
    grip_effort: float = 25.0
    slip_width: float = 0.004
    blocked_error: float = 0.12
    planning_seconds: float = 0.5
    state_timeout: float = 0.5
    settle: float = 0.3
    fresh: float = 1.5
    look_patience: float = 3.0
    aim_patience: float = 1.0
    aim_least: float = 0.002
    aim_most: float = 0.03
    aim_turn: float = 0.15
    policy: str = ""
    policy_rate: float = 20.0
    policy_cameras: tuple[CameraName, ...] = ("head", "wrist")
    policy_seconds: float = 60.0
    policy_patience: float = 0.2
    policy_late: float = 2.0
    workspace: tuple[float, float, float, float, float, float] = (-0.8, 1.1, -0.9, 0.9, 0.03, 1.7)
    led_force: float = 30.0
