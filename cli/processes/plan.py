"""The options with which `up`, `demo` and the benchmarks start a robot, checked before anything runs."""

import argparse
import contextlib
import importlib.util
import os
import uuid
from collections.abc import Sequence
from pathlib import Path

import msgspec

from cli.errors import CliError, checked
from cli.link import use_keys
from cli.processes.services import NAMES, OPTIONAL, SECTIONS, SERVICES, Service
from cli.processes.supervision import RunInfo, run_dir
from common import config
from common.bus.session import check_namespace
from common.household import load_household
from common.scene import SceneError, load_scene
from common.security import keys
from common.security.access import OPERATOR, ROUTER
from common.security.keys import OFF
from common.time.clock import unix_time

PIPELINES = ("fetch", "vla")
"""The values of `brain.pipeline`: the eight-state system flow, or voice, plan, vision and action."""
WAIT_FOR = f"{config.PREFIX}SIM__WAIT_FOR"
SENSORS = ("bought", "ideal")
"""With the noise and the gaps of sensors that can be bought, or without."""


class Plan:
    """The processes to start with their settings, checked before anything starts.

    Raises:
        CliError: an unknown service or section, a bad speed, a busy port.
    """

    def __init__(self, args: argparse.Namespace) -> None:
        self.port, self.namespace = args.port, args.namespace or os.environ.get("TIDYBOT_NAMESPACE", "")
        check_namespace(self.namespace)
        config.config_dir()
        self.speed = _speed(args.speed)
        self.services = _selection(args.only, args.without, [n for n in OPTIONAL if getattr(args, n, False)])
        self.keys = certificates(getattr(args, "keys", OFF), self.names, self.namespace)
        self.connect = f"{'tls' if self.keys else 'tcp'}/127.0.0.1:{self.port}"
        settings = {"OMP_NUM_THREADS": "1", "PYTHONUNBUFFERED": "1"}
        settings["TIDYBOT_CONNECT"], settings["TIDYBOT_NAMESPACE"] = self.connect, self.namespace
        settings["TIDYBOT_KEYS"] = self.keys or OFF
        settings["TIDYBOT_STATE_DIR"] = os.environ.get("TIDYBOT_STATE_DIR") or str(run_dir())
        settings["TIDYBOT__BRAIN__RUN"] = settings["TIDYBOT__SIM__RUN"] = uuid.uuid4().hex
        settings |= home(args)
        if args.seed is not None:
            settings["TIDYBOT__RUNTIME__SEED"] = str(args.seed)
        settings |= _overrides(machine(args))
        if getattr(args, "pipeline", None):
            settings["TIDYBOT__BRAIN__PIPELINE"] = args.pipeline
        if args.viewer:
            settings["TIDYBOT__SIM__VIEWER"] = "true"
        settings["TIDYBOT__SIM__SPEED"] = self.speed
        if self.speed != "realtime":
            settings["TIDYBOT__RUNTIME__LOCKSTEP"] = "true"
        self.environ = {**os.environ, **settings}
        if self.speed != "realtime":
            self.pace(self.services)
        self.environ |= _overrides(args.set)

    def pace(self, services: Sequence[Service], *guests: str) -> None:
        """Start these services; in lockstep time begins with all that are paced and with `guests`, which come later."""
        self.services = list(services)
        awaited = [*(s.name for s in services if s.paced), *guests]
        self.environ[WAIT_FOR] = msgspec.json.encode(awaited).decode()

    @property
    def guests(self) -> set[str]:
        """Participants that time begins with and that this plan does not start."""
        try:
            awaited = set(msgspec.json.decode(self.environ.get(WAIT_FOR, "[]"), type=list[str]))
        except msgspec.DecodeError:
            return set()  # the simulation says what is wrong with it
        return awaited - {*self.names}

    @property
    def names(self) -> list[str]:
        return [s.name for s in self.services]

    def info(self) -> RunInfo:
        return RunInfo(
            connect=self.connect,
            namespace=self.namespace,
            speed=self.speed,
            services=self.names,
            started=unix_time(),
            keys=self.keys,
            settings={k: v for k, v in self.environ.items() if k.startswith(config.PREFIX)},
        )


