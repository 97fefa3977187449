"""A mission cut out of a recording."""

from pathlib import Path
from typing import Any

import pytest

from cli.errors import CliError
from cli.recordings import export as mission_export
from common import messages as m
from common import topics
from common.bus import codec
from common.recording import Recorder, Recording
from common.time.lockstep import DT
from common.topic import Topic


def write(path: Path) -> Path:
    """30 s of a robot: a mission from 5 to 20 s, and another that is under way when the recording ends."""
    recorder = Recorder(path)

    def put(t: float, topic: Topic[Any], message: m.Message) -> None:
        recorder.write(topic.key, codec.encode(topic, message), t, 1000.0 + t, round(t / DT))

    def state(t: float, name: Any, mission: str = "", **more: Any) -> None:
        put(t, topics.BRAIN_STATE, m.BrainState(state=name, t=t, mission_id=mission, **more))

    recorder.note("run", {"scene": "minimal", "seed": "0"})
    put(0.0, topics.SIM_MODEL, m.SimModel(scene="minimal", seed=0, epoch="e", mjcf="<mujoco/>"))
    recorder.presence("sim", True, 0.0, 1000.0)
    for n in range(300):
        put(n / 10, topics.ODOMETRY, m.Odometry(t=n / 10, x=0.0, y=0.0, theta=0.0, vx=0.0, vy=0.0, omega=0.0))
    state(1.0, "WAITING")
    state(5.0, "PLANNING", "m-1", command="bring me the mug", started=5.0)
    state(8.0, "IDLE", last=m.MissionOutcome(id="m-1", command="bring me the mug", outcome="cancelled"))
    state(9.0, "NAVIGATING", "m-1", command="bring me the mug", started=5.0)
    last = m.MissionOutcome(id="m-1", command="bring me the mug", outcome="delivered", t=20.0)
    state(20.0, "COMPLETED", "m-1", command="bring me the mug", started=5.0, last=last)
    state(22.0, "WAITING", last=last)
    state(25.0, "PLANNING", "m-2", command="tidy up", started=25.0, last=last)
    recorder.close()
    return path


@pytest.fixture(scope="module")
def recording(tmp_path_factory: pytest.TempPathFactory) -> Recording:
    return Recording(write(tmp_path_factory.mktemp("tape") / "run.mcap"))


def test_missions_are_told_from_the_brains_state_alone(recording: Recording) -> None:
    first, second = mission_export.missions(recording).items()
    assert first == ("m-1", mission_export.Span("bring me the mug", 5.0, 22.0)), "stopped and gone on with: one"
    assert second == ("m-2", mission_export.Span("tidy up", 25.0, 29.9)), "under way when the recording ends"


def test_a_mission_is_cut_out_with_what_was_known_before(recording: Recording, tmp_path: Path) -> None:
    target = tmp_path / "one.mcap"
    mission_export.export(recording.path, target, "m-1")
    cut = Recording(target)
    assert not cut.torn
    assert cut.facts["run"]["scene"] == "minimal"
    assert len(cut.of(topics.SIM_MODEL.key)) == 1
    moves = [row.t for row in cut.of(topics.ODOMETRY.key)]
    assert moves[0] >= 3.0 and moves[-1] <= 24.1
    assert [*mission_export.missions(cut)] == ["m-1"]
    assert any(row.key == "service/sim/alive" for row in cut.rows)


def test_what_cannot_be_exported_is_said(recording: Recording, tmp_path: Path) -> None:
    with pytest.raises(CliError, match="m-1, m-2"):
        mission_export.export(recording.path, tmp_path / "x.mcap", "m-3")
    with pytest.raises(CliError, match="itself"):
        mission_export.export(recording.path, recording.path, "m-1")
