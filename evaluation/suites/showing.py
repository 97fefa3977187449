"""What a person shows the robot before a case begins: a world of its own, in which a thing gets its name."""

import shutil
import tempfile
from pathlib import Path

from common import messages as m
from common import topics
from common.bus import codec
from evaluation.case import Showing
from evaluation.stack import Stack

NAMES = "taught-names.json"
"""What perception keeps in its directory of state."""
PATIENCE = 60.0
"""Robot time [s] within which it is to have learned a name."""
SETTINGS = ("brain.pipeline=vla", "brain.enable_confirmation=false")


def show(showing: Showing, folder: Path) -> str:
    """Run the showing; the names that the robot keeps of it go to `folder`. Why it has learned nothing, or ""."""
    with tempfile.TemporaryDirectory(prefix="showing-") as kept:
        stack = Stack(
            showing.scene, showing.seed, SETTINGS, household=showing.household, without=("dashboard", "speech"),
            state_dir=Path(kept),
        )  # fmt: skip
        try:
            why = _teach(stack, showing)
        finally:
            stack.close()
        if not why:
            shutil.copy(Path(kept) / NAMES, folder / NAMES)
    return why


def _teach(stack: Stack, showing: Showing) -> str:
    while stack.state().state != "WAITING":
        if stack.now > PATIENCE:
            return "the robot does not get ready"
        stack.tick()
    end = stack.now + PATIENCE
    if showing.at is not None:
        request = m.TeachRequest(name=showing.name, id="click", position=showing.at)
        stack.bus.send(topics.TEACH, request)
    else:
        stack.bus.send(topics.VOICE_COMMAND, m.VoiceCommand(text=showing.sentence, id="shown", confirmed=True))
    while stack.now < end:
        stack.tick()
        last = stack.bus.last.get(topics.TAUGHT.key)
        if last is not None:
            result = codec.decode(topics.TAUGHT, last)
            return "" if result.ok else f"{result.code}: {result.detail}"
        ended = stack.state().last
        if ended is not None and ended.outcome != "delivered":
            return ended.reason
    return "it says nothing of the name"
