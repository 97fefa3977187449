"""What the robot says by itself while it drives: to people in its way, and when it does not know where it is."""

from collections.abc import Callable

from common import messages as m

PERSON = "PERSON_IN_WAY"
SAID: dict[str, str] = {
    PERSON: "Excuse me, please let me pass.",
    "LOST": "I am not sure where I am. I am looking around.",
    "MAP_MISMATCH": "I do not recognise this place: what I see does not fit my map.",
}
"""Sentences by the code of navigation's feedback."""
AGED, AGED_PAUSE = 0.6, 3600.0
"""Share of what is seen that the map explains [-] below which the robot says so, and how often at most [s]: boxes,
chairs and two people leave 0.66 at least."""
MAP_AGED = "Much has changed here since my map was made. Please let me map the home again."
FOUND = "Now I know where I am."
AFTER = {PERSON: 1.5, "LOST": 2.0, "MAP_MISMATCH": 5.0}
"""For how long [s] it has to be so before it is said; chosen: who is walking on has gone by then, and a look at the map
takes a second."""
PAUSE = 10.0
"""Time between two of the same [s]; chosen: asking more often is rude."""


class Remarks:
    """`speak` says a sentence beside the mission."""

    def __init__(self, speak: Callable[[str], None]) -> None:
        self._speak = speak
        self._code, self._since = "", 0.0
        self._said_at: dict[str, float] = {}
        self._lost = self._arrived = False
        self._fit = 1.0

    def hear(self, feedback: m.NavigationFeedback, now: float) -> None:
        """Note what navigation does."""
        code = feedback.code if feedback.status == "navigating" else ""
        if code != self._code:
            self._code, self._since = code, now
        if self._lost and not code and feedback.status == "navigating":
            self._speak(FOUND)
        if code not in ("LOST", "MAP_MISMATCH"):
            self._lost = False
        self._fit, self._arrived = feedback.map_fit, feedback.status == "arrived"

    def step(self, now: float) -> None:
        """Say what has been so for long enough."""
        if self._arrived and self._fit < AGED and now - self._said_at.get(MAP_AGED, -AGED_PAUSE) >= AGED_PAUSE:
            self._said_at[MAP_AGED] = now
            self._speak(MAP_AGED)
        code = self._code
        if code not in SAID or now - self._since < AFTER[code]:
            return
        if now - self._said_at.get(code, -PAUSE) >= PAUSE:
            self._said_at[code] = now
            self._lost = code != PERSON
            self._speak(SAID[code])
