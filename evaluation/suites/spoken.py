"""The suite of spoken commands: recorded or synthetic voices in a room, recognised and carried out.

A directory of recordings has a `manifest.tsv` with the columns file, text, voice, snr and kind. Of it, clean sentences
are taken that `SENTENCES` knows what to make of; answers come in the same voice where it has them.
"""

import csv
from pathlib import Path

import msgspec

from cli.errors import CliError
from common.scene import Scene
from common.sound import AudioError, read_wav
from evaluation.case import Case, Line, Speaker
from evaluation.suites.blocks import VLA, WORDINGS, flat, pick, random
from judge.effects import Effect
from judge.evidence import Want

SNR = 20.0
"""Signal-to-noise ratio [dB] of a quiet living room: speech of 60 dB at one metre over a hum of 40 dB."""
PACES = (0.92, 0.96, 1.0, 1.04, 1.08)
"""How fast, and with it how high, the synthetic voice speaks: within a semitone and a half of its own pitch."""
ANSWERS = ("hey jarvis", "yes", "yes please", "no", "no thanks", "cancel", "stop")
MANIFEST = "manifest.tsv"
HERE = Path(__file__).resolve().parents[3] / "shared" / "speech"
"""Recordings that lie beside the checkout are used when they are there."""
STILL = Effect("still")


class Sentence(msgspec.Struct, frozen=True):
    """What a recorded sentence asks for in the flat, as wants or effects; `thing` is what the person names if asked."""

    wants: tuple[Want, ...] = ()
    effects: tuple[Effect, ...] = ()


def _bring(thing: str, *goals: str) -> Sentence:
    return Sentence((Want(thing, goals or ("delivery tray",)),))


def _say(text: str) -> Sentence:
    return Sentence(effects=(Effect("says", text), STILL))


SENTENCES: dict[str, Sentence] = {
    "bring me the red mug": _bring("red mug"),
    "bring me a bottle of water": _bring("blue bottle"),
    "put the green bottle on the shelf": _bring("green bottle", "bookshelf"),
    "throw the can in the bin": _bring("red can", "bin"),
    "pick up the blue cup": Sentence(effects=(Effect("holds", "blue mug"),)),
    "where is the red ball": Sentence(effects=(Effect("tells where", "red ball"),)),
    "what do you see": Sentence(effects=(Effect("tells what it sees"), STILL)),
    "go to the kitchen": Sentence(effects=(Effect("ends", "kitchen"),)),
    "go to the living room": Sentence(effects=(Effect("ends", "living room"),)),
    "go back to the dock": Sentence(effects=(Effect("ends", "home"),)),
    "come here": Sentence(effects=(Effect("ends", "home"),)),
    "wait": Sentence(effects=(STILL,)),
    "open the drawer": _say("I cannot open or close"),
    "close the fridge": _say("I cannot open or close"),
    "follow me": _say("I cannot follow people"),
    "put the apple in the bowl": _say("I cannot put things on or in the bowl"),
    "hand me the phone": Sentence(effects=(Effect("says", "I could not find the phone"),)),
    "find my keys": Sentence(effects=(Effect("says", "I could not find the keys"),)),
}
"""Of the shared recordings, those that have one outcome in every layout of the flat."""


class Corpus(msgspec.Struct, frozen=True):
    """Per voice the sentences it can say, as files."""

    voices: dict[str, dict[str, Path]]


def read_corpus(directory: Path) -> Corpus:
    """The clean recordings of a directory.

    Raises:
        CliError: no manifest, a row that makes no sense, or nothing in it that the robot could do.
    """
    path = directory / MANIFEST
    try:
        with path.open(encoding="utf-8", newline="") as file:
            rows = list(csv.DictReader(file, delimiter="\t"))
    except (OSError, UnicodeDecodeError, csv.Error) as error:
        reason = getattr(error, "strerror", None) or error
        raise CliError(f"{path}: {reason}; --voices wants a directory with WAV files and a {MANIFEST}") from None
    voices: dict[str, dict[str, Path]] = {}
    for number, row in enumerate(rows, 2):
        if not all(row.get(column) for column in ("file", "text", "voice")):
            raise CliError(f"{path}:{number}: expected the columns file, text, voice, snr, kind, tab-separated")
        if (row.get("snr") or "clean") == "clean":
            voices.setdefault(row["voice"], {})[row["text"].lower()] = directory / row["file"]
    able = {voice: said for voice, said in voices.items() if SENTENCES.keys() & said.keys()}
    if not able:
        known = "; ".join(SENTENCES)
        raise CliError(f"{path}: no clean recording of a command that this suite can judge: {known}")
    return Corpus(able)


def spoken(seed: int, corpus: Corpus | None = None, snr: float | None = None) -> Case:
    """A voice and a sentence by the seed: of the corpus in turn, else a random thing to fetch in the robot's voice."""
    snr = SNR if snr is None else snr
    if corpus is None:
        return _synthetic(seed, snr)
    scene, rng = flat(), random(seed, 7)
    name = sorted(corpus.voices)[seed % len(corpus.voices)]
    files = corpus.voices[name]
    able = sorted(SENTENCES.keys() & files.keys())
    said = able[int(rng.integers(len(able)))]
    speaker = Speaker(name, {t: _samples(files[t]) for t in (said, *ANSWERS) if t in files}, room=True)
    return _case(seed, said, SENTENCES[said], speaker, snr, scene)


def _synthetic(seed: int, snr: float) -> Case:
    scene, rng = flat(), random(seed, 8)
    spec = pick(rng, scene, seed)
    said = WORDINGS[int(rng.integers(len(WORDINGS)))].format(spec.name)
    pace = PACES[int(rng.integers(len(PACES)))]
    return _case(
        seed, said, _bring(spec.name, scene.delivery), Speaker(f"pace {pace}", pace=pace, room=True), snr, scene
    )


def _case(seed: int, said: str, meant: Sentence, speaker: Speaker, snr: float, scene: Scene) -> Case:
    things = [w.thing for w in meant.wants] + [e.what for e in meant.effects if scene.object(e.what)]
    return Case(
        suite="spoken", seed=seed, name=speaker.name, command=said, lines=(Line(said),), wants=meant.wants,
        effects=meant.effects, expect="shown", thing=things[0] if things else "", spoken=True, noise=snr,
        speaker=speaker, settings=(VLA,),
    )  # fmt: skip


def _samples(path: Path) -> bytes:
    try:
        return read_wav(path).astype("<i2").tobytes()
    except (AudioError, OSError) as error:
        raise CliError(f"{path}: {error}") from None
