"""Parameters of the ROS 2 gateway."""

from typing import Literal

from common.config import Config


class Ros2Config(Config, frozen=True):
    """Whom it talks to, under which names, and how often."""

    domain: int = 0
    """ROS_DOMAIN_ID of the peers."""
    namespace: str = ""
    """Before every topic's name; "" takes the robot's own, and none where it has none."""
    distro: Literal["jazzy", "kilted", "lyrical"] = "jazzy"
    """Whose message definitions the peers have."""
    tf_rate: float = 20.0
    """How often frames that move are sent [Hz]."""
    camera_rate: float = 2.0
    """How often a watched camera is asked for a picture [Hz]."""
    camera_width: int = 320
    """Columns of such a picture [pixels]."""
    camera_height: int = 240
    """Rows of such a picture [pixels]."""
