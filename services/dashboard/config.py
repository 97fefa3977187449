"""Parameters of the operator's page."""

from common.config import Config


class DashboardConfig(Config, frozen=True):
    """Where the page is served, to whom, and how often it is drawn."""

    host: str = "127.0.0.1"
    """Address that it listens at; on any but loopback every visitor needs `token`."""
    port: int = 8080
    """Port; 0 takes any free one."""
    port_tries: int = 10
    """Ports tried, each the next, while they are busy [count]; 1: it says so and ends."""
    token: str = ""
    """What visitors must know; "": nothing on loopback, elsewhere one is made up at the start and printed."""
    frame_rate: float = 30.0
    """How often what moves is drawn [Hz]."""
    camera_rate: float = 2.0
    """How often a watched camera is asked for a picture [Hz]."""
    camera_width: int = 320
    """Columns of such a picture [pixels]."""
    camera_height: int = 240
    """Rows of such a picture [pixels]."""
    ghost_after: float = 20.0
    """Age from which on an object that is not seen is drawn as a ghost [s]."""
    supervisor: str = ""
    """Control socket of `tidybot up`, which fills it in, for the restart buttons."""
