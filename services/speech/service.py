"""Speech: listens all the time for the wake word, "stop" and "cancel", on request for anything; speaks when asked."""

from collections import deque
from dataclasses import replace
from importlib.util import find_spec

from common import messages as m
from common import speech_weights, topics
from common.bus.port import Io
from common.goal_inbox import GoalInbox
from common.language.meaning import asks_for
from common.language.normalise import normalise
from common.language.pattern import PatternError
from common.runtime import StartError
from common.sound import AudioError
from common.topic import Topic
from services.speech.config import SpeechConfig
from services.speech.listen.addressee import consequence
from services.speech.listen.segmenter import Segmenter
from services.speech.listen.utterance_queue import PendingUtterance, UtteranceQueue
from services.speech.recognise.free_text import as_heard
from services.speech.recognise.front_end import FrontEnd
from services.speech.recognise.recogniser import Recognition, grammars
from services.speech.sources import SoundSources
from services.speech.speak.player import TtsPlayer

_FAILURES = {"silence": "NO_SPEECH", "ask": "UNCERTAIN", "reject": "NO_COMMAND"}


class SpeechService:
    """Voice activity detection, wake word, recognition under the command grammar, and a voice."""

    NAME = "speech"
    HZ = 10
    CONFIG = SpeechConfig
    READS, WRITES = topics.subscribed(NAME), topics.published(NAME)

    def __init__(self, config: SpeechConfig, io: Io) -> None:
        self._config, self._io = config, io
        self._household = household = io.household
        try:
            found = grammars(config, household)
            self._sources = SoundSources(config, io)
        except (PatternError, AudioError) as error:
            raise StartError(f"speech: {error}") from None
        if config.wake_word and not find_spec("pyopen_wakeword"):
            raise StartError("speech.wake_word needs pyopen-wakeword; install it, or set speech.wake_word = false")
        if speech_weights.find() is None:
            raise StartError(f"speech: {speech_weights.MISSING}")
        self._queue = UtteranceQueue(config, io, Segmenter(config), lambda: FrontEnd(config, household, found))
        self._player = TtsPlayer(io, config.speakers, config.synthesis_seconds, config.preload)
        self._goal = m.SpeechGoal(goal="")
        self._inbox: GoalInbox[m.SpeechGoal, m.SpeechResult] = GoalInbox(
            io, (topics.SPEECH_GOAL,), self._take, self._repeat
        )
        self._names: tuple[str, ...] = ()
        self._listening = False
        self._now = self._deadline = 0.0
        self._asked_again = False
        self._unclear = Recognition("", "silence", 0.0)
        self._typed: deque[tuple[float, str]] = deque(maxlen=8)
        self._status = m.SpeechStatus(state="idle")
        io.publish(topics.SPEECH_STATUS, self._status)

    def step(self, now: float) -> None:
        io = self._io
        self._now = now
        self._inbox.receive()
        self._learn()
        for typed in io.take_all(topics.SPEECH_TEXT):
            self._type(typed.text.strip(), now)
        key = self._goal.id, self._goal.attempt
        self._queue.push(self._sources.take(self._listening), now, bool(self._player.saying), self._listening, key)
        while utterance := self._queue.take(now):
            self._act(utterance, now)
        if self._queue.abandoned(now):
            self._ask_again()
        if self._listening:
            self._listen(now)
        said = self._player.step(now)
        if said and self._asked_again:
            self._queue.open_window(now)
        self._show(now, "said" if said else "")

    def _learn(self) -> None:
        """Listen for the names that people have given to things and places, and no more for those they forgot."""
        taught, household = self._io.latest(topics.HOUSEHOLD_NAMES), self._io.household
        names = tuple(name for one in taught.names if (name := normalise(one.name))) if taught is not None else ()
        if names != self._names or household is not self._household:
            self._names, self._household = names, household
            self._queue.learn(household, names)

    # --- goals
    def _repeat(self, goal: m.SpeechGoal, answer: m.SpeechResult | None) -> None:
        if answer is not None:
            self._io.publish(topics.SPEECH_RESULT, answer)
        self._io.publish(topics.SPEECH_STATUS, self._status)

    def _take(self, goal: m.SpeechGoal) -> None:
        verb, _, text = goal.goal.strip().partition(" ")
        if verb == "say" and text.strip():
            self._goal, self._listening = goal, False
            self._player.say(text.strip())
            self._set("speaking", text.strip())
        elif goal.goal.strip() == "listen":
            self._player.stop()
            self._goal, self._listening, self._asked_again = goal, True, False
            self._deadline = self._now + self._config.listen_timeout
            self._set("listening")
            self._io.log.info("listening", id=goal.id)
        elif goal.goal.strip() == "cancel":
            self._player.stop()
            self._goal, self._listening = goal, False
            self._set("idle", "cancelled")
        else:
            detail = f"{goal.goal!r}: expected listen, say <text> or cancel"
            self._answer(goal, "ERROR", 0.0, "UNKNOWN_GOAL", detail)

    def _answer(self, goal: m.SpeechGoal, text: str, confidence: float, code: str = "", detail: str = "") -> None:
        result = m.SpeechResult(
            text=text, goal_id=goal.id, attempt=goal.attempt, confidence=confidence, code=code, detail=detail
        )
        self._inbox.end(goal, result)
        self._io.log.info("heard", text=text, confidence=confidence, code=code, detail=detail)
        self._io.publish(topics.SPEECH_RESULT, result)

    # --- status
    def _set(self, state: m.SpeechStateName, detail: str = "", code: str = "") -> None:
        goal = self._goal
        self._status = m.SpeechStatus(state=state, goal_id=goal.id, attempt=goal.attempt, detail=detail, code=code)
        self._io.publish(topics.SPEECH_STATUS, self._status)

    def _show(self, now: float, detail: str) -> None:
        """Publish the state when it has changed."""
        state: m.SpeechStateName = "idle"
        if self._player.saying:
            state = "speaking"
        elif self._queue.transcribing:
            state = "transcribing"
        elif self._listening or self._queue.window_open(now):
            state = "listening"
        if state != self._status.state:
            self._set(state, detail)

    # --- hearing
    def _act(self, utterance: PendingUtterance, now: float) -> None:
        """Do what follows from an utterance that is through recognition."""
        recognition, context = utterance.job.result(), utterance.context
        same = self._listening and utterance.key == (self._goal.id, self._goal.attempt)
        context = replace(context, listening=context.listening and same)
        text, free, verdict = recognition.text, recognition.free, recognition.verdict
        found = consequence(recognition, asks_for(text, "stop", "cancel"), utterance.scope, context)
        self._io.log.debug("utterance", text=text, free=free, verdict=verdict, act=found)
        if found in ("stop", "cancel", "answer"):
            self._queue.settle(utterance)
        if found in ("stop", "cancel"):
            self._interrupt(found, recognition.confidence, now)
        elif found == "answer":
            self._queue.close_window(now)
            self._end_listening(recognition)
        elif found == "command":
            self._queue.close_window(now)
            self._publish(topics.VOICE_COMMAND, recognition)
        elif found == "mistaken":
            self._queue.close_window(now)
        elif found == "awake":
            self._queue.open_window(now)
        elif found == "again":
            self._queue.open_window(now)
            self._set("listening", f"understood {free!r}", _FAILURES[verdict])
            self._queue.keep(utterance, now)
            self._unclear = recognition
        if found in ("awake", "command"):
            self._asked_again = False

    def _ask_again(self) -> None:
        """Say that an utterance was not understood, or have the brain weigh the words that were heard plainly.

        Once, so that no television is talked to for ever.
        """
        if self._asked_again:
            return
        self._asked_again = True
        heard = as_heard(self._unclear, self._config)
        if heard is not None and self._io.has_subscribers(topics.SPEECH_UNCLEAR):
            self._publish(topics.SPEECH_UNCLEAR, heard)
        else:
            self._player.say(m.NOT_UNDERSTOOD)

    def _end_listening(self, recognition: Recognition) -> None:
        self._listening = False
        text, verdict = recognition.text, recognition.verdict
        if verdict == "accept":
            self._answer(self._goal, text, recognition.confidence)
        else:
            detail = f"perhaps {text!r}" if verdict == "ask" else f"understood {recognition.free!r}"
            self._answer(self._goal, "ERROR", recognition.confidence, _FAILURES[verdict], detail)

    def _interrupt(self, word: str, confidence: float, now: float) -> None:
        """Somebody said stop or cancel: be silent and tell the brain; a stop goes to the motors directly."""
        self._player.stop()
        self._queue.close_window(now)
        if word == "stop":
            self._io.publish(topics.ROBOT_STOP, m.RobotStop(reason="somebody said stop", source=self.NAME))
        if self._listening:
            self._listening = False
            self._answer(self._goal, word, confidence)
        self._publish(topics.VOICE_COMMAND, Recognition(word, "accept", confidence))

    def _publish(self, topic: Topic[m.VoiceCommand], heard: Recognition) -> None:
        text, confidence, others = heard.text, heard.confidence, list(heard.alternatives)
        self._io.log.info("command", text=text, confidence=confidence, on=topic.key)
        name = self._io.new_id("voice")
        self._io.publish(topic, m.VoiceCommand(text=text, confidence=confidence, id=name, alternatives=others))

    # --- listening on request
    def _type(self, text: str, now: float) -> None:
        word = asks_for(text, "stop", "cancel")
        if word == "stop" or (word and not self._listening):
            self._interrupt(word, 1.0, now)
        else:
            self._typed.append((now, text))

    def _listen(self, now: float) -> None:
        """End the goal when something was typed, or the time is over."""
        while self._typed:
            at, text = self._typed.popleft()
            if now - at <= self._config.typed_memory and normalise(text):
                self._listening = False
                self._answer(self._goal, normalise(text), 1.0)
                return
        if now >= self._deadline and not self._queue.busy:
            self._listening = False
            silent = f"nobody spoke for {self._config.listen_timeout:.0f} s"
            self._answer(self._goal, "ERROR", 0.0, "TIMEOUT", silent)

    def close(self) -> None:
        self._sources.close()
