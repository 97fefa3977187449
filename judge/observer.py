"""Watches a running robot for the judge: the simulation's state and what the robot publishes and says go in.

Whoever judges feeds it: the examiner of an evaluation, a benchmark, the demonstration.
"""

from common import messages as m
from common.scene import Scene
from judge.claims import Claim, ClaimListener, Statement
from judge.effects import Shown, Watcher
from judge.evidence import Evidence, Recorder, Sample
from judge.goal import Goal, shortfall
from judge.replica import Replica

WATCH = 10.0
"""Robot time [s] that physics is watched on after a mission: what was put down badly falls meanwhile."""


class Observer:
    """`claims` holds every success announced so far, each with what physics said at that moment.

    `saying`: the sentence that the robot is saying aloud, "" for none.
    """

    def __init__(self, scene: Scene) -> None:
        self._scene = scene
        bins = frozenset(r.name for r in scene.receptacles if r.depth)
        self._recorder = Recorder({o.name: o.kind for o in scene.objects}, bins)
        self._watcher = Watcher(scene)
        self._replica: Replica | None = None
        self._listener = ClaimListener()
        self._goal = Goal()
        self._goals: dict[str, Goal] = {}
        self._may_move: frozenset[str] = frozenset()
        self.saying = ""
        self.claims: list[Claim] = []

    @property
    def ready(self) -> bool:
        """The world has been seen."""
        return self._recorder.ready

    # --- physics
    def model(self, model: m.SimModel) -> None:
        """The world's model; only the first one counts."""
        self._replica = self._replica or Replica(model.mjcf, self._scene, model.files)

    def world(self, state: m.SimState) -> Sample | None:
        """One state of the world; None before its model is known."""
        if self._replica is None:
            return None
        sample = self._replica.sample(state)
        self._recorder.add(sample)
        self._watcher.add(sample)
        return sample

    def contacts(self, report: m.SimContacts) -> None:
        """A part of the simulation's log of contacts."""
        self._recorder.feel(report)

    # --- what is wanted
    def begin(self) -> None:
        """The robot is about to be asked for the first time: what has moved until now is the world settling."""
        self._recorder.restart()

    def expect(self, goal: Goal) -> None:
        """What the next mission should bring about."""
        self._goal = goal
        self._may_move |= goal.things

    # --- what the robot says
    def brain(self, now: float, state: m.BrainState) -> None:
        """A message on `brain/state` at robot time `now`."""
        if state.mission_id:
            self._goals.setdefault(state.mission_id, self._goal)
        self._hold(now, self._listener.state(state))

    def status(self, now: float, status: m.SystemStatus) -> None:
        """Take a message of `system_status`."""
        self._hold(now, self._listener.status(status))

    def speech(self, now: float, status: m.SpeechStatus) -> str:
        """What the robot says aloud at robot time `now`, "" while it is silent; each sentence counts as it begins."""
        saying = status.detail if status.state == "speaking" else ""
        if saying and saying != self.saying:
            self.sentence(now, saying)
        self.saying = saying
        return saying

    def sentence(self, now: float, text: str) -> None:
        """A sentence that the robot says aloud."""
        self._watcher.hear(text)
        self._hold(now, self._listener.sentence(text))

    def _hold(self, now: float, statements: list[Statement]) -> None:
        """Hold statements against physics as it is now."""
        for said in statements:
            why = self.shortfall(self._goals.get(said.mission, self._goal))
            self.claims.append(Claim(round(now, 2), said.source, said.text, said.mission, said.command, why))

    # --- the end
    def shortfall(self, goal: Goal) -> str:
        """What is not as `goal` wants it now; "" if nothing."""
        return shortfall(self._recorder.things(goal.wants), self.shown(goal))

    def shown(self, goal: Goal) -> list[Shown]:
        """Which effects of the goal have been shown until now."""
        return self._watcher.conclude(goal.effects)

    def wrong(self) -> list[str]:
        """Objects that were in the hand and that nobody asked for."""
        return sorted(self._watcher.lifted - self._may_move)

    def conclude(self, goal: Goal) -> Evidence:
        """The evidence of all that was seen, held against `goal`."""
        return self._recorder.conclude(goal.wants, self._may_move | goal.things)
