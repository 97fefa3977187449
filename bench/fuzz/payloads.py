"""Hostile payloads for any topic, from a seed: noise, damage, wrong types, impossible numbers, depth, size."""

import random
import typing
from collections.abc import Callable
from copy import copy
from typing import Any

import msgspec

from common import messages as m
from common.topic import Topic

NUMBERS = (0.0, -0.0, 1.0, -1.0, 0.5, 3.14, 1e-320, 1e9, -1e9, 1e38, 1e200, 1.7e308, -1.7e308)
"""Numbers at the edges of what a float can be."""
NOT_FINITE = (float("nan"), float("inf"), float("-inf"))
INTEGERS = (0, 1, -1, 2, 255, 16000, 2**31, -(2**31), 2**53, 2**63 - 1, -(2**63))
"""Integers at the edges of what types and protocols take."""
WORDS = (
    "", " ", "find red mug", "find", "find  ", "goto kitchen", "goto nowhere", "return_to_start", "grab", "release",
    "home", "place delivery tray", "place", "listen", "say hello", "say", "bring me the red mug", "yes", "no",
    "tidy up the table and then throw everything in the bin", "map", "odom", "m.1", "m.2", "red mug", "red", "mug",
    "\u202e\u0000\x1b[31m", "ÄÖ 漢字 🤖", "%s%n{0}", "../../etc/passwd", "'; drop table missions; --", "ERROR",
    "a" * 3000,
)  # fmt: skip
JUNK: tuple[Any, ...] = (None, True, False, -1, 2**63, 1e308, "", "x", [], [[]], {}, {"a": 1}, [None] * 3, "9" * 400)


