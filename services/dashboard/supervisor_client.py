"""Restarting a process, as `tidybot restart` does it: over the socket of the supervisor that `tidybot up` started."""

from pathlib import Path
from typing import Any

from common.process import supervisor

HIDDEN = ("watchdog",)
OURSELVES = "dashboard"
NOBODY = (
    "Restart buttons need the supervisor of `tidybot up`, which is not reachable from here; in compose restart with "
    "`docker compose restart SERVICE`."
)


class Refused(Exception):
    """The supervisor is not there or does not do it; says why."""


class Supervisor:
    """For the worker thread: every call may take seconds."""

    def __init__(self, socket: str) -> None:
        self._socket = socket

    def names(self) -> tuple[str, ...]:
        """The processes that can be restarted; empty when no supervisor answers."""
        try:
            rows = self.call("supervisor.getAllProcessInfo")
        except Refused:
            return ()
        return tuple(str(row["name"]) for row in rows if row["name"] not in HIDDEN)

    def restart(self, name: str) -> None:
        """Stop and start one process. It does not come back from stopping itself: that is left to the supervisor.

        Raises:
            Refused: no such process, or it does not start.
        """
        if name not in self.names():
            raise Refused(f"{name[:40]!r} is not part of this run")
        if name == OURSELVES:
            self.call("supervisor.signalProcess", name, "TERM")
            return
        try:
            self.call("supervisor.stopProcess", name)
        except Refused as refused:
            if "NOT_RUNNING" not in str(refused):
                raise
        self.call("supervisor.startProcess", name, False)

    def call(self, method: str, *args: Any) -> Any:
        """One call of the supervisor's own interface.

        Raises:
            Refused: nobody answers, or it says no.
        """
        if not self._socket:
            raise Refused(NOBODY)
        try:
            return supervisor.call(Path(self._socket), method, *args)
        except supervisor.NoSupervisor:
            raise Refused(NOBODY) from None
        except supervisor.SupervisorRefused as refused:
            raise Refused(str(refused)) from None
