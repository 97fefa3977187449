"""Parameters of the operator's page."""

from common.config import Config


class DashboardConfig(Config, frozen=True):
    """`port` 0 takes any free one; a busy one gives way to the next of `port_tries`.

    On a `host` other than loopback every visitor needs `token`; an empty one is made up at the start and printed.
    `frame_rate` is how often what moves is drawn [Hz], `camera_rate` how often a watched camera is asked for a
    picture [Hz]; objects not seen for `ghost_after` seconds are drawn as ghosts. `supervisor` is the control socket
    of `tidybot up`, for the restart buttons.
    """

    host: str = "127.0.0.1"
    port: int = 8080
    port_tries: int = 10
    token: str = ""
    frame_rate: float = 30.0
    camera_rate: float = 2.0
    camera_width: int = 320
    camera_height: int = 240
    ghost_after: float = 20.0
    supervisor: str = ""
