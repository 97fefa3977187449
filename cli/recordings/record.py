"""`tidybot record`: every topic of the running robot into an MCAP file, until Ctrl-C."""

import argparse
import os
import sys
import time
from collections import deque
from collections.abc import Callable
from importlib.util import find_spec
from pathlib import Path

from cli.errors import CliError, number
from cli.link import Link, address, robot_command
from cli.output import ProgressLine
from cli.processes.supervision import settings_of_run
from cli.recordings.tape import BATCH, FLUSH, Listener, Tape, progress
from common import config, topics
from common.bus.session import NoRouter, open_session
from common.config import config_dir
from common.files.plan_file import to_toml
from common.household import load_household
from common.process.host import StopSignal
from common.recording import Recorder, RecordingError
from common.scene import SceneError, load_scene
from common.time.clock import monotonic, unix_time

PARTS = 8
"""Files that share the space of a recording that keeps its newest part only; chosen: an eighth goes at a time."""


class RecordingFiles:
    """`recorder` writes the file at work. With `keep` [bytes], not 0, files `NAME.001.mcap` and so on are begun, and
    the oldest is deleted, so that all of them together stay below it."""

    def __init__(self, path: Path, keep: int = 0) -> None:
        self._path, self._keep, self._number = path, keep, 0
        self._written: deque[Path] = deque()
        self.recorder = self._begin()

    @property
    def full(self) -> bool:
        """The file at work has its share of the space."""
        return bool(self._keep) and self.recorder.size >= self._keep / PARTS

    def turn_over(self, finish: Callable[[Recorder], None]) -> Recorder:
        """Finish the file at work, begin another and delete what is too old.

        Raises:
            OSError: the disk refuses.
        """
        finish(self.recorder)
        self.recorder.close()
        while len(self._written) >= PARTS:
            self._written.popleft().unlink(missing_ok=True)
        self.recorder = self._begin()
        return self.recorder

    def _begin(self) -> Recorder:
        self._number += 1
        path = self._path
        if self._keep:
            path = path.with_name(f"{path.stem}.{self._number:03d}{path.suffix or '.mcap'}")
        self._written.append(path)
        return Recorder(path)


FASTEST = 50
"""Most frames a second of a dataset: half the rate of joint states."""


def facts_of(link: Link, tape: Tape) -> dict[str, str]:
    """What a replay needs to know of the run."""
    facts = {"connect": link.connect, "namespace": link.namespace, "lockstep": str(tape.lockstep).lower()}
    if tape.status is not None:
        s = tape.status
        facts |= {"scene": s.scene, "seed": str(s.seed), "speed": s.speed, "epoch": s.epoch}
    return facts


def record(args: argparse.Namespace) -> int:
    if args.lerobot is not None:
        return _demonstrations(args)
    path = args.output or Path("out") / time.strftime("run-%Y%m%d-%H%M%S.mcap", time.localtime(unix_time()))
    stop = StopSignal()
    connect, namespace = address(args)
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        files = RecordingFiles(path, round(args.keep * 1e6))
    except (OSError, RecordingError) as error:
        raise CliError(str(error)) from None
    try:
        with open_session(connect, namespace, wait=_patience(args.wait, stop, connect)) as session:
            return _run(args, files, Link(session, connect, namespace), stop)
    except NoRouter:
        raise CliError("stopped before a router was there") from None
    finally:
        _close(files.recorder)


def _demonstrations(args: argparse.Namespace) -> int:
    """Missions as episodes of a dataset; pyarrow is an extra, and not for every command to load."""
    if args.output is not None:
        raise CliError("-o FILE and --lerobot DIR are two recordings; run two commands")
    if find_spec("pyarrow") is None:
        raise CliError("--lerobot needs the package pyarrow: pip install 'tidybot-zenoh[lerobot]'")
    from cli.demonstrations.command import demonstrate

    stop = StopSignal()
    connect, namespace = address(args)
    try:
        with open_session(connect, namespace, wait=_patience(args.wait, stop, connect)) as session:
            return demonstrate(args, Link(session, connect), stop)
    except NoRouter:
        raise CliError("stopped before a router was there") from None


def _patience(seconds: float, stop: StopSignal, connect: str) -> Callable[[float], bool]:
    """Wait for a router until `seconds` are over (0: as long as it takes) or a signal comes."""
    end = monotonic() + seconds if seconds else float("inf")

    def wait(pause: float) -> bool:
        if monotonic() > end:
            raise CliError(f"nothing answers at {connect}; start the robot with `tidybot up`")
        return stop.wait(pause)

    return wait


