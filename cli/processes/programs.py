"""supervisord's configuration of one run: a program for each process, and the sockets in the run directory."""

import hashlib
import os
import re
import shlex
import subprocess
import sys
import tempfile
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import NoReturn

from cli.errors import CliError
from cli.processes.services import Service
from common.installation import ROOT

SOCKET_PATH_LIMIT = 100
"""Characters of a Unix socket's path: Linux allows 107, supervisord adds a suffix."""
ROUTER_SOCKET, ENDPOINT_PATH = "router.sock", re.compile(r"[\w./-]+", re.ASCII)
WATCHDOG = "watchdog"


def environment_of(environ: Mapping[str, str] = os.environ) -> dict[str, str]:
    """The environment in which `python -m` finds our modules from any directory."""
    path = os.pathsep.join(p for p in (str(ROOT), environ.get("PYTHONPATH", "")) if p)
    return {"OMP_NUM_THREADS": "1", **environ, "PYTHONPATH": path}


def become(module: str, *words: str) -> NoReturn:
    """Replace this process by `python -m module words`, as commands do whose work needs services in their process."""
    os.execve(sys.executable, [sys.executable, "-m", module, *words], environment_of())


def said_by(module: str, *words: str, environ: Mapping[str, str] = os.environ, timeout: float | None = None) -> str:
    """What `python -m module words` prints.

    Raises:
        CliError: it failed, with its last words, or took longer than `timeout` [s].
    """
    command, environment = [sys.executable, "-m", module, *words], environment_of(environ)
    try:
        done = subprocess.run(
            command, env=environment, capture_output=True, text=True, timeout=timeout, errors="replace"
        )
    except subprocess.TimeoutExpired:
        raise CliError(f"no answer within {timeout:.0f} s") from None
    if done.returncode:
        raise CliError((done.stderr.strip().splitlines() or [f"exit status {done.returncode}"])[-1])
    return done.stdout


def socket_path(directory: Path) -> Path:
    """The control socket: in the run directory, or in the temporary one when that path is too long for a socket."""
    path = directory / "supervisor.sock"
    if len(str(path)) <= SOCKET_PATH_LIMIT:
        return path
    digest = hashlib.sha256(str(directory).encode()).hexdigest()[:12]
    return Path(tempfile.gettempdir()) / f"tidybot-{os.getuid()}-{digest}.sock"


def endpoints(directory: Path, services: Sequence[Service], connect: str) -> str:
    """What the run's router listens on and its processes connect to: a socket of their own costs less than TCP."""
    path = str(directory / ROUTER_SOCKET)
    usable = len(path) <= SOCKET_PATH_LIMIT and ENDPOINT_PATH.fullmatch(path)
    ours = connect.startswith("tcp/") and any(s.name == "router" for s in services)
    return f"unixsock-stream/{path},{connect}" if ours and usable else connect


def render_config(directory: Path, services: Sequence[Service], connect: str) -> str:
    """The supervisord configuration of one run."""

    def path(value: object) -> str:
        return str(value).replace("%", "%%")

    lines = [
        "[unix_http_server]",
        f"file={path(socket_path(directory))}",
        "chmod=0700",
        "[supervisord]",
        f"logfile={path(directory / 'logs' / 'supervisord.log')}",
        "logfile_maxbytes=1MB",
        "logfile_backups=1",
        f"pidfile={path(directory / 'supervisord.pid')}",
        f"directory={path(ROOT)}",
        "nodaemon=true",
        "silent=true",
        "nocleanup=true",
        "[rpcinterface:supervisor]",
        "supervisor.rpcinterface_factory=supervisor.rpcinterface:make_main_rpcinterface",
        "[rpcinterface:tidybot]",
        "supervisor.rpcinterface_factory=cli.processes.supervisord:make_rpc",
    ]
    watchdog = Service(WATCHDOG, "cli.processes.watchdog")
    for order, service in enumerate((*services, watchdog)):
        name, command = service.name, [sys.executable, "-m", service.module]
        if name == "router":
            command += ["--listen", endpoints(directory, services, connect)]
        lines += [
            f"[program:{name}]",
            f"command={path(shlex.join(command))}",
            f"priority={order + 1}",
            "autorestart=true",
            "startsecs=1",
            "startretries=3",
            "stopsignal=TERM",
            "stopwaitsecs=6",
            "stopasgroup=true",
            "killasgroup=true",
            "redirect_stderr=true",
            f"stdout_logfile={path(directory / 'logs' / (name + '.log'))}",
            "stdout_logfile_maxbytes=5MB",
            "stdout_logfile_backups=2",
        ]
    return "\n".join(lines) + "\n"
