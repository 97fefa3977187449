"""Looking back: missions told from a recording, their timeline as a picture, a mission cut out."""

import itertools
import re
from pathlib import Path
from typing import Any

import pytest

from cli.errors import CliError
from cli.recordings import export as mission_export
from cli.recordings import key_frames
from common import messages as m
from common import topics
from common.bus import codec
from common.mission_log import recorded, timeline
from common.mission_log.states import spans
from common.recording import Recorder, Recording, Row
from common.scene import load_scene
from common.time.lockstep import DT
from common.topic import Topic
from services.sim.model import own
from services.sim.physics import Physics
from tests.support import JOINT_NAMES


def write(path: Path, *, failed: bool = False) -> Path:
    """30 s of a robot: a mission from 5 to 20 s, and another that is under way when the recording ends."""
    physics = Physics(load_scene("minimal"), 0, ())
    recorder = Recorder(path)

    def put(t: float, topic: Topic[Any], message: m.Message) -> None:
        recorder.write(topic.key, codec.encode(topic, message), t, 1000.0 + t, round(t / DT))

    def state(t: float, name: Any, mission: str = "", **more: Any) -> None:
        put(t, topics.BRAIN_STATE, m.BrainState(state=name, t=t, mission_id=mission, **more))

    recorder.note("run", {"scene": "minimal", "seed": "0"})
    put(0.0, topics.SIM_MODEL, m.SimModel(scene="minimal", seed=0, epoch="e", mjcf=physics.mjcf))
    recorder.presence("sim", True, 0.0, 1000.0)
    for n in range(300):
        t = n / 10
        values = (t / 10, 0.0, 0.0, *own().home, 0.085)
        zeros = [0.0] * len(values)
        joints = m.JointStates(t=t, name=list(JOINT_NAMES), position=list(values), velocity=zeros, effort=zeros)
        put(t, topics.JOINT_STATES, joints)
        physics.data.qpos[0] = t / 10
        put(t, topics.SIM_STATE, m.SimState(t=t, tick=n * 10, epoch="e", qpos=physics.data.qpos.tobytes()))
    state(1.0, "WAITING")
    put(5.0, topics.VOICE_COMMAND, m.VoiceCommand(text="bring me the <mug>"))
    state(5.0, "PLANNING", "m-1", command="bring me the <mug>", started=5.0)
    state(8.0, "NAVIGATING", "m-1", command="bring me the <mug>", started=5.0)
    put(10.0, topics.SPEECH_GOAL, m.SpeechGoal(goal="say here I come"))
    if failed:
        broken = m.NavigationFeedback(status="failed", goal_id="m-1.1", code="BLOCKED", detail="a chair")
        put(12.0, topics.NAVIGATION_FEEDBACK, broken)
    last = m.MissionOutcome(id="m-1", command="bring me the <mug>", outcome="failed" if failed else "delivered", t=20.0)
    state(20.0, "ERROR" if failed else "COMPLETED", "m-1", command="bring me the <mug>", started=5.0, last=last)
    state(22.0, "WAITING", "", last=last)
    state(25.0, "PLANNING", "m-2", command="tidy up", started=25.0, last=last)
    recorder.close()
    return path


@pytest.fixture(scope="module")
def recording(tmp_path_factory: pytest.TempPathFactory) -> Recording:
    return Recording(write(tmp_path_factory.mktemp("tape") / "run.mcap", failed=True))


def test_missions_are_told_from_the_topics_alone(recording: Recording) -> None:
    first, second = recorded.missions(recording.rows)
    assert (first["id"], first["outcome"], first["started"], first["ended"]) == ("m-1", "failed", 5.0, 20.0)
    assert 20.0 <= first["until"] < 22.1
    assert (second["id"], second["outcome"]) == ("m-2", None)
    kinds = [(e["kind"], e["cause"]) for e in first["entries"] if e["kind"] != "state"]
    assert kinds == [
        ("heard", "heard “bring me the <mug>”"),
        ("note", "said “here I come”"),
        ("failed", "base: BLOCKED"),
    ]


