"""What the operator's page costs during a mission: alone, with one and with three viewers, and with one that hangs.

Also when the first picture is complete at a viewer, and what the page lost of the bus (`drops` of its health record).
The share is process CPU time by wall time; `robot` says how fast the robot's own clock ran meanwhile.
"""

import argparse
import asyncio
import itertools
import json
import re
import sys
import time
from typing import Any

import msgspec
import psutil
import viser
import zstandard
from aiohttp import ClientSession

from bench.commands import commands
from cli.link import Link, Watch
from cli.processes.ports import free_port
from common import messages as m
from common import topics
from common.bus.session import open_session

SETTLE = 3.0
"""Time [s] until all visitors are served, before the measurement."""
PHASES = (("nobody looks", 0, 0), ("one viewer", 1, 0), ("three viewers", 3, 0), ("three, and one hangs", 3, 1))
COMMANDS = ("bring me the red mug", "bring me the green can", "bring me the blue bottle", "go to the kitchen")
EYE = {
    "type": "ViewerCameraMessage", "wxyz": (0.5, -0.5, 0.5, -0.5), "position": (-3.4, -4.2, 4.6), "fov": 1.3,
    "near": 0.01, "far": 1000.0, "image_height": 720, "image_width": 900, "look_at": (0.8, -0.2, 0.3),
    "up_direction": (0.0, 0.0, 1.0),
}  # fmt: skip
READY = ("WAITING", "LISTENING", "COMPLETED", "ERROR")
ZSTD = b"\x28\xb5\x2f\xfd"


async def watching(url: str, heard: list[int], hang: bool) -> None:
    """A viewer's stream: counts its messages, or reads nothing."""
    protocol = f"viser-v{viser.__version__}"
    async with (
        ClientSession() as session,
        session.ws_connect(f"{url}view", protocols=[protocol], max_msg_size=0) as socket,
    ):
        # Nobody counts as looking before he has said from where.
        await socket.send_bytes(msgspec.msgpack.encode(EYE))
        if hang:
            # aiohttp stops reading from the socket once its buffer is full.
            await asyncio.sleep(3600)
        async for _ in socket:
            heard[0] += 1


async def first_picture(url: str) -> tuple[float, float]:
    """Seconds until a new viewer has the flat and the robot, and the megabytes that came until then."""
    began, size, missing = time.perf_counter(), 0, {b"/flat", b"/walls", b"/robot/base"}
    async with ClientSession() as session:
        async with session.get(url) as answer:
            page = await answer.text()
        for path in (*re.findall(r'"/(page/[^"]+)"', page), "view/"):
            async with session.get(url + path) as answer:
                size += len(await answer.read())
        protocol = f"viser-v{viser.__version__}"
        async with session.ws_connect(f"{url}view", protocols=[protocol], max_msg_size=0) as socket:
            while missing:
                data = await socket.receive_bytes(timeout=30)
                size += len(data)
                packed = data.find(ZSTD)
                if packed >= 0:
                    data = zstandard.ZstdDecompressor().decompressobj().decompress(data[packed:])
                missing = {name for name in missing if name not in data}
    return time.perf_counter() - began, size / 1e6


class Robot:
    """The robot under measurement: its clock, its page's process, and something for it to do."""

    def __init__(self, link: Link, pid: int) -> None:
        self._link, self._joints = link, Watch(link, topics.JOINT_STATES)
        self._process = psutil.Process(pid)
        self._commands = itertools.cycle(COMMANDS)

    def cpu(self) -> float:
        """CPU seconds of the page's process so far."""
        return float(sum(self._process.cpu_times()[:2]))

    def clock(self) -> float:
        """The robot's time now [s]."""
        newest: float | None = None
        while (joints := self._joints.next(0.0)) is not None:
            newest = joints.t
        if newest is None:
            joints = self._joints.next(10.0)
            if joints is None:
                raise SystemExit("bench.page: the robot has not said where its joints are for 10 s")
            newest = joints.t
        return newest

    def health(self) -> m.Health:
        return self._link.health()["dashboard"]

    def keep_busy(self) -> str:
        """Give it a mission unless it is on one; the state that it was in."""
        state = self._link.latest(topics.BRAIN_STATE)
        if state is not None and state.state in READY:
            self._link.send(topics.VOICE_COMMAND, m.VoiceCommand(text=next(self._commands), confirmed=True))
        return state.state if state is not None else ""


async def measure(name: str, url: str, robot: Robot, seconds: float, viewers: int, hung: int) -> None:
    """One row of the table."""
    print(f"{name}: {seconds:.0f} s ...", file=sys.stderr, flush=True)
    counts = [[0] for _ in range(viewers)]
    tasks = [asyncio.create_task(watching(url, heard, False)) for heard in counts]
    tasks += [asyncio.create_task(watching(url, [0], True)) for _ in range(hung)]
    states = [robot.keep_busy()]
    await asyncio.sleep(SETTLE)
    lost, before = robot.health().drops, [heard[0] for heard in counts]
    began, clock, spent = time.monotonic(), robot.clock(), robot.cpu()
    each: list[float] = []
    while (left := began + seconds - time.monotonic()) > 0:
        at, heard = time.monotonic(), counts[0][0] if counts else 0
        await asyncio.sleep(min(2.0, left))
        each.append(((counts[0][0] if counts else 0) - heard) / (time.monotonic() - at))
        states.append(robot.keep_busy())
    passed = time.monotonic() - began
    cpu, ran, now = (robot.cpu() - spent) / passed, (robot.clock() - clock) / passed, robot.health()
    rates = [(heard[0] - b) / passed for heard, b in zip(counts, before, strict=True)]
    for task in tasks:
        task.cancel()
    await asyncio.gather(*tasks, return_exceptions=True)
    # Nothing is sent of a robot that stands still, so the best two seconds are told as well.
    told = ", ".join(f"{rate:.0f}" for rate in rates) + f" (up to {max(each):.0f})" if rates else "-"
    on = sum(state not in READY for state in states) / len(states)
    print(f"{name:22} {100 * cpu:5.1f} % of a core   loop {now.hz:4.1f} Hz   lost {now.drops - lost:3}   "
          f"robot {ran:4.2f} x, {100 * on:3.0f} % on missions   frames a second: {told}", flush=True)  # fmt: skip


def main() -> None:
    parser = argparse.ArgumentParser(prog="python -m bench.page", description=__doc__)
    parser.add_argument("--seconds", type=float, default=20.0, help="length of each of the phases")
    args = parser.parse_args()
    with commands() as tidybot:
        port = free_port()
        print("starting the robot ...", file=sys.stderr, flush=True)
        told = tidybot("up", "--detach", "--port", str(port), "--set", "dashboard.port=0")
        url = next(word for word in told.split() if word.startswith("http://"))
        rows: list[dict[str, Any]] = json.loads(tidybot("ps", "--json"))
        pid = next(int(row["pid"]) for row in rows if row["name"] == "dashboard")
        with open_session(f"tcp/127.0.0.1:{port}") as session:
            robot = Robot(Link(session, ""), pid)
            print(f"{'start':22} {robot.cpu():5.1f} s of a core until the page was up", flush=True)
            for _ in range(2):
                seconds, size = asyncio.run(first_picture(url))
                print(f"{'first picture':22} {seconds:5.2f} s   {size:.1f} MB", flush=True)
            for name, viewers, hung in PHASES:
                asyncio.run(measure(name, url, robot, args.seconds, viewers, hung))
        print(f"{'resident':22} {psutil.Process(pid).memory_info().rss / 2**20:5.0f} MB")


if __name__ == "__main__":
    main()
