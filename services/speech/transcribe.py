"""`python -m services.speech.transcribe WAV...`: what the service would understand in recordings, a line a file."""

import argparse
import os
import sys
from pathlib import Path

import msgspec

from common import config
from common.runtime import BAD_CONFIGURATION
from common.scene import SceneError, load_scene
from services.speech.audio import AudioError, read_wav
from services.speech.config import SpeechConfig
from services.speech.grammar import GrammarError
from services.speech.recognise import Ear, command_grammar


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
        parameters, scene = config.load("speech", SpeechConfig, directory, changes), load_scene(shared.scene)
        ear = Ear(parameters, scene, command_grammar(parameters, scene))
    except (config.ConfigError, SceneError, GrammarError, FileNotFoundError) as error:
        print(f"transcribe: {error}", file=sys.stderr)
        return BAD_CONFIGURATION
    failed = False
    for path in args.wav:
        try:
            heard = ear.hear(read_wav(path))
        except AudioError as error:
            print(f"transcribe: {error}", file=sys.stderr)
            failed = True
            continue
        accepted = heard.verdict == "accept"
        row: dict[str, object] = {"file": str(path), "text": heard.text, "accepted": accepted}
        row |= {"confidence": heard.confidence, "wake": False}
        if args.json:
            print(msgspec.json.encode(row).decode(), flush=True)
        else:
            print(f"{path.name}: {heard.text or '-'} ({heard.verdict}, {heard.confidence:.2f})", flush=True)
    return int(failed)


if __name__ == "__main__":
    sys.exit(main())
