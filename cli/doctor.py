"""`tidybot doctor`: checks what the robot needs on this machine, and names the command that fixes what is missing."""

import argparse
import ctypes.util
import importlib.util
import os
import platform
import shutil
import sys
from collections.abc import Iterator
from datetime import datetime
from importlib import metadata
from pathlib import Path

import msgspec

from cli.errors import CliError
from cli.keys.authority import Authority
from cli.output import show
from cli.processes.ports import listener, port_is_free
from cli.processes.programs import said_by
from cli.processes.supervision import Supervision, run_dir
from common import speech_weights
from common.config import settings
from common.installation import ROOT
from common.rendering import backend
from common.security import keys
from common.time.clock import unix_time

EXPIRES_SOON = 30
"""Days of validity below which a certificate is worth a note."""
PAGE_PORT = 8080
"""The page's port unless another is configured."""
ROOM = 500
"""Free disk [MB] below which there is a note; chosen: logs and recordings would soon fill it."""
ROBOT = "stanford_tidybot"


class Finding(msgspec.Struct):
    """The result of one check. `level`: ok, note (an option is not there), error (the robot cannot run)."""

    level: str
    what: str
    state: str
    fix: str = ""


def python() -> Iterator[Finding]:
    version = platform.python_version()
    good = sys.version_info >= (3, 11)
    yield Finding("ok" if good else "error", "python", version, "" if good else "install Python 3.11 or newer")


def packages() -> Iterator[Finding]:
    """Every locked package is there in the locked version."""
    from packaging.markers import Marker  # not for every command to load

    lock = ROOT / "requirements.lock"
    missing, other, count = [], [], 0
    for line in lock.read_text(encoding="utf-8").splitlines() if lock.exists() else ():
        pinned, _, marker = line.removesuffix("\\").partition(";")
        name, equals, wanted = (part.strip() for part in pinned.partition("=="))
        if not equals or name.startswith(("#", "--")) or (marker.strip() and not Marker(marker).evaluate()):
            continue
        count += 1
        try:
            if (found := metadata.version(name)) != wanted:
                other.append(f"{name} {found} (locked {wanted})")
        except metadata.PackageNotFoundError:
            missing.append(name)
    if missing:
        yield Finding("error", "packages", f"missing: {', '.join(missing)}", "make setup")
    if other:
        yield Finding("note", "packages", f"not the locked versions: {', '.join(other)}", "make setup")
    if not missing and not other:
        state = f"all {count} as locked" if count else "installed without a lock file"
        yield Finding("ok" if count else "note", "packages", state)


def speech() -> Iterator[Finding]:
    """The recogniser's weights."""
    found = speech_weights.find()
    if found is None:
        yield Finding("note", "speech weights", "not here yet", "nothing: `tidybot up` fetches them once (55 MB)")
    else:
        yield Finding("ok", "speech weights", str(found))


def graphics() -> Iterator[Finding]:
    fix = "apt-get install libegl1 libgl1-mesa-dri   (or libosmesa6)"
    # A library that is there may still not render: the camera's own choice tells, by trying.
    found = backend.best()
    if found != "raycast":
        yield Finding("ok", "camera GL", f"{found} renders")
    else:
        yield Finding("note", "camera GL", "none: cameras use ray casting (slower, plain colours)", fix)
    if os.environ.get("DISPLAY") or os.environ.get("WAYLAND_DISPLAY"):
        yield Finding("ok", "window (--viewer)", "a display is there")
    else:
        yield Finding("note", "window (--viewer)", "no display", "run in a desktop session, or ssh -X")


def audio() -> Iterator[Finding]:
    if ctypes.util.find_library("portaudio"):
        cards = Path("/proc/asound/cards")
        have = cards.exists() and "no soundcards" not in cards.read_text(errors="replace")
        state = "portaudio and a sound card" if have else "portaudio, but no sound card"
        yield Finding("ok" if have else "note", "microphone, speakers", state, "" if have else "tidybot say --wav FILE")
    else:
        yield Finding(
            "note",
            "microphone, speakers",
            "no portaudio: recordings and typed text only",
            "apt-get install libportaudio2",
        )


def port() -> Iterator[Finding]:
    supervision = Supervision(run_dir())
    pid = supervision.pid()
    if pid is not None:
        yield Finding("ok", "run", f"up, supervisor pid {pid}, {supervision.info().connect}")
    elif port_is_free(7447):
        yield Finding("ok", "port 7447", "free")
    else:
        yield busy(7447, "tidybot up --port 7448")
    if pid is None and not port_is_free(PAGE_PORT):
        yield busy(PAGE_PORT, "nothing: the page takes the next free port, and `tidybot up` says which")


def busy(port: int, otherwise: str) -> Finding:
    who = listener(port)
    stop = f"kill {who.rsplit(' ', 1)[-1].rstrip(')')}, or " if who else ""
    return Finding("note", f"port {port}", f"in use{' by ' + who if who else ''}", f"{stop}{otherwise}")


