"""A brain with peers that keep the rules of goals in a tiny world, and the power to kill any of them at any moment."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

from common import messages as m
from common import topics
from common.bus import codec
from common.bus.memory import MemoryBus, MemoryIo
from common.household import load_household
from common.time.lockstep import DT
from services.brain.config import BrainConfig
from services.brain.service import BrainService
from tests.node import Node

SCENE = load_household("apartment")
ITEM = "red mug"
TRAY = (0.7, 0.0, 0.51)
PERIOD = 0.05
SECONDS = {"drive": 3.0, "grab": 3.0, "release": 2.0, "listen": 1.0, "plan": 0.5, "look": 0.5}
PLAN = [
    m.PlanStep(action="find", object=ITEM),
    m.PlanStep(action="grasp", object=ITEM),
    m.PlanStep(action="return"),
    m.PlanStep(action="release"),
]


class Peer:
    """Runs one goal at a time; the same (id, attempt) twice is answered with how it stands."""

    def __init__(self, world: "World", name: str, reads: tuple[Any, ...], writes: tuple[Any, ...]) -> None:
        self.world, self.name = world, name
        self.io = MemoryIo(world.bus, name, reads, writes, household=SCENE, lockstep=False)
        self.goals = reads
        self.seen: set[tuple[str, int]] = set()
        self.answers: dict[tuple[str, int], Callable[[], None]] = {}
        self.job: tuple[float, Any, Callable[[], None]] | None = None

    def step(self, now: float) -> None:
        self.io.begin(None, now)
        for topic in self.goals:
            for goal in self.io.take_all(topic):
                key = goal.id, getattr(goal, "attempt", 0)
                if key in self.seen:
                    if key in self.answers:
                        self.answers[key]()
                    continue
                self.seen.add(key)
                self.job = None
                self.take(goal, now)
        if self.job is not None and now >= self.job[0]:
            _, _, act = self.job
            self.job = None
            act()

    def run(self, goal: Any, seconds: float, act: Callable[[], None]) -> None:
        self.job = (self.world.now + seconds, goal, act)

    def take(self, goal: Any, now: float) -> None:
        raise NotImplementedError

    def answer(self, goal: Any, send: Callable[[], None]) -> None:
        self.answers[goal.id, getattr(goal, "attempt", 0)] = send
        send()


class Navigation(Peer):
    def __init__(self, world: "World") -> None:
        goals = (topics.NAVIGATION_GOAL, topics.NAV_GOAL)
        writes = topics.NAVIGATION_STATUS, topics.NAVIGATION_FEEDBACK, topics.POSE
        super().__init__(world, "navigation", goals, writes)

    def take(self, goal: Any, now: float) -> None:
        text = getattr(goal, "goal", "")
        if text == "stop":
            return
        self.say(goal, "navigating")
        about = getattr(goal, "object", None)
        text = f"find {about.label}" if about is not None else text
        where = {"return_to_start": "home", f"find {ITEM}": "item"}.get(text, "elsewhere")
        self.world.place = "" if self.world.place != where else where
        self.run(goal, SECONDS["drive"], lambda: self.arrive(goal, where))

    def arrive(self, goal: Any, where: str) -> None:
        self.world.place = where
        self.world.drives.append(where)
        self.say(goal, "arrived")

    def say(self, goal: Any, status: m.NavStatus) -> None:
        if isinstance(goal, m.NavGoal):
            told = m.NavigationFeedback(status=status, goal_id=goal.id)
            self.answer(goal, lambda: self.io.publish(topics.NAVIGATION_FEEDBACK, told))
            return
        message = m.NavigationStatus(status=status, goal_id=goal.id, attempt=goal.attempt)
        self.answer(goal, lambda: self.io.publish(topics.NAVIGATION_STATUS, message))


class Manipulation(Peer):
    def __init__(self, world: "World") -> None:
        super().__init__(world, "manipulation", (topics.MANIPULATION_GOAL,), (topics.MANIPULATION_STATUS,))

    def take(self, goal: m.ManipulationGoal, now: float) -> None:
        world = self.world
        if goal.goal == "stop":
            return
        self.say(goal, "executing")
        if goal.goal == "grab":
            if world.held:
                self.say(goal, "done")
            elif world.place != "item" or world.item_at != "item":
                self.say(goal, "failed")
            else:
                self.run(goal, SECONDS["grab"], lambda: self.grabbed(goal))
        elif not world.held:
            self.say(goal, "done")
        else:
            self.run(goal, SECONDS["release"], lambda: self.released(goal))

    def grabbed(self, goal: m.ManipulationGoal) -> None:
        self.world.held, self.world.item_at = ITEM, "hand"
        self.world.grabs += 1
        self.say(goal, "done")

    def released(self, goal: m.ManipulationGoal) -> None:
        self.world.held, self.world.item_at = "", self.world.place
        self.world.releases += 1
        self.say(goal, "done")

    def say(self, goal: m.ManipulationGoal, status: m.ManipStatus) -> None:
        message = m.ManipulationStatus(status=status, goal_id=goal.id, attempt=goal.attempt)
        self.answer(goal, lambda: self.io.publish(topics.MANIPULATION_STATUS, message))


class Speech(Peer):
    """Hears `yes` to every question."""

    def __init__(self, world: "World") -> None:
        super().__init__(world, "speech", (topics.SPEECH_GOAL,), (topics.SPEECH_RESULT, topics.SPEECH_STATUS))

    def take(self, goal: m.SpeechGoal, now: float) -> None:
        if goal.goal == "listen":
            words = "yes" if self.world.asked else f"bring me the {ITEM}"
            if self.world.asked and self.world.pipeline == "fetch":
                return
            self.world.asked = True
            result = m.SpeechResult(text=words, goal_id=goal.id)
            send = lambda: self.answer(goal, lambda: self.io.publish(topics.SPEECH_RESULT, result))  # noqa: E731
            self.run(goal, SECONDS["listen"], send)
        elif goal.goal.startswith("say "):
            self.world.said.append(goal.goal[4:])


class Planner(Peer):
    def __init__(self, world: "World") -> None:
        super().__init__(world, "planner", (topics.PLAN_REQUEST,), (topics.ACTION_PLAN,))

    def take(self, goal: m.PlanRequest, now: float) -> None:
        plan = m.ActionPlan(request_id=goal.id, steps=PLAN)
        send = lambda: self.answer(goal, lambda: self.io.publish(topics.ACTION_PLAN, plan))  # noqa: E731
        self.run(goal, SECONDS["plan"], send)


class Perception(Peer):
    def __init__(self, world: "World") -> None:
        super().__init__(world, "perception", (topics.OBJECT_QUERY,), (topics.OBJECT_POSE,))

    def take(self, goal: m.ObjectQuery, now: float) -> None:
        self.run(goal, SECONDS["look"], lambda: self.look(goal))

    def look(self, goal: m.ObjectQuery) -> None:
        at = self.world.item_at
        position = TRAY if at == "home" else (1.0, 2.0, 0.8)
        pose = m.ObjectPose(
            query_id=goal.id, found=at != "hand", label=ITEM, confidence=0.9, position=position, seen_at=self.world.now
        )
        self.answer(goal, lambda: self.io.publish(topics.OBJECT_POSE, pose))


PEERS = (Navigation, Manipulation, Speech, Planner, Perception)
SPOTS = {"home": 0.0, "item": 3.0, "elsewhere": 6.0}


class World:
    """One object, a hand, a base that is at `home`, `item`, `elsewhere` or under way ("").

    `silent`: the simulation is gone.
    """

    def __init__(self, pipeline: Any, path: Path | None = None, **parameters: Any) -> None:
        self.bus, self.now, self.pipeline = MemoryBus(), 100.0, pipeline
        parameters = {"settle": 0.3, **parameters}
        self.config = BrainConfig(pipeline=pipeline, journal=str(path) if path else "", **parameters)
        self.place, self.held, self.item_at = "home", "", "item"
        self.drives: list[str] = []
        self.said: list[str] = []
        self.grabs = self.releases = 0
        self.asked = self.silent = False
        self.states = self.bus.tap(topics.BRAIN_STATE)
        self.peers: dict[str, Peer] = {}
        for kind in PEERS:
            peer = kind(self)
            self.peers[peer.name] = peer
        self.node: Node | None = None
        self.start_brain()

    def start_brain(self, lockstep: bool = False) -> None:
        self.node = Node(BrainService, self.config, SCENE, bus=self.bus, lockstep=lockstep, tick=round(self.now / DT))

    @property
    def brain(self) -> BrainService | None:
        return self.node and self.node.service

    def kill_brain(self) -> None:
        assert self.node is not None
        self.bus.detach(self.node.io)
        self.node.service.context.journal.close()  # as the system does with the files of a dead process
        self.node = None

    def restart_brain(self, down: float = 0.0) -> None:
        """Kill the brain, let `down` seconds pass, and start it again."""
        self.kill_brain()
        if down:
            self.step(down)
        self.start_brain()

    def end_brain(self) -> None:
        """As SIGTERM does."""
        assert self.node is not None
        self.node.service.close()
        self.bus.detach(self.node.io)
        self.node = None

    def restart(self, name: str) -> None:
        """A peer forgets all it knew."""
        old = self.peers[name]
        self.bus.detach(old.io)
        self.peers[name] = type(old)(self)  # type: ignore[call-arg]

    def step(self, seconds: float = PERIOD) -> None:
        for _ in range(max(1, round(seconds / PERIOD))):
            self.now += PERIOD
            for peer in self.peers.values():
                peer.step(self.now)
            self._publish()
            if self.node is not None:
                self.node.step()

    def _publish(self) -> None:
        if self.silent:
            return
        width, force = (0.04, 25.0) if self.held else (0.085, 0.0)
        joints = m.JointStates(t=self.now, name=["gripper"], position=[width], velocity=[0.0], effort=[force])
        self.bus.send(topics.JOINT_STATES, joints)
        if self.place:
            self.bus.send(topics.POSE, m.PoseEstimate(t=self.now, x=SPOTS[self.place], y=0.0, theta=0.0))

    def until(self, probe: Callable[[], Any], limit: float = 200.0) -> None:
        end = self.now + limit
        while not probe():
            assert self.now < end, (self.state, self.timeline())
            self.step()

    # --- what came of it
    @property
    def state(self) -> m.BrainState:
        return codec.decode(topics.BRAIN_STATE, self.states[-1])

    @property
    def outcome(self) -> str:
        return self.state.last.outcome if self.state.last else ""

    def timeline(self) -> str:
        if self.brain is None:
            return ""
        journal = self.brain.context.journal
        record = journal.last() or next(iter(journal.missions()[-1:]), None)
        whole = journal.mission(record.id) if record else None
        return "\n".join(f"{e.t:7.2f} {e.state:10} {e.cause} | {e.evidence}" for e in whole.entries) if whole else ""
