"""Machines in a test: network namespaces with a cable between them that can be cut."""

import itertools
import os
import shutil
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest

from evaluation.site import end
from tests.support import ROOT

_NUMBERS = itertools.count(os.getpid() % 200)


def needs_namespaces() -> None:
    """Skip, with what is missing, where network namespaces cannot be made."""
    if os.geteuid() != 0:
        pytest.skip("needs root: it makes network namespaces")
    if shutil.which("ip") is None:
        pytest.skip("needs the `ip` command (apt-get install iproute2)")
    probe = f"tidybot-probe-{os.getpid()}"
    made = subprocess.run(["ip", "netns", "add", probe], capture_output=True, text=True)
    if made.returncode != 0:
        pytest.skip(f"network namespaces cannot be made here: {made.stderr.strip()}")
    _ip("netns", "del", probe)


def _ip(*words: str) -> None:
    subprocess.run(["ip", *words], check=True, capture_output=True, text=True)


class Machine:
    """One network namespace; `address` is its end of the cable to the other machine."""

    def __init__(self, name: str, address: str, log_dir: Path) -> None:
        self.name, self.address, self.log_dir = name, address, log_dir
        self.processes: dict[str, subprocess.Popen[bytes]] = {}
        _ip("netns", "add", name)
        _ip("-n", name, "link", "set", "lo", "up")

    def start(self, module: str, *args: str, label: str = "", **environ: str) -> "subprocess.Popen[bytes]":
        """`python -m module args` on this machine; its output goes to a file named after the label."""
        label = label or module
        clean = {k: v for k, v in os.environ.items() if not k.startswith("TIDYBOT")}
        clean |= {"PYTHONPATH": str(ROOT), "OMP_NUM_THREADS": "1", **environ}
        with (self.log_dir / f"{self.name}.{label}.log").open("ab") as log:
            command = ["ip", "netns", "exec", self.name, sys.executable, "-m", module, *args]
            process = subprocess.Popen(command, env=clean, stdout=log, stderr=subprocess.STDOUT, cwd=ROOT)
        self.processes[label] = process
        return process

    def log(self, label: str) -> str:
        return (self.log_dir / f"{self.name}.{label}.log").read_text(errors="replace")

    def close(self) -> None:
        end(self.processes.values())
        _ip("netns", "del", self.name)


class Cable:
    """Joins two machines, or a machine with the one that the test runs on."""

    def __init__(self, one: Machine, other: Machine | None, first: str, second: str, number: int) -> None:
        self._one = one
        self.ends = (f"tb{number}a{first.split('.')[1]}", f"tb{number}b{first.split('.')[1]}")
        _ip("link", "add", self.ends[0], "type", "veth", "peer", "name", self.ends[1])
        self._plug(self.ends[0], one.name, first)
        self._plug(self.ends[1], other.name if other else "", second)

    def _plug(self, end: str, machine: str, address: str) -> None:
        inside = ["-n", machine] if machine else []
        if machine:
            _ip("link", "set", end, "netns", machine)
        _ip(*inside, "addr", "add", f"{address}/24", "dev", end)
        _ip(*inside, "link", "set", end, "up")

    def cut(self) -> None:
        _ip("-n", self._one.name, "link", "set", self.ends[0], "down")

    def heal(self) -> None:
        _ip("-n", self._one.name, "link", "set", self.ends[0], "up")


class Network:
    """Two machines, `one` and `two`, with a cable between them, and one that the test itself reaches `one` by."""

    def __init__(self, log_dir: Path) -> None:
        number = next(_NUMBERS)
        low, tag = number % 250, f"tidybot-{os.getpid()}-{number}"
        self.one = Machine(f"{tag}-one", f"10.77.{low}.1", log_dir)
        self.two = Machine(f"{tag}-two", f"10.77.{low}.2", log_dir)
        self.cable = Cable(self.one, self.two, self.one.address, self.two.address, number)
        self.door = f"10.78.{low}.1"
        self._outside = Cable(self.one, None, self.door, f"10.78.{low}.2", number)

    def close(self) -> None:
        for machine in (self.two, self.one):
            machine.close()


@contextmanager
def network(log_dir: Path) -> Iterator[Network]:
    needs_namespaces()
    opened = Network(log_dir)
    try:
        yield opened
    finally:
        opened.close()
