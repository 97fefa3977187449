"""The real brain and the real planner through whole commands; the other peers keep a small world of many objects."""

import msgspec
import pytest

from common import config, topics
from common import messages as m
from common.bus.memory import MemoryBus, MemoryIo
from common.household import load_household
from common.time.lockstep import DT
from services.brain.config import BrainConfig
from services.brain.service import BrainService
from services.planner.config import PlannerConfig
from services.planner.service import PlannerService
from tests.node import Node

SCENE = load_household("apartment")
PLANNER = config.load("planner", PlannerConfig, config.DEFAULT_DIR, {})
PERIOD = 0.1


class World:
    """Objects on receptacles, a hand, a robot that sees what is where it stands. Goals are done at once."""

    def __init__(self, seen: tuple[str, ...] = (), **places: str) -> None:
        self.bus, self.now = MemoryBus(), 100.0
        self.on = {name.replace("_", " "): where.replace("_", " ") for name, where in places.items()}
        self.at, self.held = "home", ""
        self.seen = set(seen)
        self.log: list[str] = []
        self.said: list[str] = []
        writes = (
            topics.NAVIGATION_STATUS, topics.NAVIGATION_FEEDBACK, topics.MANIPULATION_STATUS, topics.OBJECT_POSE,
            topics.WORLD_OBJECTS, topics.JOINT_STATES, topics.SPEECH_RESULT,
        )  # fmt: skip
        self.goals = (
            topics.NAVIGATION_GOAL, topics.NAV_GOAL, topics.MANIPULATION_GOAL, topics.OBJECT_QUERY, topics.SPEECH_GOAL,
        )  # fmt: skip
        self.io = MemoryIo(self.bus, "peers", self.goals, writes, household=SCENE, lockstep=False)
        for name in ("navigation", "manipulation", "perception", "speech"):
            MemoryIo(self.bus, name, (), (), household=SCENE, lockstep=False)
        brain = BrainConfig(pipeline="vla", enable_confirmation=False, settle=0.1)
        self.nodes = [
            Node(kind, config, SCENE, bus=self.bus, lockstep=False, tick=round(self.now / DT))
            for kind, config in ((BrainService, brain), (PlannerService, PLANNER))
        ]
        self.plans = self.bus.tap(topics.ACTION_PLAN)
        self._show()

    def do(self, command: str, limit: float = 600.0) -> m.MissionOutcome:
        """Say a command and wait for the end of its mission."""
        self.step()
        before = self._last()
        self.bus.send(topics.VOICE_COMMAND, m.VoiceCommand(text=command, confidence=1.0))
        end = self.now + limit
        while self._last() == before:
            assert self.now < end, self.log
            self.step()
        outcome = self._last()
        assert outcome is not None
        return outcome

    def _last(self) -> m.MissionOutcome | None:
        state = self.bus.last.get("brain/state")
        return msgspec.json.decode(state, type=m.BrainState).last if state else None

    def step(self) -> None:
        self.now += PERIOD
        self.io.begin(None, self.now)
        width, force = (0.04, 25.0) if self.held else (0.085, 0.0)
        joints = m.JointStates(t=self.now, name=["gripper"], position=[width], velocity=[0.0], effort=[force])
        self.io.publish(topics.JOINT_STATES, joints)
        for topic in self.goals:
            for goal in self.io.take_all(topic):
                getattr(self, "_" + topic.key.rpartition("/")[2])(goal)
        for node in self.nodes:
            node.later(PERIOD)
            node.run()

    # --- the peers
    def _navigation_goal(self, goal: m.NavigationGoal) -> None:
        verb, _, where = goal.goal.partition(" ")
        if verb == "stop":
            return
        self.at = "home" if verb == "return_to_start" else self.on.get(where, where)
        self.log.append(goal.goal)
        self.seen |= {name for name, on in self.on.items() if on == self.at}
        self._show()
        self.io.publish(
            topics.NAVIGATION_STATUS, m.NavigationStatus(status="arrived", goal_id=goal.id, attempt=goal.attempt)
        )

    def _nav_goal(self, goal: m.NavGoal) -> None:
        if goal.object is not None:
            self._navigation_goal(m.NavigationGoal(goal=f"find {goal.object.label}", id=goal.id))
        self.io.publish(topics.NAVIGATION_FEEDBACK, m.NavigationFeedback(goal_id=goal.id, status="arrived"))

    def _manipulation_goal(self, goal: m.ManipulationGoal) -> None:
        verb, _, where = goal.goal.partition(" ")
        if verb == "stop":
            return
        if verb == "grab":
            assert goal.object is not None and not self.held and self.on[goal.object.label] == self.at
            self.held = goal.object.label
        else:
            self.on[self.held], self.held = where or SCENE.delivery, ""
        self.log.append(goal.goal)
        self._show()
        status = m.ManipulationStatus(status="done", goal_id=goal.id, attempt=goal.attempt)
        self.io.publish(topics.MANIPULATION_STATUS, status)

    def _object_query(self, query: m.ObjectQuery) -> None:
        known = [n for n in sorted(self.seen) if n != self.held]
        names = [n for n in known if n == query.query or n.split()[-1] == query.query]
        found = names[0] if len(names) == 1 else ""
        pose = m.ObjectPose(query_id=query.id, found=bool(found), label=found, position=(1.0, 2.0, 0.8))
        self.io.publish(topics.OBJECT_POSE, pose)

    def _speech_goal(self, goal: m.SpeechGoal) -> None:
        if goal.goal.startswith("say "):
            self.said.append(goal.goal[4:])

    def _show(self) -> None:
        rows = []
        for name in sorted(self.seen):
            spec, r = SCENE.thing(name), SCENE.receptacle(self.on[name])
            assert spec is not None
            x, y, z = r.center if r else (0.0, 0.0, 1.0)
            rows.append(
                m.WorldObject(
                    label=name, kind=spec.kind, colour=spec.colour, position=(x, y, z + 0.05), size=spec.size,
                    on=r.name if r else "", held=name == self.held,
                )
            )  # fmt: skip
        self.io.publish(topics.WORLD_OBJECTS, m.WorldObjects(t=self.now, objects=rows))


