"""What a process tells the host and asks of it: signals, connections, memory."""

import ctypes
import os
import resource
import signal
import socket
import sys
import threading
from pathlib import Path
from types import FrameType

BAD_CONFIGURATION = 2
"""Exit status of a process that refuses its configuration, fixed by the interface: starting it again does not help."""
SILENCE = 3.0
"""Time without acknowledgement after which a connection is given up [s]: longer than the lease in config/zenoh."""
_PAGE_MB = resource.getpagesize() / 2**20
"""Size of a page of memory [MB], in which the kernel counts."""


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


def limit_silence(seconds: float) -> None:
    """Have the kernel give up this process's TCP connections when nobody acknowledges what was sent for so long.

    Zenoh closes a TLS link by flushing it. When the other side is frozen or unplugged that never returns, and the
    dead peer seems to live on until TCP itself gives up, after a quarter of an hour.
    """
    option = getattr(socket, "TCP_USER_TIMEOUT", None)
    try:
        opened = list(Path("/proc/self/fd").iterdir()) if option is not None else []
    except OSError:
        return
    for one in opened:
        try:
            if not str(one.readlink()).startswith("socket:"):
                continue
            with socket.socket(fileno=os.dup(int(one.name))) as connection:
                if connection.family in (socket.AF_INET, socket.AF_INET6) and connection.type == socket.SOCK_STREAM:
                    connection.setsockopt(socket.IPPROTO_TCP, int(option or 0), round(seconds * 1000))
        except OSError:
            continue  # closed in the meantime


def return_memory() -> None:
    """Give what is not needed any more back to the system, where the C library can."""
    trim = getattr(ctypes.CDLL(None), "malloc_trim", None) if sys.platform == "linux" else None
    if trim is not None:
        trim(0)


def stat_of(pid: int) -> list[str]:
    """What Linux tells of a process: the fields of proc(5)'s `stat` from its state on; none when it has ended."""
    try:
        text = Path(f"/proc/{pid}/stat").read_text(encoding="ascii", errors="replace")
    except OSError:
        return []
    return text.rpartition(")")[2].split()


def rss_mb() -> float:
    """Resident memory of this process [MB]."""
    try:
        with open("/proc/self/statm", encoding="ascii") as statm:
            return int(statm.read().split()[1]) * _PAGE_MB
    except OSError:
        return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