def test_a_mission_that_was_stopped_and_gone_on_with_is_one_mission() -> None:
    def row(t: float, name: Any, mission: str = "", last: m.MissionOutcome | None = None) -> Row:
        state = m.BrainState(state=name, mission_id=mission, command="go" if mission else "", started=5.0, last=last)
        return Row(topics.BRAIN_STATE.key, codec.encode(topics.BRAIN_STATE, state), t, 1000.0 + t)

    cut = m.MissionOutcome(id="m-1", command="go", outcome="cancelled", reason="stopped")
    done = m.MissionOutcome(id="m-1", command="go", outcome="delivered")
    rows = [row(5, "NAVIGATING", "m-1"), row(8, "IDLE", last=cut)]
    (stopped,) = recorded.missions(rows)
    assert (stopped["outcome"], stopped["reason"], stopped["ended"]) == ("cancelled", "stopped", 8.0)
    rows.append(row(20, "NAVIGATING", "m-1", cut))
    (going,) = recorded.missions(rows)
    assert (going["outcome"], going["reason"]) == (None, "")
    rows += [row(30, "COMPLETED", "m-1", done), row(31, "WAITING", last=done)]
    (record,) = recorded.missions(rows)
    assert (record["outcome"], record["ended"]) == ("delivered", 30.0)
    bands = spans(record["entries"], 5.0, 30.0)
    assert bands[:3] == [("NAVIGATING", 0.0, 3.0), ("IDLE", 3.0, 15.0), ("NAVIGATING", 15.0, 25.0)]
    # A recording that begins afterwards knows of it what comes then.
    assert [r["outcome"] for r in recorded.missions(rows[2:])] == ["delivered"]
    assert recorded.missions(rows[3:]) == []


def test_bands_cover_the_mission_without_gaps(recording: Recording) -> None:
    record = recorded.missions(recording.rows)[0]
    bands = spans(record["entries"], 5.0, 20.0)
    assert [b[0] for b in bands] == ["PLANNING", "NAVIGATING", "ERROR"][: len(bands)]
    assert bands[0][1] == 0.0 and bands[-1][2] == 15.0
    assert all(a[2] == b[1] for a, b in itertools.pairwise(bands))


def test_the_timeline_escapes_words_and_loads_nothing(recording: Recording) -> None:
    page = timeline.page(recorded.missions(recording.rows)[0])
    assert "<mug>" not in page and "&lt;mug&gt;" in page
    assert "base: BLOCKED" in page
    assert all(link.startswith("data:") for link in re.findall(r'(?:src|href)="([^"]*)"', page))


@pytest.mark.parametrize(
    "entries", [[], [{"t": 5.0, "state": "PLANNING", "cause": "", "evidence": "", "kind": "state"}]]
)
def test_a_mission_that_just_began_has_a_timeline(entries: list[Any]) -> None:
    record = {
        "id": "x", "command": "go", "started": 5.0, "outcome": None, "reason": "", "ended": 0.0, "steps": 0,
        "entries": entries,
    }  # fmt: skip
    assert "under way" in timeline.page(record)


def test_a_mission_is_cut_out_with_what_was_known_before(recording: Recording, tmp_path: Path) -> None:
    target = tmp_path / "one.mcap"
    mission_export.export(recording.path, target, "m-1")
    cut = Recording(target)
    assert not cut.torn
    assert cut.facts["run"]["scene"] == "minimal"
    assert len(cut.of(topics.SIM_MODEL.key)) == 1
    moves = [row.t for row in cut.of(topics.JOINT_STATES.key)]
    assert moves[0] >= 3.0 and moves[-1] <= 24.1
    assert [r["id"] for r in recorded.missions(cut.rows)] == ["m-1"]
    assert any(row.key == "service/sim/alive" for row in cut.rows)


def test_what_cannot_be_exported_is_said(recording: Recording, tmp_path: Path) -> None:
    with pytest.raises(CliError, match="m-1, m-2"):
        mission_export.export(recording.path, tmp_path / "x.mcap", "m-3")
    with pytest.raises(CliError, match="what kind of file"):
        mission_export.export(recording.path, tmp_path / "x.mp4", "last")
    with pytest.raises(CliError, match="itself"):
        mission_export.export(recording.path, recording.path, "m-1")


def test_a_timeline_from_a_recording_has_key_frames(
    recording: Recording, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(key_frames, "SIZE", (32, 24))
    target = tmp_path / "one.html"
    mission_export.export(recording.path, target, "m-1")
    page = target.read_text()
    assert page.count("data:image/jpeg;base64,") == 4, "two states end, a fault, the outcome"
    assert "PLANNING ends" in page and "base: BLOCKED" in page
    monkeypatch.setattr(key_frames, "MOST", 2)
    frames = key_frames.key_frames(recording, recorded.missions(recording.rows)[0])
    assert len(frames) == 2
    assert frames[-1][1] == "failed", "how it ended is always shown"
