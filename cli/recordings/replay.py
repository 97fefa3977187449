"""`tidybot replay`: what is in a recording, a mission of it; or a service fed with it and compared."""

import argparse
from pathlib import Path

from cli.errors import CliError, checked
from cli.processes.programs import become
from cli.processes.services import NAMES
from cli.recordings import export as mission_export
from cli.recordings.copies import repair
from common.recording import RAW, Recording, RecordingError


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


def replay(args: argparse.Namespace) -> int:
    try:
        if args.repair:
            print(f"{repair(args.file, args.repair)} messages into {args.repair}")
            return 0
        if args.export:
            try:
                mission_export.export(args.file, args.export, args.mission)
            except OSError as error:
                raise CliError(f"{args.export}: {error.strerror or error}") from None
            return 0
        if args.info or not args.service:
            return info(args.file)
    except RecordingError as error:
        raise CliError(str(error)) from None
    return _service(args)


def _service(args: argparse.Namespace) -> int:
    """Become `python -m evaluation.replay` with the words that concern it."""
    checked(args.service, [n for n in NAMES if n != "router"], "service")
    changes = (word for s in args.set for word in ("--set", s))
    become("evaluation.replay", str(args.file), "--service", args.service, *changes)


def register(commands: "argparse._SubParsersAction[argparse.ArgumentParser]") -> None:
    parser = commands.add_parser("replay", help="what a recording holds; or feed it to one service and compare")
    parser.add_argument("file", type=Path, metavar="FILE")
    parser.add_argument("--info", action="store_true", help="summarise the file (the default without --service)")
    parser.add_argument("--service", metavar="NAME", help="replay to this service; exit 1 when its outputs differ")
    parser.add_argument("--repair", type=Path, metavar="OUT", help="write what a torn file holds into a whole one")
    parser.add_argument("--export", type=Path, metavar="OUT", help="write one mission as a recording of its own")
    parser.add_argument("--mission", default="last", metavar="ID", help="which one (default: the last)")
    parser.add_argument("--set", action="append", default=[], metavar="section.key=value", help="override a parameter")
    parser.set_defaults(run=replay)
