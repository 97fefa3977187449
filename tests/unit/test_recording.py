"""Recordings: what is written is read back, also from a torn file; a replay of the same run is the same."""

import argparse
import json
import random
import struct
from pathlib import Path
from typing import Any

import pytest
from mcap.reader import make_reader

from bench.fuzz.payloads import Payloads
from cli.errors import CliError
from cli.recordings import replay
from cli.recordings.copies import repair
from common import messages as m
from common import topics
from common.bus import codec
from common.recording import BULK, Recorder, Recording, RecordingError
from common.schemas import schema_of
from common.time.lockstep import DT
from common.topic import Topic
from evaluation.replay.__main__ import main as replay_service
from evaluation.replay.comparison import compare, differs
from evaluation.stack import Stack

FOXGLOVE = {"boolean", "string", "number", "integer", "object", "array"}


def check_dialect(schema: dict[str, Any], where: str) -> None:
    """The rules of Foxglove's own reader of JSON schemas."""
    assert schema.get("type") == "object", where
    for name, field in schema["properties"].items():
        assert field.get("type") in FOXGLOVE, f"{where}.{name}"
        assert field.get("contentEncoding") in (None, "base64")
        if field["type"] == "array":
            assert field["items"].get("type") in FOXGLOVE - {"array"}, f"{where}.{name}"
            assert "contentEncoding" not in field["items"]
            field = field["items"]
        if field["type"] == "object":
            check_dialect(field, f"{where}.{name}")


@pytest.mark.parametrize("topic", topics.TABLE, ids=lambda t: t.key)
def test_the_schema_of_every_topic_is_one_that_foxglove_reads(topic: "Topic[Any]") -> None:
    schema = json.loads(schema_of(topic.type))
    check_dialect(schema, topic.key)
    untyped = {*topic.type.__struct_fields__} - {*schema["properties"]}
    assert untyped <= {"points", "path", "offered"}, (
        "only arrays of arrays, which Foxglove has no word for, are left out"
    )


def test_every_topic_comes_back_as_it_was_and_opens_with_the_official_reader(tmp_path: Path) -> None:
    path, make = tmp_path / "all.mcap", Payloads(3)
    recorder = Recorder(path)
    sent = {}
    for n, topic in enumerate(topics.TABLE):
        sent[topic.key] = message = make.message(topic.type)
        recorder.write(topic.key, codec.encode(topic, message), n * 0.5, 1e9 + n, tick=n)
    recorder.note("run", {"seed": "3"})
    recorder.attach("scene/flat.toml", b"name = 'flat'", 1e9)
    recorder.close()
    back = Recording(path)
    assert not back.torn and back.facts["run"] == {"seed": "3"} and back.files["scene/flat.toml"] == b"name = 'flat'"
    for n, row in enumerate(back.rows):
        topic = topics.TABLE[n]
        assert (row.key, row.t, row.wall, row.tick) == (topic.key, n * 0.5, 1e9 + n, n)
        assert codec.decode(topic, row.payload) == sent[topic.key]
    with path.open("rb") as file:
        summary = make_reader(file, validate_crcs=True).get_summary()
    assert summary is not None and summary.statistics is not None
    assert summary.statistics.message_count == len(topics.TABLE)
    for channel in summary.channels.values():
        assert channel.message_encoding == ("msgpack" if channel.topic in BULK else "json")
        if channel.topic not in BULK:
            assert summary.schemas[channel.schema_id].encoding == "jsonschema"


def test_text_becomes_json_and_junk_has_a_channel_of_its_own(tmp_path: Path) -> None:
    path = tmp_path / "words.mcap"
    recorder = Recorder(path)
    recorder.write("brain/navigation_goal", b"find red mug", 1.0, 2.0)
    recorder.write("joint_states", b"\xff\x00", 1.5, 2.0)
    recorder.write("somebody/elses", b"hello", 1.6, 2.0)
    recorder.presence("speech", True, 2.0, 3.0)
    recorder.close()
    goal, noise, foreign, token = Recording(path).rows
    assert json.loads(goal.payload) == {"goal": "find red mug", "id": "", "attempt": 1} and goal.tick is None
    assert noise.junk and noise.payload == b"\xff\x00" and foreign.junk
    assert (token.key, token.payload) == ("service/speech/alive", b'{"alive":true}')


def recorded(path: Path, messages: int) -> None:
    """A file with a chunk for every 20 messages."""
    recorder = Recorder(path)
    for n in range(messages):
        status = m.NavigationStatus(status="navigating", goal_id=f"m.{n}", detail="x" * 50)
        recorder.write("brain/navigation_status", codec.encode(topics.NAVIGATION_STATUS, status), n * DT, 5.0)
        if n % 20 == 19:
            recorder.flush()
    recorder.close()


