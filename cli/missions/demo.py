"""`tidybot demo`: the whole flow once, from a recorded voice to an object delivered, judged by physics."""

import argparse
import os
import shutil
import sys
import uuid
from pathlib import Path

from cli.errors import CliError, near, port_number
from cli.link import Link, Subscription
from cli.missions.audio import Player, recorded
from cli.missions.conversation import ACCEPT, Conversation, speak_into, typed
from cli.missions.verdict import Verdict, Witness
from cli.output import NewStates, ProgressLine
from cli.processes.plan import Plan, add_start_options
from cli.processes.ports import free_port, port_is_free
from cli.processes.programs import said_by
from cli.processes.supervision import Supervision, run_dir
from cli.processes.up import Stopped, bring_up, check_free, interruptible
from common import messages as m
from common import topics
from common.bus.session import open_session
from common.installation import ROOT, shipped, workspace
from common.scene import Scene, SceneError, load_scene
from common.security.keys import OFF
from common.time.clock import monotonic
from judge.observer import WATCH

VOICE = shipped("audio") / "bring_me_the_red_mug.wav"
YES = shipped("audio") / "yes.wav"
SPOKEN = "red mug"
OUT = (workspace() or Path.cwd()) / "out"
PICTURE = 60.0
"""Time [s] for the picture at the end; chosen: far above what drawing takes."""


class Screen:
    """States on lines of their own, and below them one line of progress."""

    def __init__(self) -> None:
        self._line = ProgressLine(sys.stdout)
        self._states = NewStates()
        self._began = monotonic()
        self._ended = 0.0
        self.robot = self._first = 0.0

    def say(self, text: str) -> None:
        self._line.clear()
        print(text, flush=True)

    def state(self, state: m.BrainState) -> None:
        if line := self._states.line(state):
            self.say(line)

    def start(self, robot: float) -> None:
        self._began, self._first, self.robot = monotonic(), robot, robot

    def finish(self, robot: float) -> None:
        self.robot, self._ended = robot, monotonic()

    def times(self) -> str:
        wall = (self._ended or monotonic()) - self._began
        robot = self.robot - self._first
        return f"robot time {robot:.1f} s, wall time {wall:.1f} s, {robot / max(wall, 1e-3):.1f}x real time"

    def progress(self, robot: float) -> None:
        self.robot = max(self.robot, robot)
        self._line.show(lambda: f"  ... {self.times()}")


class Demo:
    """One demonstration against a robot that is up."""

    def __init__(self, link: Link, screen: Screen, scene: Scene, thing: str) -> None:
        self._link, self._screen = link, screen
        self._speech = Subscription(link, topics.SPEECH_STATUS)
        self._answered = ""
        self._witness = Witness(link, scene, thing)

    def perform(self, text: str, chunks: list[bytes], timeout: float) -> Verdict:
        """Command, follow, judge.

        Raises:
            CliError: the command was not accepted or never ended.
        """
        self._witness.begin()
        self._screen.start(self._witness.now)
        talk = Conversation(self._link, self._screen.state)
        if chunks:
            mission_id, why = speak_into(self._link, talk, chunks)
        else:
            self._link.send(topics.VOICE_COMMAND, typed(text, "demo"))
            mission_id, why = talk.accepted(ACCEPT), "the brain started no mission"
        if not mission_id:
            raise CliError(f"the command was not accepted: {why}")
        outcome = talk.outcome(timeout, lambda: self._meanwhile(talk))
        self._screen.say(f"watching on for {WATCH:.0f} s of robot time")
        verdict = self._witness.judge()
        self._screen.finish(self._witness.now)
        if outcome.outcome != "delivered":
            said = f"the brain reports {outcome.outcome}: {outcome.reason}"
            return Verdict(False, f"{said}; {verdict.why}")
        return verdict

    def _meanwhile(self, talk: Conversation) -> None:
        """Say yes, aloud, when the robot asks whether it heard right; look at the objects."""
        status = self._speech.next(0.0) or self._speech.last
        asks = talk.state.state == "CONFIRMING" and status is not None and status.state == "listening"
        if asks and status is not None and status.goal_id != self._answered:
            self._answered = status.goal_id
            self._screen.say(f'{"":13}"yes" from {YES.name}')
            Player(self._link, recorded(YES)).play()
        self._witness.look()
        self._screen.progress(self._witness.now)