def certificates() -> Iterator[Finding]:
    """Keys, whether they can be used, and when the first of them expires."""
    try:
        found = keys.directory()
    except keys.KeysError as error:
        what, _, cure = str(error).partition("; ")
        yield Finding("error", "keys", what, cure.partition("`")[2].partition("`")[0] or "tidybot keys")
        return
    if found is None:
        yield Finding("ok", "keys", "none: the robot is open to this machine only", "")
        return
    there = Authority(found)
    rows = sorted(there.rows(), key=lambda row: row.expires)
    broken = {s.common_name for s in there.subjects()} - {row.name for row in rows}
    if broken or not rows:
        state = f"cannot be read: {', '.join(sorted(broken))}" if broken else f"{found} holds no certificate"
        yield Finding("error", "keys", state, f"tidybot keys --dir {found} --force")
        return
    first = rows[0]
    days = (datetime.fromisoformat(first.expires).timestamp() - unix_time()) / 86400
    state = f"{len(rows)} in {found}; {first.name}'s is the first to expire, on {first.expires[:10]}"
    level = "error" if days < 0 else "note" if days < EXPIRES_SOON else "ok"
    yield Finding(level, "keys", state, "" if level == "ok" else "tidybot keys --force")


def machine() -> Iterator[Finding]:
    cores = len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1
    good = cores >= 2
    yield Finding("ok" if good else "note", "cores", str(cores), "" if good else "real time needs two")
    directory = run_dir()
    try:
        directory.mkdir(parents=True, exist_ok=True)
        usable = os.access(directory, os.W_OK)
    except OSError:
        usable = False
    fix = "" if usable else "export TIDYBOT_RUN_DIR=$HOME/tidybot-run"
    yield Finding("ok" if usable else "error", "run directory", str(directory), fix)
    if usable and (room := shutil.disk_usage(directory).free / 1e6) < ROOM:
        fix = f"rm -r {directory}/logs   (or TIDYBOT_RUN_DIR on another disk)"
        yield Finding("note", "disk", f"{room:.0f} MB left for journal, logs and recordings", fix)
    docker = shutil.which("docker")
    engine = docker is not None and Path("/var/run/docker.sock").exists()
    state = "client and engine" if engine else "client, no engine" if docker else "none (only for `docker compose`)"
    fix = "" if engine else "systemctl start docker" if docker else "apt-get install docker.io docker-compose"
    yield Finding("ok" if engine else "note", "docker", state, fix)


def robots() -> Iterator[Finding]:
    """Which robot the simulation has, and whether the official model is there as its skin."""
    name = settings().get("sim.robot", "tidybot")
    skin = "primitives" if name == "tidybot" else "the official meshes"
    yield Finding("ok", "robot", f"sim.robot = {name}: TidyBot, drawn as {skin}")
    root = os.environ.get("MENAGERIE_ROOT", "")
    if root:
        there = any((Path(root).expanduser() / ROBOT).glob("*.xml"))
        fix = "" if there else f"export MENAGERIE_ROOT=<the folder that holds {ROBOT}/>"
        yield Finding("ok" if there else "note", "official model", f"{root}/{ROBOT}{'' if there else ': none'}", fix)
    elif importlib.util.find_spec("mujoco_menagerie"):
        yield Finding("ok", "official model", "from the mujoco-menagerie package")
    else:
        fix = ".venv/bin/pip install mujoco-menagerie   (or MENAGERIE_ROOT=<a checkout>)"
        yield Finding("note", "official model", "none (only for --robot official)", fix)


def language_model() -> Iterator[Finding]:
    """Check of the language model: the planner's own check of its configuration and endpoint."""
    try:
        yield msgspec.json.decode(said_by("services.planner.language_model.diagnosis"), type=Finding)
    except CliError as error:
        yield Finding("error", "language model", f"the planner cannot tell: {error}", "make setup")


def doctor(args: argparse.Namespace) -> int:
    looks = (python, packages, speech, graphics, audio, port, certificates, machine, robots, language_model)
    findings = [f for look in looks for f in look()]
    lines = [(f"{f.level:5}  {f.what:21} {f.state}", f"{'':28} -> {f.fix}" if f.fix else "") for f in findings]
    show(args, findings, (line for both in lines for line in both if line))
    bad = [f.what for f in findings if f.level == "error"]
    if bad:
        raise CliError(f"the robot cannot run here: {', '.join(bad)}")
    return 0


def register(commands: "argparse._SubParsersAction[argparse.ArgumentParser]") -> None:
    parser = commands.add_parser("doctor", help="what is missing on this machine, and the command that fixes it")
    parser.add_argument("--json", action="store_true", help="as JSON")
    parser.set_defaults(run=doctor)
