"""A client of Foxglove's WebSocket protocol that is not ours: frames by `websockets`, messages by `protobuf`.

The server's own schemas decode what it sends. https://github.com/foxglove/ws-protocol (subprotocol foxglove.sdk.v1)
"""

import base64
import contextlib
import json
import struct
import threading
import time
from collections.abc import Callable
from typing import Any

from google.protobuf import descriptor_pb2, descriptor_pool, message_factory
from websockets.exceptions import ConnectionClosed
from websockets.sync.client import connect

SUBPROTOCOL = "foxglove.sdk.v1"


class FoxgloveClient:
    """Connected from the start; what arrives is kept by topic, decoded."""

    def __init__(self, url: str) -> None:
        self._socket = connect(url, subprotocols=[SUBPROTOCOL], max_size=None)  # type: ignore[list-item]
        self.server: dict[str, Any] = {}
        self.channels: dict[str, dict[str, Any]] = {}
        self.heard: dict[str, list[Any]] = {}
        self.times: dict[str, list[int]] = {}
        self.parameters: dict[str, Any] = {}
        self.warnings: list[str] = []
        self._names: dict[int, str] = {}
        self._decoders: dict[str, Callable[[bytes], Any]] = {}
        self._thread = threading.Thread(target=self._read, daemon=True)
        self._thread.start()

    def _read(self) -> None:
        with contextlib.suppress(ConnectionClosed):
            self._listen()

    def _listen(self) -> None:
        for message in self._socket:
            if isinstance(message, str):
                self._take(json.loads(message))
            elif message[0] == 1:
                number, nanoseconds = struct.unpack_from("<IQ", message, 1)
                name = self._names[number]
                self.times[name].append(nanoseconds)
                self.heard[name].append(self._decoders[name](message[13:]))

    def _take(self, message: dict[str, Any]) -> None:
        kind = message["op"]
        if kind == "serverInfo":
            self.server = message
        elif kind == "advertise":
            self.channels |= {channel["topic"]: channel for channel in message["channels"]}
        elif kind == "parameterValues":
            self.parameters |= {p["name"]: p.get("value") for p in message["parameters"]}
        elif kind == "status":
            self.warnings.append(message["message"])

    def _send(self, **message: Any) -> None:
        self._socket.send(json.dumps(message))

    def watch(self, *names: str) -> None:
        """Subscribe to channels."""
        wanted = []
        for name in names:
            channel = self.channels[name]
            self.heard.setdefault(name, [])
            self.times.setdefault(name, [])
            self._decoders[name] = json.loads if channel["encoding"] == "json" else decoder(channel)
            self._names[channel["id"]] = name
            wanted.append({"id": channel["id"], "channelId": channel["id"]})
        self._send(op="subscribe", subscriptions=wanted)

    def forget(self, *names: str) -> None:
        """End subscriptions."""
        self._send(op="unsubscribe", subscriptionIds=[self.channels[name]["id"] for name in names])

    def offer(self, number: int, topic: str) -> Callable[[Any], None]:
        """Advertise a topic of the client's own; call the result with what is to be published on it."""
        self._send(op="advertise", channels=[{"id": number, "topic": topic, "encoding": "json", "schemaName": ""}])
        head = struct.pack("<BI", 1, number)
        return lambda value: self._socket.send(head + json.dumps(value).encode())

    def ask(self, *names: str) -> None:
        """Get parameters."""
        self._send(op="getParameters", parameterNames=list(names), id="get")

    def set(self, name: str, value: Any) -> None:
        """Set a parameter."""
        self._send(op="setParameters", parameters=[{"name": name, "value": value}], id=f"set-{time.monotonic()}")

    def close(self) -> None:
        self._socket.close()
        self._thread.join(5)


def decoder(channel: dict[str, Any]) -> Callable[[bytes], Any]:
    """What reads a channel's protobuf messages by the schema that the server sent along."""
    files = descriptor_pb2.FileDescriptorSet.FromString(base64.b64decode(channel["schema"]))
    pool = descriptor_pool.DescriptorPool()
    for file in files.file:
        pool.Add(file)
    kind = message_factory.GetMessageClass(pool.FindMessageTypeByName(channel["schemaName"]))
    return kind.FromString
