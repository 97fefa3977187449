"""The fleet's page in a real browser: a map with every robot, a stop for each and for all, questions, commands."""

import asyncio
import threading
from collections.abc import Iterator
from typing import Any

import pytest
from aiohttp import web

from cli.fleet.page import application
from cli.processes.ports import free_port
from evaluation.site import eventually
from tests.e2e.test_page import Visitor, browser, pytestmark
from tests.unit.test_fleet_page import Room

__all__ = ["browser", "pytestmark"]


@pytest.fixture
def served() -> Iterator[tuple[Room, str]]:
    """The page of a room, in a loop of its own."""
    room, port, loop = Room(), free_port(), asyncio.new_event_loop()

    async def begin() -> web.AppRunner:
        runner = web.AppRunner(application(room, ""), access_log=None)  # type: ignore[arg-type]
        await runner.setup()
        await web.TCPSite(runner, "127.0.0.1", port).start()
        return runner

    thread = threading.Thread(target=loop.run_forever)
    thread.start()
    runner = asyncio.run_coroutine_threadsafe(begin(), loop).result(20)
    try:
        yield room, f"http://127.0.0.1:{port}/"
    finally:
        asyncio.run_coroutine_threadsafe(runner.cleanup(), loop).result(20)
        loop.call_soon_threadsafe(loop.stop)
        thread.join()
        loop.close()


def test_one_page_for_all_robots(browser: Any, served: tuple[Room, str]) -> None:
    room, url = served
    window = Visitor(browser, url)
    page = window.page

    def shows(condition: str) -> None:
        # Not `wait_for_function`, which the page's policy does not allow to evaluate text.
        eventually(lambda: page.evaluate(condition), condition)

    shows("document.querySelectorAll('#robots tr').length === 2")
    assert "Did you say mug?" in page.locator("#robots").inner_text() and "50 %" in page.locator("#robots").inner_text()
    assert "is busy" in page.locator("#orders").inner_text()
    blue = "Array.from(document.getElementById('map').getContext('2d').getImageData(93, 280, 1, 1).data).join()"
    shows(f"{blue} === '77,171,247,255'")  # the robot at (1, 1) m: 9.33 pixels for a cell of 0.1 m
    page.locator("#robots tr:nth-child(2) button:has-text('Yes')").click()
    page.locator("#robots tr:nth-child(1) button:has-text('STOP')").click()
    page.locator("#text").fill("bring me the red mug")
    page.locator("#over").check()
    page.locator("#say button").click()
    eventually(lambda: len(room.done) == 3, "all three have arrived")
    page.locator("body").click()
    page.keyboard.press("Space")
    page.locator("#stop").click()
    eventually(lambda: len(room.done) == 5, "both stops have arrived")
    assert room.done[0] == ("answer", "kitchen", True) and room.done[1] == ("stop", "hall")
    assert room.done[2] == ("say", "bring me the red mug", True) and room.done[3:] == [("stop", None)] * 2
    room.lost = 9.0
    shows("document.getElementById('robots').textContent.includes('LOST')")
    assert window.errors == [] and window.outside() == []
    page.close()
