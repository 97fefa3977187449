"""Text to speech with Hibari's bundled voice: https://pypi.org/project/hibari-tts/."""

import re
from functools import cache

import numpy as np

from common.process.host import return_memory
from common.sound import RATE, Samples, resample
from services.speech.prepared import prepared
from services.speech.speak.pronounce import SAMPLE_RATE, LeanHibari

MAX_CHARACTERS = 400
"""Longest text that is spoken (chosen: half a minute)."""
MAX_DIGITS = 20
"""Digits of a long number that are spoken (chosen)."""
LONG_NUMBER = re.compile(r"\d{7,}")


class Voice:
    """Synthesises speech in milliseconds; takes seconds to load, so it is made in the worker."""

    def __init__(self) -> None:
        with prepared() as folder:
            self._voice = LeanHibari(folder)
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
        return np.concatenate([resample(audio * 32000, SAMPLE_RATE), pause])


@cache
def voice() -> Voice:
    """The voice, shared by all that speak in one process."""
    return Voice()
