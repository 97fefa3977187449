"""What is heard, cut into utterances, each recognised under the grammar that its setting asks for."""

from collections import deque
from collections.abc import Callable
from dataclasses import dataclass, replace

from common.bus.port import Io, Job
from services.speech.audio import RATE, Samples
from services.speech.config import SpeechConfig
from services.speech.listen.addressee import Setting, scope
from services.speech.listen.segmenter import Segment, Segmenter
from services.speech.recognise.front_end import Ear
from services.speech.recognise.recogniser import Heard, Scope

GAP, LOADING = 0.1, 0.5


@dataclass(frozen=True)
class Hearing:
    """An utterance in recognition; `key` is the listen goal at its end, `began` the time of its beginning."""

    job: Job[Heard]
    scope: Scope
    setting: Setting
    key: tuple[str, int]
    began: float


class Attention:
    """`push` sound, `take` what was understood. The wake word opens a window for the utterance after it."""

    def __init__(self, config: SpeechConfig, io: Io, load: Callable[[], Ear]) -> None:
        self._config, self._io, self._load = config, io, load
        self._ear: Job[Ear] | None = None
        self._segmenter = Segmenter(
            config.end_silence, config.max_utterance, config.interrupt_pause, config.interrupt_longest, config.wake_word
        )
        if config.preload:
            self._ear = io.submit(load, seconds=LOADING)
        if not io.lockstep:
            self._segmenter.load()
        self._setting = Setting()
        self._began = self._heard_at = 0.0
        self._awake_until = self._closed = float("-inf")
        self._done = False
        self._hearings: deque[Hearing] = deque()

    @property
    def transcribing(self) -> bool:
        """True while a possible command is being recognised."""
        return any(h.scope != "interrupt" for h in self._hearings)

    @property
    def busy(self) -> bool:
        """True while somebody speaks, or what was said is being recognised."""
        return self._segmenter.speaking or bool(self._hearings)

    def awake(self, now: float) -> bool:
        """True while a command needs no wake word."""
        return now <= self._awake_until

    def wake(self, now: float) -> None:
        """Open the window, or keep it open."""
        self._awake_until = now + self._config.wake_window

    def sleep(self, now: float) -> None:
        """Close the window: a command was given."""
        self._awake_until, self._closed = float("-inf"), now

    def settle(self, hearing: Hearing) -> None:
        """What this utterance asked for is done: the rest of it means nothing more."""
        self._hearings = deque(h for h in self._hearings if h.began != hearing.began)
        self._done = self._done or hearing.began == self._began

    def push(
        self, parts: list[tuple[Samples, bool]], now: float, speaking: bool, listening: bool, key: tuple[str, int]
    ) -> None:
        """New sound, each part with whether it is meant for the robot; does the robot speak or the brain listen?"""
        if parts:
            self._heard_at = now
        elif self._segmenter.speaking and now - self._heard_at > self._config.end_silence + GAP:
            # A stream that stops in mid-utterance has ended it, as silence would have.
            self._notice(now, False, speaking, listening)
            segment = self._segmenter.finish()
            if segment is not None:
                self._utterance(segment, now, key)
        for samples, addressed in parts:
            self._notice(now, addressed, speaking, listening)
            for segment in self._segmenter.push(samples):
                self._utterance(segment, now, key)

    def take(self, now: float) -> Hearing | None:
        """The next utterance that is through recognition, its setting as it is now."""
        if not self._hearings or not self._hearings[0].job.poll(now):
            return None
        hearing = self._hearings.popleft()
        if hearing.setting.window and hearing.began <= self._closed:
            return replace(hearing, setting=replace(hearing.setting, window=False))
        return hearing

    def _notice(self, now: float, addressed: bool, speaking: bool, listening: bool) -> None:
        """Keep what is known of the utterance under way: how it began, and what came since."""
        old, config = self._setting, self._config
        if not self._segmenter.speaking:
            self._began, self._done = now, False
            old = Setting(window=self.awake(now), addressed=not config.wake_word)
        woken = not speaking and self._segmenter.wake >= config.wake_threshold
        if woken and not old.woken:
            self._io.log.info("wake word", score=round(self._segmenter.wake, 2))
            self.wake(now)
        self._setting = Setting(
            speaking=old.speaking or speaking,
            listening=listening,
            woken=old.woken or woken,
            window=old.window,
            addressed=old.addressed or addressed,
        )

    def _utterance(self, segment: Segment, now: float, key: tuple[str, int]) -> None:
        config, setting = self._config, self._setting
        if segment.wake >= config.wake_threshold and not setting.speaking and not setting.woken:
            self.wake(now)
            setting = replace(setting, woken=True)
        asked = scope(setting, segment.over)
        if segment.over:
            known = self._done and segment.examined
            longest = (config.interrupt_longest + config.end_silence) * RATE
            if known or (asked == "interrupt" and (segment.examined or len(segment.samples) > longest)):
                return
        if self._ear is None:
            self._ear = self._io.submit(self._load, seconds=LOADING)
        ear, samples = self._ear, segment.samples
        seconds = config.interrupt_seconds if asked == "interrupt" else config.recognition_seconds
        job = self._io.submit(lambda: ear.result().hear(samples, asked), seconds=seconds)
        self._hearings.append(Hearing(job, asked, setting, key, self._began))
