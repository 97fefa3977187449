"""Decoder plug-ins of zenoh-cli: `zenoh ... subscribe -k 'brain/**' --decoder tidybot` or `--decoder tidybot-text`."""

from cli.payload import line, word


def decode(key: object, payload: bytes) -> str:
    """JSON, MessagePack and text payloads of any key as one line of JSON."""
    return line(str(key), payload)


def decode_text(key: object, payload: bytes) -> str:
    """The bare word of goals, results, statuses and states; JSON of all other keys."""
    return word(str(key), payload)
