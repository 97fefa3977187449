"""`python -m evaluation.replay FILE --service NAME`: a service fed with a recording and its outputs compared.

`tidybot replay FILE --service NAME` becomes this.
"""

import argparse
import os
import sys
import tempfile
from collections.abc import Iterable
from pathlib import Path

from cli.errors import CliError
from cli.output import ProgressLine
from common import config, topics
from common import messages as m
from common.bus import codec
from common.household import load_household
from common.recording import Recording, RecordingError, Row
from common.scene import SceneError, load_scene
from common.time.clock import monotonic
from evaluation.registry import service_class
from evaluation.replay.comparison import TOLERANCE, Comparison, Timed, compare
from evaluation.replay.player import Player

SLACK = 0.2
"""Tolerance for times [s] outside lockstep, where the replay cannot know in which step a message was seen."""
LOCKSTEP_SLACK = 0.1
"""Tolerance for times [s] of a run in lockstep that a client outside lockstep took part in."""


def prepared(args: argparse.Namespace, workspace: Path) -> Player:
    """The service as it was configured in the run, on the recording.

    Raises:
        CliError: a configuration or a scene that cannot be used.
    """
    name = args.service
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
        file = _file(workspace, "scene") or run.get("scene", "")
        household = load_household(_file(workspace, "household") or file or shared.household_file, directory)
        world = load_scene(file or shared.world_file) if getattr(kind, "KNOWS_WORLD", False) else None
        parameters = config.load(name, kind.CONFIG, directory, changes)
        return Player(kind, parameters, recording, household, _seed(run, shared.seed), world)
    except (config.ConfigError, SceneError) as error:
        raise CliError(str(error)) from None


def _file(workspace: Path, folder: str) -> str:
    files = sorted((workspace / folder).glob("*.toml"))
    return str(files[0]) if files else ""


def _seed(run: dict[str, str], default: int) -> int:
    return int(run.get("seed", default))


def verdicts(player: Player, outputs: list[tuple[float, str, bytes]], slack: float) -> list[Comparison]:
    """One verdict for every topic that the service writes."""
    recorded = _by_key(row for row in player.recording.rows if player.covers(row))
    replayed = _by_key(Row(key, payload, t, wall=0.0) for t, key, payload in outputs)
    found = []
    for topic in player.kind.WRITES:
        old, new = recorded.get(topic.key, []), replayed.get(topic.key, [])
        if old or new:
            found.append(compare(topic, old, new, slack))
    return found


def _by_key(rows: Iterable[Row]) -> dict[str, list[Timed]]:
    """The messages of each key with their times, without what is none."""
    found: dict[str, list[Timed]] = {}
    for row in rows:
        if (message := _decoded(row)) is not None:
            found.setdefault(row.key, []).append((row.t, message))
    return found


def _decoded(row: Row) -> m.Message | None:
    """The message of a row, None when it is none of its topic."""
    topic = topics.BY_KEY.get(row.key)
    if topic is None or row.junk:
        return None
    try:
        message: m.Message = codec.decode(topic, row.payload)
    except codec.DecodeError:
        return None
    return message


def judged(player: Player) -> int:
    """Run the player and print a verdict for each topic; 0 when all are the same, else 1."""
    began, line = monotonic(), ProgressLine(sys.stderr)
    try:
        outputs = player.run(lambda t: line.show(lambda: f"  {t:.1f} s") if sys.stderr.isatty() else None)
    finally:
        player.close()
    slack = 0.0 if player.exact else LOCKSTEP_SLACK if player.lockstep else SLACK
    line.clear()
    found = verdicts(player, outputs, slack)
    if player.recording.torn:
        print(f"the recording is torn ({player.recording.torn})")
    mode = "lockstep" if player.lockstep else "real time"
    print(f"{player.kind.NAME} over {player.seconds:.1f} s of robot time in {monotonic() - began:.1f} s; {mode}, "
          f"numbers within {TOLERANCE:g}, times within {slack:g} s")  # fmt: skip
    print(f"{'topic':30} {'recorded':>9} {'replayed':>9}  verdict")
    for v in found:
        print(f"{v.key:30} {v.recorded:9} {v.replayed:9}  {'same' if v.same else 'differing: ' + v.difference}")
    if not found:
        raise CliError(f"neither the recording nor the replay has anything from {player.kind.NAME}")
    return 0 if all(v.same for v in found) else 1


def main(argv: list[str]) -> int:
    parser = argparse.ArgumentParser(prog="tidybot replay", description=__doc__)
    parser.add_argument("file", type=Path)
    parser.add_argument("--service", required=True)
    parser.add_argument("--set", action="append", default=[])
    args = parser.parse_args(argv)
    try:
        with tempfile.TemporaryDirectory(prefix="tidybot-replay-") as workspace:
            return judged(prepared(args, Path(workspace)))
    except (RecordingError, CliError) as error:
        print(f"tidybot: {error}", file=sys.stderr)
        return 1


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
