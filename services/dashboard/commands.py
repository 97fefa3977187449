"""What visitors do, as messages to the robot."""

from math import atan2

from common import messages as m
from common import topics
from common.bus.port import Io
from common.geometry import Pose2
from services.dashboard.panels.history_buffers import Transcript
from services.dashboard.scene.picking import Picked

RATE = 16000
"""Samples per second that speech takes (`audio/pcm`)."""
CHUNK = RATE // 10 * 2
"""Bytes of 100 ms of int16, the piece that speech recognition takes at a time."""
TRAILING = 15
"""Pieces of silence after the last word, 1.5 s, from which speech knows that it was the last; chosen."""
LONGEST = 400
"""Pieces of one utterance, 40 s; chosen: longer than any command."""
OPEN = ("WAITING", "LISTENING", "COMPLETED", "ERROR")
SOURCE = "page"


class Commands:
    """Publishes; speech recognition follows one microphone at a time."""

    def __init__(self, io: Io, transcript: Transcript) -> None:
        self._io, self._transcript = io, transcript
        self._sound = b""
        self._sent = 0

    def use_transcript(self, transcript: Transcript) -> None:
        """From now on, what visitors do is noted there."""
        self._transcript = transcript

    def words(self, do: str, text: str, t: float) -> None:
        """A button was pressed or a line typed; what is unknown is counted."""
        if do == "stop":
            self._io.publish(topics.ROBOT_STOP, m.RobotStop(reason="stop button", source=SOURCE))
            self._transcript.add(t, "typed", "STOP")
        elif do in ("resume", "go on"):
            self._io.publish(topics.ROBOT_RESUME, m.RobotResume(source=SOURCE, go_on=do == "go on"))
            self._transcript.add(t, "typed", "release" if do == "resume" else do)
        elif do in ("yes", "no"):
            self.say(do, t)
        elif do == "say" and text.strip():
            self.say(text.strip()[:500], t)
        else:
            self._io.count_drop("page", f"{do!r}: expected stop, resume, go on, yes, no or say with words")

    def say(self, text: str, t: float) -> None:
        """A person typed it, so nobody needs to ask whether it was heard right."""
        self._io.publish(topics.VOICE_COMMAND, m.VoiceCommand(text=text, id=self._io.new_id("page"), confirmed=True))
        self._transcript.add(t, "typed", text)

    def picked(self, picked: Picked, base: Pose2, state: m.BrainState | None, t: float) -> None:
        """A click: fetch the object, or drive to the place when no mission is under way."""
        ready = state is not None and state.state in OPEN
        if not (picked.label or picked.point):
            return
        if not ready:
            self._transcript.add(t, "robot", "busy: clicks do nothing during a mission")
        elif picked.label:
            self.say(f"bring me the {picked.label}", t)
        elif picked.point is not None:
            x, y = picked.point
            theta = atan2(y - base[1], x - base[0])
            self._io.publish(topics.NAV_GOAL, m.NavGoal(id=self._io.new_id("page"), x=x, y=y, theta=theta))
            self._transcript.add(t, "typed", f"go to {x:.1f}, {y:.1f}")

    def sound(self, data: bytes, t: float) -> None:
        """From the microphone; an empty piece ends the utterance, which is then padded with silence."""
        if data:
            if len(data) % 2:
                self._io.count_drop(topics.AUDIO_PCM.key, "not 16 bit samples")
                return
            self._sound += data
            while len(self._sound) >= CHUNK:
                self._chunk(self._sound[:CHUNK], t)
                self._sound = self._sound[CHUNK:]
            return
        if self._sent or self._sound:
            rest = self._sound + bytes(-len(self._sound) % CHUNK)
            quiet = bytes(CHUNK * TRAILING)
            rest, self._sound = rest + quiet, b""
            for start in range(0, len(rest), CHUNK):
                self._chunk(rest[start : start + CHUNK], t, end=start + CHUNK >= len(rest))
            self._sent = 0

    def _chunk(self, data: bytes, t: float, end: bool = False) -> None:
        if self._sent < LONGEST or end:
            chunk = m.AudioChunk(t=t, data=data, rate=RATE, seq=self._sent, end=end, addressed=True)
            self._io.publish(topics.AUDIO_PCM, chunk)
        self._sent += 1
