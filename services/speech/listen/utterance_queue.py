"""The queue of utterances from segmentation to recognition, each with the grammar for its circumstances."""

from collections import deque
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from common.bus.port import Io, Job
from common.household import Household
from common.language.meaning import asks_for
from common.sound import RATE, Samples
from services.speech.config import SpeechConfig
from services.speech.listen.addressee import UtteranceContext, scope
from services.speech.listen.going_on import rank, whole
from services.speech.listen.segmenter import Segment, Segmenter
from services.speech.recognise.front_end import FrontEnd
from services.speech.recognise.recogniser import Recognition, Scope

GAP = 0.1
"""Longest gap between two chunks of a stream [s]: one step of the service."""
LOADING = 0.5
"""Modelled time of loading the networks in lockstep [s] (chosen: below the first words)."""
PATIENCE = 1.5
"""How long an utterance that was found to be no command may be gone on with [s] (chosen: with `end_silence` before it,
twice the pause of somebody who looks for a word)."""
REST = 4.0
"""How long what follows on an utterance may last before that is acted on alone [s] (chosen: more than half a sentence
takes; a television goes on)."""
DOUBT = 0.7
"""How long after its end an utterance that will be asked about waits for more [s] (chosen: with `end_silence` before
it, the pause of somebody who looks for a word, whom a question that comes too early would talk over)."""
NOTHING: Samples = np.zeros(0, np.int16)


@dataclass(frozen=True, eq=False)
class PendingUtterance:
    """An utterance in recognition; `key` is the listen goal at its end, `began` the time of its beginning [s],
    `ended` that of its end [s], `samples` its sound (n,)."""

    job: Job[Recognition]
    scope: Scope
    context: UtteranceContext
    key: tuple[str, int]
    began: float
    ended: float
    samples: Samples

    def goes_on(self, began: float) -> bool:
        """True when sound from time `began` [s] on counts as the rest of this utterance, which is no stop or answer."""
        if self.scope == "interrupt" or not self.ended < began <= self.ended + PATIENCE:
            return False
        found = self.job.result()
        return rank(found) > 0 and not asks_for(found.text, "stop", "cancel", "yes", "no")


