"""Recognition on recorded commands, through the code that the service and `tidybot transcribe` use.

Per kind of recording and noise: sentences that are exactly right and accepted; exactly right whatever the verdict; the
peer, which is the same model without the grammar; accepted at all; wake word heard; CPU seconds per second of sound.
`python -m bench.speech --limit 0` takes all recordings; `--shard 2/4` a quarter of them. The sentences fall into two
halves: parameters are tuned on one (`--half tuning`), the other one (`--half held`) shows what that is worth.
"""

import argparse
import csv
import hashlib
import random
import sys
import time
from pathlib import Path

import psutil  # type: ignore[import-untyped]

from common import config
from common.household import load_household
from common.language.normalise import normalise
from services.speech.audio import RATE, read_wav
from services.speech.config import SpeechConfig
from services.speech.recognise.front_end import without_wake
from services.speech.transcribe import Reader

ROWS = (
    ("cmd", "clean"), ("cmd", "10"), ("wakecmd", "clean"), ("wakecmd", "10"), ("wake", ""), ("near", ""), ("oog", ""),
)  # fmt: skip
CORPUS = Path(__file__).resolve().parents[2] / "shared" / "speech"
NOTHING = 2
"""Exit status when nothing could be measured."""
MISSING = """bench.speech: no recordings: {}/manifest.tsv is not there, so nothing was measured.
Point --corpus at a directory of WAV files (16 kHz mono) with a manifest.tsv, tab-separated, with the columns
file, text, voice, snr (clean or dB) and kind (cmd, wakecmd, wake, near, oog). The shared recordings belong in
shared/speech beside the checkout; your own can be made with any recorder."""


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--corpus", type=Path, default=CORPUS)
    parser.add_argument("--limit", type=int, default=30, help="recordings a row, 0 for all")
    parser.add_argument("--only", default="", help="rows whose name begins like this, such as 'cmd 10'")
    parser.add_argument("--half", choices=("tuning", "held"), help="only that half of the sentences")
    parser.add_argument("--shard", default="1/1", help="such as 2/4: the second quarter of the recordings")
    parser.add_argument("--errors", action="store_true", help="print what was misheard")
    args = parser.parse_args()
    shard, shards = (int(part) for part in args.shard.split("/"))
    manifest = args.corpus / "manifest.tsv"
    if not manifest.exists():
        print(MISSING.format(args.corpus), file=sys.stderr)
        return NOTHING
    parameters = config.load("speech", SpeechConfig, config.config_dir(), {})
    reader = Reader(parameters, load_household("apartment"))
    with manifest.open(encoding="utf-8") as file:
        recordings = list(csv.DictReader(file, delimiter="\t"))
    random.Random(0).shuffle(recordings)
    print(f"{'recordings':14} {'n':>4} {'right':>7} {'exact':>7} {'free':>7} {'accepted':>9} {'wake':>6} {'CPU/s':>7}")
    for kind, noise in ROWS:
        name = f"{kind} {noise or 'all'}"
        if not name.startswith(args.only):
            continue
        rows = [r for r in recordings if r["kind"] == kind and r["snr"].startswith(noise)]
        rows = [r for r in rows if args.half in (None, half_of(r["text"]))][: args.limit or None][shard - 1 :: shards]
        right, exact, free, accepted, woken, heard_seconds, spent = 0, 0, 0, 0, 0, 0.0, 0.0
        for row in rows:
            samples = read_wav(args.corpus / row["file"])
            began = time.process_time()
            heard, wake = reader(samples)
            spent += time.process_time() - began
            heard_seconds += len(samples) / RATE
            same = heard.text == without_wake(row["text"], parameters.wake)
            taken = heard.verdict == "accept" and bool(heard.text)
            right, exact, free = right + (same and taken), exact + same, free + (normalise(heard.free) == row["text"])
            accepted, woken = accepted + taken, woken + wake
            if args.errors and ((same and taken) != kind.endswith("cmd") or wake != kind.startswith("wake")):
                print(f"   {row['file']}: {heard} wake={wake}", flush=True)
        n = max(1, len(rows))
        figures = f"{right / n:7.3f} {exact / n:7.3f} {free / n:7.3f} {accepted / n:9.3f} {woken / n:6.2f}"
        print(f"{name:14} {len(rows):4} {figures} {spent / max(heard_seconds, 1e-9):7.2f}", flush=True)
    memory = psutil.Process().memory_full_info()
    print(f"memory: {memory.rss / 1e6:.0f} MB resident, {memory.pss / 1e6:.0f} MB proportional")
    return 0


def half_of(sentence: str) -> str:
    """tuning or held, by what is said: the same for every voice and noise."""
    return ("tuning", "held")[hashlib.sha1(sentence.encode()).digest()[0] & 1]


if __name__ == "__main__":
    sys.exit(main())
