"""`tidybot up` and the commands around it, with real processes: alive, watched, restarted, ended, no orphan ever."""

import json
import os
import signal
import socket
import subprocess
import sys
import uuid
from collections.abc import Iterator
from pathlib import Path

import psutil
import pytest

from cli.processes.ports import free_port
from evaluation.site import eventually
from tests.support import ROOT

pytestmark = pytest.mark.long


class Run:
    """`tidybot` commands on a run directory and a port of their own."""

    def __init__(self, directory: Path) -> None:
        self.directory = directory
        self.port = free_port()
        self.mark = uuid.uuid4().hex
        self.opened: list[subprocess.Popen[str]] = []
        clean = {k: v for k, v in os.environ.items() if not k.startswith("TIDYBOT")}
        self.environ = {
            **clean,
            "PYTHONPATH": str(ROOT),
            "TIDYBOT_RUN_DIR": str(directory),
            # Marks every process of this run, however it was started.
            "TIDYBOT_TEST_MARK": self.mark,
        }

    def command(self, *words: str, timeout: float = 60) -> "subprocess.CompletedProcess[str]":
        line = [sys.executable, "-m", "cli.main", *words]
        return subprocess.run(line, env=self.environ, cwd=ROOT, capture_output=True, text=True, timeout=timeout)

    def up(self, *words: str) -> "subprocess.Popen[str]":
        line = [sys.executable, "-m", "cli.main", "up", "--port", str(self.port), *words]
        process = subprocess.Popen(
            line, env=self.environ, cwd=ROOT, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True
        )
        self.opened.append(process)
        return process

    def detached(self, *words: str) -> "subprocess.CompletedProcess[str]":
        return self.command("up", "--detach", "--port", str(self.port), *words)

    def processes(self) -> list[psutil.Process]:
        """Everything that carries the mark and still runs."""
        found = []
        for process in psutil.process_iter():
            try:
                if process.environ().get("TIDYBOT_TEST_MARK") == self.mark and process.status() != "zombie":
                    found.append(process)
            except psutil.Error:
                continue
        return found

    def rows(self) -> dict[str, dict[str, object]]:
        done = self.command("ps", "--json")
        assert done.returncode == 0, done.stderr
        return {row["name"]: row for row in json.loads(done.stdout)}

    def close(self) -> None:
        for process in self.processes():
            process.kill()
        for opened in self.opened:
            opened.wait()
            assert opened.stdout is not None
            opened.stdout.close()


@pytest.fixture
def run(tmp_path: Path) -> Iterator[Run]:
    opened = Run(tmp_path / "run")
    try:
        yield opened
    finally:
        opened.close()


def read_until(process: "subprocess.Popen[str]", word: str) -> str:
    """Output up to the line with `word`; fails when the process ends before."""
    said = ""
    assert process.stdout is not None
    for line in process.stdout:
        said += line
        if word in line:
            return said
    raise AssertionError(f"ended with {process.wait()} before saying {word!r}:\n{said}")


def test_up_shows_each_service_and_ctrl_c_leaves_nothing(run: Run) -> None:
    up = run.up("--only", "router,sim,brain")
    said = read_until(up, "Ctrl-C")
    assert "ready in" in said
    assert {"router", "sim", "brain"} <= set(said.split())
    rows = run.rows()
    assert list(rows) == ["router", "sim", "brain"]
    for row in rows.values():
        assert row["state"] == "running" and row["alive"] and row["restarts"] == 0 and row["rss_mb"], row
    assert rows["sim"]["epoch"] and rows["brain"]["epoch"]
    up.send_signal(signal.SIGINT)
    assert up.wait(30) == 0
    assert run.processes() == []
    assert run.command("ps").returncode == 1


@pytest.mark.parametrize("victim", ["up", pytest.param("supervisord", marks=pytest.mark.slow)])
def test_kill_9_of_either_leaves_no_orphan(run: Run, victim: str) -> None:
    up = run.up("--only", "router,sim")
    read_until(up, "Ctrl-C")
    assert len(run.processes()) == 5  # up, the supervisor, its watchdog and two services
    if victim == "up":
        up.kill()
    else:
        os.kill(int((run.directory / "supervisord.pid").read_text()), signal.SIGKILL)
    eventually(lambda: not run.processes(), "every process has ended")
    assert up.wait(30) != 0


