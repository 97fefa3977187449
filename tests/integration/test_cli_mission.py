"""`say`, `status`, `missions`, `transcribe` and `demo` with the whole robot."""

import json
import signal
import subprocess
import sys
from pathlib import Path

import pytest

from evaluation.site import eventually
from tests.integration.test_cli_up import Run, read_until, run
from tests.support import ROOT

pytestmark = pytest.mark.long

VOICE = "docs/audio/bring_me_the_red_mug.wav"

__all__ = ["run"]


@pytest.mark.slow
@pytest.mark.timeout(400)
def test_commands_by_text_and_by_recording_end_as_physics_says(run: Run, tmp_path: Path) -> None:
    # At this speed the robot's patience with an answer would end while the next command starts.
    patient = ("--set", "brain.answer_timeout=600")
    done = run.detached("--without", "dashboard", "--speed", "max", "--seed", "1", *patient)
    assert done.returncode == 0, done.stderr
    waiting = run.command("status", "--wait", "WAITING", "--timeout", "30", "--json")
    assert waiting.returncode == 0 and json.loads(waiting.stdout)["mission"] is None
    # What is no command starts nothing that succeeds.
    refused = run.command("say", "--json", "--wait", "paint the wall green", timeout=120)
    assert refused.returncode == 1
    assert json.loads(refused.stdout).get("outcome") != "delivered"
    # Two broken recordings are refused before the robot hears of them.
    (tmp_path / "empty.wav").write_bytes(b"")
    whole = (ROOT / VOICE).read_bytes()
    (tmp_path / "short.wav").write_bytes(whole[: len(whole) // 2])
    for name in ("empty.wav", "short.wav"):
        broken = run.command("say", "--wav", str(tmp_path / name))
        assert broken.returncode == 1 and name in broken.stderr and "Traceback" not in broken.stderr
    assert run.command("status", "--wait", "WAITING", "--timeout", "60").returncode == 0
    heard = run.command("say", "--wav", VOICE, "--json", timeout=120)
    assert heard.returncode == 0 and json.loads(heard.stdout)["accepted"], heard
    assert run.command("status", "--wait", "CONFIRMING", "--timeout", "30").returncode == 0
    answered = run.command("say", "yes", "--wait", "--json", timeout=300)
    record = json.loads(answered.stdout)
    assert answered.returncode == 0, answered
    assert record["accepted"] and record["mission_id"] and record["outcome"] == "delivered"
    truth = json.loads(run.command("status", "--json").stdout)
    assert truth["last"]["id"] == record["mission_id"] and "red mug" in truth["last"]["command"]
    listed = json.loads(run.command("missions", "--json").stdout)
    assert listed[-1]["id"] == record["mission_id"] and listed[-1]["outcome"] == "delivered"
    # While it fetches, a second command is refused with the reason.
    assert run.command("say", "bring me the green can").returncode == 0
    again = run.command("say", "bring me the blue mug")
    if again.returncode:
        assert "busy" in again.stdout
    run.command("down")
    assert run.processes() == []


@pytest.mark.slow
def test_transcribe_reads_good_files_and_names_bad_ones(run: Run, tmp_path: Path) -> None:
    bad = tmp_path / "bad.wav"
    bad.write_text("no sound")
    done = run.command("transcribe", "--json", VOICE, str(bad))
    rows = [json.loads(x) for x in done.stdout.splitlines()]
    assert done.returncode == 1 and "bad.wav" in done.stderr and "Traceback" not in done.stderr
    assert rows[0]["file"] == VOICE and rows[0]["accepted"] and "red mug" in rows[0]["text"]
    assert set(rows[0]) >= {"file", "text", "accepted", "confidence", "wake"}


@pytest.mark.slow
@pytest.mark.timeout(400)
@pytest.mark.parametrize("scene", ["minimal", "apartment"])
def test_the_demo_delivers_and_leaves_nothing_behind(run: Run, tmp_path: Path, scene: str) -> None:
    # At the greatest speed a busy machine lets minutes of robot time pass before the answer to its question is played.
    done = run.command("demo", "--scene", scene, "--speed", "3", "--out", str(tmp_path / "demo.png"), timeout=360)
    assert done.returncode == 0, done.stdout + done.stderr
    for word in (
        "CONFIRMING",
        "PLANNING",
        "GROUNDING",
        "NAVIGATING",
        "GRABBING",
        "RETURNING",
        "RELEASING",
        "DELIVERED",
    ):
        assert word in done.stdout
    assert "picture: " in done.stdout and "no picture: " not in done.stdout, done.stdout
    assert (tmp_path / "demo.png").stat().st_size > 5000
    assert run.processes() == []
    assert not list(run.directory.glob("demo-*"))


@pytest.mark.slow
def test_a_demo_that_runs_out_of_time_says_so_and_leaves_nothing(run: Run) -> None:
    words = ("demo", "--without", "camera", "--typed", "--timeout", "1")
    done = run.command(*words, timeout=120)
    assert done.returncode == 1
    assert "NOT DELIVERED: no outcome after 1 s" in done.stdout
    assert run.processes() == []


@pytest.mark.slow
def test_an_interrupted_demo_leaves_nothing(run: Run) -> None:
    line = [sys.executable, "-m", "cli.main", "demo", "--without", "camera", "--typed"]
    demo = subprocess.Popen(
        line, env=run.environ, cwd=ROOT, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True
    )
    run.opened.append(demo)
    read_until(demo, "GROUNDING")
    demo.send_signal(signal.SIGTERM)
    assert demo.wait(30) != 0
    eventually(lambda: not run.processes(), "every process has ended")
