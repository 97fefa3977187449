"""Does the microphone hear the robot's own voice? Pure."""

from common.sound import RATE
from services.speech.listen.loudness import FRAME

HEARD = 1 / 3
"""Share of the time that the robot speaks, synthesis among it, with a voice in the microphone, from which that is its
own (chosen: where echo is cancelled there is only who talks over it)."""
PAUSE = 5
"""Frames of the pause that ends what was heard of it: 0.16 s (chosen: longer than the closure of a consonant; people
answer after 0.2 s)."""
TAIL = round(0.5 * RATE / FRAME) + PAUSE
"""Frames after its end in which such a pause counts (chosen: half a second for the sound card's buffer and the room's
echo; in a later one somebody else has begun to speak)."""


class OwnVoice:
    """Counts voiced frames while the robot speaks, and frames since then."""

    def __init__(self) -> None:
        self._frames = self._voiced = self._since = 0

    def push(self, own: bool, voiced: bool) -> None:
        """A frame; `own`: the robot speaks."""
        if not own:
            self._since += 1
            return
        if self._since:
            self._frames = self._voiced = self._since = 0
        self._frames += 1
        self._voiced += voiced

    @property
    def ends(self) -> bool:
        """True where a pause ends what was heard of the robot itself."""
        return 0 < self._since <= TAIL and self._voiced > HEARD * self._frames
