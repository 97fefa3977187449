"""Transcript of the dialogue with the robot, for viewers."""

from collections import deque
from dataclasses import dataclass

from common import messages as m

LINES = 60
"""Lines of the transcript that are kept; chosen: two screens."""
REPEATED = 2.0
"""Time [s] within which the same words of the same speaker are one line: a command comes by two topics."""

PEOPLE = ("heard", "typed")
"""Whose words those of people are."""


@dataclass(frozen=True)
class Line:
    """One line of the transcript; `who` is heard, typed, said or robot."""

    t: float
    who: str
    text: str


class Transcript:
    """The last lines of the dialogue, newest last."""

    def __init__(self) -> None:
        self.lines: deque[Line] = deque(maxlen=LINES)
        self.changed = True

    def add(self, t: float, who: str, text: str) -> None:
        """Append a line said at robot time `t` [s]; a repetition within `REPEATED` is left out."""
        text = text.strip()
        if not text:
            return
        same = PEOPLE if who in PEOPLE else (who,)
        if any(line.text == text and line.who in same and t - line.t < REPEATED for line in self.lines):
            return
        self.lines.append(Line(t, who, text))
        self.changed = True

    def add_result(self, t: float, result: m.SpeechResult) -> None:
        """Append what was understood at `t` [s], or why nothing was."""
        if result.code == "TIMEOUT":
            return
        if result.text == "ERROR":
            self.add(t, "robot", f"not understood: {result.code} {result.detail}".strip())
        else:
            self.add(t, "heard", result.text)

    def add_goal(self, t: float, goal: m.SpeechGoal) -> None:
        """Append what the robot says from `t` [s] on."""
        verb, _, words = goal.goal.strip().partition(" ")
        if verb == "say":
            self.add(t, "said", words)

    def add_command(self, t: float, command: m.VoiceCommand) -> None:
        """Append a command that came to the brain at `t` [s], from whomever."""
        self.add(t, "typed" if command.confirmed else "heard", command.text)
