"""Payload bytes to messages and back: JSON for what people read, MessagePack for what is bulky."""

from typing import Any, TypeVar

import msgspec

from common import messages as m
from common.bus.validation import bad_field
from common.topic import Topic

M = TypeVar("M", bound=m.Message)
JSON, MSGPACK = "application/json", "application/msgpack"
MAX_TEXT_BYTES = 65536
"""Longest goal as bare text [bytes]; chosen: no sentence is as long."""
_SPACE = b" \t\r\n"

_json_encode = msgspec.json.Encoder().encode
_msgpack_encode = msgspec.msgpack.Encoder().encode
_json_decoders: dict[type, msgspec.json.Decoder[Any]] = {}
_msgpack_decoders: dict[type, msgspec.msgpack.Decoder[Any]] = {}


class DecodeError(ValueError):
    """A payload that is none of the accepted forms; the text is the reason."""


def encoding_of(topic: Topic[Any]) -> str:
    """The MIME type that messages of this topic are sent with."""
    return MSGPACK if topic.binary else JSON


def encode(topic: Topic[M], message: M) -> bytes:
    """Encode a message as its topic has it on the wire.

    Raises:
        TypeError: the message is not of the topic's type.
    """
    if type(message) is not topic.type:
        raise TypeError(f"{topic.key} carries {topic.type.__name__}, not {type(message).__name__}")
    return _msgpack_encode(message) if topic.binary else _json_encode(message)


def decode_as(kind: type[M], payload: bytes, text_field: str = "") -> M:
    """A message from JSON, MessagePack or, where the type has a text field, a JSON string or bare text.

    The declared encoding is not consulted: command-line tools send none, and the first byte tells.

    Raises:
        DecodeError: none of these forms.
    """
    if not payload:
        raise DecodeError("empty payload")
    if text_field and len(payload) > MAX_TEXT_BYTES:
        raise DecodeError(f"payload of {len(payload)} bytes is over the limit of {MAX_TEXT_BYTES}")
    stripped = payload.lstrip(_SPACE)
    try:
        if stripped[:1] == b"{":
            return _sound(_json(kind).decode(payload))
        if text_field:
            return kind(**{text_field: _text(stripped)})
        if stripped[:1] in (b"[", b'"'):
            raise DecodeError("not a JSON object")
        return _sound(_msgpack(kind).decode(payload))
    except (msgspec.DecodeError, UnicodeDecodeError, RecursionError) as error:
        raise DecodeError(str(error)) from None


def decode(topic: Topic[M], payload: bytes) -> M:
    """`decode_as` for a topic of the table."""
    return decode_as(topic.type, payload, topic.text)


def _sound(message: M) -> M:
    if where := bad_field(message):
        raise DecodeError(f"{where} is not a finite number of a sane size")
    return message


def _text(payload: bytes) -> str:
    if payload[:1] == b'"':
        text = msgspec.json.decode(payload, type=str).strip()
    else:
        text = payload.decode("utf-8").strip()
    if not text or not text.isprintable():
        raise DecodeError("not printable text")
    return text


def _json(kind: type[M]) -> "msgspec.json.Decoder[M]":
    if kind not in _json_decoders:
        _json_decoders[kind] = msgspec.json.Decoder(kind)
    return _json_decoders[kind]


def _msgpack(kind: type[M]) -> "msgspec.msgpack.Decoder[M]":
    if kind not in _msgpack_decoders:
        _msgpack_decoders[kind] = msgspec.msgpack.Decoder(kind)
    return _msgpack_decoders[kind]