def home(args: argparse.Namespace) -> dict[str, str]:
    """The environment for `--scene`, or `--world` and `--household`, whose files are read once to see that they can be.

    Raises:
        CliError: one that cannot be used, or a world without what the robot is told of it.
    """
    given = {name: path for name in ("scene", "world", "household") if (path := getattr(args, name, None))}
    try:
        shared = msgspec.convert(given, config.RuntimeConfig)
        if given:
            load_scene(shared.world_file)
            load_household(shared.household_file)
    except (config.ConfigError, SceneError) as error:
        raise CliError(str(error)) from None
    return {f"{config.PREFIX}RUNTIME__{name.upper()}": _absolute(path) for name, path in given.items()}


def _absolute(name: str) -> str:
    """A file of the user's stands where this command runs, which is not where the services do."""
    path = Path(name)
    return str(path.resolve()) if path.exists() and path.suffix else name


def _speed(text: str) -> str:
    if text in ("realtime", "max"):
        return text
    with contextlib.suppress(ValueError):
        if float(text) > 0:
            return text
    raise CliError(f"--speed {text}: expected realtime, max or a positive factor such as 4")


def certificates(option: str | None, names: Sequence[str], namespace: str) -> str:
    """The keys that everything is to use, every certificate looked at; "" for none.

    Raises:
        CliError: keys asked for that are not there, or one that cannot be used.
    """
    try:
        given = {"TIDYBOT_KEYS": option} if option else os.environ
        found = keys.directory(given)
        if found is None:
            if option == "":
                raise CliError(f"no keys in {keys.default_directory()}; `tidybot keys` makes them")
            use_keys(OFF)
            return ""
        from common.security.certificate import Identity

        for name in (*names, OPERATOR):
            where = namespace if name != ROUTER else ""
            Identity(keys.folder(found, name, where), name, where)
    except keys.KeysError as error:
        raise CliError(str(error)) from None
    use_keys(str(found))
    return str(found)


def machine(args: argparse.Namespace) -> list[str]:
    """The settings that `--robot` and `--sensors` stand for, as `section.key=value`."""
    robot = [f"sim.robot={args.robot}"] if getattr(args, "robot", None) else []
    sensors = getattr(args, "sensors", None)
    return [*robot, *(f"{section}.sensors={sensors}" for section in ("camera", "sim") if sensors)]


def _selection(only: str, without: str, besides: Sequence[str]) -> list[Service]:
    default = [n for n in NAMES if n not in OPTIONAL]
    chosen = [checked(n, NAMES, "service") for n in only.split(",") if n] or default
    dropped = [checked(n, NAMES, "service") for n in without.split(",") if n]
    found = [s for s in SERVICES if s.name in (*chosen, *besides) and s.name not in dropped]
    for service in found:
        if service.needs and importlib.util.find_spec(service.needs) is None:
            raise CliError(f"{service.name} needs a package: pip install 'tidybot-zenoh[{service.name}]'")
    return found


def _overrides(settings: Sequence[str]) -> dict[str, str]:
    try:
        config.overrides({}, settings)
    except config.ConfigError as error:
        raise CliError(str(error)) from None
    environ = {}
    for setting in settings:
        left, _, value = setting.partition("=")
        section, _, key = left.strip().partition(".")
        checked(section, SECTIONS, "section")
        environ[f"{config.PREFIX}{section.upper()}__{key.upper()}"] = value
    return environ


def add_start_options(parser: argparse.ArgumentParser) -> None:
    """Options that `up` and `demo` share."""
    parser.add_argument("--speed", default="realtime", metavar="realtime|N|max", help="other than realtime: lockstep")
    parser.add_argument("--scene", help="a shipped scene's name or a path: the world, and all of it is told")
    parser.add_argument("--world", metavar="FILE", help="what the simulation builds (docs/WORLDS.md)")
    parser.add_argument("--household", metavar="FILE", help="what the robot is told of it")
    parser.add_argument("--seed", type=int, help="object layout and noise")
    parser.add_argument("--pipeline", choices=PIPELINES, help="the brain's flow (default: brain.toml's, else vla)")
    add_machine_options(parser)
    parser.add_argument("--set", action="append", default=[], metavar="section.key=value", help="override a parameter")
    parser.add_argument("--viewer", action="store_true", help="open a window on the simulation")


def add_machine_options(parser: argparse.ArgumentParser) -> None:
    """Options that everything shares which starts a robot."""
    parser.add_argument("--robot", metavar="NAME", help="tidybot, or official: with MuJoCo Menagerie's meshes")
    parser.add_argument("--sensors", choices=SENSORS, help="bought: with noise and gaps (the default), or ideal")
