"""Recognition on recorded commands: sentence accuracy, false acceptance and speed; the peer is the same model
without the grammar. `python -m bench.speech --limit 20`."""

import argparse
import csv
import random
import sys
import time
from pathlib import Path

from common import config
from common.scene import load_scene
from services.speech.audio import RATE, read_wav
from services.speech.config import SpeechConfig
from services.speech.grammar import spoken
from services.speech.recognise import Ear, command_grammar

ROWS = (("cmd", "clean"), ("cmd", "10"), ("oog", ""), ("near", ""))
CORPUS = Path(__file__).resolve().parents[2] / "shared" / "speech"


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--corpus", type=Path, default=CORPUS)
    parser.add_argument("--limit", type=int, default=30, help="recordings a row, 0 for all")
    parser.add_argument("--errors", action="store_true", help="print what was misheard")
    args = parser.parse_args()
    manifest = args.corpus / "manifest.tsv"
    if not manifest.exists():
        print(f"no recordings at {args.corpus}: nothing measured")
        return 0
    parameters = config.load("speech", SpeechConfig, config.config_dir(), {})
    scene = load_scene("apartment")
    ear = Ear(parameters, scene, command_grammar(parameters, scene))
    with manifest.open(encoding="utf-8") as file:
        recordings = list(csv.DictReader(file, delimiter="\t"))
    random.Random(0).shuffle(recordings)
    print(f"{'recordings':14} {'n':>4} {'exact':>7} {'free':>7} {'accepted':>9} {'x real time':>12}")
    for kind, noise in ROWS:
        rows = [r for r in recordings if r["kind"] == kind and r["snr"].startswith(noise)]
        rows = rows[: args.limit or None]
        exact, free, accepted, heard_seconds, spent = 0, 0, 0, 0.0, 0.0
        for row in rows:
            samples = read_wav(args.corpus / row["file"])
            began = time.perf_counter()
            heard = ear.hear(samples)
            spent += time.perf_counter() - began
            heard_seconds += len(samples) / RATE
            right = heard.verdict == "accept" and heard.text == row["text"]
            exact, free = exact + right, free + (spoken(heard.free) == row["text"])
            accepted += heard.verdict == "accept"
            if args.errors and right != (kind == "cmd"):
                print(f"   {row['file']}: {heard}")
        n = max(1, len(rows))
        name = f"{kind} {noise or 'all'}"
        rate = heard_seconds / max(spent, 1e-9)
        print(f"{name:14} {len(rows):4} {exact / n:7.2f} {free / n:7.2f} {accepted / n:9.2f} {rate:12.1f}", flush=True)
    return 0


if __name__ == "__main__":
    sys.exit(main())
