"""Voices in the background, and how a quiet microphone is amplified: on numbers alone."""

import numpy as np

from common.sound import RATE
from services.speech.listen.loudness import BACK, FRAME, LOUD, LOUDER, MOST_GAIN, SPAN, BackgroundVoices, Gain

BABBLE, PERSON = 1e4, 1e5
"""Mean powers of a frame [16 bit steps squared], 10 dB apart."""
SECOND = RATE // FRAME


def after(background: BackgroundVoices, power: float, frames: int, voiced: bool = True) -> float:
    """How much louder the last of so many frames is."""
    found = np.inf
    for _ in range(frames):
        found = background.push(power, voiced)
    return found


def test_voices_that_go_on_for_seconds_are_background_and_a_nearer_person_is_not() -> None:
    background = BackgroundVoices()
    assert after(background, BABBLE, BACK) == np.inf, "the first seconds may be a command"
    assert after(background, BABBLE, SPAN) < LOUDER
    assert after(background, PERSON, SECOND) > LOUDER
    assert after(background, PERSON, 3 * SECOND) > LOUDER, "not even a long command becomes its own background"
    assert after(background, BABBLE, SECOND) < LOUDER, "the command is over, and they talk on"


def test_noise_and_a_conversation_with_pauses_are_no_background() -> None:
    background = BackgroundVoices()
    assert after(background, BABBLE, BACK + SPAN, voiced=False) == np.inf
    for _ in range(4):
        after(background, PERSON, SECOND)
        found = after(background, BABBLE, SECOND, voiced=False)
    assert found == np.inf


def test_one_who_speaks_some_seconds_after_a_loud_command_is_heard() -> None:
    background = BackgroundVoices()
    after(background, PERSON, SPAN)
    for second in range(8):
        after(background, 1.0, SECOND, voiced=False)
        assert background.push(BABBLE, True) == np.inf, second


def test_when_the_voices_have_ended_a_quiet_one_is_heard_again() -> None:
    background = BackgroundVoices()
    after(background, PERSON, BACK + SPAN)
    assert after(background, BABBLE, SECOND) < LOUDER
    after(background, 1.0, BACK + SPAN // 2, voiced=False)
    assert after(background, BABBLE, SECOND) == np.inf


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
