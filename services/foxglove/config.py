"""Parameters of the Foxglove server."""

from common.config import Config


class FoxgloveConfig(Config, frozen=True):
    """`port` 0 takes any free one. Visitors need no password, so `host` is of this machine alone unless it is `open`.

    `commands`: visitors may talk to the robot and drive it; without, they may only stop it. Off unless asked for: a web
    page of any site in a browser of this machine can connect, too. `tf_rate`: how often frames that move are sent [Hz];
    a watched camera is asked for a picture of `camera_width` x `camera_height` at `camera_rate` [Hz].
    """

    host: str = "127.0.0.1"
    port: int = 8765
    open: bool = False
    commands: bool = False
    tf_rate: float = 20.0
    camera_rate: float = 2.0
    camera_width: int = 320
    camera_height: int = 240
