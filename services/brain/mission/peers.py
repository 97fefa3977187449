"""The services that a mission is carried out with, one channel each."""

from collections.abc import Callable

from common import topics
from common.bus.port import Io
from services.brain.mission.channel import Channel


class Peers:
    """`before_send` is called before any goal whose result is awaited leaves the brain."""

    def __init__(self, io: Io, before_send: Callable[[], None]) -> None:
        self.speech = Channel(io, "speech", topics.SPEECH_GOAL)
        self.navigation = Channel(io, "navigation", topics.NAVIGATION_GOAL)
        self.manipulation = Channel(io, "manipulation", topics.MANIPULATION_GOAL)
        self.planner = Channel(io, "planner")
        self.perception = Channel(io, "perception")
        self.all = (self.speech, self.navigation, self.manipulation, self.planner, self.perception)
        for channel in self.all:
            channel.before_send = before_send
