"""The page's restart button against the real supervisor of `tidybot up`."""

from pathlib import Path

import pytest

from cli.processes.ports import free_port
from cli.processes.programs import socket_path
from cli.processes.services import SERVICES
from cli.processes.supervision import RunInfo, Supervision
from evaluation.site import eventually
from services.dashboard.supervisor_client import Refused, Supervisor


@pytest.mark.timeout(120)
def test_a_process_is_restarted_over_the_supervisors_socket(tmp_path: Path) -> None:
    connect = f"tcp/127.0.0.1:{free_port()}"
    router = [s for s in SERVICES if s.name == "router"]
    info = RunInfo(connect=connect, namespace="", speed="realtime", services=["router"], started=0.0)
    supervision = Supervision(tmp_path / "run")
    try:
        page = Supervisor(str(socket_path(supervision.directory)))
        assert page.names() == (), "nothing is up yet"
        supervision.start(router, connect, {"OMP_NUM_THREADS": "1"}, info, detach=False)
        eventually(lambda: page.names() == ("router",), "the supervisor answers", 60)
        eventually(lambda: supervision.processes()[0].state == "running", "the router runs", 60)
        before = supervision.processes()[0].pid
        page.restart("router")
        after = eventually(
            lambda: next((p for p in supervision.processes() if p.state == "running" and p.pid != before), None),
            "it runs again", 60,
        )  # fmt: skip
        assert after is not None and after.restarts == 1
        with pytest.raises(Refused):
            page.restart("watchdog")
    finally:
        supervision.stop()
