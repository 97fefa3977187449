"""A robot of processes that can be killed one by one or, as by a power cut, all at once."""

import os
import signal
import subprocess
import sys
import uuid
from contextlib import suppress
from pathlib import Path

import psutil  # type: ignore[import-untyped]

from cli.processes.own_robot import own_robot
from cli.processes.plan import Plan
from cli.processes.supervision import Supervision
from cli.processes.up import bring_up
from common.files.plan_file import to_toml
from common.installation import ROOT
from common.scene import Scene
from evaluation.suites.unknown import nothing_listed

RECORDED = 60
"""Newest part [MB] of everything on the bus that is kept."""


class Robot:
    """The robot of the day; its processes come and go, its directory and simulated world stay."""

    def __init__(self, directory: Path, world: Scene, home: Scene, seed: int, speed: str) -> None:
        self.directory = directory
        self.files = {"world": directory / "world.toml", "household": directory / "household.toml"}
        self.files["world"].write_text(to_toml(world), encoding="utf-8")
        self.files["household"].write_text(to_toml(nothing_listed(home)), encoding="utf-8")
        self.supervision = Supervision(directory / "run")
        self._options = own_robot(
            "day",
            speed=speed,
            seed=seed,
            without="dashboard",
            settings=[f"sim.run=world-{uuid.uuid4().hex}"],
            **{name: str(path) for name, path in self.files.items()},
        )
        self._recording: subprocess.Popen[bytes] | None = None
        self.connect = ""
        os.environ["TIDYBOT_STATE_DIR"] = str(directory / "state")

    def up(self) -> None:
        """Switch everything on; the simulated world goes on where it was."""
        plan = Plan(self._options)
        self.connect, self.namespace = plan.connect, plan.namespace
        bring_up(self.supervision, plan, lambda text: None)
        tape = self.directory / "recordings" / f"day-{uuid.uuid4().hex[:4]}.mcap"
        record = [sys.executable, "-m", "cli.main", "record", "-o", str(tape), "--keep", str(RECORDED), "--wait", "0"]
        quiet = subprocess.DEVNULL
        self._recording = subprocess.Popen(record, cwd=ROOT, env=plan.environ, stdout=quiet, stderr=quiet)

    def down(self) -> None:
        """Switch everything off."""
        if self._recording is not None:
            self._recording.terminate()
            self._recording.wait()
        self.supervision.stop()

    def kill(self, name: str) -> None:
        os.kill(self.supervision.running()[name], signal.SIGKILL)

    def power_cut(self) -> None:
        """Kill every process at once, as when the power goes."""
        if self._recording is not None:
            self._recording.kill()
            self._recording.wait()
        pids = [*self.supervision.running().values(), self.supervision.pid()]
        for pid in pids:
            if pid is not None:
                os.kill(pid, signal.SIGKILL)
        if self.supervision.process is not None:
            self.supervision.process.wait()
        self.supervision = Supervision(self.supervision.directory)
        self.supervision.stop()

    def memory(self) -> dict[str, float]:
        found = {}
        for name, pid in self.supervision.running().items():
            try:
                found[name] = psutil.Process(pid).memory_info().rss / 1e6
            except psutil.NoSuchProcess:
                continue
        return found

    def disk(self) -> float:
        """Size of all files [MB]."""
        found = 0
        for path in self.directory.rglob("*"):
            # Logs and recordings rotate, journals are swapped meanwhile.
            with suppress(FileNotFoundError):
                found += path.stat().st_size if path.is_file() else 0
        return found / 1e6