class Payloads:
    """`of(topic)` is the next payload; the same seed gives the same ones. `gentle` leaves out the megabytes."""

    def __init__(self, seed: int, gentle: bool = False) -> None:
        self.rng = random.Random(seed)
        self._samples: dict[str, list[m.Message]] = {}
        self._kinds: tuple[Callable[[Topic[Any]], bytes], ...] = (
            self.noise, self.valid, self.valid, self.truncated, self.flipped, self.mistyped, self.mistyped,
            self.impossible, self.impossible, self.deep, self.text, self.big if not gentle else self.text,
        )  # fmt: skip

    def of(self, topic: Topic[Any]) -> bytes:
        """A payload of a random kind."""
        return self.rng.choice(self._kinds)(topic)

    def learn(self, topic: Topic[Any], message: m.Message) -> None:
        """A message as the robot really sends it, to be varied."""
        self._samples.setdefault(topic.key, []).append(message)

    # --- kinds
    def noise(self, topic: Topic[Any]) -> bytes:
        return self.rng.randbytes(self.rng.choice((0, 1, 2, 7, 60, 400)))

    def valid(self, topic: Topic[Any]) -> bytes:
        return self._encode(topic, self._message(topic))

    def truncated(self, topic: Topic[Any]) -> bytes:
        whole = self.valid(topic)
        return whole[: self.rng.randrange(len(whole))]

    def flipped(self, topic: Topic[Any]) -> bytes:
        damaged = bytearray(self.valid(topic))
        for _ in range(self.rng.randint(1, 4)):
            damaged[self.rng.randrange(len(damaged))] ^= 1 << self.rng.randrange(8)
        return bytes(damaged)

    def mistyped(self, topic: Topic[Any]) -> bytes:
        """A message with one field of another type, missing, or unknown."""
        fields = self._fields(topic)
        name = self.rng.choice([*fields, "unknown"])
        if self.rng.random() < 0.2:
            fields.pop(name, None)
        else:
            fields[name] = self.rng.choice(JUNK)
        if self.rng.random() < 0.5:
            return msgspec.json.encode(fields)
        try:
            return msgspec.msgpack.encode(fields)
        except OverflowError:
            return msgspec.json.encode(fields)

    def impossible(self, topic: Topic[Any]) -> bytes:
        """A message whose numbers are no numbers or far too large; in JSON also 1e999 and NaN."""
        message = self._message(topic, wild=True)
        if self.rng.random() < 0.7:
            return msgspec.msgpack.encode(message)
        return msgspec.json.encode(message).replace(b"null", self.rng.choice((b"NaN", b"1e999", b"-Infinity", b"null")))

    def deep(self, topic: Topic[Any]) -> bytes:
        n = self.rng.choice((10, 500, 5000))
        forms = (b"[" * n, b'{"a":' * n + b"1" + b"}" * n, b"\x91" * n, b"\x81\xa1a" * n, b'{"children":[' * n)
        return self.rng.choice(forms)

    def text(self, topic: Topic[Any]) -> bytes:
        word = self.rng.choice(WORDS)
        forms = (word.encode(), msgspec.json.encode(word), b'"\\ud800"', b'{"goal":"\\ud800"}', word.encode("utf-16"))
        return self.rng.choice(forms)

    def big(self, topic: Topic[Any]) -> bytes:
        size = self.rng.choice((70_000, 300_000))
        return self.rng.choice((b'{"goal":"' + b"a" * size + b'"}', b"find " + b"x" * size, self.rng.randbytes(size)))

    # --- messages
    def message(self, kind: type[m.Message], wild: bool = False) -> m.Message:
        """A message that fits its type; `wild`: with numbers that no sender should send."""
        found: m.Message = self._value(kind, wild, 3)
        return found

    def _message(self, topic: Topic[Any], wild: bool = False) -> m.Message:
        """An invented message, or a real one with a field replaced."""
        if topic.key not in self._samples or self.rng.random() < 0.4:
            return self.message(topic.type, wild)
        found = copy(self.rng.choice(self._samples[topic.key]))
        name, other = self.rng.choice(found.__struct_fields__), self.message(topic.type, wild)
        value = getattr(found, name)
        if isinstance(value, list) and value and self.rng.random() < 0.6:
            value = list(value)
            place = self.rng.randrange(len(value))
            if self.rng.random() < 0.4:
                del value[place:]
            elif isinstance(value[place], float):
                value[place] = self.rng.choice(NUMBERS + (NOT_FINITE if wild else ()))
            else:
                value.append(value[place])
            setattr(found, name, value)
        else:
            setattr(found, name, getattr(other, name))
        return found

    def _fields(self, topic: Topic[Any]) -> dict[str, Any]:
        message = self._message(topic)
        return {name: getattr(message, name) for name in message.__struct_fields__}

    def _encode(self, topic: Topic[Any], message: m.Message) -> bytes:
        binary = topic.binary if self.rng.random() < 0.8 else not topic.binary
        return msgspec.msgpack.encode(message) if binary else msgspec.json.encode(message)

    def _value(self, kind: Any, wild: bool, depth: int) -> Any:
        rng, origin, inner = self.rng, typing.get_origin(kind), typing.get_args(kind)
        if kind is float:
            pool = NUMBERS + NOT_FINITE if wild else NUMBERS[:6]
            return rng.choice(pool) if wild and rng.random() < 0.5 else rng.uniform(-4, 4)
        if kind is int:
            return rng.choice(INTEGERS) if wild else rng.randint(0, 640)
        if kind is bool:
            return rng.random() < 0.5
        if kind is str:
            return rng.choice(WORDS)
        if kind is bytes:
            return rng.randbytes(rng.choice((0, 1, 2, 160, 1440, 3200)))
        if origin is typing.Literal:
            return rng.choice(inner)
        if origin is tuple:
            return tuple(self._value(i, wild, depth - 1) for i in inner)
        if origin is list:
            return [
                self._value(inner[0], wild, depth - 1) for _ in range(0 if depth <= 0 else rng.choice((0, 1, 3, 7, 12)))
            ]
        if origin is dict:
            return {rng.choice(WORDS): self._value(inner[1], wild, depth - 1) for _ in range(rng.randint(0, 3))}
        if isinstance(kind, type) and issubclass(kind, msgspec.Struct):
            hints = typing.get_type_hints(kind)
            return kind(**{f.name: self._value(hints[f.name], wild, depth - 1) for f in msgspec.structs.fields(kind)})
        if inner:  # a union
            return self._value(rng.choice(inner), wild, depth - 1)
        return None
