"""What the operator's page costs during a mission: alone, with one and with three viewers, and with one that hangs.

Also when the first picture is complete at a viewer, and what the page lost of the bus (`drops` of its health record).
"""

import asyncio
import contextlib
import json
import os
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from typing import Any

import psutil
import viser
import zstandard
from aiohttp import ClientSession

from cli.link import Link
from common import bus
from common import messages as m
from tests.support import free_port

SECONDS = 20.0
ZSTD = b"\x28\xb5\x2f\xfd"


async def watching(url: str, heard: list[int], hang: bool) -> None:
    """A viewer's stream: counts its messages, or reads nothing."""
    protocol = f"viser-v{viser.__version__}"
    async with (
        ClientSession() as session,
        session.ws_connect(f"{url}view", protocols=[protocol], max_msg_size=0) as socket,
    ):
        if hang:
            # aiohttp stops reading from the socket once its buffer is full.
            await asyncio.sleep(3600)
        async for _ in socket:
            heard[0] += 1


async def first_picture(url: str) -> tuple[float, float]:
    """Seconds until a new viewer has the flat and the robot, and the megabytes that came until then."""
    began, size, missing = time.perf_counter(), 0, {b"/flat", b"/walls", b"/robot/base"}
    async with ClientSession() as session:
        for path in ("", "page/page.js", "page/tape.js", "page/keys.js", "page/page.css", "view/"):
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


async def measure(name: str, url: str, pid: int, viewers: int, hung: int, health: Callable[[], m.Health]) -> None:
    counts = [[0] for _ in range(viewers)]
    tasks = [asyncio.create_task(watching(url, heard, False)) for heard in counts]
    tasks += [asyncio.create_task(watching(url, [0], True)) for _ in range(hung)]
    await asyncio.sleep(3.0)
    lost = health().drops
    process, before = psutil.Process(pid), [heard[0] for heard in counts]
    spent = sum(process.cpu_times()[:2])
    await asyncio.sleep(SECONDS)
    cpu = (sum(process.cpu_times()[:2]) - spent) / SECONDS
    now = health()
    rates = [(heard[0] - b) / SECONDS for heard, b in zip(counts, before, strict=True)]
    for task in tasks:
        task.cancel()
        with contextlib.suppress(asyncio.CancelledError):
            await task
    told = ", ".join(f"{rate:.0f}" for rate in rates) or "-"
    print(f"{name:26} {100 * cpu:5.1f} % of a core   loop {now.hz:4.1f} Hz   lost {now.drops - lost:3}   "
          f"frames a second: {told}", flush=True)  # fmt: skip


def main() -> None:
    with tempfile.TemporaryDirectory() as run_dir:
        environment = {**os.environ, "TIDYBOT_RUN_DIR": run_dir}

        def tidybot(*words: str) -> str:
            command = [sys.executable, "-m", "cli.main", *words]
            return subprocess.run(command, env=environment, capture_output=True, text=True, check=True).stdout

        port = free_port()
        told = tidybot("up", "--detach", "--port", str(port), "--set", "dashboard.port=0")
        try:
            url = next(word for word in told.split() if word.startswith("http://"))
            rows: list[dict[str, Any]] = json.loads(tidybot("ps", "--json"))
            pid = next(int(row["pid"]) for row in rows if row["name"] == "dashboard")
            print(f"{'start, until the page was up':26} {sum(psutil.Process(pid).cpu_times()[:2]):5.1f} s of a core")
            with bus.session(f"tcp/127.0.0.1:{port}") as session:
                link = Link(session, "")
                for _ in range(2):
                    seconds, size = asyncio.run(first_picture(url))
                    print(f"{'first picture':26} {seconds:5.2f} s   {size:.1f} MB", flush=True)
                tidybot("say", "bring me the red mug, please")
                for name, viewers, hung in (
                    ("nobody looks", 0, 0), ("one viewer", 1, 0), ("three viewers", 3, 0),
                    ("three, and one hangs", 3, 1),
                ):  # fmt: skip
                    asyncio.run(measure(name, url, pid, viewers, hung, lambda: link.health()["dashboard"]))
            rows = json.loads(tidybot("ps", "--json"))
            print(f"{'resident':26} {next(row['rss_mb'] for row in rows if row['name'] == 'dashboard'):5.0f} MB")
        finally:
            tidybot("down")


if __name__ == "__main__":
    main()
