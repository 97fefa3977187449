"""Recognition on recorded commands, through the code that the service and `tidybot transcribe` use.

Per kind of recording and noise: sentences that are exactly right and accepted; exactly right whatever the verdict; the
peer, which is the same model without the grammar; accepted at all; taken for another sentence without a question
(`wrong`); wake word heard; CPU seconds per second of sound. `python -m bench.speech --limit 0` takes all recordings;
`--voice NAME` those of one voice. `--noise babble --snr 10` mixes the clean ones with noise. The sentences fall into
two halves: parameters are tuned on one (`--half tuning`), the other one (`--half held`) shows what that is worth.

`--everyday 60` takes everyday sentences of tests/data by lot (`--seed`) in the robot's own voice instead, or the
recordings of kind `everyday` of `--corpus`, and tells in how many the planner makes of what was heard what it makes of
the sentence.
"""

import argparse
import csv
import hashlib
import sys
import time
import zlib
from collections import Counter
from pathlib import Path
from random import Random
from typing import Literal

import psutil  # type: ignore[import-untyped]

from bench.speech_noise import KINDS, noisy
from common import config
from common.household import load_household
from common.language.normalise import normalise
from common.messages import ActionPlan, PlanStep
from common.plan_rules import known_world
from common.sound import RATE, Samples, read_wav
from evaluation.everyday.flat import CONFIG, FLAT, HOME, NOW
from evaluation.everyday.sentences import lists
from evaluation.everyday.understanding import planned
from evaluation.person.voice import utter
from evaluation.report.statistics import wilson
from services.brain.config import BrainConfig
from services.planner.grammar import grammar
from services.planner.transcriptions import DOUBTFUL, chosen
from services.planner.world import believed
from services.speech.config import SpeechConfig
from services.speech.recognise.free_text import as_heard
from services.speech.recognise.recogniser import Recognition
from services.speech.recognise.wake_text import without_wake
from services.speech.transcribe import Reader

Outcome = Literal["same", "asked", "asked wrongly", "not understood", "wrong"]
OUTCOMES: tuple[Outcome, ...] = ("same", "asked", "asked wrongly", "not understood", "wrong")
SURE = config.load("brain", BrainConfig, config.DEFAULT_DIR, {}).confirm_below
"""Confidence from which the brain does not ask."""
LISTENING = config.load("speech", SpeechConfig, config.DEFAULT_DIR, {})
ROWS = (
    ("cmd", "clean"), ("cmd", "10"), ("wakecmd", "clean"), ("wakecmd", "10"), ("wake", ""), ("near", ""), ("oog", ""),
)  # fmt: skip
TITLES = "recordings        n   right    (95 %)   exact    free  accepted  wrong   wake  CPU/s"
NOISY_ROWS = (("cmd", "clean"), ("wakecmd", "clean"), ("oog", "clean"))
COLUMNS = ("right", "exact", "free", "accepted", "wrong", "wake")
Row = dict[str, str]
CORPUS = Path(__file__).resolve().parents[2] / "shared" / "speech"
NOTHING = 2
"""Exit status when nothing could be measured."""
MISSING = """bench.speech: no recordings: {}/manifest.tsv is not there, so nothing was measured.
Point --corpus at a directory of WAV files (16 kHz mono) with a manifest.tsv, tab-separated, with the columns
file, text, voice, snr (clean or dB) and kind (cmd, wakecmd, wake, near, oog, everyday). The shared recordings belong in
shared/speech beside the checkout; your own can be made with any recorder."""


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--corpus", type=Path, default=CORPUS)
    parser.add_argument("--limit", type=int, default=30, help="recordings a row, 0 for all")
    parser.add_argument("--only", default="", help="rows whose name begins like this, such as 'cmd 10'")
    parser.add_argument("--half", choices=("tuning", "held"), help="only that half of the sentences")
    parser.add_argument("--voice", default="", help="only recordings of that voice")
    parser.add_argument("--noise", choices=KINDS, help="mix the clean recordings with noise")
    parser.add_argument("--snr", type=float, default=10.0, help="how far the noise is below the words [dB]")
    parser.add_argument("--everyday", type=int, default=0, metavar="N", help="that many everyday sentences instead")
    parser.add_argument("--seed", type=int, default=0, help="of the lot of everyday sentences")
    parser.add_argument("--errors", action="store_true", help="print what was misheard")
    args = parser.parse_args()
    manifest = args.corpus / "manifest.tsv"
    if not manifest.exists():
        print(MISSING.format(args.corpus), file=sys.stderr)
        return NOTHING
    parameters = config.load("speech", SpeechConfig, config.config_dir(), {})
    reader = Reader(parameters, load_household("apartment"))
    with manifest.open(encoding="utf-8") as file:
        recordings = list(csv.DictReader(file, delimiter="\t"))
    Random(0).shuffle(recordings)
    mix = Mixer(args, recordings)
    recordings = [r for r in recordings if args.voice in ("", r["voice"])]
    if args.everyday:
        _everyday(reader, recordings, mix, args)
    else:  # without the voice and the planner, whose memory is not the recogniser's
        _commands(reader, recordings, mix, parameters, args)
        memory = psutil.Process().memory_full_info()
        print(f"memory: {memory.rss / 1e6:.0f} MB resident, {memory.pss / 1e6:.0f} MB proportional")
    return 0


