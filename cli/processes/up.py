"""`tidybot up`: start everything, say when it is ready, follow it, end everything."""

import argparse
import contextlib
import signal
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from types import FrameType
from typing import TypeVar

from cli.errors import CliError, port_number
from cli.link import Link, Subscription
from cli.output import NewStates
from cli.processes.plan import Plan, add_start_options
from cli.processes.ports import port_is_free
from cli.processes.programs import socket_path
from cli.processes.services import NAMES, OPTIONAL
from cli.processes.supervision import Supervision, run_dir
from common import speech_weights, topics
from common.bus.session import NoRouter, open_session
from common.installation import ROOT
from common.time.clock import monotonic, sleep

T = TypeVar("T")
READY_LIMIT = 120.0
"""Time [s] for the next process to be ready; chosen: far above the 3 to 5 s that all take on a calm machine. A busy one
may take longer for all of them, not for the next."""
EXTRA = {"camera", "dashboard", *OPTIONAL}  # the brain starts missions without these


class Stopped(Exception):
    """The user, or the system, asked us to end."""


@contextmanager
def interruptible() -> Iterator[None]:
    """SIGINT, SIGTERM and SIGHUP raise `Stopped` once inside; further ones do not disturb the clean-up."""

    def handle(number: int, frame: FrameType | None) -> None:
        for each in numbers:
            signal.signal(each, signal.SIG_IGN)
        raise Stopped

    numbers = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP)
    before = [signal.signal(n, handle) for n in numbers]
    try:
        yield
    finally:
        for number, old in zip(numbers, before, strict=True):
            signal.signal(number, old)


def check_free(supervision: Supervision, plan: Plan) -> None:
    """Check that no run is up in this directory, and that the port and the folder for its state can be had.

    Raises:
        CliError: says what to do.
    """
    pid = supervision.pid()
    if pid is not None:
        raise CliError(f"already up (supervisor pid {pid}, {supervision.info().connect}); `tidybot down` stops it")
    if "router" in plan.names and not port_is_free(plan.port):
        raise CliError(
            f"port {plan.port} is in use by another program; stop it, or choose another with `--port N` "
            f"(`tidybot doctor` shows who listens)"
        )
    Path(plan.environ["TIDYBOT_STATE_DIR"]).mkdir(parents=True, exist_ok=True)
    for service in plan.services:
        if not (ROOT / service.module.replace(".", "/") / "__main__.py").exists():
            raise CliError(f"{service.module} is not there; leave it out with `--without {service.name}`")


def require_weights(plan: Plan, say: Callable[[str], None]) -> None:
    """Fetch the weights of speech recognition where no package could bring them.

    Raises:
        CliError: they cannot be had.
    """
    if "speech" not in plan.names or speech_weights.find() is not None:
        return
    say("fetching the weights of speech recognition, once (55 MB)")
    try:
        say(f"  they are in {speech_weights.fetch()}")
    except speech_weights.WeightsError as error:
        raise CliError(f"{error}; `--without speech` starts a robot that is only typed to") from None


def bring_up(supervision: Supervision, plan: Plan, say: Callable[[str], None], detach: bool = False) -> float:
    """Start everything and wait until every service is alive and the brain takes commands; seconds it took.

    Raises:
        CliError: a process failed, or was not ready in time; with its last log lines.
    """
    require_weights(plan, say)
    began = monotonic()
    supervision.start(plan.services, plan.connect, plan.environ, plan.info(), detach)
    _until(lambda: supervision.pid() is not None, supervision, "the supervisor")
    if "router" in plan.names:
        _until(lambda: not port_is_free(plan.port), supervision, "the router")
        say(f"  router        {monotonic() - began:4.1f} s  {plan.connect}")
    waiting = {s.name for s in plan.services if s.token}
    with open_session(plan.connect, plan.namespace, wait=_gone(supervision, monotonic())) as session:
        link = Link(session, plan.connect)
        while waiting:
            for name in sorted(_until(lambda: waiting & link.alive(), supervision, ", ".join(sorted(waiting)))):
                waiting.discard(name)
                say(f"  {name:12}  {monotonic() - began:4.1f} s")
        if comes_to_life(plan):
            _until(lambda: _awake(link), supervision, "the brain's first joint states", pause=0.05)
        if "dashboard" in plan.names:
            page = _until(lambda: link.latest(topics.PAGE_STATUS), supervision, "the page")
            say(f"  page                  {page.url}")
    return monotonic() - began


def comes_to_life(plan: Plan) -> bool:
    """True when time passes for the brain, and it takes commands, with nobody but those that the plan starts."""
    return not plan.guests and {*NAMES} - {*plan.names} <= EXTRA


