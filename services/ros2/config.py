"""Parameters of the ROS 2 gateway."""

from typing import Literal

from common.config import Config


class Ros2Config(Config, frozen=True):
    """`domain` is ROS_DOMAIN_ID of the peers, `distro` whose message definitions they have.

    `namespace`: before every topic's name; "" takes the robot's own, and none where it has none. `tf_rate`: how often
    frames that move are sent [Hz]; a watched camera is asked for a picture of `camera_width` x `camera_height` at
    `camera_rate` [Hz].
    """

    domain: int = 0
    namespace: str = ""
    distro: Literal["jazzy", "kilted", "lyrical"] = "jazzy"
    tf_rate: float = 20.0
    camera_rate: float = 2.0
    camera_width: int = 320
    camera_height: int = 240
