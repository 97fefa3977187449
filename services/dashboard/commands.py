"""Translation of what visitors do into messages to the robot."""

from math import atan2

from common import messages as m
from common import topics
from common.bus.port import Io
from common.geometry import Pose2
from common.mission_log.transcript import Transcript
from common.naming.part_names import kind_named
from common.sound import RATE
from services.dashboard.scene.picking import Picked

CHUNK = RATE // 10 * 2
"""Bytes of 100 ms of int16, the piece that speech recognition takes at a time."""
TRAILING = 15
"""Pieces of silence after the last word, 1.5 s, from which speech knows that it was the last; chosen."""
LONGEST = 400
"""Pieces of one utterance, 40 s; chosen: longer than any command."""
SOURCE = "page"


class Commands:
    """Publishes visitors' commands, sound of one visitor's microphone at a time."""

    def __init__(self, io: Io, transcript: Transcript) -> None:
        self._io, self._transcript = io, transcript
        self._sound = b""
        self._sent = 0
        self.naming = ""

    def words(self, do: str, text: str, t: float) -> None:
        """Carry out a button or a typed line; unknown ones are counted."""
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
        elif do == "name" and text.strip():
            self.naming = text.strip()[:500]
            self._transcript.add(t, "robot", f"click on what is called {self.naming}")
        else:
            self._io.count_drop("page", f"{do!r}: expected stop, resume, go on, yes, no, or say or name with words")

    def say(self, text: str, t: float) -> None:
        """Publish typed words as a command that needs no question whether it was heard right."""
        self._io.publish(topics.VOICE_COMMAND, m.VoiceCommand(text=text, id=self._io.new_id("page"), confirmed=True))
        self._transcript.add(t, "typed", text)

    def picked(self, picked: Picked, base: Pose2, state: m.BrainState | None, t: float) -> None:
        """Name the object that was clicked, or with a name like "desk" the part of the home, as was typed; without
        one the object is fetched, or the robot drives to the place, when no mission is under way."""
        ready = state is not None and state.state in m.OPEN_STATES
        if self.naming and picked.hit is not None and kind_named(self.naming) is not None:
            self._name_part(picked.hit, t)
            return
        if not (picked.label or picked.point):
            return
        if self.naming:
            self._teach(picked, t)
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

    def _teach(self, picked: Picked, t: float) -> None:
        name, self.naming = self.naming, ""
        if not picked.label:
            self._transcript.add(t, "robot", f"no thing was clicked on: nothing is called {name}")
            return
        request = m.TeachRequest(id=self._io.new_id("page"), name=name, label=picked.label)
        self._io.publish(topics.TEACH, request)
        self._transcript.add(t, "typed", f"the {picked.label} is called {name}")

    def _name_part(self, hit: m.Vec3, t: float) -> None:
        """The room, surface or place that was clicked on gets the name that was typed."""
        name, self.naming = self.naming, ""
        edit = m.HouseholdEdit(do="name", id=self._io.new_id("page"), name=name, position=hit)
        self._io.publish(topics.HOUSEHOLD_EDIT, edit)
        self._transcript.add(t, "typed", f"this is the {name}")

    def edited(self, result: m.EditResult, t: float) -> None:
        """Tell visitors the outcome of a name for a part of the home, or of a rule, whoever told it."""
        if not result.ok:
            self._transcript.add(t, "robot", f"{result.name} was not kept: {result.detail}")
        elif result.kind:
            self._transcript.add(t, "robot", f"the name {result.name} is kept")
        else:
            self._transcript.add(t, "robot", f"the rule about {result.name} is kept")

    def taught(self, result: m.TeachResult, t: float) -> None:
        """Tell visitors the outcome of a taught name, whoever taught it."""
        done = f"forgot {result.name}" if not result.label else f"the {result.label} is the {result.name} from now on"
        self._transcript.add(t, "robot", done if result.ok else f"{result.name} was not learnt: {result.detail}")

    def sound(self, data: bytes, t: float) -> None:
        """Take sound of the microphone; an empty piece ends the utterance, which is then padded with silence."""
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
