"""The verdict on a mission of a running robot, by the judge of the evaluation over a link."""

import msgspec

from cli.link import Link, Subscription
from common import topics
from common.scene import Scene
from common.time.clock import monotonic
from judge.evidence import Want
from judge.goal import Goal
from judge.observer import WATCH, Observer
from judge.verdict import objections

PATIENCE = 60.0
"""Wall time [s] that the simulation may be silent while the judge watches on: a link that is cut heals within it."""


class Verdict(msgspec.Struct):
    """`delivered` by physics and without a false claim; `why` not, or where the thing is."""

    delivered: bool
    why: str


class Witness:
    """Observes one object, to be delivered to the scene's delivery place, from before the command on.

    Made once the simulation answers. `look` takes in what has come since; `judge` watches on for `WATCH` seconds of
    robot time before it concludes.
    """

    def __init__(self, link: Link, scene: Scene, thing: str) -> None:
        self._goal = Goal((Want(thing, (scene.delivery,)),))
        self._thing = thing
        self._observer = Observer(scene)
        self._model = Subscription(link, topics.SIM_MODEL)
        self._state = Subscription(link, topics.SIM_STATE)
        self._contacts = Subscription(link, topics.SIM_CONTACTS)
        self._brain = Subscription(link, topics.BRAIN_STATE)
        self._status = Subscription(link, topics.SYSTEM_STATUS)
        self._speech = Subscription(link, topics.SPEECH_STATUS)
        self.now = 0.0

    def begin(self) -> None:
        """Wait for the world; what moves from here on is disturbed."""
        end = monotonic() + PATIENCE
        while not self._observer.ready and monotonic() < end:
            self.look(0.2)
        self._observer.begin()
        self._observer.expect(self._goal)

    def look(self, timeout: float = 0.0) -> None:
        """Take in what has come, waiting for the world at most `timeout` seconds of wall time."""
        observer = self._observer
        if not observer.ready and (model := self._model.next(timeout)) is not None:
            observer.model(model)
        world = self._state.next(timeout)
        while world is not None:
            observer.world(world)
            self.now = max(self.now, world.t)
            world = self._state.next(0.0)
        for contacts in self._contacts.drain():
            observer.contacts(contacts)
        for status in self._speech.drain():
            observer.speech(self.now, status)
        for system in self._status.drain():
            observer.status(self.now, system)
        for state in self._brain.drain():
            observer.brain(self.now, state)

    def judge(self) -> Verdict:
        """After the mission, watch on and conclude."""
        until, end, before = self.now + WATCH, monotonic() + PATIENCE, self.now
        while self.now < until and monotonic() < end:
            self.look(0.2)
            if self.now > before:
                before, end = self.now, monotonic() + PATIENCE
        evidence = self._observer.conclude(self._goal)
        if self.now < until:
            return Verdict(False, f"the simulation was silent for {PATIENCE:.0f} s")
        if against := objections(evidence, self._observer.claims):
            return Verdict(False, "; ".join(against))
        thing = evidence.things[0]
        return Verdict(True, f"the {self._thing} stands on {thing.on}, {thing.tilt:.0f} degrees from upright")
