"""`tidybot replay`: what is in a recording, or a service fed with it and its outputs compared."""

import argparse
import os
import sys
import tempfile
from collections.abc import Callable
from pathlib import Path

from cli import lookback
from cli.comparison import Timed, Verdict, compare, decoded
from cli.errors import CliError, checked, port_number
from cli.player import Player, service_class
from cli.services import NAMES
from common import config, topics
from common.recording import RAW, Recording, RecordingError, repair
from common.scene import SceneError, load_scene
from common.time.clock import monotonic

SLACK = 0.2  # outside lockstep the replay cannot know in which step a message was seen
LOCKSTEP_SLACK = 0.1


def info(path: Path) -> int:
    """Print what the file holds."""
    recording = Recording(path, lambda key: False)
    run = recording.facts.get("run", {})
    spans = recording.spans
    if recording.torn:
        print(f"torn: {recording.torn}; `tidybot replay {path} --repair FILE` writes a whole one")
    first = min((s.first for s in spans.values()), default=0.0)
    last = max((s.last for s in spans.values()), default=0.0)
    total = sum(s.count for s in spans.values())
    print(f"{path}  {path.stat().st_size / 1e6:.1f} MB  {total} messages  robot time {first:.1f} to {last:.1f} s")
    if run:
        kind = "lockstep" if run.get("lockstep") == "true" else "real time"
        print(f"scene {run.get('scene', '?')}, seed {run.get('seed', '?')}, {kind}, speed {run.get('speed', '?')}")
    for name, value in sorted(recording.facts.get("settings", {}).items()):
        print(f"  {name}={value}")
    print(f"{'key':32} {'messages':>9} {'Hz':>7} {'kB':>9} {'from':>8} {'to':>8}")
    for key, s in sorted(spans.items()):
        rate = f"{(s.count - 1) / (s.last - s.first):7.1f}" if s.last > s.first else f"{'':7}"
        note = "  (no messages of this topic)" if key.endswith(RAW) else ""
        print(f"{key:32} {s.count:9} {rate} {s.size / 1000:9.1f} {s.first:8.2f} {s.last:8.2f}{note}")
    return 0


def prepared(args: argparse.Namespace, workspace: Path) -> Player:
    """The service as it was configured in the run, on the recording.

    Raises:
        CliError: an unknown service, a configuration or a scene that cannot be used.
    """
    name = checked(args.service, [n for n in NAMES if n != "router"], "service")
    kind = service_class(name)
    keys = {t.key for t in (*kind.READS, *kind.WRITES)} | {"sim/ack", "sim/clock"}
    recording = Recording(args.file, lambda key: key in keys or key.startswith("service/"))
    for file, data in recording.files.items():
        target = workspace / file
        target.parent.mkdir(parents=True, exist_ok=True)
        target.write_bytes(data)
    directory = workspace / "config" if (workspace / "config").exists() else config.config_dir()
    os.environ["TIDYBOT_CONFIG_DIR"] = str(directory)
    os.environ["TIDYBOT_RUN_DIR"] = str(workspace / "run")  # no journal of the real robot may be touched
    run = recording.facts.get("run", {})
    try:
        changes = config.overrides(recording.facts.get("settings", {}), args.set)
        shared = config.load("runtime", config.RuntimeConfig, directory, changes)
        scene = load_scene(_scene(workspace) or run.get("scene") or shared.scene)
        return Player(
            kind, config.load(name, kind.CONFIG, directory, changes), recording, scene, _seed(run, shared.seed)
        )
    except (config.ConfigError, SceneError) as error:
        raise CliError(str(error)) from None


def _scene(workspace: Path) -> str:
    files = sorted((workspace / "scene").glob("*.toml"))
    return str(files[0]) if files else ""


def _seed(run: dict[str, str], default: int) -> int:
    return int(run.get("seed", default))


def verdicts(player: Player, outputs: list[tuple[float, str, bytes]], tolerance: float, slack: float) -> list[Verdict]:
    """One verdict for every topic that the service writes."""
    recorded: dict[str, list[Timed]] = {}
    for row in player.recording.rows:
        topic = topics.BY_KEY.get(row.key)
        message = None if row.junk or topic is None else decoded(row.key, row.payload)
        if message is not None and player.covers(row):
            recorded.setdefault(row.key, []).append((row.t, message))
    replayed: dict[str, list[Timed]] = {}
    for t, key, payload in outputs:
        message = decoded(key, payload)
        if message is not None:
            replayed.setdefault(key, []).append((t, message))
    found = []
    for topic in player.kind.WRITES:
        old, new = recorded.get(topic.key, []), replayed.get(topic.key, [])
        if old or new:
            found.append(compare(topic, old, new, tolerance, slack))
    return found


