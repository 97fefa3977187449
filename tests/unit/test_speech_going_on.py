"""Whoever goes on speaking is not done: what the queue waits for, with a recogniser that knows the answers."""

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from common.sound import RATE, Samples
from services.speech.config import SpeechConfig
from services.speech.listen.going_on import SURE
from services.speech.listen.segmenter import Segment
from services.speech.listen.utterance_queue import DOUBT, REST, UtteranceQueue
from services.speech.recognise.recogniser import Recognition

ANSWERS = {
    (1,): Recognition("bring me the apple", "accept", 0.9),
    (2,): Recognition("from the counter", "reject", 0.1),
    (1, 2): Recognition("bring me the apple from the counter", "accept", 0.9),
    (3,): Recognition("bring me my wallet", "accept", 0.5),
    (3, 2): Recognition("bring me my wallet from the counter", "accept", 0.5),
    (4,): Recognition("the weather", "accept", 0.5),
    (1, 4): Recognition("bring me the apple the weather", "accept", 0.5),
    (6,): Recognition("", "reject", 0.1),
    (1, 6): Recognition("", "reject", 0.1),
    (5,): Recognition("stop", "accept", 0.9),
    (3, 5): Recognition("bring me my wallet stop", "accept", 0.5),
}
RECOGNISED = 0.8
KEY = ("", 0)


class Later:
    """A job that is done at a time of its own."""

    def __init__(self, work: Callable[[], Any], at: float) -> None:
        self.result, self._at = work, at

    def poll(self, now: float) -> bool:
        return now >= self._at


class Worker:
    lockstep, now = True, 0.0

    def submit(self, work: Callable[[], Any], seconds: float = 0.0) -> Later:
        return Later(work, self.now + seconds)


class FrontEnd:
    def recognise(self, samples: Samples, _asked: str, _wake: float) -> Recognition:
        return ANSWERS[tuple(dict.fromkeys(samples.tolist()))]


class Listener:
    """A queue whose segmenter is told what it hears; somebody addresses the robot throughout."""

    wake = 0.0

    def __init__(self, seconds: float = RECOGNISED) -> None:
        self.worker, self.speaking, self.ended = Worker(), False, 0
        config = SpeechConfig(preload=False, wake_word=False, recognition_seconds=seconds)
        self.queue = UtteranceQueue(config, self.worker, self, FrontEnd)  # type: ignore[arg-type]
        self.begins(1.0)

    def push(self, _samples: Samples, _own: bool) -> list[Segment]:
        self.speaking, number, self.ended = not self.ended, self.ended, 0
        return [Segment(np.full(RATE, number, np.int16), True, 0.0)] if number else []

    def begins(self, now: float) -> None:
        self._hear(now)

    def ends(self, now: float, number: int) -> None:
        self.ended = number
        self._hear(now)

    def _hear(self, now: float) -> None:
        self.worker.now = now
        self.queue.push([(np.zeros(1, np.int16), True)], now, False, False, KEY)

    def taken(self, now: float) -> str:
        found = self.queue.take(now)
        return found.job.result().text if found else ""


@pytest.fixture
def listener() -> Listener:
    return Listener()


def test_a_sure_command_waits_for_nobody(listener: Listener) -> None:
    listener.ends(2.0, 1)
    assert listener.taken(2.0 + RECOGNISED) == "bring me the apple"


def test_a_doubtful_one_waits_a_little_as_it_will_be_asked_about() -> None:
    listener = Listener(0.1)
    listener.ends(2.0, 3)
    assert not listener.taken(2.0 + DOUBT - 0.1)
    assert listener.taken(2.0 + DOUBT) == "bring me my wallet"


@pytest.mark.parametrize("first", [1, 3])
def test_what_could_stand_alone_waits_for_what_its_speaker_goes_on_with(listener: Listener, first: int) -> None:
    listener.ends(2.0, first)
    listener.begins(2.5)
    assert not listener.taken(2.0 + RECOGNISED)
    listener.ends(4.0, 2)
    assert listener.taken(4.0 + RECOGNISED) == f"{ANSWERS[(first,)].text} from the counter"
    assert not listener.queue.busy


def test_of_a_sure_command_that_is_doubtfully_gone_on_with_no_part_is_done_unasked(listener: Listener) -> None:
    listener.ends(2.0, 1)
    listener.begins(2.5)
    listener.ends(4.0, 4)
    found = listener.queue.take(4.0 + RECOGNISED)
    assert found is not None
    said = found.job.result()
    assert said.text == "bring me the apple the weather" and said.confidence < SURE
    assert [one.text for one in said.alternatives] == ["bring me the apple"]


def test_a_sure_command_is_not_spoilt_by_what_others_say_after_it(listener: Listener) -> None:
    listener.ends(2.0, 1)
    listener.begins(2.5)
    listener.ends(4.0, 6)
    assert listener.taken(4.0 + RECOGNISED) == "bring me the apple"


def test_nobody_talks_so_long_that_a_command_is_not_carried_out(listener: Listener) -> None:
    listener.ends(2.0, 1)
    listener.begins(2.5)
    assert not listener.taken(2.5 + REST - 0.1)
    assert listener.taken(2.5 + REST) == "bring me the apple"


def test_who_begins_much_later_says_something_else(listener: Listener) -> None:
    listener.ends(2.0, 1)
    listener.begins(4.0)
    assert listener.taken(4.0) == "bring me the apple"


def test_stop_waits_for_nobody(listener: Listener) -> None:
    listener.ends(2.0, 5)
    listener.begins(2.5)
    assert listener.taken(2.0 + RECOGNISED) == "stop"


def test_a_stop_is_the_end_of_what_was_said_before_it() -> None:
    listener = Listener(0.1)
    listener.ends(3.95, 3)  # is not recognised yet as the next one ends, and then waits as a doubtful one
    listener.begins(3.98)
    listener.ends(4.0, 5)
    stop = listener.queue.take(4.2)
    assert stop is not None and stop.job.result().text == "stop" and listener.queue.busy
    listener.queue.settle(stop)
    assert not listener.queue.busy
