"""A run of the robot's processes under supervisord: its directory, configuration, start, control and end."""

import contextlib
import os
import signal
import subprocess
import sys
import tempfile
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import msgspec

from cli.errors import CliError
from cli.processes.programs import ROUTER_SOCKET, WATCHDOG, endpoints, environment_of, render_config, socket_path
from cli.processes.services import Service
from common.config import PREFIX
from common.installation import ROOT, workspace
from common.process import supervisor
from common.process.host import stat_of
from common.time import clock

STATES = {
    "RUNNING": "running",
    "STARTING": "starting",
    "BACKOFF": "starting",
    "FATAL": "failed",
    "STOPPED": "stopped",
    "STOPPING": "stopped",
    "EXITED": "stopped",
    "UNKNOWN": "failed",
}
WORLD = "sim.checkpoint"
ENDING = 15.0
"""Time [s] that a run has to end before it is killed; chosen: each of its processes has six."""


class RunInfo(msgspec.Struct):
    """What other commands need to know of a run; `run.json` in its directory."""

    connect: str
    namespace: str
    speed: str
    services: list[str]
    started: float
    keys: str = ""
    settings: dict[str, str] = {}


class ProcessState(msgspec.Struct):
    name: str
    pid: int
    state: str
    restarts: int
    detail: str = ""


def run_dir(environ: Mapping[str, str] = os.environ) -> Path:
    """Where a run keeps its socket and logs: TIDYBOT_RUN_DIR, or `run/` in the checkout, or one of the user's own."""
    if environ.get("TIDYBOT_RUN_DIR"):
        return Path(environ["TIDYBOT_RUN_DIR"]).resolve()
    if (ours := workspace()) is not None:
        return ours / "run"
    return Path(environ.get("XDG_RUNTIME_DIR") or tempfile.gettempdir()) / f"tidybot-{os.getuid()}"


def settings_of_run() -> dict[str, str]:
    """The overrides that services run with: those of the run that is up, before those of this process."""
    try:
        given = Supervision(run_dir()).info().settings
    except CliError:
        given = {}
    return {k: v for k, v in {**os.environ, **given}.items() if k.startswith(PREFIX)}