def test_a_torn_file_gives_all_that_was_flushed_and_is_repaired(tmp_path: Path) -> None:
    whole, torn, mended = tmp_path / "whole.mcap", tmp_path / "torn.mcap", tmp_path / "mended.mcap"
    recorded(whole, 100)
    data, found = whole.read_bytes(), []
    for size in range(len(data) - 1, 20, -37):
        torn.write_bytes(data[:size])
        back = Recording(torn)
        assert back.torn
        assert [json.loads(r.payload)["goal_id"] for r in back.rows] == [f"m.{n}" for n in range(len(back.rows))]
        found.append(len(back.rows))
    assert found == sorted(found, reverse=True) and set(found) == {0, 20, 40, 60, 80, 100}
    torn.write_bytes(data[: len(data) * 6 // 10])
    saved = repair(torn, mended)
    again = Recording(mended)
    assert saved == len(again.rows) == len(Recording(torn).rows) > 0 and not again.torn
    assert [(r.t, r.payload) for r in again.rows] == [(r.t, r.payload) for r in Recording(torn).rows]


def test_a_repaired_file_says_who_was_there(tmp_path: Path) -> None:
    path, mended = tmp_path / "whole.mcap", tmp_path / "mended.mcap"
    recorder = Recorder(path)
    recorder.presence("brain", True, 0.5, 5.0)
    recorder.presence("brain", False, 2.0, 6.5)
    recorder.close()
    assert repair(path, mended) == 2
    again = Recording(mended)
    assert list(again.spans) == ["service/brain/alive"], "no message that is none"
    assert [json.loads(row.payload)["alive"] for row in again.rows] == [True, False]


def test_damage_ends_the_reading_and_is_told(tmp_path: Path) -> None:
    path, rng = tmp_path / "damaged.mcap", random.Random(1)
    recorded(path, 100)
    data = path.read_bytes()
    for _ in range(200):
        broken = bytearray(data)
        broken[rng.randrange(8, len(data))] ^= 1 << rng.randrange(8)
        path.write_bytes(broken)
        back = Recording(path)
        ids = [json.loads(r.payload)["goal_id"] for r in back.rows]
        assert ids == [f"m.{n}" for n in range(len(ids))] or back.torn
        assert len(ids) <= 100


@pytest.mark.parametrize("data", [b"", b"RIFF....WAVE", struct.pack("<100Q", *range(100))])
def test_what_is_no_recording_is_refused(tmp_path: Path, data: bytes) -> None:
    path = tmp_path / "photo.png"
    path.write_bytes(data)
    with pytest.raises(RecordingError, match="not an MCAP file"):
        Recording(path)
    with pytest.raises(RecordingError, match="No such file"):
        Recording(tmp_path / "absent.mcap")
    with pytest.raises(RecordingError):
        Recorder(tmp_path / "no" / "such" / "folder.mcap")


# --- comparison
def states(*rows: tuple[float, str]) -> list[tuple[float, m.Message]]:
    return [(t, m.NavigationStatus(status="navigating", detail=text)) for t, text in rows]


@pytest.mark.parametrize(
    ("old", "new", "slack", "said"),
    [
        (((1, "a"), (2, "b")), ((1, "a"), (2, "b")), 0.0, ""),
        (((1, "a"), (2, "b")), ((1, "a"), (2, "c")), 0.0, "message 2 at 2.00 s: detail 'b' -> 'c'"),
        (((1, "a"),), ((1.04, "a"),), 0.0, "message 1 at 1.00 s: came at 1.04 s"),
        (((1, "a"),), ((1.04, "a"),), 0.05, ""),
        (((1, "a"), (2, "b")), ((1, "a"),), 0.0, "message 2 at 2.00 s never came"),
        (((1, "a"),), ((1, "a"), (3, "b")), 0.0, "message 2 at 3.00 s was not recorded"),
    ],
)
def test_events_are_compared_in_order(old: Any, new: Any, slack: float, said: str) -> None:
    verdict = compare(topics.NAVIGATION_STATUS, states(*old), states(*new), slack)
    assert verdict.difference.startswith(said) and verdict.same is (not said)


def test_a_stream_with_slack_may_skip_but_not_stray() -> None:
    def poses(*rows: float) -> list[tuple[float, m.Message]]:
        return [(t, m.PoseEstimate(t=t, x=2 * t, y=0.0, theta=0.0)) for t in rows]

    old = poses(0.0, 0.1, 0.2, 0.3)
    assert compare(topics.POSE, old, poses(0.1, 0.3), 0.05).same
    assert not compare(topics.POSE, old, poses(0.1, 0.3), 0.0).same
    new = [*poses(0.1), (0.2, m.PoseEstimate(t=0.2, x=0.9, y=0.0, theta=0.0))]
    assert "x 0.4 -> 0.9" in compare(topics.POSE, old, new, 0.05).difference


def test_numbers_differ_beyond_the_tolerance_and_epochs_never() -> None:
    a, b = m.JointStates(t=1, name=["j"], position=[1.0], velocity=[], effort=[]), None
    b = m.JointStates(t=1, name=["j"], position=[1.001], velocity=[], effort=[])
    assert differs(a, b, 0.0) == "position[0] 1.0 -> 1.001"
    assert not differs(a, m.JointStates(t=1, name=["j"], position=[1 + 1e-12], velocity=[], effort=[]), 0.0)
    assert not differs(m.SimStatus(state="running", epoch="a"), m.SimStatus(state="running", epoch="b"), 0.0)
    assert "has 1 -> 0 items" in differs(a, m.JointStates(t=1, name=[], position=[], velocity=[], effort=[]), 0.0)


# --- replay
@pytest.fixture(scope="module")
def run_file(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Ten seconds of driving in the small flat, recorded from the bus in memory."""
    path = tmp_path_factory.mktemp("runs") / "run.mcap"
    recorder = Recorder(path)
    keys = {t.key for t in topics.TABLE}
    robot = Stack("minimal", seed=5, without=("camera", "perception", "planner", "speech"))
    deliver = robot.bus.put

    def put(topic: Any, payload: bytes, stamp: int = -1) -> None:
        if topic.key in keys:
            recorder.write(topic.key, payload, max(0, stamp) * DT, 0.0, max(0, stamp))
        deliver(topic, payload, stamp)

    for key, payload in robot.bus.last.items():
        recorder.write(key, payload, 0.0, 0.0, 0)
    robot.bus.put = put  # type: ignore[method-assign]
    for tick in range(1, 1001):
        robot.tick()
        clock = m.SimClockTick(t=tick * DT, tick=tick, lockstep=True)
        recorder.write("sim/clock", codec.encode(topics.SIM_CLOCK, clock), tick * DT, 0.0)
        for name, period in (("navigation", 5), ("manipulation", 2)):
            if tick % period == 0:
                ack = codec.encode(topics.LOCKSTEP_ACK, m.LockstepAck(name=name, tick=tick, period=period))
                recorder.write("sim/ack", ack, tick * DT, 0.0)
        if tick == 100:
            goal = m.NavigationGoal(goal="goto start", id="m.1")
            robot.bus.put(topics.NAVIGATION_GOAL, codec.encode(topics.NAVIGATION_GOAL, goal), tick)
            there = m.NavGoal(id="m.2", x=-0.4, y=0.3, theta=0.5)
            robot.bus.put(topics.NAV_GOAL, codec.encode(topics.NAV_GOAL, there), tick)
    robot.close()
    recorder.note("run", {"lockstep": "true", "scene": "minimal", "seed": "5"})
    recorder.close()
    return path


@pytest.fixture(scope="module")
def cut_file(run_file: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The same run, ended amid a step: outputs of it are there, its clock and its acknowledgements are not."""
    path, whole = tmp_path_factory.mktemp("cut") / "run.mcap", Recording(run_file)
    recorder = Recorder(path)
    for row in whole.rows:
        if row.key not in ("sim/clock", "sim/ack") or row.t < 9.94:
            recorder.write(row.key, row.payload, row.t, row.wall, row.tick)
    recorder.note("run", whole.facts["run"])
    recorder.close()
    return path


def play(path: Path, service: str, *settings: str) -> int:
    words = (word for setting in settings for word in ("--set", setting))
    return replay_service([str(path), "--service", service, *words])


@pytest.mark.parametrize("file", ["run_file", "cut_file"])
@pytest.mark.parametrize("service", ["navigation", "sim"])
def test_the_same_inputs_give_the_same_outputs(
    request: pytest.FixtureRequest,
    file: str,
    service: str,
    capsys: pytest.CaptureFixture[str],
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setenv("TIDYBOT_CONFIG_DIR", "")
    monkeypatch.setenv("TIDYBOT_RUN_DIR", "")
    code, shown = play(request.getfixturevalue(file), service), capsys.readouterr().out
    assert code == 0, shown
    assert "differing" not in shown and shown.count(" same") >= 3


def test_another_parameter_gives_other_outputs_and_exit_status_1(
    run_file: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("TIDYBOT_CONFIG_DIR", "")
    monkeypatch.setenv("TIDYBOT_RUN_DIR", "")
    assert play(run_file, "sim", "sim.max_speed=0.1") == 1
    shown = capsys.readouterr().out
    assert "joint_states" in shown and "differing: message" in shown


def test_what_a_recording_holds(run_file: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert replay.info(run_file) == 0
    shown = capsys.readouterr().out
    assert "scene minimal, seed 5, lockstep" in shown and "torn" not in shown
    row = next(x for x in shown.splitlines() if x.startswith("joint_states"))
    assert row.split()[1] == "1000" and row.split()[2] == "100.0"


def test_an_unknown_service_is_named(run_file: Path) -> None:
    parser = argparse.ArgumentParser()
    replay.register(parser.add_subparsers())
    with pytest.raises(CliError, match="did you mean 'navigation'"):
        replay.replay(parser.parse_args(["replay", str(run_file), "--service", "navigator"]))
