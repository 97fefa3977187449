"""The hand led from the page: only while somebody holds on; manipulation keeps it within its limits."""

from math import isfinite

from common import messages as m
from common import topics
from common.bus.port import Io
from services.dashboard.teleoperation import HOLD, free

SPEED, TURN = 0.1, 0.5
"""Greatest speed [m/s] and rate of turn [rad/s] of the hand; chosen: what a person follows with the eyes."""
FINGERS = ("open", "close")


class HandTeleoperation:
    """Turns what visitors hold into velocities. Not while a mission, navigation or the brake has the robot."""

    def __init__(self, io: Io) -> None:
        self._io = io
        self._wish: m.HandVelocity | None = None
        self._until = float("-inf")
        self._leading = False

    def hold(self, text: str, now: float) -> None:
        """A visitor holds on: "forward left up roll pitch yaw", each from -1 to 1, then open or close, if wished; or
        "home". What is no such thing is counted."""
        try:
            self._wish, self._until = _wish(text.split()), now + HOLD
        except ValueError:
            self._io.count_drop("page", f"hand {text[:60]!r}: expected six numbers from -1 to 1, or home")

    def step(self, now: float) -> None:
        """Send the velocity of this moment, and one of zero when it has ended; then nothing, which means stop."""
        io, wish = self._io, self._wish
        if wish is not None and now < self._until and free(io):
            io.publish(topics.HAND_VELOCITY, wish)
            if wish.fingers:  # said once: what is sent again would close again what was opened since
                self._wish = m.HandVelocity(linear=wish.linear, angular=wish.angular, home=wish.home)
            self._leading = True
        elif self._leading:
            self._leading = False
            io.publish(topics.HAND_VELOCITY, m.HandVelocity())


def _wish(words: list[str]) -> m.HandVelocity:
    """Raises ValueError for what is no wish."""
    if words == ["home"]:
        return m.HandVelocity(home=True)
    fingers = words.pop() if len(words) == 7 else ""
    values = [float(word) for word in words]
    if len(values) != 6 or not all(isfinite(v) and abs(v) <= 1 for v in values) or fingers not in ("", *FINGERS):
        raise ValueError(words)
    x, y, z, roll, pitch, yaw = values
    return m.HandVelocity(
        linear=(x * SPEED, y * SPEED, z * SPEED),
        angular=(roll * TURN, pitch * TURN, yaw * TURN),
        fingers=fingers,  # type: ignore[arg-type]
    )
