"""The robot in the flat of docs/COMMANDS.md, with a disk, for tests that tell it things."""

from pathlib import Path
from typing import TypeVar

from common import messages as m
from common import topics
from common.bus import codec
from common.topic import Topic
from evaluation.stack import Stack
from evaluation.suites.commands import LAID, scene_of

M = TypeVar("M", bound=m.Message)


class Home:
    """The robot in the flat of docs/COMMANDS.md; nobody asks whether a command was heard right."""

    def __init__(self, state_dir: Path) -> None:
        self.stack = Stack(
            scene_of(LAID),
            0,
            ("brain.enable_confirmation=false",),
            without=("dashboard", "speech"),
            state_dir=state_dir,
        )

    def latest(self, topic: Topic[M]) -> M:
        return codec.decode(topic, self.stack.bus.last[topic.key])

    def tell(self, text: str, limit: float) -> m.MissionOutcome:
        """How the mission of a command ends, within `limit` robot seconds."""
        stack = self.stack
        while stack.state().state != "WAITING":
            stack.tick()
        began = stack.now
        stack.bus.send(topics.VOICE_COMMAND, m.VoiceCommand(text=text, id=text, confirmed=True))
        while stack.now < began + limit:
            stack.tick()
            last = stack.state().last
            if last is not None and last.command == text and last.t >= began:
                return last
        raise AssertionError(f"{text!r} did not end: {stack.state()}")

    def names(self) -> dict[str, list[str]]:
        return {o.label: o.names for o in self.latest(topics.WORLD_OBJECTS).objects if o.names}

    def place_of(self, name: str) -> str:
        return str(self.stack.truth()["objects"][name]["on"])