@pytest.mark.slow
def test_a_detached_run_is_commanded_by_the_other_commands(run: Run) -> None:
    assert run.detached("--only", "router,sim,brain").returncode == 0
    before = run.rows()
    # The others find the port by themselves.
    state = json.loads(run.command("status", "--json").stdout)
    assert state["state"] == "IDLE" and state["mission"] is None and state["last"] is None
    assert run.command("topic", "echo", "base/odom", "-n", "1").stdout.startswith("base/odom  {")
    assert run.command("watch", "--once", "--tree").stdout.count("\n") > 3
    assert "stopped" in run.command("stop").stdout
    assert "running" in run.command("resume").stdout
    again = run.detached()
    assert again.returncode == 1 and "already up" in again.stderr
    # A killed service comes back; a restarted one too, and both are counted.
    os.kill(int(str(before["brain"]["pid"])), signal.SIGKILL)
    eventually(lambda: run.rows()["brain"]["restarts"] == 1 and run.rows()["brain"]["alive"], "the brain is back")
    done = run.command("restart", "sim")
    assert done.returncode == 0, done.stderr
    after = run.rows()
    assert after["sim"]["restarts"] == 1 and after["sim"]["epoch"] != before["sim"]["epoch"]
    assert "started" in run.command("logs", "sim", "-n", "50").stdout
    wrong = run.command("restart", "brian")
    assert wrong.returncode == 1 and "'brain'" in wrong.stderr
    assert run.command("down").returncode == 0
    assert run.processes() == []


@pytest.mark.slow
def test_a_frozen_service_is_ended_and_started_anew(run: Run) -> None:
    assert run.detached("--only", "router,sim,brain").returncode == 0
    for name in ("brain", "router"):
        before = run.rows()[name]
        os.kill(int(str(before["pid"])), signal.SIGSTOP)
        eventually(lambda name=name: run.rows()[name]["restarts"] == 1 and run.rows()[name]["alive"], f"{name} is back")  # type: ignore[misc]
        assert run.rows()[name]["pid"] != before["pid"]
    assert "is ended" in (run.directory / "logs" / "watchdog.log").read_text()
    run.command("down")
    assert run.processes() == []


def test_a_killed_simulation_goes_on_with_its_world(run: Run) -> None:
    assert run.detached("--only", "router,sim", "--scene", "minimal").returncode == 0
    moved = run.command("topic", "pub", "base/target_pose", '{"x": 0.15, "y": 0.0, "theta": 0.0, "id": "t"}')
    assert moved.returncode == 0, moved.stderr

    def x() -> float:
        told = run.command("topic", "echo", "base/odom", "-n", "1").stdout.partition("{")[2]
        return float(json.loads("{" + told)["x"]) if told else 0.0

    eventually(lambda: x() > 0.1, "the base has moved")
    before = run.rows()["sim"]
    eventually(lambda: (run.directory / "sim.checkpoint").exists(), "the world is on disk")
    os.kill(int(str(before["pid"])), signal.SIGKILL)
    eventually(lambda: run.rows()["sim"]["restarts"] == 1 and run.rows()["sim"]["alive"], "the simulation is back")
    assert x() > 0.05
    assert run.command("restart", "sim", "--fresh").returncode == 0
    eventually(lambda: abs(x()) < 0.05, "the world began anew")
    run.command("down")


def test_a_busy_port_is_said_before_anything_starts(run: Run) -> None:
    with socket.socket() as other:
        other.bind(("127.0.0.1", run.port))
        other.listen()
        done = run.detached("--only", "router,sim")
    assert done.returncode == 1
    assert f"port {run.port} is in use" in done.stderr and "--port" in done.stderr
    assert "Traceback" not in done.stderr
    assert not (run.directory / "supervisord.conf").exists()


def test_a_bad_configuration_ends_up_at_once_with_the_reason(run: Run) -> None:
    done = run.detached("--only", "router,brain", "--set", "brain.setle=1")
    assert done.returncode == 1
    assert "brain failed" in done.stderr and "unknown key 'setle'" in done.stderr
    assert run.processes() == []


@pytest.mark.slow
def test_a_crash_loop_ends_as_failed(run: Run) -> None:
    assert run.detached("--only", "router,brain").returncode == 0

    def crash() -> bool:
        row = run.rows()["brain"]
        if row["state"] == "failed":
            return True
        if row["pid"]:
            os.kill(int(str(row["pid"])), signal.SIGKILL)
        return False

    eventually(crash, "the supervisor gives up", 60)
    assert run.rows()["router"]["state"] == "running"
    # A person may try again.
    assert run.command("restart", "brain").returncode == 0
    assert run.rows()["brain"]["state"] == "running"
    run.command("down")
