"""What is said right after the robot, where the microphone hears it: on numbers in place of voice detection."""

import numpy as np
import pytest

from common.sound import RATE, Samples
from services.speech.config import SpeechConfig
from services.speech.listen import segmenter
from services.speech.listen.loudness import FRAME
from services.speech.listen.own_voice import TAIL
from services.speech.listen.segmenter import Segment, Segmenter

SECOND = RATE // FRAME
ROBOT, PERSON, NOBODY = 1000, 2000, 0
Part = tuple[int, int, bool]


class Level:
    """In place of voice detection: what is not silent is a voice."""

    def __call__(self, frame: Samples) -> float:
        return float(frame.any())

    def reset(self) -> None:
        pass


def heard(monkeypatch: pytest.MonkeyPatch, *parts: Part, over: bool = True) -> list[Segment]:
    """The utterances that are over, or pause, of parts: how loud, how many frames, whether the robot speaks."""
    monkeypatch.setattr(segmenter, "VoiceDetector", Level)
    cut, found = Segmenter(SpeechConfig(wake_word=False)), []
    for level, frames, own in (*parts, (NOBODY, SECOND, False)):
        found += cut.push(np.full(frames * FRAME, level, np.int16), own)
    return [segment for segment in found if segment.over == over]


@pytest.mark.parametrize("after", [0, SECOND // 3])
def test_who_answers_the_robot_soon_is_not_taken_for_a_part_of_what_it_says(
    monkeypatch: pytest.MonkeyPatch, after: int
) -> None:
    """`after`: frames of silence that end its own sound."""
    (answer,) = heard(
        monkeypatch,
        (ROBOT, 3 * SECOND, True), (NOBODY, after, True), (NOBODY, SECOND // 3 - after // 2, False),
        (PERSON, 2 * SECOND, False),
    )  # fmt: skip
    assert set(answer.samples) == {NOBODY, PERSON}
    assert np.sum(answer.samples == PERSON) == 2 * SECOND * FRAME


def test_who_talks_over_the_robot_is_left_whole_where_it_does_not_hear_itself(monkeypatch: pytest.MonkeyPatch) -> None:
    (said,) = heard(
        monkeypatch,
        (NOBODY, 3 * SECOND, True), (PERSON, SECOND // 2, True),
        (PERSON, SECOND // 4, False), (NOBODY, SECOND // 3, False), (PERSON, SECOND, False),
    )  # fmt: skip
    assert np.sum(said.samples == PERSON) == (SECOND // 2 + SECOND // 4 + SECOND) * FRAME


def test_who_goes_on_after_the_robot_without_a_pause_is_not_cut_in_mid_sentence(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    (said,) = heard(
        monkeypatch,
        (ROBOT, 3 * SECOND, True), (PERSON, TAIL, False), (NOBODY, SECOND // 3, False), (PERSON, SECOND, False),
    )  # fmt: skip
    assert np.sum(said.samples == PERSON) == (TAIL + SECOND) * FRAME


def test_what_is_said_after_the_robot_need_not_be_louder_than_it_was(monkeypatch: pytest.MonkeyPatch) -> None:
    (answer,) = heard(monkeypatch, (PERSON, 9 * SECOND, True), (NOBODY, SECOND // 3, False), (ROBOT, 2 * SECOND, False))
    assert np.sum(answer.samples == ROBOT) == 2 * SECOND * FRAME


def test_a_word_into_a_short_reply_of_the_robot_is_still_examined(monkeypatch: pytest.MonkeyPatch) -> None:
    parts = (ROBOT, SECOND // 2, True), (PERSON, SECOND // 2, False)
    (paused,) = heard(monkeypatch, *parts, over=False)
    assert set(paused.samples) == {ROBOT, PERSON, NOBODY}
    assert not heard(monkeypatch, *parts)
