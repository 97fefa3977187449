import msgspec
import pytest

from common import messages as m
from common import topics
from common.bus import codec
from common.topic import Topic


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
def test_encoded_messages_decode_to_themselves(topic: Topic[m.Message]) -> None:
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


def refusal(topic: Topic[m.Message], payload: bytes) -> str:
    with pytest.raises(codec.DecodeError) as refused:
        codec.decode(topic, payload)
    assert refused.value.__cause__ is None, "the reason is enough"
    return str(refused.value)


@pytest.mark.parametrize(
    ("payload", "reason"),
    [
        (b"", "empty payload"),
        (b"a\x00b", "not printable text"),
        (b"   ", "not printable text"),
        (b'""', "not printable text"),
        (b'" \\t"', "not printable text"),
        (b"x" * (codec.MAX_TEXT_BYTES + 1), "payload of 65537 bytes is over the limit of 65536"),
    ],
)
def test_the_reason_says_what_is_wrong_with_a_text(payload: bytes, reason: str) -> None:
    assert refusal(topics.NAVIGATION_GOAL, payload) == reason


@pytest.mark.parametrize("payload", [b'"hello"', b"[1]", b' \t\r\n"hello"'])
def test_a_structure_is_an_object(payload: bytes) -> None:
    assert refusal(topics.GOAL_REACHED, payload) == "not a JSON object"


def test_what_is_no_number_is_named_in_either_form() -> None:
    infinite = msgspec.msgpack.encode({"t": float("inf"), "x": 0.0, "y": 0.0, "theta": 0.0})
    for payload in (infinite, b'{"t": 1e99, "x": 0.0, "y": 0.0, "theta": 0.0}'):
        assert refusal(topics.ODOMETRY, payload) == "t is not a finite number of a sane size"


def test_the_limit_is_for_texts_and_reached_by_the_longest_of_them() -> None:
    longest = codec.decode(topics.NAVIGATION_GOAL, b"x" * codec.MAX_TEXT_BYTES)
    assert len(longest.goal) == codec.MAX_TEXT_BYTES
    sound = m.AudioChunk(t=0.0, data=bytes(2 * codec.MAX_TEXT_BYTES))
    assert codec.decode(topics.AUDIO_PCM, codec.encode(topics.AUDIO_PCM, sound)) == sound


def test_a_text_is_trimmed_inside_its_quotes_and_outside() -> None:
    for payload in (b'" goto kitchen "', b'\n\t"goto kitchen"', b"\r goto kitchen \t"):
        assert codec.decode(topics.NAVIGATION_GOAL, payload).goal == "goto kitchen"


def test_an_object_may_have_any_white_space_before_it() -> None:
    assert codec.decode(topics.GOAL_REACHED, b' \t\r\n{"reached": true}').reached is True


def test_a_type_without_text_field_takes_no_bare_text_whatever_its_topic() -> None:
    assert codec.decode_as(m.NavigationGoal, b"goto kitchen", "goal").goal == "goto kitchen"
    with pytest.raises(codec.DecodeError):
        codec.decode_as(m.NavigationGoal, b"goto kitchen")


def test_the_encoding_is_told() -> None:
    assert codec.encoding_of(topics.BRAIN_STATE) == "application/json"
    assert codec.encoding_of(topics.HEAD_RGBD) == "application/msgpack"
    assert codec.encode(topics.GOAL_REACHED, m.GoalReached(reached=True))[:1] == b"{"
    assert codec.encode(topics.AUDIO_PCM, m.AudioChunk(t=0.0, data=b""))[:1] != b"{"


def test_the_wrong_type_for_a_topic_is_a_programming_error_told_with_both_names() -> None:
    with pytest.raises(TypeError, match=r"^brain/state carries BrainState, not GoalReached$"):
        codec.encode(topics.BRAIN_STATE, m.GoalReached(reached=True))


def test_a_type_that_was_never_decoded_before_is_read_in_either_form() -> None:
    class Fresh(m.Message):
        x: float

    for payload in (b'{"x": 0.5}', msgspec.msgpack.encode({"x": 0.5})) * 2:
        assert codec.decode_as(Fresh, payload) == Fresh(x=0.5)
    with pytest.raises(codec.DecodeError):
        codec.decode_as(Fresh, b'{"y": 0.5}')


def test_the_decoder_s_own_reason_is_passed_on() -> None:
    assert refusal(topics.NAVIGATION_GOAL, b'{"goal": "find') == "Input data was truncated"
