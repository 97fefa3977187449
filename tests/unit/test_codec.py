import msgspec
import pytest

from common import codec, topics
from common import messages as m


@pytest.mark.parametrize(
    "payload",
    [
        b"return_to_start",
        b'"return_to_start"',
        b'{"goal":"return_to_start"}',
        b' {"goal": "return_to_start", "surprise": [1, 2]}\n',
        b"  return_to_start \n",
    ],
)
def test_a_goal_means_the_same_in_every_accepted_form(payload: bytes) -> None:
    goal = codec.decode(topics.NAVIGATION_GOAL, payload)
    assert (goal.goal, goal.id, goal.attempt) == ("return_to_start", "", 1)


@pytest.mark.parametrize(
    "payload",
    [
        b"",
        b"\xff\xfe\x00",
        b'{"goal": "find',
        b'{"goal": 3}',
        b'{"id": "a"}',
        b"a\x00b",
        b"   ",
        b'""',
        b"x" * (codec.MAX_TEXT_BYTES + 1),
        b"[" * 100_000,
        b'{"goal":' * 50_000,
    ],
)
def test_anything_else_is_refused_with_a_reason(payload: bytes) -> None:
    with pytest.raises(codec.DecodeError, match=r"."):
        codec.decode(topics.NAVIGATION_GOAL, payload)


def test_binary_topics_accept_json_from_a_plain_peer() -> None:
    payload = b'{"t": 1.5, "name": ["base_x"], "position": [0.25], "velocity": [0.0], "effort": [0.0]}'
    assert codec.decode(topics.JOINT_STATES, payload).position == [0.25]


def test_json_topics_accept_message_pack() -> None:
    payload = msgspec.msgpack.encode({"reached": True, "target_id": "a"})
    assert codec.decode(topics.GOAL_REACHED, payload).reached is True


@pytest.mark.parametrize("payload", [b"hello", b'"hello"', b"[1]", b"\x01", b"\x93\x01\x02\x03"])
def test_structured_topics_refuse_bare_text(payload: bytes) -> None:
    with pytest.raises(codec.DecodeError):
        codec.decode(topics.GOAL_REACHED, payload)


@pytest.mark.parametrize("topic", topics.TABLE, ids=lambda t: t.key)
def test_encoded_messages_decode_to_themselves(topic: topics.Topic[m.Message]) -> None:
    samples = {str: "listen", float: 0.1, int: 7, bool: True, bytes: b"\x00\xff", list: [], dict: {}}
    values = {}
    for field in msgspec.structs.fields(topic.type):
        if field.required:
            values[field.name] = _sample(field.type, samples)
    message = topic.type(**values)
    assert codec.decode(topic, codec.encode(topic, message)) == message


def _sample(kind: object, samples: dict[type, object]) -> object:
    info = msgspec.inspect.type_info(kind)
    if isinstance(info, msgspec.inspect.LiteralType):
        return info.values[0]
    if isinstance(info, msgspec.inspect.TupleType):
        return tuple(0.5 for _ in info.item_types)
    if isinstance(info, msgspec.inspect.StructType):
        return info.cls(**{f.name: _sample(f.type, samples) for f in msgspec.structs.fields(info.cls) if f.required})
    origin = getattr(kind, "__origin__", kind)
    return samples[origin]


def test_the_wrong_type_for_a_topic_is_a_programming_error() -> None:
    with pytest.raises(TypeError, match="brain/state"):
        codec.encode(topics.BRAIN_STATE, m.GoalReached(reached=True))
