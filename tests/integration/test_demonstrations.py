"""`tidybot record --lerobot` beside a whole robot: a mission that was delivered is an episode, others are not."""

import io
import json
import signal
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from tests.integration.test_cli_up import Run, read_until, run
from tests.support import ROOT

pq = pytest.importorskip("pyarrow.parquet")
__all__ = ["run"]


@pytest.mark.slow
@pytest.mark.timeout(800)
def test_missions_become_episodes(run: Run, tmp_path: Path) -> None:
    done = run.detached("--without", "dashboard", "--speed", "max", "--seed", "1", "--scene", "minimal")
    assert done.returncode == 0, done.stderr
    root = tmp_path / "set"
    line = [sys.executable, "-m", "cli.main", "record", "--lerobot", str(root), "--fps", "10"]
    recorder = subprocess.Popen(
        line, env=run.environ, cwd=ROOT, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True
    )
    run.opened.append(recorder)
    read_until(recorder, "Ctrl-C ends it")
    assert run.command("status", "--wait", "WAITING", "--timeout", "60").returncode == 0
    assert run.command("say", "--wait", "bring me the unicorn", timeout=300).returncode == 1
    read_until(recorder, "left out, failed: 'bring me the unicorn'")
    assert run.command("say", "--wait", "bring me the red mug", timeout=300).returncode == 0
    read_until(recorder, "episode 0, delivered: 'bring me the red mug'")
    recorder.send_signal(signal.SIGINT)
    assert recorder.wait(20) == 0
    info = json.loads((root / "meta" / "info.json").read_text())
    assert (info["total_episodes"], info["total_tasks"]) == (1, 1)
    table = pq.read_table(root / "data" / "chunk-000" / "file-000.parquet")
    state, action = (np.array(table.column(name).to_pylist()) for name in ("observation.state", "action"))
    assert len(state) == info["total_frames"] > 100
    names = info["features"]["observation.state"]["names"]
    moved = state.max(axis=0) - state.min(axis=0)
    assert moved[names.index("base_x")] > 0.3 and moved[names.index("gripper")] > 0.005
    assert action[:, -1].min() < 0.7 and action[:, -1].max() == 1.0, "the hand was opened and closed"
    assert np.abs(action[:, 3:10] - state[:, 3:10]).max() < 1.0
    table_of = table.column("observation.images.head").to_pylist()
    pictures = {bytes(row["bytes"]) for row in table_of}
    assert len(pictures) > 20, "the camera's view changed with the robot"
    assert np.asarray(Image.open(io.BytesIO(table_of[0]["bytes"]))).std() > 5


def test_what_cannot_be_is_said_before_anything_is_recorded(run: Run, tmp_path: Path) -> None:
    (tmp_path / "taken").mkdir()
    (tmp_path / "taken" / "file").touch()
    for words, why in (
        (("--lerobot", "x", "-o", "y.mcap"), "two recordings"),
        (("--lerobot", "x", "--fps", "0"), "expected 1 to 50"),
        (("--lerobot", "x", "--cameras", "left"), "expected head or wrist"),
        (("--lerobot", "x", "--connect", f"tcp/127.0.0.1:{run.port}", "--wait", "1"), "nothing answers"),
    ):
        done = run.command("record", *words)
        assert done.returncode in (1, 2) and why in done.stderr, done
        assert "Traceback" not in done.stderr
