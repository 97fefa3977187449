"""Voices in the background, and how a quiet microphone is amplified: on numbers alone."""

import numpy as np

from common.sound import RATE
from services.speech.listen.loudness import FRAME, GOING_ON, LOUD, LOUDER, MEMORY, MOST_GAIN, BackgroundVoices, Gain

BABBLE, PERSON = 1e4, 1e5
"""Mean powers of a frame [16 bit steps squared], 10 dB apart."""
SILENCE = 1.0
"""Mean power of a frame in a quiet room."""
SECOND = RATE // FRAME


def after(background: BackgroundVoices, power: float, frames: int, voiced: bool = True) -> float:
    """How much louder the last of so many frames is."""
    found = np.inf
    for _ in range(frames):
        found = background.push(power, voiced)
    return found


def talk(background: BackgroundVoices, power: float, seconds: int) -> float:
    """How much louder one is who talks for a second, pauses for half of one, and so on: the least of all words."""
    found = np.inf
    for _ in range(seconds):
        after(background, SILENCE, SECOND // 2)
        after(background, power, SECOND // 2)
        found = min(found, after(background, power, SECOND // 2))
    return found


def test_voices_that_go_on_for_seconds_are_background_and_a_nearer_person_is_not() -> None:
    background = BackgroundVoices()
    assert after(background, BABBLE, GOING_ON - 1) == np.inf, "the first seconds may be a command"
    assert after(background, BABBLE, SECOND) < LOUDER
    assert after(background, PERSON, SECOND) > LOUDER
    assert after(background, PERSON, 8 * SECOND) > LOUDER, "not even a long command becomes its own background"
    assert after(background, BABBLE, SECOND) < LOUDER, "the command is over, and they talk on"


def test_nobody_is_the_background_to_their_own_words() -> None:
    assert talk(BackgroundVoices(), PERSON, 30) > LOUDER, "one who talks on, or two in turn"
    background = BackgroundVoices()
    after(background, SILENCE, MEMORY, voiced=False)
    assert after(background, PERSON, MEMORY - 2 * SECOND) > LOUDER, "ten seconds without any pause"


def test_noise_is_no_background_voice() -> None:
    assert after(BackgroundVoices(), BABBLE, 2 * MEMORY, voiced=False) == np.inf


def test_when_the_voices_have_ended_a_quiet_one_is_heard_again() -> None:
    background = BackgroundVoices()
    after(background, PERSON, MEMORY)
    assert after(background, BABBLE, SECOND) < LOUDER
    after(background, SILENCE, 4 * SECOND, voiced=False)
    assert after(background, BABBLE, SECOND) > LOUDER


def test_a_quiet_microphone_is_amplified_at_leisure_and_a_loud_one_not_at_all() -> None:
    gain, quiet = Gain(), np.full(FRAME, 100, np.int16)
    first = gain(quiet)
    for _ in range(10 * SECOND):
        last = gain(quiet)
    assert first.max() < 120 and last.max() == int(100 * MOST_GAIN)
    loud = np.array([-32768, 32767] * (FRAME // 2), np.int16)
    assert np.array_equal(gain(loud), loud)
    assert np.abs(gain(quiet)).max() < 1.5 * 100, "what follows on a loud sound is left as it was"


def test_an_amplified_sound_does_not_clip() -> None:
    gain = Gain()
    for amplitude in (10, 300, 3000, 9000, 32767):
        for _ in range(10 * SECOND):
            found = gain(np.full(FRAME, -amplitude, np.int16))
            assert found.min() >= -max(amplitude, LOUD * 32768 + 1) and found.max() < 0
