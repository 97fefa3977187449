"""Services as forks of supervisord, which has imported the libraries that they share.

A service so started does not import them again and shares their memory until it writes to it: a robot of ten processes
takes 150 MB and half of the processor time to its start less than with a new interpreter for each.
"""

import atexit
import contextlib
import ctypes
import gc
import importlib
import os
import runpy
import signal
import sys
import threading
import traceback
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import NoReturn

LIBRARIES = (
    "msgspec", "numpy", "zenoh", "mujoco", "PIL.Image", "scipy.ndimage", "scipy.sparse.csgraph", "scipy.spatial",
)  # fmt: skip
"""What several services import, and starts no thread as it is imported: a fork has only the thread that forked."""
OURS = {"cli", "common", "services"}
"""Packages that a fork imports anew: a service that is restarted runs the code that is on disk by then."""
ARGUMENTS = 47, 48
"""Where in proc(5)'s `stat` are the addresses of the command line's begin and end, counted from 0."""


def load() -> None:
    """Import the libraries, and keep the garbage collector from writing to the pages that they are on."""
    given = dict(os.environ)
    os.environ["MUJOCO_GL"] = "disable"  # who draws loads a GL library itself
    for library in LIBRARIES:
        importlib.import_module(library)
    os.environ.clear()
    os.environ.update(given)
    gc.collect()
    gc.freeze()


def module_of(command: Sequence[str]) -> str:
    """The module that a command line `python -m MODULE ...` runs, "" for another one or on another system."""
    return command[2] if sys.platform == "linux" and list(command[1:2]) == ["-m"] else ""


def become(command: Sequence[str], environment: Mapping[str, str]) -> NoReturn:
    """In a fork: run `python -m MODULE ...` as a new interpreter would, and end the process with its exit status."""
    for number in signal.valid_signals():
        if callable(signal.getsignal(number)):
            signal.signal(number, signal.SIG_DFL)
    signal.signal(signal.SIGINT, signal.default_int_handler)
    atexit._clear()
    for name in [name for name in sys.modules if name.partition(".")[0] in OURS]:
        del sys.modules[name]
    os.environ.clear()
    os.environ.update(environment)
    sys.orig_argv, sys.argv = list(command), list(command[2:])
    name_process(command)
    status = _run(command[2])
    # Python has no public names for what it does at its end; multiprocessing ends its forks by the first as well.
    # Without them threads would be cut short, and handlers of atexit not run, or supervisord's ones (`_clear` above).
    threading._shutdown()  # type: ignore[attr-defined]
    atexit._run_exitfuncs()
    sys.stdout.flush()
    sys.stderr.flush()
    # Not `sys.exit`: files of supervisord are open here only by name, and their numbers are taken by others.
    os._exit(status)


def _run(module: str) -> int:
    try:
        runpy.run_module(module, run_name="__main__", alter_sys=True)
    except SystemExit as end:
        if end.code is None or isinstance(end.code, int):
            return end.code or 0
        print(end.code, file=sys.stderr)
        return 1
    except BaseException:
        traceback.print_exc()
        return 1
    return 0


def name_process(command: Sequence[str]) -> None:
    """Show a command line to `ps` and the like in place of supervisord's, as far as there is room for it."""
    with contextlib.suppress(OSError):
        words = Path("/proc/self/stat").read_text(encoding="ascii").rpartition(")")[2].split()
        # The first two of proc(5)'s fields stand before the bracket.
        start, end = (int(words[k - 2]) for k in ARGUMENTS)
        room = end - start
        text = b"\0".join(os.fsencode(word) for word in command)[: room - 1]
        ctypes.memmove(start, text.ljust(room, b"\0"), room)
