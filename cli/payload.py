"""Conversion of any payload into something to print."""

from typing import Any

import msgspec

from common import messages as m
from common import topics
from common.bus import codec

SHOWN_BYTES, SHOWN_ITEMS = 24, 400
"""Bytes that are shown as hexadecimal digits, and items of a list; chosen: a line and a screen."""
STATE_FIELD = {topics.SYSTEM_STATUS.key: "state", topics.BRAIN_STATE.key: "state", topics.SIM_STATUS.key: "state"}
"""Keys that carry a state and take no bare text: the field with its name."""


def plain(key: str, payload: bytes) -> Any:
    """The payload as plain values, by the key's own type where the table knows it; text or size where nothing fits."""
    name = bare(key)
    kind = topics.type_of(name)
    if kind is not None:
        text = topics.BY_KEY[name].text if name in topics.BY_KEY else ""
        try:
            return shortened(fields(codec.decode_as(kind, payload, text)))
        except codec.DecodeError as error:
            return {"undecodable": str(error), "payload": shortened(foreign(payload))}
    return shortened(foreign(payload))


def bare(key: str) -> str:
    """The key without a robot's namespace before it."""
    while topics.type_of(key) is None and "/" in key:
        _, _, rest = key.partition("/")
        if topics.type_of(rest) is not None or "/" in rest:
            key = rest
        else:
            break
    return key


def fields(value: Any) -> Any:
    """Messages as dictionaries, everything else as it is."""
    if isinstance(value, m.Message):
        return {name: fields(getattr(value, name)) for name in value.__struct_fields__}
    if isinstance(value, (list, tuple)):
        return [fields(v) for v in value]
    if isinstance(value, dict):
        return {str(k): fields(v) for k, v in value.items()}
    if isinstance(value, msgspec.msgpack.Ext):
        return value.data
    return value


def foreign(payload: bytes) -> Any:
    """A payload of an unknown key: JSON, MessagePack, text, or bytes."""
    if payload[:1] in (b"{", b"[", b'"') or payload[:1].isdigit():
        try:
            return msgspec.json.decode(payload)
        except (ValueError, RecursionError):
            pass
    if payload and payload[0] >= 0x80:
        try:
            return fields(msgspec.msgpack.decode(payload))
        except (ValueError, RecursionError):
            pass
    try:
        text = payload.decode()
    except UnicodeDecodeError:
        return payload
    return text if text.isprintable() else payload


def shortened(value: Any) -> Any:
    """Bytes become their size, floats six digits, so that a line stays readable."""
    if isinstance(value, (bytes, bytearray, memoryview)):
        return f"<{len(value)} bytes>" if len(value) > SHOWN_BYTES else bytes(value).hex()
    if isinstance(value, float):
        return round(value, 6)
    if isinstance(value, str) and len(value) > SHOWN_ITEMS * 10:
        return value[: SHOWN_ITEMS * 10] + f"... ({len(value)} characters)"
    if isinstance(value, dict):
        return {k: shortened(v) for k, v in value.items()}
    if isinstance(value, (list, tuple)):
        return [shortened(v) for v in value[:SHOWN_ITEMS]]
    return value


def line(key: str, payload: bytes) -> str:
    """The payload as one line of JSON."""
    return msgspec.json.encode(plain(key, payload)).decode()


def word(key: str, payload: bytes) -> str:
    """The one field that says it all where the key's message has such a field, else `line`."""
    value = plain(key, payload)
    name = bare(key)
    field = STATE_FIELD.get(name) or (topics.BY_KEY[name].text if name in topics.BY_KEY else "")
    if field and isinstance(value, dict) and isinstance(value.get(field), str):
        return str(value[field])
    return line(key, payload)
