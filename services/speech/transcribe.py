"""`python -m services.speech.transcribe WAV...`: what the service would understand in recordings, a line a file."""

import argparse
import os
import sys
from pathlib import Path

import msgspec

from common import config
from common.household import Household, load_household
from common.language.pattern import PatternError
from common.process.host import BAD_CONFIGURATION
from common.runtime import StartError
from common.scene import SceneError
from common.sound import AudioError, Samples, read_wav
from common.speech_weights import WeightsError
from services.speech.config import SpeechConfig
from services.speech.listen.wake_word import WakeWord
from services.speech.recognise.front_end import FrontEnd
from services.speech.recognise.recogniser import Recognition, grammars


class Reader:
    """Recordings of one utterance each, taken as meant for the robot with or without the wake word."""

    def __init__(self, parameters: SpeechConfig, household: Household) -> None:
        self._threshold = parameters.wake_threshold
        self._front_end = FrontEnd(parameters, household, grammars(parameters, household))
        self._wake = WakeWord() if parameters.wake_word else None

    def __call__(self, samples: Samples) -> tuple[Recognition, bool]:
        """What 16 kHz samples (n,) say, and whether the wake word is in them."""
        score = 0.0
        if self._wake:
            self._wake.restart()
            score = self._wake(samples)
        woken = score >= self._threshold
        found = self._front_end.recognise(samples, "woken" if woken else "command", score)
        return found, woken and not found.mistaken


def main() -> int:
    """Exit status 0, 1 when a file could not be read, 2 for a bad configuration."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("wav", nargs="+", type=Path)
    parser.add_argument("--json", action="store_true")
    args = parser.parse_args()
    try:
        changes = config.overrides(os.environ, ())
        directory = config.config_dir()
        shared = config.load("runtime", config.RuntimeConfig, directory, changes)
        parameters = config.load("speech", SpeechConfig, directory, changes)
        household = load_household(shared.household_file, directory)
        reader = Reader(parameters, household)
    except (config.ConfigError, SceneError, PatternError, StartError, WeightsError) as error:
        print(f"transcribe: {error}", file=sys.stderr)
        return BAD_CONFIGURATION
    failed = False
    for path in args.wav:
        try:
            found, woken = reader(read_wav(path))
        except AudioError as error:
            print(f"transcribe: {error}", file=sys.stderr)
            failed = True
            continue
        accepted = found.verdict == "accept" and bool(found.text)
        row: dict[str, object] = {"file": str(path), "text": found.text, "accepted": accepted}
        row |= {"confidence": found.confidence, "wake": woken}
        if args.json:
            print(msgspec.json.encode(row).decode(), flush=True)
        else:
            wake = ", wake word" if woken else ""
            print(f"{path.name}: {found.text or '-'} ({found.verdict}, {found.confidence:.2f}{wake})", flush=True)
    return int(failed)


if __name__ == "__main__":
    sys.exit(main())
