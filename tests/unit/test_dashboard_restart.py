"""Restart buttons: who can be restarted, what is asked of the supervisor, and what is said without one."""

import xmlrpc.client
from pathlib import Path
from typing import Any

import pytest

from common import topics
from common.bus.memory import MemoryBus, MemoryIo
from common.household import load_household
from common.process.health_records import ServiceRow
from services.dashboard.background_requests import BackgroundRequests
from services.dashboard.panels import markup
from services.dashboard.supervisor_client import NOBODY, Refused, Supervisor


class Fake(Supervisor):
    """A supervisor that notes what it is asked."""

    def __init__(self, stopped: bool = False) -> None:
        super().__init__("/nowhere")
        self.calls: list[tuple[Any, ...]] = []
        self._stopped = stopped

    def call(self, method: str, *args: Any) -> Any:
        if method == "supervisor.getAllProcessInfo":
            return [{"name": name} for name in ("sim", "navigation", "dashboard", "watchdog")]
        self.calls.append((method, *args))
        if method == "supervisor.stopProcess" and self._stopped:
            raise Refused("NOT_RUNNING: sim")
        return True


@pytest.mark.parametrize("stopped", [False, True])
def test_a_process_is_stopped_and_started(stopped: bool) -> None:
    fake = Fake(stopped)
    fake.restart("sim")
    assert fake.calls == [("supervisor.stopProcess", "sim"), ("supervisor.startProcess", "sim", False)]


def test_the_page_leaves_its_own_start_to_the_supervisor() -> None:
    fake = Fake()
    fake.restart("dashboard")
    assert fake.calls == [("supervisor.signalProcess", "dashboard", "TERM")]


@pytest.mark.parametrize("name", ["watchdog", "", "init", "sim; reboot"])
def test_nothing_else_can_be_restarted(name: str) -> None:
    fake = Fake()
    with pytest.raises(Refused, match="not part of this run"):
        fake.restart(name)
    assert fake.calls == []


def test_without_a_supervisor_there_are_no_buttons_and_the_page_says_why(tmp_path: Path) -> None:
    nobody = Supervisor(str(tmp_path / "none.sock"))
    assert nobody.names() == ()
    with pytest.raises(Refused):
        nobody.restart("sim")
    row = ServiceRow("sim", True, 0, 100.0, 80.0, 0, 5.0, "")
    bare = markup.services([row], (), NOBODY)
    assert "<button" not in bare
    assert "docker compose restart" in bare
    full = markup.services([row], ("sim", "router"), "")
    assert full.count("<button") == 2, "one for the router, which has no health"


def test_a_dead_socket_is_nobody(tmp_path: Path) -> None:
    (tmp_path / "dead.sock").touch()
    assert Supervisor(str(tmp_path / "dead.sock")).names() == ()


def carer(told: list[str], supervisor: Supervisor) -> tuple[BackgroundRequests, MemoryBus, MemoryIo]:
    bus = MemoryBus()
    io = MemoryIo(bus, "dashboard", (), (), household=load_household("minimal"), lockstep=True)
    return BackgroundRequests(io, supervisor, told.append), bus, io


def test_errands_run_one_after_the_other_and_tell_of_failure() -> None:
    told: list[str] = []
    care, bus, io = carer(told, Fake())
    rows = b'[{"id": "m-1", "command": "fetch", "reason": "", "outcome": null, "started": 0, "ended": 0}, 7]'
    bus.handlers[topics.BRAIN_MISSIONS] = lambda request: b"null" if b"m-2" in request else rows
    answers: list[object] = []
    care.restart("navigation")
    care.restart("kettle")
    care.mission("m-2", answers.append)
    for _ in range(60):
        io.clock.advance(0.1)  # type: ignore[attr-defined]
        care.step(io.clock.now(), watched=True)
    io.shutdown()
    assert told[-2:] == ["navigation was restarted", "kettle was not restarted: 'kettle' is not part of this run"]
    assert [row["id"] for row in care.missions or []] == ["m-1"], "what is no mission is left out"
    assert care.restartable == ("sim", "navigation", "dashboard")
    assert answers == [None]


def test_nothing_is_asked_while_nobody_looks() -> None:
    care, bus, io = carer([], Supervisor(""))
    asked: list[bytes] = []
    bus.handlers[topics.BRAIN_MISSIONS] = lambda request: asked.append(request) or b"[]"  # type: ignore[func-returns-value]
    for n in range(100):
        care.step(float(n), watched=False)
    io.shutdown()
    assert asked == []


def test_a_fault_of_the_supervisor_is_a_refusal(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    class Proxy:
        def __init__(self, *_: object, **__: object) -> None: ...

        def __getattr__(self, name: str) -> Any:
            def call(*args: object) -> None:
                raise xmlrpc.client.Fault(10, "BAD_NAME: x")

            return call

    socket = tmp_path / "s.sock"
    socket.touch()
    monkeypatch.setattr(xmlrpc.client, "ServerProxy", Proxy)
    with pytest.raises(Refused, match="BAD_NAME"):
        Supervisor(str(socket)).call("supervisor.startProcess", "x", False)