def test_tidying_a_table_nobody_has_seen() -> None:
    world = World(red_mug="living table", green_can="living table", red_ball="living table", blue_mug="counter")
    outcome = world.do("tidy up the living table")
    assert outcome.outcome == "delivered", outcome.reason
    assert world.on == {
        "red mug": "counter", "green can": "recycling bin", "red ball": "toy box", "blue mug": "counter",
    }  # fmt: skip
    assert world.log[0] == "goto living table", "it looks before it takes anything"
    plans = [msgspec.json.decode(p, type=m.ActionPlan) for p in world.plans]
    assert [p.again for p in plans] == [True, False]


def test_an_empty_table_is_reported() -> None:
    outcome = World(apple="counter").do("tidy up the living table")
    assert outcome.outcome == "failed" and "found nothing" in outcome.reason


@pytest.mark.parametrize(
    ("command", "expected"),
    [
        ("bring me the apple", {"apple": "delivery tray"}),
        ("bring me all the cans", {"green can": "delivery tray", "red can": "delivery tray"}),
        ("put the apple and the red mug on the desk", {"apple": "desk", "red mug": "desk"}),
        ("pick up the red mug and put it on the bookshelf", {"red mug": "bookshelf"}),
        ("throw the red can away and then bring me the mug on the counter", {"red can": "recycling bin",
                                                                            "blue mug": "delivery tray"}),
        ("put everything on the counter in the bin", {"blue mug": "bin", "red can": "bin"}),
        ("take the apple to the bedroom", {"apple": "dresser"}),
    ],
)  # fmt: skip
def test_commands_change_the_world_as_they_say(command: str, expected: dict[str, str]) -> None:
    places = {"red_mug": "living table", "green_can": "living table", "blue_mug": "counter", "red_can": "counter"}
    world = World(seen=("red mug", "green can", "blue mug", "red can", "apple"), apple="kitchen table", **places)
    before = dict(world.on)
    outcome = world.do(command)
    assert outcome.outcome == "delivered", outcome.reason
    assert world.on == before | expected and not world.held


def test_what_was_taken_in_one_command_is_put_in_the_next() -> None:
    world = World(seen=("apple",), apple="counter")
    assert world.do("pick up the apple").outcome == "delivered" and world.held == "apple"
    assert world.do("put it in the bin").outcome == "delivered" and world.on == {"apple": "bin"}


def test_a_refusal_is_spoken() -> None:
    world = World()
    assert world.do("open the fridge").outcome == "failed"
    for _ in range(20):
        world.step()
    assert any("I cannot open or close doors" in said for said in world.said)
    assert not world.log