def replay(args: argparse.Namespace) -> int:
    try:
        if args.repair:
            print(f"{repair(args.file, args.repair)} messages into {args.repair}")
            return 0
        if args.view:
            return lookback.view(args.file, args.port, args.at)
        if args.export:
            try:
                lookback.export(args.file, args.export, args.mission)
            except OSError as error:
                raise CliError(f"{args.export}: {error.strerror or error}") from None
            return 0
        if args.info or not args.service:
            return info(args.file)
        with tempfile.TemporaryDirectory(prefix="tidybot-replay-") as workspace:
            return _run(args, prepared(args, Path(workspace)))
    except RecordingError as error:
        raise CliError(str(error)) from None


def _run(args: argparse.Namespace, player: Player) -> int:
    began = monotonic()
    try:
        outputs = player.run(_progress())
    finally:
        player.close()
    slack = (
        args.slack if args.slack is not None else 0.0 if player.exact else LOCKSTEP_SLACK if player.lockstep else SLACK
    )
    if sys.stderr.isatty():
        print("\r\033[K", end="", file=sys.stderr)
    found = verdicts(player, outputs, args.tolerance, slack)
    if player.recording.torn:
        print(f"the recording is torn ({player.recording.torn})")
    mode = "lockstep" if player.lockstep else "real time"
    print(f"{player.kind.NAME} over {player.seconds:.1f} s of robot time in {monotonic() - began:.1f} s; {mode}, "
          f"numbers within {args.tolerance:g}, times within {slack:g} s")  # fmt: skip
    print(f"{'topic':30} {'recorded':>9} {'replayed':>9}  verdict")
    for v in found:
        print(f"{v.key:30} {v.recorded:9} {v.replayed:9}  {'same' if v.same else 'differing: ' + v.difference}")
    if not found:
        raise CliError(f"neither the recording nor the replay has anything from {player.kind.NAME}")
    return 0 if all(v.same for v in found) else 1


def _progress() -> Callable[[float], None]:
    due = [0.0]

    def show(t: float) -> None:
        if sys.stderr.isatty() and monotonic() > due[0]:
            due[0] = monotonic() + 0.2
            print(f"\r\033[K  {t:.1f} s", end="", file=sys.stderr, flush=True)

    return show


def register(commands: "argparse._SubParsersAction[argparse.ArgumentParser]") -> None:
    parser = commands.add_parser("replay", help="what a recording holds; or feed it to one service and compare")
    parser.add_argument("file", type=Path, metavar="FILE")
    parser.add_argument("--info", action="store_true", help="summarise the file (the default without --service)")
    parser.add_argument("--service", metavar="NAME", help="replay to this service; exit 1 when its outputs differ")
    parser.add_argument("--repair", type=Path, metavar="OUT", help="write what a torn file holds into a whole one")
    parser.add_argument("--view", action="store_true", help="the operator's page on it, with a time slider")
    parser.add_argument("--port", type=port_number, default=8080, help="of that page (default %(default)s)")
    parser.add_argument("--at", type=float, metavar="S", help="begin there, paused [s of robot time]")
    parser.add_argument(
        "--export", type=Path, metavar="OUT",
        help="one mission as a recording (.mcap), a film (.mp4, .webp, .gif) or its timeline (.html)",
    )  # fmt: skip
    parser.add_argument("--mission", default="last", metavar="ID", help="which one (default: the last)")
    parser.add_argument("--tolerance", type=float, default=1e-9, metavar="X", help="for numbers (default %(default)s)")
    parser.add_argument(
        "--slack", type=float, metavar="S",
        help=f"for times; default 0 for a lockstep run, {LOCKSTEP_SLACK} when a client took part, {SLACK} in real time",
    )  # fmt: skip
    parser.add_argument("--set", action="append", default=[], metavar="section.key=value", help="override a parameter")
    parser.set_defaults(run=replay)