def _awake(link: Link) -> bool:
    state = link.latest(topics.BRAIN_STATE)
    return state is not None and state.state != "IDLE"


def _gone(supervision: Supervision, began: float) -> Callable[[float], bool]:
    """For `open_session`: give up as soon as there is nobody left to wait for."""

    def wait(seconds: float) -> bool:
        sleep(seconds)
        return bool(supervision.died()) or monotonic() - began > READY_LIMIT

    return wait


def _until(probe: Callable[[], T | None], supervision: Supervision, what: str, pause: float = 0.03) -> T:
    """The first truthy value of `probe`, which is asked again until then."""
    since = monotonic()
    while not (value := probe()):
        _check(supervision, what, since)
        sleep(pause)
    return value


def _check(supervision: Supervision, what: str, since: float) -> None:
    why = supervision.died()
    if why:
        raise CliError(f"the supervisor did not start: {why}")
    # Before its socket is there nothing can be asked of it.
    if socket_path(supervision.directory).exists() and supervision.pid() is not None:
        for process in supervision.processes():
            if process.state == "failed":
                raise CliError(failure(supervision, process.name, process.detail))
    if monotonic() - since > READY_LIMIT:
        raise CliError(f"nothing new for {READY_LIMIT:.0f} s: still waiting for {what}; see `tidybot logs`")


def failure(supervision: Supervision, name: str, detail: str) -> str:
    """One process failed: the reason and the last lines of its log."""
    lines = "\n".join(f"    {line}" for line in supervision.tail(name))
    return f"{name} failed{': ' + detail if detail else ''}; its last words:\n{lines}"


def follow(supervision: Supervision, plan: Plan, say: Callable[[str], None]) -> None:
    """Print what changes until interrupted, or until supervisord ends."""
    seen: dict[str, tuple[int, str]] = {}
    told = NewStates()
    with (
        contextlib.suppress(NoRouter),
        open_session(plan.connect, plan.namespace, wait=_gone(supervision, monotonic())) as session,
    ):
        watch = Subscription(Link(session, plan.connect), topics.BRAIN_STATE)
        while not supervision.died():
            state = watch.next(0.5)
            if state is not None and (line := told.line(state)):
                say(line)
            try:
                processes = supervision.processes()
            except CliError:
                continue
            for p in processes:
                now, before = (p.restarts, p.state), seen.get(p.name)
                if (
                    before is not None
                    and before != now
                    and (p.restarts > before[0] or p.state in ("failed", "stopped"))
                ):
                    say(f"{'':13}{p.name}: {p.state} (restarts: {p.restarts}{', ' + p.detail if p.detail else ''})")
                seen[p.name] = now


def run(args: argparse.Namespace) -> int:
    """Start everything and follow it until interrupted; the exit status."""
    supervision, plan = Supervision(run_dir()), Plan(args)
    check_free(supervision, plan)

    def say(text: str) -> None:
        print(text, flush=True)

    detached = False
    try:
        with interruptible():
            seconds = bring_up(supervision, plan, say, args.detach)
            say(f"ready in {seconds:.1f} s")
            if args.detach:
                detached = True
                say("`tidybot status` shows the robot, `tidybot down` stops it")
                return 0
            say("Ctrl-C stops everything")
            follow(supervision, plan, say)
            raise CliError(f"the supervisor is gone: {supervision.died()}")
    except Stopped:
        say("stopped")
        return 0
    finally:
        if not detached:
            supervision.stop()


def register(commands: "argparse._SubParsersAction[argparse.ArgumentParser]") -> None:
    parser = commands.add_parser("up", help="start every service and a router; Ctrl-C stops all")
    add_start_options(parser)
    parser.add_argument(
        "--port", type=port_number, default=7447, help="the router's port on 127.0.0.1 (default %(default)s)"
    )
    parser.add_argument("--namespace", metavar="NAME", help="all keys of this robot go below this name")
    parser.add_argument("--keys", nargs="?", const="", metavar="DIR", help="insist on certificates (default: if there)")
    parser.add_argument("--ros2", action="store_true", help="with the gateway to ROS 2 tools (docs/ROS2.md)")
    parser.add_argument("--foxglove", action="store_true", help="with a server for Foxglove (docs/FOXGLOVE.md)")
    parser.add_argument("--detach", "-d", action="store_true", help="return when ready; `tidybot down` stops it")
    parser.add_argument("--only", default="", metavar="A,B", help=f"start only these of {', '.join(NAMES)}")
    parser.add_argument("--without", default="", metavar="A,B", help="start all but these")
    parser.set_defaults(run=run)
