"""Speech: listens on request and answers with the command that was heard; speaks what it is asked to say."""

from collections import deque
from pathlib import Path

import numpy as np

from common import messages as m
from common import topics
from common.io import Io, Job
from common.runtime import StartError
from services.speech.audio import RATE, AudioError, Samples, read_wav, resample
from services.speech.config import SpeechConfig
from services.speech.grammar import GrammarError, spoken
from services.speech.recognise import Ear, Heard, command_grammar
from services.speech.speak import Microphone, Speakers, Voice
from services.speech.vad import FRAME, Endpointer, VoiceDetector

CHUNK = RATE // 10
PRE_ROLL = int(0.4 * RATE)
_FAILURES = {"silence": "NO_SPEECH", "ask": "UNCERTAIN", "reject": "NO_COMMAND"}


class SpeechService:
    """Voice activity detection, recognition under the command grammar, and a voice."""

    NAME = "speech"
    HZ = 10
    CONFIG = SpeechConfig
    READS = (topics.SPEECH_GOAL, topics.SPEECH_TEXT, topics.AUDIO_PCM)
    WRITES = (
        topics.SPEECH_RESULT, topics.SPEECH_STATUS, topics.AUDIO_OUT, topics.VOICE_COMMAND, topics.ROBOT_STOP,
    )  # fmt: skip

    def __init__(self, config: SpeechConfig, io: Io) -> None:
        self._config, self._io = config, io
        try:
            grammar = command_grammar(config, io.scene)
            self._recording: Samples | None = read_wav(Path(config.wav)) if config.wav else None
        except (GrammarError, AudioError) as error:
            raise StartError(f"speech: {error}") from None
        self._microphone = Microphone() if config.microphone else None
        self._speakers = Speakers() if config.speakers else None
        self._ear: Job[Ear] = io.submit(Ear, config, io.scene, grammar, seconds=0.5)
        self._voice: Job[Voice] | None = None
        self._detector = VoiceDetector()
        self._endpointer = Endpointer(config.end_silence, config.max_utterance)
        self._goal = m.SpeechGoal(goal="")
        self._seen: set[tuple[str, int]] = set()
        self._answers: dict[tuple[str, int], m.SpeechResult] = {}
        self._listening = False
        self._deadline = 0.0
        self._typed: deque[tuple[float, str]] = deque(maxlen=8)
        self._frames: list[Samples] = []
        self._rest = np.zeros(0, np.int16)
        self._audio_at = 0.0
        self._hearing: Job[Heard] | None = None
        self._synthesis: Job[Samples] | None = None
        self._speech = np.zeros(0, np.int16)
        self._sequence = 0
        self._status = m.SpeechStatus(state="idle")
        io.publish(topics.SPEECH_STATUS, self._status)

    def step(self, now: float) -> None:
        io = self._io
        for goal in io.drain(topics.SPEECH_GOAL):
            self._take(goal, now)
        for typed in io.drain(topics.SPEECH_TEXT):
            self._typed.append((now, typed.text.strip()))
        self._hear(self._audio(), now)
        if self._listening:
            self._listen(now)
        self._speak(now)

    # --- goals
    def _take(self, goal: m.SpeechGoal, now: float) -> None:
        goal.id = goal.id or self._io.new_id("speech")
        key = goal.id, goal.attempt
        if key in self._seen:
            if key in self._answers:
                self._io.publish(topics.SPEECH_RESULT, self._answers[key])
            self._io.publish(topics.SPEECH_STATUS, self._status)
            return
        self._seen.add(key)
        verb, _, text = goal.goal.strip().partition(" ")
        if verb == "say" and text.strip():
            self._quiet()
            self._goal, self._listening = goal, False
            if self._voice is None:
                self._voice = self._io.submit(Voice, seconds=0.2)
            self._set("speaking", text.strip())
        elif goal.goal.strip() == "listen":
            self._quiet()
            self._goal, self._listening = goal, True
            self._deadline = now + self._config.listen_timeout
            self._forget_audio()
            self._set("listening")
            self._io.log.info("listening", id=goal.id)
        elif goal.goal.strip() == "cancel":
            self._quiet()
            self._goal, self._listening = goal, False
            self._set("idle", "cancelled")
        else:
            detail = f"{goal.goal!r}: expected listen, say <text> or cancel"
            self._answer(goal, "ERROR", 0.0, "UNKNOWN_GOAL", detail)

    def _answer(self, goal: m.SpeechGoal, text: str, confidence: float, code: str = "", detail: str = "") -> None:
        result = m.SpeechResult(
            text=text, goal_id=goal.id, attempt=goal.attempt, confidence=confidence, code=code, detail=detail
        )
        self._answers[goal.id, goal.attempt] = result
        self._io.log.info("heard", text=text, confidence=confidence, code=code, detail=detail)
        self._io.publish(topics.SPEECH_RESULT, result)

    def _set(self, state: m.SpeechStateName, detail: str = "") -> None:
        goal = self._goal
        self._status = m.SpeechStatus(state=state, goal_id=goal.id, attempt=goal.attempt, detail=detail)
        self._io.publish(topics.SPEECH_STATUS, self._status)

    # --- hearing
    def _audio(self) -> list[Samples]:
        """What arrived since the last step, at 16 kHz."""
        found: list[Samples] = []
        for chunk in self._io.drain(topics.AUDIO_PCM):
            if len(chunk.data) % 2 or not 4000 <= chunk.rate <= 192000:
                self._io.count_drop(topics.AUDIO_PCM.key, "not 16 bit samples at 4 to 192 kHz")
                continue
            samples = np.frombuffer(chunk.data, "<i2").astype(np.int16)
            found.append(samples if chunk.rate == RATE else resample(samples.astype(np.float32), chunk.rate))
        if self._microphone:
            found += self._microphone.take()
        if self._recording is not None and self._listening:
            found.append(self._recording[:CHUNK])
            self._recording = self._recording[CHUNK:] if len(self._recording) > CHUNK else None
            if self._recording is None:
                found.append(np.zeros(RATE, np.int16))
        return found

    def _hear(self, parts: list[Samples], now: float) -> None:
        """Run voice detection over new audio; keeps a little from before the speech."""
        if not parts:
            # A stream that stops in mid-utterance has ended it, as silence would have.
            silent = now - self._audio_at > self._config.end_silence + CHUNK / RATE
            if self._endpointer.speaking and self._hearing is None and silent:
                self._recognise(np.concatenate(self._frames))
            return
        self._audio_at = now
        stream = np.concatenate([self._rest, *parts])
        usable = len(stream) // FRAME * FRAME
        self._rest = stream[usable:]
        if not self._listening or self._hearing is not None:
            return
        for i in range(0, usable, FRAME):
            frame = stream[i : i + FRAME]
            ended = self._endpointer.push(self._detector(frame))
            self._frames.append(frame)
            if not self._endpointer.speaking:
                self._frames = self._frames[-(PRE_ROLL // FRAME) :]
            if ended:
                self._recognise(np.concatenate(self._frames))
                return

    def _recognise(self, samples: Samples) -> None:
        ear = self._ear
        self._hearing = self._io.submit(lambda: ear.result().hear(samples), seconds=self._config.recognition_seconds)
        self._forget_audio()
        self._set("transcribing")

    def _forget_audio(self) -> None:
        self._frames = []
        self._rest = np.zeros(0, np.int16)
        self._endpointer.reset()
        self._detector.reset()

    def _listen(self, now: float) -> None:
        """End the goal when something was typed or understood, or the time is over."""
        while self._typed:
            at, text = self._typed.popleft()
            if now - at <= self._config.typed_memory and spoken(text):
                self._end_listening(spoken(text), 1.0)
                return
        if self._hearing is not None:
            if self._hearing.poll(now):
                heard = self._hearing.result()
                self._hearing = None
                if heard.verdict == "accept":
                    self._end_listening(heard.text, heard.confidence)
                else:
                    detail = f"perhaps {heard.text!r}" if heard.verdict == "ask" else f"understood {heard.free!r}"
                    self._end_listening("ERROR", heard.confidence, _FAILURES[heard.verdict], detail)
        elif now >= self._deadline:
            silent = f"nobody spoke for {self._config.listen_timeout:.0f} s"
            self._end_listening("ERROR", 0.0, "TIMEOUT", silent)

    def _end_listening(self, text: str, confidence: float, code: str = "", detail: str = "") -> None:
        self._listening = False
        self._answer(self._goal, text, confidence, code, detail)
        self._set("idle")

    # --- speaking
    def _speak(self, now: float) -> None:
        if self._status.state != "speaking":
            return
        if self._synthesis is None and self._voice is not None and self._voice.poll(now):
            voice, text = self._voice, self._status.detail
            self._synthesis = self._io.submit(
                lambda: voice.result().speak(text), seconds=self._config.synthesis_seconds
            )
            return
        if self._synthesis is not None and not len(self._speech):
            if not self._synthesis.poll(now):
                return
            self._speech = self._synthesis.result()
            if self._speakers:
                self._speakers.play(self._speech)
        if not len(self._speech):
            return
        part, self._speech = self._speech[:CHUNK], self._speech[CHUNK:]
        last = not len(self._speech)
        chunk = m.AudioChunk(t=now, data=part.tobytes(), rate=RATE, seq=self._sequence, end=last)
        self._sequence += 1
        self._io.publish(topics.AUDIO_OUT, chunk)
        if last:
            self._synthesis = None
            self._set("idle", "said")

    def _quiet(self) -> None:
        """Stop whatever is being heard or said."""
        self._hearing = self._synthesis = None
        self._speech = np.zeros(0, np.int16)
        if self._speakers:
            self._speakers.stop()

    def close(self) -> None:
        if self._microphone:
            self._microphone.close()