class Mixer:
    """Recordings with the noise that the arguments ask for; babble is made of those that are no commands."""

    def __init__(self, args: argparse.Namespace, recordings: list[Row]) -> None:
        self._corpus, self._kind, self._snr = args.corpus, args.noise, args.snr
        self._talk = [args.corpus / r["file"] for r in recordings if (r["kind"], r["snr"]) == ("oog", "clean")]

    def recorded(self, row: Row) -> Samples:
        """A recording of the corpus."""
        return self.over(read_wav(self._corpus / row["file"]), row["text"])

    def over(self, samples: Samples, text: str) -> Samples:
        """Samples that say `text`, from which the noise is drawn."""
        if not self._kind:
            return samples
        return noisy(samples, self._kind, self._snr, zlib.crc32(text.encode()), self._talk)


def _commands(
    reader: Reader, recordings: list[Row], mix: Mixer, parameters: SpeechConfig, args: argparse.Namespace
) -> None:
    print(TITLES)
    for kind, noise in NOISY_ROWS if args.noise else ROWS:
        name = f"{kind} {args.noise or noise or 'all'}"
        if not name.startswith(args.only):
            continue
        rows = [r for r in recordings if r["kind"] == kind and r["snr"].startswith(noise)]
        rows = [r for r in rows if args.half in (None, half_of(r["text"]))][: args.limit or None]
        counts: Counter[str] = Counter()
        seconds, spent = 1e-9, 0.0
        for row in rows:
            samples = mix.recorded(row)
            began = time.process_time()
            heard, wake = reader(samples)
            spent += time.process_time() - began
            seconds += len(samples) / RATE
            same = heard.text == without_wake(row["text"], parameters.wake)
            taken = heard.verdict == "accept" and bool(heard.text)
            counts.update(right=same and taken, exact=same, free=normalise(heard.free) == row["text"], accepted=taken)
            counts.update(wrong=taken and not same and heard.confidence >= SURE, wake=wake)
            if args.errors and ((same and taken) != kind.endswith("cmd") or wake != kind.startswith("wake")):
                print(f"   {row['file']}: {heard} wake={wake}", flush=True)
        n = max(1, len(rows))
        low, high = wilson(counts["right"], n)
        right, exact, free, accepted, wrong, woken = (counts[key] / n for key in COLUMNS)
        figures = (
            f"{right:7.3f} {low:.2f}-{high:.2f} {exact:7.3f} {free:7.3f} {accepted:9.3f} {wrong:6.3f} {woken:6.2f}"
        )
        print(f"{name:14} {len(rows):4} {figures} {spent / seconds:6.2f}", flush=True)


def _everyday(reader: Reader, recordings: list[Row], mix: Mixer, args: argparse.Namespace) -> None:
    rows = [r for r in recordings if r["kind"] == "everyday"][: args.everyday]
    said = {r["text"]: r for r in rows} if rows else dict.fromkeys(drawn(args.everyday, args.seed))
    outcomes: Counter[Outcome] = Counter()
    for text, row in said.items():
        heard, _ = reader(mix.recorded(row) if row else mix.over(utter(text), text))
        found = outcome(text, heard)
        outcomes[found] += 1
        if args.errors and found != "same":
            print(
                f"   {found}: {text} | {heard.text} ({heard.verdict}, {heard.confidence:.2f}) | {heard.free}",
                flush=True,
            )
    for name in OUTCOMES:
        low, high = wilson(outcomes[name], max(1, len(said)))
        print(f"{name:16} {outcomes[name]:4} of {len(said)}   {low:.2f}-{high:.2f}")


def half_of(sentence: str) -> str:
    """tuning or held, by what is said: the same for every voice and noise."""
    return ("tuning", "held")[hashlib.sha1(sentence.encode()).digest()[0] & 1]


# --- everyday sentences by voice: does the planner make of what was heard what it makes of the typed sentence?
def drawn(count: int, seed: int) -> list[str]:
    """That many everyday sentences at random, of those that are said without anything before."""
    every = dict.fromkeys(row.said for rows in lists().values() for row in rows if row.context == "-")
    return Random(seed).sample(list(every), count)


def outcome(said: str, heard: Recognition) -> Outcome:
    """What comes of a sentence that was `said`: its plan at once or after "Did you say ...?", or another one."""
    command = heard.verdict in ("accept", "ask") and bool(heard.text)
    if (words := heard if command else as_heard(heard, LISTENING)) is None:
        return "not understood"
    weighed = weigh(words)
    if not (command or weighed.steps or weighed.suggestion):
        return "not understood"
    doubted = weighed.suggestion if weighed.detail == DOUBTFUL or not command else ""
    wanted, found = _steps(said), _steps(doubted or words.text)
    if doubted or not command or heard.verdict == "ask" or heard.confidence < SURE:
        return "asked" if found == wanted else "asked wrongly"
    if found == wanted:
        return "same"
    return "wrong" if any(step.action != "say" for step in found) else "not understood"


def weigh(heard: Recognition) -> ActionPlan:
    """What the planner makes of all that was perhaps said."""
    told = known_world(HOME, [thing.label for thing in FLAT], "")
    world = believed(HOME, told, FLAT, (0.0, 0.0, 0.0), NOW)
    return chosen(heard.text, heard.alternatives, lambda text: grammar.plan(text, world, CONFIG), world.names)


def _steps(text: str) -> list[PlanStep]:
    """What the planner makes of a text in the flat of the sentences, after a yes where it asks; empty for nothing."""
    plan = planned(text)
    plan = planned(plan.asks) if plan.asks else plan
    return [*plan.looks, *plan.steps]


if __name__ == "__main__":
    sys.exit(main())
