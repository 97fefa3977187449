"""A driver under test: its messages on the bus, and the passing of its time."""

import math
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

from cli.link import Link
from common import topics
from common.bus import codec
from common.time.clock import monotonic, sleep
from common.topic import Topic

HEARD: tuple[Topic[Any], ...] = (
    topics.JOINT_STATES, topics.ODOMETRY, topics.SCAN, topics.GOAL_REACHED, topics.SIM_STATUS,
    topics.ROBOT_DESCRIPTION,
)  # fmt: skip
STALL, PERIOD = 20.0, 0.05
"""Time [s] without `joint_states` after which a driver counts as gone, and period of repeated commands [s]."""


class Unmet(Exception):
    """A requirement is not met; says what was expected and what came."""


@dataclass
class Driver:
    """Collects a driver's messages in their order."""

    link: Link
    heard: dict[str, list[Any]] = field(default_factory=dict)
    bad: dict[str, str] = field(default_factory=dict)

    def __post_init__(self) -> None:
        self.heard = {t.key: [] for t in HEARD}
        self._kept = [self.link.session.declare_subscriber(t.key, self._listener(t)) for t in HEARD]

    def _listener(self, topic: Topic[Any]) -> Callable[[Any], None]:
        def receive(sample: Any) -> None:
            try:
                self.heard[topic.key].append(codec.decode(topic, sample.payload.to_bytes()))
            except codec.DecodeError as error:
                self.bad[topic.key] = str(error)

        return receive

    @property
    def t(self) -> float:
        rows = self.heard[topics.JOINT_STATES.key]
        return float(rows[-1].t) if rows else -math.inf

    def joints(self) -> dict[str, float]:
        row = self.heard[topics.JOINT_STATES.key][-1]
        return dict(zip(row.name, row.position, strict=False))

    def speed(self) -> float:
        """Speed of the base in the plane [m/s]."""
        row = self.heard[topics.JOINT_STATES.key][-1]
        v = dict(zip(row.name, row.velocity, strict=False))
        return math.hypot(v.get("base_x", 0.0), v.get("base_y", 0.0))

    def place(self) -> tuple[float, float, float]:
        q = self.joints()
        return q["base_x"], q["base_y"], q["base_yaw"]

    def wait(
        self, seconds: float, done: Callable[[], bool] = lambda: False, each: Callable[[], None] | None = None
    ) -> bool:
        """Let `seconds` of the driver's time pass, or less when `done`; `each` is called every 0.05 of them.

        Raises:
            Unmet: its time stands still.
        """
        begin = due = self.t if self.heard[topics.JOINT_STATES.key] else 0.0
        last, moved_at = self.t, monotonic()
        while not done():
            now = self.t
            if now > last:
                last, moved_at = now, monotonic()
            elif monotonic() - moved_at > STALL:
                raise Unmet(f"no joint_states for {STALL:.0f} s")
            if math.isinf(begin) and math.isfinite(now):
                begin = due = now
            if now - begin >= seconds:
                return done()
            if each is not None and now >= due:
                each()
                due = now + PERIOD
            sleep(0.005)
        return True
