"""The gripper by the brain's own hand: commands that need no arm, and letting go when the arm is gone."""

import pytest

from common import messages as m
from common import topics
from common.bus.memory import MemoryIo
from common.household import load_household
from common.plan_rules import known_world, objection
from services.brain.config import BrainConfig
from tests.unit.brain_bench import Bench

OPEN = m.PlanStep(action="release", target="gripper")
CLOSE = m.PlanStep(action="grasp", target="gripper")
PUT_DOWN = m.PlanStep(action="release")
Grip = tuple[float, float]
WIDE, SHUT, AROUND = (0.085, 0.0), (0.0, 30.0), (0.041, 30.0)


class GripperState(Bench):
    """A bench whose joint_states tell of a gripper that goes where it is told, unless it is `stuck`."""

    def __init__(self, grip: Grip, steps: list[m.PlanStep], holding: str = "", inside: float = 0.0) -> None:
        super().__init__(BrainConfig(pipeline="vla", enable_confirmation=False))
        self.grip, self.inside, self.stuck = grip, inside, False
        self.brain.context.gripper.holding = holding
        self.step()
        self.ask(steps)

    def ask(self, steps: list[m.PlanStep]) -> None:
        """A command, and the plan for it."""
        count = len(self.sent(topics.PLAN_REQUEST)) + 1
        self.send(topics.VOICE_COMMAND, m.VoiceCommand(text="as I say", confidence=1.0))
        request = self.next_goal(topics.PLAN_REQUEST, count)
        self.send(topics.ACTION_PLAN, m.ActionPlan(request_id=request.id, steps=steps))

    def feed(self) -> None:
        self._move()
        width, force = self.grip
        joints = m.JointStates(t=self.now, name=["gripper"], position=[width], velocity=[0.0], effort=[force])
        self.bus.send(topics.JOINT_STATES, joints)

    def _move(self) -> None:
        told = self.sent(topics.GRIPPER_COMMAND)
        if not told or self.stuck:
            return
        width = self.grip[0]
        if told[-1].position == 0.0:
            self.grip = min(WIDE[0], width + 0.005), 0.0
        else:
            least = self.inside or 0.0
            self.grip = (max(least, width - 0.005), 30.0)

    def outcome(self) -> m.MissionOutcome:
        self.until(lambda: self.state.last is not None)
        assert self.state.last is not None
        return self.state.last

    def positions(self) -> set[float]:
        return {command.position for command in self.sent(topics.GRIPPER_COMMAND)}


@pytest.mark.parametrize("grip", [WIDE, SHUT], ids=["open", "closed"])
def test_an_empty_hand_opens_without_the_arm(grip: Grip) -> None:
    hand = GripperState(grip, [OPEN])
    assert hand.outcome().outcome == "delivered"
    assert hand.positions() == {0.0} and hand.grip[0] > 0.08
    assert hand.sent(topics.MANIPULATION_GOAL) == []
    assert "RELEASING" in hand.states() and "EXECUTING" in [s.state for s in hand.sent(topics.SYSTEM_STATUS)]


def test_an_empty_hand_closes_and_stays_empty() -> None:
    hand = GripperState(WIDE, [CLOSE])
    assert hand.outcome().outcome == "delivered"
    assert hand.positions() == {1.0} and hand.brain.context.gripper.holding == ""


def test_what_a_person_puts_into_the_closing_hand_is_held() -> None:
    hand = GripperState(WIDE, [CLOSE], inside=0.03)
    assert hand.outcome().outcome == "delivered"
    assert hand.brain.context.gripper.holding == "object"
    hand.step(3.0)
    assert hand.brain.context.gripper.holding == "object" and not hand.brain.context.gripper.has_lost_object(hand.now)


@pytest.mark.parametrize("step", [OPEN, CLOSE])
def test_time_alone_is_no_success(step: m.PlanStep) -> None:
    hand = GripperState((0.05, 0.0), [step])
    hand.stuck = True
    ended = hand.outcome()
    assert ended.outcome == "failed" and "STUCK" in ended.reason and "50 mm" in ended.reason
    assert len(hand.sent(topics.GRIPPER_COMMAND)) > 5, "it is said again and again"


def test_a_full_hand_sets_down_first() -> None:
    hand = GripperState(AROUND, [OPEN])
    goal = hand.manip(1)
    assert goal.goal == "release" and not hand.sent(topics.GRIPPER_COMMAND), "felt, though nobody knew of it"
    hand.did(goal)
    assert hand.outcome().outcome == "delivered"


def gone(answer: str) -> GripperState:
    """Asked to put down the mug while manipulation dies for good; the person answers the question."""
    hand = GripperState(AROUND, [PUT_DOWN], holding="red mug")
    arm = MemoryIo(hand.bus, "manipulation", (), (), household=hand.io.household, lockstep=False)
    hand.manip(1)
    hand.step(0.5)
    hand.bus.detach(arm)
    reply(hand, answer)
    return hand


def reply(hand: GripperState, answer: str) -> None:
    hand.until(lambda: hand.state.state == "CONFIRMING")
    assert "let the red mug drop" in hand.state.step and not hand.sent(topics.GRIPPER_COMMAND)
    hand.send(topics.VOICE_COMMAND, m.VoiceCommand(text=answer, confidence=1.0))
    hand.step()


def test_without_an_arm_it_lets_go_on_a_yes() -> None:
    hand = gone("yes")
    assert hand.outcome().outcome == "delivered"
    assert hand.positions() == {0.0} and hand.brain.context.gripper.holding == ""
    assert "red mug" in hand.brain.context.gripper.put_down


def test_without_a_yes_it_holds_on() -> None:
    hand = gone("no")
    ended = hand.outcome()
    assert ended.outcome == "failed" and "NO_PEER" in ended.reason and "still holding the red mug" in ended.reason
    assert not hand.sent(topics.GRIPPER_COMMAND) and hand.brain.context.gripper.holding == "red mug"
    hand.until(lambda: hand.state.state == "WAITING")
    asked = hand.now
    hand.ask([PUT_DOWN])
    reply(hand, "yes")
    assert hand.now - asked < BrainConfig().peer_timeout, "who is long gone is not waited for again"
    hand.until(lambda: hand.outcome().outcome == "delivered")


def test_plans_of_the_hand_alone() -> None:
    scene = load_household("apartment")
    empty, full = known_world(scene, [], ""), known_world(scene, [], "red mug")
    assert objection([OPEN, CLOSE], empty, scene) is None
    assert "has to be put down" in str(objection([OPEN], full, scene))
    assert "has to be put down" in str(objection([CLOSE], full, scene))
    assert "nothing in the hand" in str(objection([PUT_DOWN], empty, scene)), "as before"
    assert "no object is named" in str(objection([m.PlanStep(action="grasp")], empty, scene)), "as before"
