"""A decoder plug-in of zenoh-cli: `zenoh ... subscribe -k 'brain/**' --decoder tidybot`."""

from cli.payload import line


def decode(key: object, payload: bytes) -> str:
    """JSON, MessagePack and text payloads of any key as one line of JSON."""
    return line(str(key), payload)
