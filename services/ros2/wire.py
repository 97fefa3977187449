"""rmw_zenoh's wire: keys with type and hash, liveliness tokens for node and topics, an attachment to each message.

Source: rmw_zenoh's design, https://github.com/ros2/rmw_zenoh/blob/rolling/docs/design.md
"""

import hashlib
import itertools
import re
import struct
from collections.abc import Callable
from contextlib import AbstractContextManager, ExitStack
from typing import Any, NamedTuple

import zenoh
from zenoh import ext, handlers

from common.time.clock import unix_time

NODE, PUBLISHER, SUBSCRIPTION = "NN", "MP", "MS"
MAX_DOMAIN = 232
"""Highest ROS domain id [1]: what DDS leaves room for ports for, and rmw checks."""
_ATTACHMENT = struct.Struct("<qqB16s")
Receive = Callable[[bytes], None]


class Qos(NamedTuple):
    """Quality of service as far as it is not ROS's default; `transient`: the last `depth` also reach who comes late."""

    transient: bool = False
    depth: int = 10

    def encoded(self) -> str:
        """Text for a token: reliability, durability, history, deadline, lifespan, liveliness; a default is empty."""
        return f":{1 if self.transient else ''}:,{self.depth}:,:,:,,"


class RosTopic(NamedTuple):
    """A ROS topic: `name` absolute with its namespace, `type` as `std_msgs/msg/String`, the type's RIHS01 `hash`."""

    name: str
    type: str
    hash: str
    qos: Qos = Qos()

    def key(self, domain: int) -> str:
        """The key its messages travel on."""
        return f"{domain}/{self.name.strip('/')}/{dds_type(self.type)}/{self.hash}"


def dds_type(name: str) -> str:
    """`std_msgs/msg/String` as rmw writes it."""
    package, kind, message = name.split("/")
    return f"{package}::{kind}::dds_::{message}_"


def ros_name(namespace: str) -> str:
    """A robot's namespace as ROS allows names: letters, digits and `_`, no part beginning with a digit."""
    parts = (re.sub(r"\W", "_", part, flags=re.ASCII) for part in namespace.split("/") if part)
    return "/".join(f"_{part}" if part[0].isdigit() else part for part in parts)


def mangled(name: str) -> str:
    """A name in one part of a key."""
    return name.replace("/", "%") or "%"


def attachment(sequence: int, nanoseconds: int, gid: bytes) -> bytes:
    """What goes with each message: its number, when it was sent (Unix time), and who sent it (16 bytes)."""
    return _ATTACHMENT.pack(sequence, nanoseconds, len(gid), gid)


class Outlet:
    """Publishes one ROS topic. `wanted`: somebody elsewhere subscribes to it."""

    def __init__(self, session: zenoh.Session, topic: RosTopic, key: str, token: str) -> None:
        self.topic = topic
        self._gid = hashlib.blake2b(token.encode(), digest_size=16).digest()
        self._sequence = itertools.count(1)
        remote = zenoh.Locality.REMOTE
        # An advanced publisher cannot say who listens, so a plain one does.
        plain = session.declare_publisher(key, allowed_destination=remote)
        self._out: Any = plain
        if topic.qos.transient:
            self._out = ext.declare_advanced_publisher(
                session,
                key,
                allowed_destination=remote,
                cache=ext.CacheConfig(topic.qos.depth),
                publisher_detection=True,
            )
        self.wanted = bool(plain.matching_status.matching)  # type: ignore[attr-defined]
        matching: Any = handlers.Callback(self._matched, indirect=False)
        self._kept = plain, plain.declare_matching_listener(matching), session.liveliness().declare_token(token)

    def _matched(self, status: Any) -> None:
        self.wanted = bool(status.matching)

    def put(self, payload: bytes) -> None:
        """Send one message, encoded."""
        now = round(unix_time() * 1e9)
        self._out.put(payload, attachment=attachment(next(self._sequence), now, self._gid))


class RosNode:
    """A node of a ROS graph, shown to the others by tokens; it ends with `close`."""

    def __init__(self, opened: AbstractContextManager[zenoh.Session], name: str, namespace: str, domain: int) -> None:
        self._stack = ExitStack()
        self._session = self._stack.enter_context(opened)
        self._ids = itertools.count()
        self._domain = domain
        self._path = "/".join((mangled(""), mangled(namespace), name))  # no enclave
        self._node = next(self._ids)
        self._kept: list[Any] = [self._session.liveliness().declare_token(self._token(self._node, NODE))]

    def _token(self, entity: int, kind: str, topic: RosTopic | None = None) -> str:
        zid = self._session.info.zid()
        parts = ["@ros2_lv", self._domain, zid, self._node, entity, kind, self._path]
        if topic is not None:
            parts += [mangled(topic.name), dds_type(topic.type), topic.hash, topic.qos.encoded()]
        return "/".join(map(str, parts))

    def publish(self, topic: RosTopic) -> Outlet:
        """Declare a publisher."""
        token = self._token(next(self._ids), PUBLISHER, topic)
        return Outlet(self._session, topic, topic.key(self._domain), token)

    def subscribe(self, topic: RosTopic, receive: Receive) -> None:
        """Call `receive(payload)`, in Zenoh's thread, with what others publish."""
        enqueue: Any = handlers.Callback(lambda sample: receive(sample.payload.to_bytes()), indirect=False)
        key, token = topic.key(self._domain), self._token(next(self._ids), SUBSCRIPTION, topic)
        self._kept.append(self._session.declare_subscriber(key, enqueue, allowed_origin=zenoh.Locality.REMOTE))
        self._kept.append(self._session.liveliness().declare_token(token))

    def close(self) -> None:
        """Leave the graph."""
        self._stack.close()
