"""The robot's bus as its services see it, for tests of gateways to other tools."""

from typing import Any

import zenoh

from common import messages as m
from common.bus import codec
from common.topic import Topic


class RobotSide:
    """Sends what the robot's services send, and hears what a gateway sends them."""

    def __init__(self, session: zenoh.Session) -> None:
        self.session = session
        self._kept: list[Any] = []

    def heard(self, topic: Topic[Any]) -> list[Any]:
        """A list that receives what the gateway sends on a topic of the robot."""
        found: list[Any] = []
        kept = self.session.declare_subscriber(
            topic.key, lambda sample: found.append(codec.decode(topic, sample.payload.to_bytes()))
        )
        self._kept.append(kept)
        return found

    def send(self, topic: Topic[Any], message: m.Message, key: str = "") -> None:
        """Put a message, for a topic with a wildcard on `key`."""
        self.session.put(key or topic.key, codec.encode(topic, message), encoding=codec.encoding_of(topic))
