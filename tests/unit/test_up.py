"""`tidybot up` waits for as long as the robot is getting on, and says what has not come."""

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import pytest

from cli import main
from cli.errors import CliError
from cli.processes import up
from cli.processes.plan import Plan
from common import messages as m
from common import topics


class Machine:
    """A clock, processes that come up at their times [s], and a link over which every second question is lost."""

    def __init__(self, monkeypatch: pytest.MonkeyPatch, ready: dict[str, float]) -> None:
        self.now, self.asked, self.ready = 0.0, 0, ready
        self.directory = Path("nowhere")
        monkeypatch.setattr(up, "monotonic", lambda: self.now)
        monkeypatch.setattr(up, "sleep", self.sleep)
        monkeypatch.setattr(up, "port_is_free", lambda port: False)
        monkeypatch.setattr(up, "require_weights", lambda plan, say: None)
        monkeypatch.setattr(up, "open_session", self.session)
        monkeypatch.setattr(up, "Link", lambda session, connect: self)

    def sleep(self, seconds: float) -> None:
        self.now += 5.0

    @contextmanager
    def session(self, connect: str, namespace: str, wait: Any) -> Iterator[None]:
        yield

    def start(self, *args: Any) -> None:
        pass

    def pid(self) -> int:
        return 1

    def died(self) -> str:
        return ""

    def alive(self) -> set[str]:
        return {name for name, at in self.ready.items() if self.now >= at}

    def latest(self, topic: Any) -> Any:
        self.asked += 1
        if self.asked % 2:
            return None
        return m.PageStatus(url="http://here") if topic is topics.PAGE_STATUS else m.BrainState(state="WAITING")


def test_up_waits_for_each_process_however_long_all_of_them_take(monkeypatch: pytest.MonkeyPatch) -> None:
    plan = Plan(main.parser().parse_args(["up"]))
    tokens = [s.name for s in plan.services if s.token]
    slow = up.READY_LIMIT - 1.0
    machine: Any = Machine(monkeypatch, {name: n * slow for n, name in enumerate(tokens)})
    said: list[str] = []
    assert up.bring_up(machine, plan, said.append) > 2 * up.READY_LIMIT
    assert said[-1].split() == ["page", "http://here"], "asked again until it was told"


def test_up_says_what_has_not_come(monkeypatch: pytest.MonkeyPatch) -> None:
    plan = Plan(main.parser().parse_args(["up", "--only", "router,sim,camera"]))
    machine: Any = Machine(monkeypatch, {"sim": 1.0})
    with pytest.raises(CliError, match="still waiting for camera"):
        up.bring_up(machine, plan, lambda text: None)