def _run(args: argparse.Namespace, files: RecordingFiles, link: Link, stop: StopSignal) -> int:
    recorder = files.recorder
    listener = Listener(link.session)
    tape = Tape(recorder, listener, os.environ.get("TIDYBOT_CLOCK") == "wall")
    line = ProgressLine(sys.stderr)
    print(f"recording {link.connect} into {recorder.path}; Ctrl-C ends it", file=sys.stderr, flush=True)
    end = monotonic() + args.duration if args.duration else float("inf")
    flushed = monotonic()
    try:
        while not stop.is_set() and monotonic() < end:
            if tape.write() < BATCH:
                stop.wait(0.02)
            if monotonic() - flushed > FLUSH:
                flushed = monotonic()
                recorder.flush()
            if files.full:
                recorder = files.turn_over(lambda done: _facts(done, link, tape))
                tape.go_on(recorder)
            line.show(lambda: progress(files.recorder, tape, listener.inbox.qsize()))
        listener.close()
        while tape.write():
            pass
        _facts(recorder, link, tape)
    except OSError as error:
        raise CliError(f"{recorder.path}: {error.strerror}; what was written until then is kept") from None
    line.show(lambda: progress(recorder, tape, 0), last=True)
    return 0


def _facts(recorder: Recorder, link: Link, tape: Tape) -> None:
    """What a replay of the file needs beside its messages."""
    recorder.note("run", facts_of(link, tape))
    recorder.note("settings", settings_of_run())
    _attach(recorder, tape)


def _attach(recorder: Recorder, tape: Tape) -> None:
    """The configuration, world and household of this machine, so that a replay elsewhere runs with the same."""
    now = unix_time()
    for file in sorted(config_dir().glob("*.toml")):
        recorder.attach(f"config/{file.name}", file.read_bytes(), now)
    if tape.status is None:
        return
    try:
        changes = config.overrides(settings_of_run(), ())
        shared = config.load("runtime", config.RuntimeConfig, config_dir(), changes)
        world, household = load_scene(shared.world_file), load_household(shared.household_file)
    except (config.ConfigError, SceneError):
        # A robot that another machine simulates: what it is told is not known here.
        return
    if world.name == tape.status.scene:
        recorder.attach("scene/world.toml", to_toml(world).encode(), now)
        recorder.attach("household/household.toml", to_toml(household).encode(), now)


def _close(recorder: Recorder) -> None:
    try:
        recorder.close()
    except OSError as error:
        raise CliError(
            f"{recorder.path}: {error.strerror}; `tidybot replay {recorder.path} --repair FILE` saves it"
        ) from None
    if not recorder.counts:
        recorder.path.unlink(missing_ok=True)
        print("nothing was heard; no file is kept", file=sys.stderr)


def _cameras(text: str) -> tuple[str, ...]:
    found = tuple(dict.fromkeys(text.split(",")))
    if not set(found) <= set(topics.PICTURES):
        raise argparse.ArgumentTypeError(f"{text!r}: expected {' or '.join(topics.PICTURES)}, or both with a comma")
    return found


def register(commands: "argparse._SubParsersAction[argparse.ArgumentParser]") -> None:
    parser = robot_command(commands, record, "every topic into an MCAP file, until Ctrl-C")
    parser.add_argument("-o", "--output", type=Path, metavar="FILE", help="default: out/run-<time>.mcap")
    parser.add_argument("--duration", type=float, default=0.0, metavar="S", help="wall seconds (default: until Ctrl-C)")
    size = number(1, unit="MB", whole=False)
    parser.add_argument(
        "--keep", type=size, default=0.0, metavar="MB", help="the newest so many MB only, in several files"
    )
    parser.add_argument(
        "--wait", type=float, default=3.0, metavar="S", help="for the robot's router; 0: as long as it takes"
    )
    learning = parser.add_argument_group("demonstrations for learning")
    learning.add_argument(
        "--lerobot", type=Path, metavar="DIR", help="missions as episodes of a LeRobotDataset, new or continued"
    )
    learning.add_argument(
        "--fps", type=number(1, FASTEST), default=10, metavar="N", help="frames a second, 1 to 50 (%(default)s)"
    )
    learning.add_argument(
        "--cameras", type=_cameras, default=tuple(topics.PICTURES), metavar="A,B", help="head, wrist or both (both)"
    )
    learning.add_argument("--all", action="store_true", help="also missions that failed or were cancelled")
