"""Model of the fleet's page: polls the robots once a second and follows the commands given there."""

import base64
import threading
from typing import Any

import msgspec

from cli.errors import CliError
from cli.fleet.dispatch import POLL, Dispatch
from cli.fleet.robots import Desk, RobotNow
from common import messages as m
from common import topics
from common.time.clock import monotonic, sleep

PERIOD = 1.0
"""Time between two looks [s]."""
KEPT = 20
"""Orders that are shown [count]; chosen: a day of one flat."""
FORGOTTEN = 600.0
"""Time after which a lost robot is shown no more [s]; chosen."""
SOURCE = "fleet page"


class WatchRoom:
    """Polls and follows in threads of its own; its methods may be called from any thread."""

    def __init__(self, desk: Desk) -> None:
        self._desk, self._over = desk, threading.Event()
        self._robots: dict[str, tuple[float, RobotNow]] = {}
        self._map: m.Costmap | None = None
        self._mapped = ""
        self._subscriber: Any = None
        self._orders: list[dict[str, Any]] = []
        self._threads = [threading.Thread(target=self._look, daemon=True)]
        self._threads[0].start()

    def close(self) -> None:
        """End the threads."""
        self._over.set()
        for thread in self._threads:
            thread.join(10.0)

    def shown(self) -> dict[str, Any]:
        """Everything on the page, as plain values for JSON; `lost` [s]: how long a robot has not been heard."""
        now, rows = monotonic(), []
        for _, (seen, one) in sorted(self._robots.items()):
            away = now - seen
            rows.append({**msgspec.to_builtins(one), "knows": [], "lost": away if away > 4 * PERIOD else 0})
        grid = None
        if self._map is not None:
            grid = msgspec.structs.asdict(self._map) | {"cells": base64.b64encode(self._map.cells).decode()}
        return {"robots": rows, "map": grid, "orders": self._orders[-KEPT:][::-1]}

    def say(self, text: str, hand_over: bool) -> None:
        """Give a command to the best robot, and follow it."""
        order: dict[str, Any] = {"text": text, "by": None, "state": "choosing", "lines": []}
        self._orders.append(order)
        thread = threading.Thread(target=self._follow, args=(order, text, hand_over), daemon=True)
        self._threads.append(thread)
        thread.start()

    def stop(self, name: str | None) -> None:
        """The brake of one robot, or of all of them."""
        for one in [name] if name is not None else sorted({*self._robots, *self._desk.names()}):
            self._desk.send(one, topics.ROBOT_STOP, m.RobotStop(reason="stop button", source=SOURCE))

    def answer(self, name: str, yes: bool) -> None:
        """Answer the question of a robot."""
        self._desk.send(name, topics.VOICE_COMMAND, m.VoiceCommand(text="yes" if yes else "no", confirmed=True))

    # --- threads
    def _look(self) -> None:
        while not self._over.wait(PERIOD):
            now = monotonic()
            for one in self._desk.look():
                self._robots[one.name] = now, one
            self._robots = {n: r for n, r in self._robots.items() if now - r[0] < FORGOTTEN}
            self._follow_map(now)

    def _follow_map(self, now: float) -> None:
        """One robot's map is drawn: they all share it. Another's when that one is gone."""
        present = [n for n, (seen, r) in sorted(self._robots.items()) if now == seen and r.pose is not None]
        if present and self._mapped not in present:
            if self._subscriber is not None:
                self._subscriber.undeclare()
            self._mapped = present[0]
            self._subscriber = self._desk.listen(self._mapped, topics.COSTMAP, lambda one: setattr(self, "_map", one))

    def _follow(self, order: dict[str, Any], text: str, hand_over: bool) -> None:
        work = Dispatch(self._desk, text, tell=order["lines"].append)
        try:
            taken = work.offer()
            order["lines"] += [f"{c.name or 'robot'}: {c.why}" for c in work.candidates]
            order |= {"by": work.by, "state": "under way" if taken else "nobody can take it"}
            while taken and not self._over.is_set() and not work.follow(hand_over):
                order["by"] = work.by
                sleep(POLL)
        except (CliError, ValueError) as error:
            order["state"] = str(error)
            return
        if work.outcome is not None:
            reason = work.outcome.reason
            order |= {"by": work.by, "state": work.outcome.outcome + (f": {reason}" if reason else "")}
