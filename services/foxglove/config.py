"""Parameters of the Foxglove server."""

from common.config import Config


class FoxgloveConfig(Config, frozen=True):
    """Where it listens, what visitors may do, and how often they are sent something."""

    host: str = "127.0.0.1"
    """Address that it listens at; visitors need no password, so it is of this machine alone unless `open`."""
    port: int = 8765
    """Port; 0 takes any free one."""
    open: bool = False
    """Let it listen at other addresses than loopback."""
    commands: bool = False
    """Let visitors talk to the robot and drive it; without, they may only stop it. Off unless asked for: a web page of
    any site in a browser of this machine can connect, too."""
    tf_rate: float = 20.0
    """How often frames that move are sent [Hz]."""
    camera_rate: float = 2.0
    """How often a watched camera is asked for a picture [Hz]."""
    camera_width: int = 320
    """Columns of such a picture [pixels]."""
    camera_height: int = 240
    """Rows of such a picture [pixels]."""