class UtteranceQueue:
    """Takes sound by `push` and gives recognised utterances by `take`; the wake word opens a window for the next one.

    What begins soon after an utterance that was `keep`t unfinished, or before it was taken, is one with it: "bring me
    ... the red mug".
    """

    def __init__(self, config: SpeechConfig, io: Io, segmenter: Segmenter, load: Callable[[], FrontEnd]) -> None:
        self._config, self._io, self._segmenter, self._load = config, io, segmenter, load
        self._front_end: Job[FrontEnd] | None = None
        self._vocabulary: tuple[Household, tuple[str, ...]] | None = None
        if config.preload:
            self._front_end = io.submit(load, seconds=LOADING)
        if not io.lockstep:
            self._segmenter.load()
        self._context = UtteranceContext()
        self._began = self._last_sound = 0.0
        self._window_end = self._window_closed = float("-inf")
        self._settled = False
        self._unfinished, self._unfinished_until = NOTHING, float("-inf")
        self._pending: deque[PendingUtterance] = deque()

    @property
    def transcribing(self) -> bool:
        """True while a possible command is being recognised."""
        return any(u.scope != "interrupt" for u in self._pending)

    @property
    def busy(self) -> bool:
        """True while somebody speaks, or what was said is being recognised."""
        return self._segmenter.speaking or bool(self._pending)

    def window_open(self, now: float) -> bool:
        """True while a command needs no wake word."""
        return now <= self._window_end

    def open_window(self, now: float) -> None:
        """Open the window, or keep it open."""
        self._window_end = now + self._config.wake_window

    def close_window(self, now: float) -> None:
        """Close the window: a command was given."""
        self._window_end, self._window_closed = float("-inf"), now

    def learn(self, household: Household, names: Sequence[str]) -> None:
        """Listen for the names of this household and of these things, from the next utterance on."""
        self._vocabulary = household, tuple(names)
        if self._front_end is not None:
            self._teach(self._front_end)

    def _teach(self, front_end: Job[FrontEnd]) -> None:
        if self._vocabulary is not None:
            household, names = self._vocabulary
            self._io.submit(lambda: front_end.result().learn(household, names), seconds=0.0)

    def keep(self, utterance: PendingUtterance, now: float) -> None:
        """Wait for the rest of an utterance that is no command so far."""
        self._unfinished, self._unfinished_until = utterance.samples, now + PATIENCE

    def abandoned(self, now: float) -> bool:
        """True once, when a kept utterance was not continued in time and nobody speaks."""
        if not len(self._unfinished) or now < self._unfinished_until:
            return False
        if self.busy and self._began <= self._unfinished_until:
            return False
        self._unfinished = NOTHING
        return not self.busy

    def settle(self, utterance: PendingUtterance) -> None:
        """Drop what was said before this utterance and in the same breath: what it asked for is done."""
        self._pending = deque(u for u in self._pending if u.began > utterance.began)
        self._settled = self._settled or utterance.began == self._began

    def push(
        self, parts: list[tuple[Samples, bool]], now: float, speaking: bool, listening: bool, key: tuple[str, int]
    ) -> None:
        """Append sound, each part with whether it is meant for the robot.

        `speaking`: the robot speaks; `listening`: the brain listens, for the goal `key`.
        """
        if parts:
            self._last_sound = now
        elif self._segmenter.speaking and now - self._last_sound > self._config.end_silence + GAP:
            # A stream that stops in mid-utterance has ended it, as silence would have.
            self._update_context(now, False, speaking, listening)
            segment = self._segmenter.finish()
            if segment is not None:
                self._submit(segment, now, key)
        for samples, addressed in parts:
            self._update_context(now, addressed, speaking, listening)
            for segment in self._segmenter.push(samples, speaking):
                self._submit(segment, now, key)

    def take(self, now: float) -> PendingUtterance | None:
        """The next utterance that was recognised and is not waiting for its rest, with its context as it is now."""
        for utterance in self._pending:
            if not utterance.job.poll(now):
                return None
            if not self._waits(utterance, now):
                break
        else:
            return None
        self._pending.remove(utterance)
        if utterance.context.window and utterance.began <= self._window_closed:
            return replace(utterance, context=replace(utterance.context, window=False))
        return utterance

    def _waits(self, utterance: PendingUtterance, now: float) -> bool:
        """True while somebody goes on with this utterance, or may do so, as it will be asked about."""
        if self._segmenter.speaking and now - self._began < REST and utterance.goes_on(self._began):
            return True
        return rank(utterance.job.result()) < 2 and now < utterance.ended + DOUBT and utterance.goes_on(now)

    def _update_context(self, now: float, addressed: bool, speaking: bool, listening: bool) -> None:
        """Update the circumstances of the utterance under way: how it began, and what has come since."""
        old, config = self._context, self._config
        if not self._segmenter.speaking:
            self._began, self._settled = now, False
            old = UtteranceContext(window=self.window_open(now), addressed=not config.wake_word)
        woken = not speaking and self._segmenter.wake >= config.wake_threshold
        if woken and not old.woken:
            self._io.log.info("wake word", score=round(self._segmenter.wake, 2))
            self.open_window(now)
        self._context = UtteranceContext(
            speaking=old.speaking or speaking,
            listening=listening,
            woken=old.woken or woken,
            window=old.window,
            addressed=old.addressed or addressed,
        )

    def _submit(self, segment: Segment, now: float, key: tuple[str, int]) -> None:
        """Submit a segment to recognition, unless its recognition can bring nothing new."""
        config, context = self._config, self._context
        if segment.wake >= config.wake_threshold and not context.speaking and not context.woken:
            self.open_window(now)
            context = replace(context, woken=True)
        asked = scope(context, segment.over)
        if segment.over:
            known = self._settled and segment.examined
            longest = (config.interrupt_longest + config.end_silence) * RATE
            if known or (asked == "interrupt" and (segment.examined or len(segment.samples) > longest)):
                return
        if self._front_end is None:
            self._front_end = self._io.submit(self._load, seconds=LOADING)
            self._teach(self._front_end)
        front_end, samples, wake = self._front_end, segment.samples, segment.wake
        seconds = config.interrupt_seconds if asked == "interrupt" else config.recognition_seconds
        before, first = self._before(segment, context, now)

        def recognise() -> Recognition:
            listen = front_end.result().recognise
            found = listen(np.concatenate([before, samples]), asked, wake)
            if first is not None:
                return whole(first, found)
            return found if not len(before) or found.verdict == "accept" else listen(samples, asked, wake)

        job = self._io.submit(recognise, seconds=seconds)
        self._pending.append(PendingUtterance(job, asked, context, key, self._began, now, samples))

    def _before(self, segment: Segment, context: UtteranceContext, now: float) -> tuple[Samples, Recognition | None]:
        """The sound of the utterance that a segment continues, cut to the longest that one may be, and what
        was recognised in it if that could stand alone."""
        if not (segment.over and context.meant):
            return NOTHING, None
        before, self._unfinished = self._unfinished, NOTHING
        room = round(self._config.max_utterance * RATE) - len(segment.samples)
        if context.woken or room <= 0:
            return NOTHING, None  # who says the wake word begins anew
        for utterance in self._pending:
            if utterance.job.poll(now) and utterance.goes_on(self._began):
                self._pending.remove(utterance)
                return utterance.samples[-room:], utterance.job.result()
        return (before[-room:] if self._began <= self._unfinished_until else NOTHING), None
