"""Microphone and speakers of the machine, through the optional package sounddevice (PortAudio)."""

from queue import SimpleQueue
from typing import Any

import numpy as np

from common.runtime import StartError
from common.sound import RATE, Samples


class Speakers:
    """The speakers of the machine's default sound card."""

    def __init__(self) -> None:
        self._card = sound_card("speakers")

    def play(self, samples: Samples) -> None:
        self._card.play(samples, RATE)

    def stop(self) -> None:
        self._card.stop()


class Microphone:
    """The default microphone as a queue of 16 kHz samples."""

    def __init__(self) -> None:
        card = sound_card("microphone")
        self._heard: SimpleQueue[bytes] = SimpleQueue()
        self._stream = card.RawInputStream(
            samplerate=RATE, channels=1, dtype="int16", blocksize=1600,
            callback=lambda data, frames, at, status: self._heard.put(bytes(data)),
        )  # fmt: skip
        self._stream.start()

    def take(self) -> list[Samples]:
        """The samples since the last call."""
        found = []
        while not self._heard.empty():
            found.append(np.frombuffer(self._heard.get(), np.int16))
        return found

    def close(self) -> None:
        self._stream.close()


def sound_card(what: str) -> Any:
    """Import and return the module sounddevice.

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
