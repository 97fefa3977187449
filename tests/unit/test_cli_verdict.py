"""The demonstration's judge: fed over a link, and the same that the evaluation has; and what benchmarks end with."""

import subprocess
import sys
from collections import defaultdict
from collections.abc import Callable
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest

from bench import speech
from cli.missions import verdict
from cli.missions.verdict import Witness
from common import messages as m
from common import topics
from common.bus import codec
from common.topic import Topic
from tests.simulation import Simulation

ROOT = Path(__file__).parents[2]


class FakeLink:
    """A link on which the test publishes."""

    def __init__(self) -> None:
        self.session = self
        self._takers: dict[str, list[Callable[[Any], None]]] = defaultdict(list)

    def declare_subscriber(self, key: str, take: Callable[[Any], None]) -> None:
        self._takers[key].append(take)

    def latest(self, topic: Topic[Any]) -> None:
        return None

    def put(self, topic: Topic[Any], message: m.Message) -> None:
        sample = SimpleNamespace(payload=SimpleNamespace(to_bytes=lambda: codec.encode(topic, message)))
        for take in self._takers[topic.key]:
            take(sample)


def told(*said: tuple[Topic[Any], m.Message], seconds: float = verdict.WATCH + 1.0) -> verdict.Verdict:
    """The verdict over a world in which nothing happens, while this is said."""
    simulation, link = Simulation("minimal", 0), FakeLink()
    witness = Witness(link, simulation.io.world, "yellow block")  # type: ignore[arg-type]
    link.put(topics.SIM_MODEL, simulation.last(topics.SIM_MODEL))
    simulation.step(0.05)
    state = simulation.last(topics.SIM_STATE)
    link.put(topics.SIM_STATE, state)
    witness.begin()
    for topic, message in said:
        link.put(topic, message)
    witness.look()
    for _ in range(round(seconds)):
        state.t += 1.0
        link.put(topics.SIM_STATE, state)
    return witness.judge()


def test_a_mission_that_did_nothing_is_not_delivered_whatever_is_said() -> None:
    silent = told()
    assert not silent.delivered and silent.why.startswith("yellow block: never lifted by the gripper; on ")
    assert "false claim" not in silent.why
    completed = m.BrainState(state="COMPLETED", mission_id="m-1", command="bring")
    aloud = m.SpeechStatus(state="speaking", detail="Done.")
    status = m.SystemStatus(state="SUCCESS", mission_id="m-1")
    for words in ((topics.BRAIN_STATE, completed), (topics.SPEECH_STATUS, aloud), (topics.SYSTEM_STATUS, status)):
        assert told(words).why.endswith("; 1 false claim"), words


def test_a_collision_that_the_simulation_logs_is_an_objection() -> None:
    touch = m.Touch(id=0, part="base", thing="sofa", kind="furniture", first=1.0, last=1.1, force=400.0)
    logged = m.SimContacts(t=1.1, epoch="e", touches=[touch])
    assert "hit: base on sofa: 400 N" in told((topics.SIM_CONTACTS, logged)).why


def test_a_simulation_that_falls_silent_proves_nothing(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(verdict, "PATIENCE", 0.3)
    assert "the simulation was silent" in told(seconds=3.0).why


# --- benchmarks
def test_without_recordings_bench_speech_ends_with_2_and_says_where_they_are_to_be_had(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(sys, "argv", ["bench.speech", "--corpus", str(tmp_path / "none")])
    assert speech.main() == 2
    said = capsys.readouterr().err
    assert str(tmp_path / "none") in said and "manifest.tsv" in said and "--corpus" in said


@pytest.mark.parametrize(("status", "ends"), [(0, 0), (1, 2)])
def test_make_bench_fails_when_a_benchmark_does(status: int, ends: int, tmp_path: Path) -> None:
    """Make's own status for a failed target is 2; the benchmarks after the failed one are run all the same."""
    python = tmp_path / "python"
    python.write_text(f'#!/bin/sh\necho "ran $2"\ntest "$2" != bench.one || exit {status}\n')
    python.chmod(0o755)
    words = ["make", "-o", "setup", "bench", f"BIN={tmp_path}", "BENCHES=one two"]
    done = subprocess.run(words, cwd=ROOT, capture_output=True, text=True, timeout=60)
    assert done.returncode == ends, done.stderr
    assert "ran bench.one" in done.stdout and "ran bench.two" in done.stdout
    assert ("failed: one" in done.stdout) == bool(status)
