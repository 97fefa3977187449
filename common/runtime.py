"""Entry point of every service process: arguments, configuration, clock, session, exit status."""

import argparse
import os
import sys
import textwrap
from functools import partial

from common import config
from common.bus.port import Outside
from common.bus.session import BusError, NoRouter, default_connect, open_session
from common.household import load_household
from common.process.host import BAD_CONFIGURATION, StopSignal
from common.process.service_process import Process, ServiceClass
from common.scene import SceneError, load_scene
from common.time.clock import SimClock, WallClock

TERMINAL = 100
"""[columns] of the help; chosen: what today's terminals have at least."""


def main(kind: ServiceClass) -> None:
    """Entry point of `python -m services.<name>`; ends the process with the documented exit status."""
    args = _arguments(kind)
    stop = StopSignal()
    environ = os.environ
    # One link, one task that reads it: a second thread is only woken in vain, at every message.
    environ.setdefault("ZENOH_RUNTIME", "(rx: (worker_threads: 1))")
    try:
        changes = config.overrides(environ, args.set)
        directory = config.config_dir(environ)
        shared = config.load("runtime", config.RuntimeConfig, directory, changes)
        household = load_household(shared.household_file, directory)
        world = load_scene(shared.world_file) if getattr(kind, "KNOWS_WORLD", False) else None
        parameters = config.load(kind.NAME, kind.CONFIG, directory, changes)
        # A service for people keeps their time: it goes on while the simulation pauses, and never holds it up.
        clock_name = getattr(kind, "CLOCK", "") or environ.get("TIDYBOT_CLOCK", "sim")
        if clock_name not in ("sim", "wall"):
            raise config.ConfigError(f"TIDYBOT_CLOCK={clock_name}: expected sim or wall")
        clock: SimClock | WallClock = SimClock() if clock_name == "sim" else WallClock()
        connect = environ.get("TIDYBOT_CONNECT") or default_connect()
        namespace = environ.get("TIDYBOT_NAMESPACE", "")
        with open_session(connect, namespace, wait=stop.wait, name=kind.NAME) as opened:
            state_dir = config.state_dir(environ, connect, namespace)
            again = partial(open_session, connect, namespace, wait=stop.wait, name=kind.NAME, prefixed=False)
            beside = partial(open_session, connect, wait=stop.wait, name=kind.NAME)
            outside = Outside(namespace, again, beside)
            _run(Process(kind, parameters, shared, household, opened, clock, stop, state_dir, world, outside), clock)
    except NoRouter:
        sys.exit(0)
    except (config.ConfigError, SceneError, BusError, StartError) as error:
        print(f"{kind.NAME}: {error}", file=sys.stderr)
        sys.exit(BAD_CONFIGURATION)


class StartError(ValueError):
    """The error of a service that cannot start as configured; the message says what to change."""


def _run(process: Process, clock: SimClock | WallClock) -> None:
    try:
        if isinstance(clock, WallClock):
            process.run_on_wall_clock()
        elif hasattr(process.service, "paused"):
            speed, wait_for = process.service.pace()
            process.run_simulation(clock, speed, wait_for)
        else:
            process.run_on_sim_clock(clock)
    finally:
        process.close()


def _arguments(kind: ServiceClass) -> argparse.Namespace:
    fields = "\n".join(_explained(kind.NAME, key, *rest) for key, rest in config.described(kind.CONFIG).items())
    parser = argparse.ArgumentParser(
        prog=f"python -m services.{kind.NAME}",
        description=(kind.__doc__ or "").strip(),
        formatter_class=argparse.RawDescriptionHelpFormatter,
        epilog=f"parameters (config/{kind.NAME}.toml, TIDYBOT__{kind.NAME.upper()}__<KEY>, --set):\n{fields}\n\n"
        "environment: TIDYBOT_CONNECT, TIDYBOT_NAMESPACE, TIDYBOT_KEYS, TIDYBOT_CONFIG_DIR, TIDYBOT_CLOCK=sim|wall",
    )
    parser.add_argument("--set", action="append", default=[], metavar="section.key=value", help="override a parameter")
    return parser.parse_args()


def _explained(section: str, key: str, default: object, meaning: str) -> str:
    indented = textwrap.indent(textwrap.fill(meaning, width=TERMINAL - 6), " " * 6)
    return f"  {section}.{key} = {default!r}\n{indented}"
