"""The door of the fleet's page: who gets in, and what may be asked for."""

import asyncio
import base64
import zlib
from typing import Any

import numpy as np
from aiohttp import ClientSession, web

from cli.fleet.page import application
from cli.processes.ports import free_port

TOKEN = "sixteen-characters-or-more"


class Room:
    """Two robots, one of which asks; what the page asks for is kept."""

    def __init__(self) -> None:
        self.done: list[tuple[Any, ...]] = []
        self.lost = 0.0

    def shown(self) -> dict[str, Any]:
        robot = {"state": "WAITING", "detail": "", "command": "", "question": "", "holding": "", "braked": False}
        asking = {"state": "CONFIRMING", "command": "bring me the mug", "question": "Did you say mug?"}
        cells = np.full((40, 60), 255, np.uint8)
        cells[:, 30] = 0
        grid = {"t": 1.0, "x": 0.0, "y": 0.0, "resolution": 0.1, "width": 60, "height": 40, "far": 2.0}
        return {
            "robots": [
                {**robot, "name": "hall", "pose": [1.0, 1.0, 0.0], "battery": 0.5, "lost": self.lost},
                {**robot, **asking, "name": "kitchen", "pose": [5.0, 3.0, 1.0], "battery": None, "lost": 0},
            ],
            "map": {**grid, "cells": base64.b64encode(zlib.compress(cells.tobytes())).decode()},
            "orders": [{"text": "tidy up", "by": "hall", "state": "under way", "lines": ["kitchen: is busy"]}],
        }

    def say(self, text: str, hand_over: bool) -> None:
        self.done.append(("say", text, hand_over))

    def stop(self, name: str | None) -> None:
        self.done.append(("stop", name))

    def answer(self, name: str, yes: bool) -> None:
        self.done.append(("answer", name, yes))


def test_no_other_site_and_nobody_without_the_token_gets_in() -> None:
    async def tried() -> list[int]:
        room, port, found = Room(), free_port(), []
        runner = web.AppRunner(application(room, TOKEN), access_log=None)  # type: ignore[arg-type]
        await runner.setup()
        await web.TCPSite(runner, "127.0.0.1", port).start()
        stop: dict[str, Any] = {"do": "stop", "robot": None}
        key = {"Cookie": f"tidybot={TOKEN}"}
        async with ClientSession(f"http://127.0.0.1:{port}") as client:
            for headers, how in (
                ({}, {"json": stop}),
                (key | {"Origin": "http://elsewhere"}, {"json": stop}),
                (key, {"data": "do=stop"}),
                (key, {"json": {"do": "resume"}}),
                (key, {"json": stop}),
            ):
                async with client.post("/act", headers=headers, **how) as answer:
                    found.append(answer.status)
        await runner.cleanup()
        assert room.done == [("stop", None)]
        return found

    assert asyncio.run(tried()) == [401, 403, 415, 400, 200]
