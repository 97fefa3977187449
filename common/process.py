"""What a process tells the host and asks of it: signals, parent death, memory."""

import ctypes
import os
import resource
import signal
import threading
from types import FrameType

_PR_SET_PDEATHSIG = 1
_PAGE_MB = resource.getpagesize() / 2**20


class StopSignal:
    """Becomes set on SIGTERM or SIGINT; a second signal kills the process the default way."""

    def __init__(self) -> None:
        self._event = threading.Event()
        for number in (signal.SIGTERM, signal.SIGINT):
            signal.signal(number, self._handle)

    def _handle(self, number: int, frame: FrameType | None) -> None:
        self._event.set()
        signal.signal(number, signal.SIG_DFL)

    def is_set(self) -> bool:
        return self._event.is_set()

    def wait(self, timeout: float) -> bool:
        return self._event.wait(timeout)


def die_with_parent(environ: "os._Environ[str]" = os.environ) -> None:
    """Ask Linux for SIGTERM when the supervisor dies, when it says it is our parent (TIDYBOT_SUPERVISED)."""
    if environ.get("TIDYBOT_SUPERVISED") != "1":
        return
    try:
        ctypes.CDLL(None, use_errno=True).prctl(_PR_SET_PDEATHSIG, signal.SIGTERM)
    except (OSError, AttributeError):
        return
    if os.getppid() == 1:
        os.kill(os.getpid(), signal.SIGTERM)


def rss_mb() -> float:
    """Resident memory of this process [MB]."""
    try:
        with open("/proc/self/statm", encoding="ascii") as statm:
            return int(statm.read().split()[1]) * _PAGE_MB
    except OSError:
        return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
