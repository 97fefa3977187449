"""What is printed of a payload, the decoder plug-in, composing messages, key matching, rates."""

import msgspec
import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from cli import topic
from cli.errors import CliError
from cli.payload import line
from cli.zenoh_decoder import decode, decode_text
from common import messages as m
from common import topics
from common.bus import codec
from common.topic import Topic


def test_json_messagepack_and_text_all_print_as_json() -> None:
    odom = codec.encode(topics.ODOMETRY, m.Odometry(t=1.5, x=1.0, y=2.0, theta=0.5))
    assert msgspec.json.decode(decode("base/odom", odom))["y"] == 2.0
    goal = codec.encode(topics.NAVIGATION_GOAL, m.NavigationGoal(goal="find mug", id="g1"))
    assert msgspec.json.decode(decode("brain/navigation_goal", goal))["id"] == "g1"
    assert msgspec.json.decode(decode("brain/navigation_goal", b"return_to_start"))["goal"] == "return_to_start"


def test_a_namespace_before_the_key_does_not_hide_its_type() -> None:
    odom = codec.encode(topics.ODOMETRY, m.Odometry(t=1.5, x=1.0, y=2.0, theta=0.5))
    assert msgspec.json.decode(decode("kitchen-bot/base/odom", odom))["x"] == 1.0


@pytest.mark.parametrize(
    ("topic", "message", "shown"),
    [
        (topics.SYSTEM_STATUS, m.SystemStatus(state="GROUNDING", detail="look"), "GROUNDING"),
        (topics.BRAIN_STATE, m.BrainState(state="WAITING"), "WAITING"),
        (topics.NAVIGATION_STATUS, m.NavigationStatus(status="arrived", goal_id="g1"), "arrived"),
        (topics.SPEECH_GOAL, m.SpeechGoal(goal="listen", id="g1"), "listen"),
    ],
)
def test_who_asks_for_text_gets_the_bare_word(topic: Topic[m.Message], message: m.Message, shown: str) -> None:
    payload = codec.encode(topic, message)
    assert decode_text(f"kitchen-bot/{topic.key}", payload) == shown
    assert msgspec.json.decode(decode(topic.key, payload))


def test_what_is_no_single_word_stays_json() -> None:
    assert decode_text("base/goal_reached", b'{"reached": true}').startswith('{"reached":true')
    assert "undecodable" in decode_text("system_status", b'{"state": 3}')
    assert decode_text("some/key", b"plain words") == '"plain words"'


def test_keys_of_others_print_too() -> None:
    assert decode("some/key", b"plain words") == '"plain words"'
    assert decode("some/key", b'{"a": 1}') == '{"a":1}'
    assert decode("some/key", msgspec.msgpack.encode({"a": b"x" * 99})) == '{"a":"<99 bytes>"}'
    assert decode("some/key", b"\xff\xfe\x00") == '"fffe00"'


def test_a_payload_of_the_wrong_kind_says_so() -> None:
    shown = msgspec.json.decode(line("base/odom", b'{"t": "late"}'))
    assert "undecodable" in shown and shown["payload"] == {"t": "late"}


# A JSON string that is no UTF-8; an extension type; too deep for JSON and for MessagePack.
@example(topics.ODOMETRY.key, b'"\x80"')
@example(topics.ODOMETRY.key, b"\xd4\x01\x02")
@example(topics.ODOMETRY.key, b"[" * 100_000)
@example(topics.ODOMETRY.key, b"\x91" * 100_000)
@given(st.sampled_from(sorted(topics.BY_KEY)), st.binary(max_size=200))
def test_no_payload_breaks_the_decoder(key: str, payload: bytes) -> None:
    msgspec.json.decode(decode(key, payload))


@pytest.mark.parametrize(
    ("expression", "key", "expected"),
    [
        ("brain/**", "brain/state", True),
        ("brain/**", "brain", True),
        ("brain/**", "brains/x", False),
        ("**/state", "brain/state", True),
        ("**", "joint_states", True),
        ("brain/*", "brain/state", True),
        ("camera/*", "camera/head/rgbd", False),
        ("camera/*/rgbd", "camera/head/rgbd", True),
        ("service/*/health", "service/sim/health", True),
    ],
)
def test_key_expressions(expression: str, key: str, expected: bool) -> None:
    assert topic.matches(expression, key) is expected


def test_messages_from_words() -> None:
    pose = topic.compose(topics.BASE_TARGET, ["x=1", "y=-2.5", "theta=0"])
    assert pose == m.BaseTarget(x=1.0, y=-2.5, theta=0.0)
    assert topic.compose(topics.NAVIGATION_GOAL, ["find", "red", "mug"]) == m.NavigationGoal(goal="find red mug")
    assert topic.compose(topics.NAVIGATION_GOAL, ['{"goal": "stop", "id": "7"}']) == m.NavigationGoal(
        goal="stop", id="7"
    )
    assert topic.compose(topics.VOICE_COMMAND, ["text=hello you", "confidence=0.5"]) == m.VoiceCommand(
        text="hello you", confidence=0.5
    )
    with pytest.raises(CliError, match="did you mean 'goal'"):
        topic.compose(topics.NAVIGATION_GOAL, ['{"gaol": "stop"}'])
    with pytest.raises(CliError, match="takes a JSON object or field=value"):
        topic.compose(topics.BASE_TARGET, ["forward"])


def test_rates() -> None:
    stamps = [(0.01 * i, 100) for i in range(101)]
    assert "100.0 Hz" in topic.rate_line("a", stamps) and "10.0 kB/s" in topic.rate_line("a", stamps)
    assert topic.rate_line("a", [(1.0, 5)]) == "a  1 message"
