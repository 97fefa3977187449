"""Events of visitors, queued from the SDK's threads until the service's next step."""

import queue
from collections.abc import Callable
from typing import Any, NamedTuple

LONGEST = 65536
"""Bytes of a visitor's message [count]; chosen: no command is as long."""
WAITING = 256
"""Events that may wait for a step [count]; chosen: seconds of a joystick, more is counted and lost."""


class Subscribed(NamedTuple):
    """A visitor has subscribed (+1) to a channel or unsubscribed (-1)."""

    channel: int
    change: int


class Sent(NamedTuple):
    """A visitor published `data` on a topic."""

    topic: str
    data: bytes


class Set(NamedTuple):
    """A visitor has set a parameter; `allowed`: it may be set."""

    name: str
    value: Any
    allowed: bool


class Listener:
    """The SDK's callbacks; `parameters`: values for visitors, `may_set(name, value)`: what they may change."""

    def __init__(self, parameters: dict[str, Any], may_set: Callable[[str, Any], bool]) -> None:
        self.parameters, self._may_set = parameters, may_set
        self.events: queue.SimpleQueue[Subscribed | Sent | Set] = queue.SimpleQueue()
        self.lost = 0
        self._topics: dict[tuple[int, int], str] = {}

    def on_subscribe(self, client: Any, channel: Any) -> None:
        self.events.put(Subscribed(channel.id, 1))

    def on_unsubscribe(self, client: Any, channel: Any) -> None:
        self.events.put(Subscribed(channel.id, -1))

    def on_client_advertise(self, client: Any, channel: Any) -> None:
        self._topics[client.id, channel.id] = channel.topic

    def on_client_unadvertise(self, client: Any, client_channel_id: int) -> None:
        self._topics.pop((client.id, client_channel_id), None)

    def on_message_data(self, client: Any, client_channel_id: int, data: bytes) -> None:
        topic = self._topics.get((client.id, client_channel_id), "")
        if len(data) > LONGEST or self.events.qsize() > WAITING:
            self.lost += 1
        else:
            self.events.put(Sent(topic, bytes(data)))

    def on_get_parameters(self, client: Any, param_names: list[str], request_id: str | None = None) -> list[Any]:
        return self._told(param_names or [*self.parameters])

    def on_set_parameters(self, client: Any, parameters: list[Any], request_id: str | None = None) -> list[Any]:
        for parameter in parameters:
            name, value = parameter.name, parameter.get_value()
            allowed = self._may_set(name, value)
            if allowed:
                self.parameters[name] = value
            self.events.put(Set(name, value, allowed))
        return self._told([parameter.name for parameter in parameters])

    def _told(self, names: list[str]) -> list[Any]:
        from foxglove import Parameter

        known = self.parameters
        return [Parameter(name, value=known[name]) for name in names if name in known]

    def on_parameters_subscribe(self, param_names: list[str]) -> None:
        """Do nothing: the server publishes changes to whom they concern."""

    def on_parameters_unsubscribe(self, param_names: list[str]) -> None:
        """Nothing."""

    def on_connection_graph_subscribe(self) -> None:
        """Nothing."""

    def on_connection_graph_unsubscribe(self) -> None:
        """Nothing."""
