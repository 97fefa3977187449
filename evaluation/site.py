"""Real processes for tests and benchmarks: a router on a free port, services in a fresh namespace."""

import os
import socket
import subprocess
import sys
import time
import uuid
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from functools import partial
from pathlib import Path
from typing import TypeVar

import zenoh

from cli.processes.ports import free_port
from common import topics
from common.bus.session import open_session

T = TypeVar("T")
ROOT = Path(__file__).resolve().parent.parent
PATIENCE = 40.0
"""Time [s] for what is waited for; chosen: a service starts in a tenth of it on an idle machine."""


def eventually(probe: Callable[[], T], what: str, patience: float = PATIENCE) -> T:
    """Call `probe` until its value is truthy and return that; AssertionError after `patience` seconds."""
    end = time.monotonic() + patience
    while True:
        value = probe()
        if value:
            return value
        if time.monotonic() > end:
            raise AssertionError(f"did not happen within {patience:.0f} s: {what}")
        time.sleep(0.02)


class Site:
    """A router of our own and a namespace nobody else uses; processes started here are ended with it."""

    def __init__(self, log_dir: Path) -> None:
        self.namespace = f"test-{uuid.uuid4().hex[:8]}"
        self.port = free_port()
        self.connect = f"tcp/127.0.0.1:{self.port}"
        self.log_dir = log_dir
        self.processes: list[subprocess.Popen[bytes]] = []

    def environment(self, **extra: str) -> dict[str, str]:
        clean = {k: v for k, v in os.environ.items() if not k.startswith("TIDYBOT")}
        return {
            **clean,
            "PYTHONPATH": str(ROOT),
            "OMP_NUM_THREADS": "1",
            "TIDYBOT_STATE_DIR": str(self.log_dir / "state"),
            "TIDYBOT_CONNECT": self.connect,
            "TIDYBOT_NAMESPACE": self.namespace,
            "TIDYBOT_KEYS": "off",
            **extra,
        }

    def start(self, module: str, *args: str, **extra: str) -> "subprocess.Popen[bytes]":
        """`python -m module args`; its output goes to a file named after the module."""
        log = (self.log_dir / f"{module}.log").open("ab")
        process = subprocess.Popen(
            [sys.executable, "-m", module, *args],
            env=self.environment(**extra),
            stdout=log,
            stderr=subprocess.STDOUT,
            cwd=ROOT,
        )
        log.close()
        self.processes.append(process)
        return process

    def log(self, module: str) -> str:
        return (self.log_dir / f"{module}.log").read_text(errors="replace")

    def start_router(self) -> "subprocess.Popen[bytes]":
        router = self.start("services.router", "--listen", self.connect)
        eventually(self.listening, "the router listens")
        return router

    def listening(self) -> bool:
        with socket.socket() as probe:
            return probe.connect_ex(("127.0.0.1", self.port)) == 0

    @contextmanager
    def session(self) -> Iterator[zenoh.Session]:
        with open_session(self.connect, self.namespace) as opened:
            yield opened

    def wait_alive(self, opened: zenoh.Session, *names: str) -> None:
        for name in names:
            alive = topics.ALIVE_KEY.format(name=name)
            eventually(partial(_replies, opened, alive), f"{name} is alive")

    def close(self) -> None:
        end(self.processes)


def _replies(opened: zenoh.Session, key: str) -> list[zenoh.Reply]:
    return list(opened.liveliness().get(key, timeout=1.0))


def end(processes: "Iterable[subprocess.Popen[bytes]]") -> None:
    """End processes by SIGTERM, and those that do not go by SIGKILL."""
    running = [process for process in processes if process.poll() is None]
    for process in running:
        process.terminate()
    for process in running:
        try:
            process.wait(10)
        except subprocess.TimeoutExpired:
            process.kill()
            process.wait()


@contextmanager
def site(log_dir: Path) -> Iterator[Site]:
    """A `Site` with its router running."""
    opened = Site(log_dir)
    try:
        opened.start_router()
        yield opened
    finally:
        opened.close()
