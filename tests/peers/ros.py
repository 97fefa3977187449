"""A ROS 2 peer that is not ours: the package zenoh-ros2-sdk, with its own keys, tokens, hashes and QoS.

Its message definitions would come from GitHub; here it is given those of rosbags as files, and computes the hashes of
them itself.
"""

import re
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from rosbags.typesys import Stores, get_typestore
from zenoh_ros2_sdk import ROS2Publisher, ROS2Subscriber, discovery, message_registry
from zenoh_ros2_sdk.qos import QosDurability, QosProfile
from zenoh_ros2_sdk.session import ZenohSession

__all__ = ["QosDurability", "QosProfile", "RosPeer", "ros_peer"]


def write_definitions(folder: Path, kinds: list[str]) -> None:
    """The definitions of these types, and of what they are made of, as `package/msg/Name.msg`."""
    store = get_typestore(Stores.ROS2_JAZZY)
    for kind in kinds:
        package, _, name = kind.split("/")
        text, _ = store.generate_msgdef(kind, ros_version=2)
        first, *others = re.split(r"^=+\nMSG: (\S+)\n", text, flags=re.MULTILINE)
        for title, body in [(f"{package}/{name}", first), *zip(others[::2], others[1::2], strict=True)]:
            part, *_, message = title.split("/")
            path = folder / part / "msg" / f"{message}.msg"
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(body, encoding="utf-8")


class RosPeer:
    """The peer's session on one router; what it hears is kept by topic."""

    def __init__(self, port: int, prefix: str) -> None:
        self.port, self.prefix = port, prefix
        self.heard: dict[str, list[Any]] = {}
        self._kept: list[Any] = []

    def listen(self, name: str, kind: str, **options: Any) -> Any:
        """Subscribe to a topic below the prefix."""
        self.heard.setdefault(name, [])
        hear = self.heard[name].append
        found = ROS2Subscriber(f"{self.prefix}/{name}", kind, hear, router_port=self.port, **options)
        self._kept.append(found)
        return found

    def talk(self, name: str, kind: str) -> Any:
        """A publisher of a topic below the prefix."""
        found = ROS2Publisher(f"{self.prefix}/{name}", kind, router_port=self.port)
        self._kept.append(found)
        return found

    def topics(self) -> dict[str, list[str]]:
        """What `ros2 topic list -t` would show."""
        return dict(discovery.get_topic_names_and_types(router_port=self.port))

    def publishers(self, name: str) -> list[Any]:
        """What `ros2 topic info -v` would show of those who publish."""
        found = discovery.get_topic_info(f"{self.prefix}/{name}", router_port=self.port, verbose=True)
        return list(found.publishers) if found is not None else []

    def leave(self, topic: Any) -> None:
        """End a subscription or a publisher."""
        self._kept.remove(topic)
        topic.close()

    def put(self, key: str, payload: bytes) -> None:
        """Bytes that no ROS node would send."""
        ZenohSession.get_instance().session.put(key, payload)

    def close(self) -> None:
        for one in self._kept:
            one.close()


@contextmanager
def ros_peer(folder: Path, port: int, prefix: str, kinds: list[str]) -> Iterator[RosPeer]:
    """A peer on the router at this port of this machine."""
    write_definitions(folder, kinds)
    session = ZenohSession("127.0.0.1", port)
    before = ZenohSession._instance, message_registry._registry
    ZenohSession._instance, message_registry._registry = session, message_registry.MessageRegistry(str(folder))
    peer = RosPeer(port, prefix)
    try:
        yield peer
    finally:
        peer.close()
        ZenohSession._instance, message_registry._registry = before
        session.session.close()
