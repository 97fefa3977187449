"""A new service in forty lines: how far the base has driven, on `odometer/distance`.

Start it beside the robot with `python -m examples.odometer`; docs/EXTENDING.md explains each line.
"""

from math import hypot

from common import messages as m
from common import topics
from common.bus.port import Io
from common.config import Config
from common.runtime import main
from common.topic import Topic


class Distance(m.Message):
    """`metres` driven since the start of the service."""

    t: float
    metres: float


DISTANCE = Topic(key="odometer/distance", type=Distance, writers=("odometer",), latched=True)


class OdometerConfig(Config, frozen=True):
    """How often it reports."""

    report_every: float = 0.1
    """Way between two reports [m]."""


class OdometerService:
    """Adds up what odometry reports."""

    NAME, HZ, CONFIG = "odometer", 20, OdometerConfig
    READS, WRITES = (topics.ODOMETRY,), (DISTANCE,)

    def __init__(self, config: OdometerConfig, io: Io) -> None:
        self._config, self._io = config, io
        self._last: m.Odometry | None = None
        self._metres = self._told = 0.0

    def step(self, now: float) -> None:
        for odometry in self._io.take_all(topics.ODOMETRY):
            if self._last is not None:
                self._metres += hypot(odometry.x - self._last.x, odometry.y - self._last.y)
            self._last = odometry
        if self._metres - self._told >= self._config.report_every:
            self._told = self._metres
            self._io.publish(DISTANCE, Distance(t=now, metres=round(self._metres, 3)))


if __name__ == "__main__":
    main(OdometerService)