def take_picture(plan: Plan, path: Path) -> str:
    """A picture of the scene as it is now; what was done about it."""
    path.parent.mkdir(parents=True, exist_ok=True)
    try:
        said_by("services.camera.picture", str(path), environ=plan.environ, timeout=PICTURE)
    except CliError as error:
        return f"no picture: {error}"
    return f"picture: {path.relative_to(ROOT) if path.is_relative_to(ROOT) else path}"


def troubles(supervision: Supervision, names: list[str]) -> list[str]:
    """The last warnings and errors of every service."""
    found = []
    for name in names:
        lines = [x for x in supervision.tail(name, 400) if "ERROR" in x[:24] or "WARNING" in x[:24] or "Error" in x]
        found += lines[-3:]
    return found


def choose(args: argparse.Namespace, scene: Scene) -> tuple[str, str, Path | None]:
    """The object's name in the scene, the sentence, and the recording to play (None: typed).

    Raises:
        CliError: no such object, or no such recording.
    """
    spec = scene.object(args.object)
    if spec is None:
        raise CliError(
            f"the scene {scene.name} has no {args.object!r}{near(args.object, [o.name for o in scene.objects])}"
        )
    text = f"bring me the {args.object}"
    if args.wav is not None:
        return spec.name, text, args.wav
    return spec.name, text, VOICE if args.object == SPOKEN and not args.typed else None


def demo(args: argparse.Namespace) -> int:
    args.port = args.port or (7447 if port_is_free(7447) else free_port())
    args.namespace = f"demo-{uuid.uuid4().hex[:6]}" if args.port != 7447 else ""
    args.only, args.keys = "", OFF if args.namespace and "TIDYBOT_KEYS" not in os.environ else None
    try:
        scene = load_scene(args.world or args.scene or "apartment")
    except SceneError as error:
        raise CliError(str(error)) from None
    thing, text, recording = choose(args, scene)
    chunks = recorded(recording) if recording else []
    plan, screen = Plan(args), Screen()
    supervision = Supervision(run_dir() / f"demo-{uuid.uuid4().hex[:8]}")
    check_free(supervision, plan)
    verdict, good = Verdict(False, "nothing was done"), False
    try:
        with interruptible():
            screen.say(f"starting on {plan.connect}, speed {plan.speed}, seed {args.seed or 0}")
            screen.say(f"ready in {bring_up(supervision, plan, screen.say):.1f} s")
            screen.say(f'"{text}" ' + (f"from {recording.name}" if recording else "typed"))
            with open_session(plan.connect, plan.namespace) as session:
                link = Link(session, plan.connect)
                verdict = Demo(link, screen, scene, thing).perform(text, chunks, args.timeout)
                screen.say(take_picture(plan, args.out.resolve()))
            good = verdict.delivered
    except CliError as error:
        verdict = Verdict(False, str(error))
    except Stopped:
        screen.say("stopped")
        return 130
    finally:
        if not good:
            for line in troubles(supervision, plan.names):
                screen.say(f"    {line}")
        supervision.stop()
        _keep_logs(supervision, good)
    screen.say(f"{'DELIVERED' if good else 'NOT DELIVERED'}: {verdict.why}")
    screen.say(screen.times())
    if not good:
        screen.say(f"logs: {OUT / 'demo-logs'}")
    return 0 if good else 1


def _keep_logs(supervision: Supervision, good: bool) -> None:
    kept = OUT / "demo-logs"
    if not good and (supervision.directory / "logs").exists():
        shutil.rmtree(kept, ignore_errors=True)
        shutil.copytree(supervision.directory / "logs", kept)
    shutil.rmtree(supervision.directory, ignore_errors=True)


def register(commands: "argparse._SubParsersAction[argparse.ArgumentParser]") -> None:
    parser = commands.add_parser("demo", help="the whole flow once: voice in, object delivered, judged by physics")
    add_start_options(parser)
    parser.add_argument("--object", default=SPOKEN, metavar="NAME", help="what to bring (default: %(default)s)")
    parser.add_argument("--wav", type=Path, metavar="FILE", help="another recording of the command")
    parser.add_argument("--typed", action="store_true", help="type the command instead of playing a recording")
    parser.add_argument("--without", default="", metavar="A,B", help="leave these services out")
    parser.add_argument("--port", type=port_number, default=0, help="default: 7447, or a free one if in use")
    parser.add_argument("--timeout", type=float, default=900.0, metavar="S", help="wall time (default %(default)s)")
    parser.add_argument("--out", type=Path, default=OUT / "demo.png", metavar="FILE", help="the picture")
    parser.set_defaults(run=demo)
