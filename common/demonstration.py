"""State, action and pictures of a demonstration, the same for the recorder and for the policies that learn from it."""

from collections.abc import Callable, Sequence

from common import messages as m
from common.robot.joints import ARM, JOINTS

STATE = JOINTS
"""Names of `observation.state`: the base's pose by its wheels [m, m, rad], joints [rad], the gripper's width [m]."""
ACTION = ("base_vx", "base_vy", "base_omega", *ARM, "gripper_closed")
"""Names of `action`: velocity in the robot's frame [m/s, m/s, rad/s], joint targets [rad], 0 open to 1 closed."""
PICTURE_SIZE = (320, 240)
"""Width and height of pictures [pixels]."""


class PictureTurns:
    """Asks one camera after the other for a picture, so that the robot's own requests are served in between.

    `renew` [s]: a picture that has not come by then is asked for again.
    """

    def __init__(self, cameras: Sequence[m.CameraName], renew: float) -> None:
        self._cameras, self._renew = list(cameras), renew
        self._wanted, self._asked = "", float("-inf")

    def came(self, picture: m.Rgbd) -> None:
        """Note that a picture has come; if it is the one asked for, it is the next camera's turn."""
        if picture.id == self._wanted:
            self._wanted = ""
            self._cameras.append(self._cameras.pop(0))

    def request(self, now: float, new_id: Callable[[], str]) -> m.CameraRequest | None:
        """The next request; None while one is under way."""
        if not self._cameras or (self._wanted and now - self._asked <= self._renew):
            return None
        self._wanted, self._asked = new_id(), now
        width, height = PICTURE_SIZE
        return m.CameraRequest(id=self._wanted, camera=self._cameras[0], width=width, height=height)