class Supervision:
    """One run directory and, when it is up, the supervisord in it."""

    def __init__(self, directory: Path) -> None:
        self.directory = directory
        self.process: subprocess.Popen[bytes] | None = None

    # --- start and end
    def start(
        self, services: Sequence[Service], connect: str, environ: Mapping[str, str], info: RunInfo, detach: bool
    ) -> None:
        """Start supervisord with these services; in the foreground it ends when this process does."""
        logs = self.directory / "logs"
        logs.mkdir(parents=True, exist_ok=True)
        for name in ("supervisord", WATCHDOG, *(s.name for s in services)):
            (logs / f"{name}.log").unlink(missing_ok=True)
        config = self.directory / "supervisord.conf"
        config.write_text(render_config(self.directory, services, connect), encoding="utf-8")
        (self.directory / "run.json").write_bytes(msgspec.json.encode(info))
        environment = environment_of(environ)
        if not detach:
            environment["TIDYBOT_FOREGROUND_PARENT"] = str(os.getpid())
        environment["TIDYBOT_RUN_DIR"] = str(self.directory)
        environment["TIDYBOT_CONNECT"] = endpoints(self.directory, services, connect)
        environment["TIDYBOT__DASHBOARD__SUPERVISOR"] = str(socket_path(self.directory))
        with (logs / "supervisord.err").open("wb") as errors:
            self.process = subprocess.Popen(
                [sys.executable, "-m", "cli.processes.supervisord", "-c", str(config)],
                cwd=ROOT,
                env=environment,
                stdin=subprocess.DEVNULL,
                stdout=errors,
                stderr=errors,
                start_new_session=True,
            )

    def died(self) -> str:
        """Why our supervisord ended, "" while it runs."""
        if self.process is None or self.process.poll() is None:
            return ""
        with contextlib.suppress(OSError):
            text = (self.directory / "logs" / "supervisord.err").read_text(errors="replace").strip()
            return text.splitlines()[-1] if text else f"supervisord ended with {self.process.returncode}"
        return "supervisord ended"

    def stop(self) -> bool:
        """End every process of the run; False when there was none."""
        pid = self.pid()
        with contextlib.suppress(CliError):
            self.call("supervisor.shutdown")
        if pid is None and self.process is not None and self.process.poll() is None:
            pid = self.process.pid
        if pid is None:
            self._forget()
            return False
        end = clock.monotonic() + ENDING
        while self._runs(pid):
            if clock.monotonic() > end:
                # Its children follow it: they asked the kernel to.
                with contextlib.suppress(ProcessLookupError):
                    os.kill(pid, signal.SIGKILL)
                end = clock.monotonic() + ENDING
            clock.sleep(0.02)
        self._forget()
        return True

    def _runs(self, pid: int) -> bool:
        if self.process is not None and self.process.pid == pid:
            return self.process.poll() is None
        return _alive(pid)

    def _forget(self) -> None:
        for name in ("run.json", "supervisord.pid", ROUTER_SOCKET, f"{ROUTER_SOCKET}.lock"):
            (self.directory / name).unlink(missing_ok=True)
        socket_path(self.directory).unlink(missing_ok=True)

    # --- control
    def call(self, method: str, *args: Any) -> Any:
        """Call a method of supervisord over XML-RPC.

        Raises:
            CliError: nothing is up in this directory, or supervisord refuses.
        """
        try:
            return supervisor.call(socket_path(self.directory), method, *args)
        except supervisor.NoSupervisor:
            raise CliError("nothing is up; start with `tidybot up`") from None
        except supervisor.SupervisorRefused as refused:
            raise CliError(f"supervisord: {refused}; see {self.log_path('supervisord')}") from None

    def pid(self) -> int | None:
        """The process id of the supervisord that answers here, None when nobody does."""
        try:
            return int(self.call("supervisor.getPID"))
        except CliError:
            return None

    def processes(self) -> list[ProcessState]:
        """Every process of the run, in the order of the table.

        Raises:
            CliError: nothing is up.
        """
        starts, exits = self.call("tidybot.starts"), self.call("tidybot.exits")
        found = []
        for row in self.call("supervisor.getAllProcessInfo"):
            if row["name"] == WATCHDOG:
                continue
            name, state = row["name"], STATES.get(row["statename"], "failed")
            detail = ""
            if name in exits and state != "running":
                detail = f"ended by exit status {exits[name]}" if exits[name] >= 0 else "ended by a signal"
            restarts = max(0, starts.get(name, 0) - 1)
            found.append(ProcessState(name=name, pid=row["pid"], state=state, restarts=restarts, detail=detail))
        order = {name: i for i, name in enumerate(self.info().services)} if self.info() else {}
        return sorted(found, key=lambda p: order.get(p.name, 99))

    def running(self) -> dict[str, int]:
        """The process ids of those that run, by name.

        Raises:
            CliError: nothing is up.
        """
        return {p.name: p.pid for p in self.processes() if p.state == "running"}

    def restart(self, name: str, forget: Path | None = None) -> None:
        """Stop and start one process; between the two a file that it would go on from can be forgotten.

        Raises:
            CliError: no such process, or it does not start.
        """
        if name not in {p.name for p in self.processes()}:
            raise CliError(f"{name} is not part of this run")
        with contextlib.suppress(CliError):
            self.call("supervisor.stopProcess", name)
        if forget is not None:
            forget.unlink(missing_ok=True)
        self.call("supervisor.startProcess", name, False)

    def info(self) -> "RunInfo":
        """What `tidybot up` wrote down.

        Raises:
            CliError: nothing is up.
        """
        try:
            return msgspec.json.decode((self.directory / "run.json").read_bytes(), type=RunInfo)
        except (OSError, msgspec.DecodeError):
            raise CliError("nothing is up; start with `tidybot up`") from None

    # --- logs
    def log_path(self, name: str) -> Path:
        return self.directory / "logs" / f"{name}.log"

    def tail(self, name: str, lines: int = 8) -> list[str]:
        """The last lines that a process wrote."""
        try:
            return self.log_path(name).read_text(errors="replace").splitlines()[-lines:]
        except OSError:
            return []


def _alive(pid: int) -> bool:
    return stat_of(pid)[:1] not in ([], ["Z"])
