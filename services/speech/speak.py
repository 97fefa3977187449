"""Text to speech: Hibari's bundled voice, on the bus as `audio/out` and on speakers where there are any."""

import re
from typing import Any

import numpy as np

from common.runtime import StartError
from services.speech.audio import RATE, Samples, resample
from services.speech.weights import return_memory, session

MAX_CHARACTERS = 400
MAX_DIGITS = 20
LONG_NUMBER = re.compile(r"\d{7,}")


class Voice:
    """Loads in seconds and speaks in milliseconds: make it in the worker."""

    def __init__(self) -> None:
        from hibari import SAMPLE_RATE

        from services.speech.pronounce import LeanHibari

        self._voice, self._rate = LeanHibari(session), int(SAMPLE_RATE)
        self.speak("ready")  # what else it needs it loads with the first word
        return_memory()

    def speak(self, text: str) -> Samples:
        """16 kHz samples of the spoken text, with a short silence after it."""
        # The voice stumbles over numbers beyond its words for thousands and millions: digit by digit then.
        words = LONG_NUMBER.sub(lambda found: " ".join(found[0][:MAX_DIGITS]), text[:MAX_CHARACTERS])
        pause = np.zeros(RATE // 5, np.int16)
        try:
            audio = np.asarray(self._voice(words, seed=0), dtype=np.float32)
        except (LookupError, ValueError, TypeError, ArithmeticError, RecursionError):
            return pause  # a text that the library cannot pronounce must not silence the robot for good
        return np.concatenate([resample(audio * 32000, self._rate), pause])


class Speakers:
    """The default sound card."""

    def __init__(self) -> None:
        self._card = sound_card("speakers")

    def play(self, samples: Samples) -> None:
        self._card.play(samples, RATE)

    def stop(self) -> None:
        self._card.stop()


class Microphone:
    """The default microphone as a queue of 16 kHz samples."""

    def __init__(self) -> None:
        from queue import SimpleQueue

        card = sound_card("microphone")
        self._heard: SimpleQueue[bytes] = SimpleQueue()
        self._stream = card.RawInputStream(
            samplerate=RATE, channels=1, dtype="int16", blocksize=1600,
            callback=lambda data, frames, at, status: self._heard.put(bytes(data)),
        )  # fmt: skip
        self._stream.start()

    def take(self) -> list[Samples]:
        """What was heard since the last call."""
        found = []
        while not self._heard.empty():
            found.append(np.frombuffer(self._heard.get(), np.int16))
        return found

    def close(self) -> None:
        self._stream.close()


def sound_card(what: str) -> Any:
    """The sounddevice module.

    Raises:
        StartError: it or its library is missing, with the command that installs it.
    """
    try:
        import sounddevice
    except ImportError:
        raise StartError(f"speech.{what} needs sounddevice: pip install sounddevice") from None
    except OSError:
        raise StartError(f"speech.{what} needs libportaudio2: apt-get install libportaudio2") from None
    if not len(sounddevice.query_devices()):
        raise StartError(f"speech.{what} is on, but there is no sound card; set speech.{what} = false")
    return sounddevice
