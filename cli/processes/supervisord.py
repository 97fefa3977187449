"""supervisord with additions: services are forks, nothing outlives its parent, crash loops end, starts are counted.

`python -m cli.processes.supervisord -c FILE` is started by `tidybot up`.
"""

import ctypes
import os
import signal
import sys
from collections import Counter, deque
from typing import Any

from supervisor import events, supervisord
from supervisor.options import ProcessConfig, ServerOptions, decode_wait_status
from supervisor.process import Subprocess
from supervisor.states import ProcessStates

from cli.processes import forked
from common.process.host import BAD_CONFIGURATION
from common.time import clock

PR_SET_PDEATHSIG = 1
"""Option of prctl(2): the signal that a process gets when its parent ends."""
CRASHES, WITHIN = int(os.environ.get("TIDYBOT_CRASHES", "5")), 60.0
"""So many ends of a process within so many seconds are a crash loop; chosen."""
starts: Counter[str] = Counter()


def follow_parent(number: signal.Signals, parent: int) -> None:
    """Have the kernel send us `number` when `parent` dies; leave at once if it already has."""
    ctypes.CDLL(None, use_errno=True).prctl(PR_SET_PDEATHSIG, number)
    if os.getppid() != parent:
        os._exit(1)


class Program(Subprocess):  # type: ignore[misc]
    """A service process. A bad configuration is not tried again, nor one that keeps crashing."""

    def __init__(self, config: Any) -> None:
        super().__init__(config)
        self._crashes: deque[float] = deque(maxlen=CRASHES)
        self.last_exit: int | None = None

    def finish(self, pid: int, sts: int) -> None:
        asked = self.killing
        super().finish(pid, sts)
        self.last_exit = decode_wait_status(sts)[0]
        if asked:
            self._crashes.clear()
            return
        now = clock.monotonic()
        looping = len(self._crashes) == CRASHES and now - self._crashes[0] < WITHIN
        self._crashes.append(now)
        if self.last_exit == BAD_CONFIGURATION or looping:
            self.delay = self.backoff = 0
            self.system_stop = True
            self.change_state(ProcessStates.FATAL)
            self._crashes.clear()


class ProgramConfig(ProcessConfig):  # type: ignore[misc]
    def make_process(self, group: Any = None) -> Program:
        process = Program(self)
        process.group = group
        return process


class Options(ServerOptions):  # type: ignore[misc]
    """Options whose programs are of our kind and die with us, even when we are killed."""

    def processes_from_section(self, parser: Any, section: str, group_name: str, klass: Any = None) -> Any:
        kind = ProgramConfig if klass in (None, ProcessConfig) else klass
        return super().processes_from_section(parser, section, group_name, kind)

    def setpgrp(self) -> Any:
        """Called in the child, between fork and exec."""
        follow_parent(signal.SIGKILL, int(os.environ["TIDYBOT_SUPERVISOR"]))
        return super().setpgrp()

    def execve(self, filename: str, argv: list[str], env: dict[str, str]) -> Any:
        """Called in the child: become the program, without a new interpreter where it can do with this one."""
        if forked.module_of(argv):
            forked.become(argv, env)
        return super().execve(filename, argv, env)


class Extra:
    """What plain supervisord does not tell over XML-RPC."""

    def __init__(self, daemon: Any) -> None:
        self._daemon = daemon

    def starts(self) -> dict[str, int]:
        """How often each program was started."""
        return dict(starts)

    def exits(self) -> dict[str, int]:
        """The last exit status of each program that ever ended; -1 after a signal."""
        found = {}
        for group in self._daemon.process_groups.values():
            for name, process in group.processes.items():
                if process.last_exit is not None:
                    found[name] = process.last_exit
        return found


def make_rpc(daemon: Any, **settings: str) -> Extra:
    """The factory that the configuration file names."""
    events.subscribe(events.ProcessStateStartingEvent, _count)
    return Extra(daemon)


def _count(event: Any) -> None:
    starts[event.process.config.name] += 1


def main() -> None:
    parent = os.environ.pop("TIDYBOT_FOREGROUND_PARENT", "")
    if parent:
        follow_parent(signal.SIGTERM, int(parent))
    os.environ["TIDYBOT_SUPERVISOR"] = str(os.getpid())
    if sys.platform == "linux":
        forked.load()
    options = Options()
    options.realize(sys.argv[1:], doc=__doc__)
    options.first, options.test = True, False
    supervisord.go(options)
    options.close_httpservers()
    options.close_logger()


if __name__ == "__main__":
    # The configuration file names this module, which must be the one that runs.
    sys.modules["cli.processes.supervisord"] = sys.modules["__main__"]
    main()
