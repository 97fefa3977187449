"""A policy that grabs: whatever it answers, the arm stays within its limits, and only what is held is claimed."""

import threading
from typing import Any

import numpy as np
import pytest

from cli.demonstrations.sampler import Sampler
from common import messages as m
from common import topics
from common.bus import codec
from common.demonstration import ACTION, PICTURE_SIZE, STATE
from common.runtime import StartError
from services.manipulation.arm.arm_model import Obstacle
from services.manipulation.arm.servo import COLLISION, OUTSIDE, Servo
from services.manipulation.execution.policy import (
    PolicyError,
    action_of,
    load_policy,
    observation,
    picture_of,
    state_of,
)
from services.sim.model import own
from tests.mission import Robot
from tests.unit.led_arm import PERIOD, LedArm

MUG = m.ObjectRef(label="red mug", position=(0.62, 0.0, 0.65), size=(0.074, 0.074, 0.095), kind="mug")
HOLD = [0.0, 0.0, 0.0, *own().home, 0.0]
RELEASED = threading.Event()


class Wild:
    """Throws the arm about."""

    def __init__(self) -> None:
        self._rng = np.random.default_rng(3)

    def __call__(self, seen: dict[str, Any]) -> Any:
        return [9.0, 9.0, 9.0, *(np.array(own().home) + self._rng.uniform(-2.5, 2.5, 7)), 0.5]


def done(seen: dict[str, Any]) -> None:
    return None


def short(seen: dict[str, Any]) -> Any:
    return [0.0] * 7


def no_number(seen: dict[str, Any]) -> Any:
    return [float("nan")] * 11


def broken(seen: dict[str, Any]) -> Any:
    raise KeyError("observation.images.third")


def still(seen: dict[str, Any]) -> Any:
    return HOLD


def stuck(seen: dict[str, Any]) -> Any:
    RELEASED.wait(30)
    return HOLD


def playing(name: str, seconds: float = 3.0, lockstep: bool = True, **config: object) -> LedArm:
    arm = LedArm(lockstep, policy=f"{__name__}:{name}", **{"policy_cameras": (), **config})
    arm.step(1.0)
    arm.send(topics.MANIPULATION_GOAL, m.ManipulationGoal(goal="grab", id="a.1", object=MUG))
    arm.step(seconds)
    return arm


# --- set-points
def test_no_target_leads_the_arm_out_of_its_limits_or_into_anything() -> None:
    arm = LedArm().model
    servo = Servo(arm, 1.0, 2.5, (-0.8, 1.1, -0.9, 0.9, 0.03, 1.7), PERIOD)
    servo.begin(arm.home, np.zeros(7), ())
    rng, seen, target = np.random.default_rng(1), [servo.q], arm.home
    for n in range(1500):
        if n % 60 == 0:
            target = arm.home + rng.uniform(-3, 3, 7)
        servo.towards(target)
        seen.append(servo.q)
    rates = np.diff(np.array(seen), axis=0) / PERIOD
    assert np.abs(rates).max() <= 1.0 + 1e-9 and np.abs(np.diff(rates, axis=0)).max() <= 2.5 * PERIOD + 1e-9
    free = LedArm().model
    free.set_obstacles((), 0.0)
    assert not any(free.collides(q) for q in seen)
    heights = [arm.pose(q).position[2] for q in seen[::3]]
    assert min(heights) >= 0.03 - 1e-3 and np.abs(rates).max() > 0.9, "and yet it moves"


def test_it_brakes_before_a_solid_and_goes_away_from_it_again() -> None:
    arm = LedArm().model
    start = arm.home + np.array([0.0, 0.9, 0.0, 0.5, 0.0, 0.3, 0.0])
    tip = arm.pose(start).position
    servo = Servo(arm, 0.5, 2.5, (-0.8, 1.1, -0.9, 0.9, 0.03, 1.7), PERIOD)
    below = Obstacle((float(tip[0]), float(tip[1]), float(tip[2]) - 0.2), (0.1, 0.1, 0.1))
    servo.begin(start, np.zeros(7), [below])
    whys = {servo.hand(np.array([0.0, 0.0, -0.1]), np.zeros(3)) for _ in range(200)}
    down = arm.pose(servo.q).position
    assert COLLISION in whys and 0.02 < tip[2] - down[2] < 0.15
    for _ in range(50):
        servo.hand(np.array([0.0, 0.0, 0.1]), np.zeros(3))
    assert arm.pose(servo.q).position[2] > down[2] + 0.03


def test_the_workspace_ends_where_it_is_said_to() -> None:
    arm = LedArm().model
    tip = arm.pose(arm.home).position
    servo = Servo(arm, 0.5, 2.5, (-0.8, float(tip[0]) + 0.05, -0.9, 0.9, 0.03, 1.7), PERIOD)
    servo.begin(arm.home, np.zeros(7), ())
    whys = {servo.hand(np.array([0.1, 0.0, 0.0]), np.zeros(3)) for _ in range(100)}
    assert OUTSIDE in whys and arm.pose(servo.q).position[0] <= tip[0] + 0.05 + 1e-3


@pytest.mark.parametrize("tells_weight", [False, True])
def test_a_force_is_felt_whether_or_not_the_arm_tells_its_own_weight(tells_weight: bool) -> None:
    led = LedArm()
    servo = Servo(led.model, 0.5, 2.5, (-0.8, 1.1, -0.9, 0.9, 0.03, 1.7), PERIOD)
    q = led.model.home + np.array([0.2, 0.3, 0.1, 0.2, 0.0, -0.2, 0.0])
    weight = [servo._gravity(at) if tells_weight else np.zeros(7) for at in (led.model.home, q)]
    servo.begin(led.model.home, weight[0], ())
    led.q, led.press = q, np.array([0.0, 12.0, -9.0])
    assert servo.force(q, weight[1]) < 1.0
    assert servo.force(q, weight[1] + led.torques()) == pytest.approx(15.0, abs=1.0)


# --- playing
def test_a_wild_policy_moves_the_arm_within_its_limits_and_is_ended() -> None:
    arm = playing("Wild", 20.0, policy_seconds=6.0)
    rates = arm.rates()
    assert len(arm.followed) > 50 and np.abs(rates).max() <= arm.config.joint_speed + 1e-6
    assert np.abs(np.diff(rates[:-1], axis=0)).max() <= arm.config.joint_acceleration * PERIOD + 1e-6
    assert not any(arm.model.collides(q) for q in arm.followed)
    assert arm.status().status == "failed" and arm.status().code in ("TIMEOUT", COLLISION, OUTSIDE)


@pytest.mark.parametrize(
    ("name", "code", "word"),
    [
        ("done", "EMPTY_GRASP", "nothing is held"),
        ("short", "POLICY_ERROR", "7 numbers"),
        ("no_number", "POLICY_ERROR", "0 finite"),
        ("broken", "POLICY_ERROR", "observation.images.third"),
    ],
)
def test_what_is_no_grasp_is_not_claimed(name: str, code: str, word: str) -> None:
    status = playing(name).status()
    assert (status.status, status.code) == ("failed", code) and word in status.detail


def test_a_stop_comes_first() -> None:
    arm = playing("Wild", 1.6)
    assert arm.status().status == "executing"
    arm.bus.put(topics.ROBOT_STOP, b"enough")
    arm.step(0.04)
    before = arm.count(topics.ARM_COMMAND)
    arm.step(1.0)
    assert arm.status().code == "STOPPED" and arm.count(topics.ARM_COMMAND) == before


def test_a_push_on_the_hand_ends_it() -> None:
    arm = playing("still", 1.6)
    assert arm.status().status == "executing"
    arm.press = np.array([0.0, 0.0, -40.0])
    arm.step(0.1)
    assert arm.status().code == "TOUCHED"


def test_an_arm_that_does_not_follow_ends_it() -> None:
    arm = playing("Wild", 1.6)
    arm.follows = False
    arm.step(2.0)
    assert arm.status().status == "failed" and arm.status().code in ("BLOCKED", COLLISION)


def test_a_policy_that_does_not_answer_has_the_arm_hold_and_ends_late() -> None:
    RELEASED.clear()
    arm = LedArm(lockstep=False, policy=f"{__name__}:stuck", policy_cameras=())
    try:
        # Outside of lockstep models load while time goes on.
        arm.until(lambda: arm.service._robot.planner is not None or threading.Event().wait(0.01))
        arm.send(topics.MANIPULATION_GOAL, m.ManipulationGoal(goal="grab", id="a.1", object=MUG))
        arm.until(lambda: arm.count(topics.ARM_COMMAND) or threading.Event().wait(0.001), 4000.0)
        arm.step(arm.config.policy_late + 0.5)
    finally:
        RELEASED.set()
    assert arm.status().code == "POLICY_LATE"
    assert np.abs(arm.rates()).max() < 1e-6, "it held"


def test_without_pictures_it_does_not_begin() -> None:
    arm = playing("still", 5.0, policy_cameras=("head",))
    assert (arm.status().status, arm.status().code) == ("failed", "NO_PICTURE")
    assert arm.count(topics.CAMERA_REQUEST) >= 2 and not arm.count(topics.ARM_COMMAND)


def test_an_unknown_policy_is_said_at_the_start() -> None:
    for entry in ("no.such:thing", "math:pi", "math"):
        with pytest.raises(PolicyError):
            load_policy(entry)
    with pytest.raises(StartError, match="math:pi"):
        LedArm(policy="math:pi")


# --- what it sees
def test_it_sees_what_a_demonstration_shows() -> None:
    width, height = PICTURE_SIZE
    joints = m.JointStates(
        t=1.0, name=list(STATE), position=[0.1 * n for n in range(11)], velocity=[0.0] * 11, effort=[0.0] * 11
    )
    sampler = Sampler(10, ())
    sampler.take(m.BrainState(state="GRABBING", mission_id="m1", command="bring me the red mug"))
    sampler.take(joints)
    ended = m.MissionOutcome(id="m1", command="bring me the red mug", outcome="delivered")
    sampler.take(m.BrainState(state="COMPLETED", mission_id="m1", last=ended))
    (episode,) = sampler.ended()
    state = state_of(joints)
    assert state is not None and state.dtype == np.float32
    assert np.allclose(state, episode.frames[0].state) and len(episode.frames[0].action) == len(ACTION)
    rgb = bytes(range(256)) * (width * height * 3 // 256)
    shot = m.Rgbd(
        t=1.0, id="x", camera="head", width=width, height=height, fx=1.0, fy=1.0, cx=1.0, cy=1.0,
        position=(0.0, 0.0, 0.0), orientation=(1.0, 0.0, 0.0, 0.0), rgb=rgb, depth=b"",
    )  # fmt: skip
    picture = picture_of(shot)
    assert picture is not None and picture.shape == (height, width, 3) and picture.tobytes() == rgb
    seen = observation(state, {"head": picture}, episode.task)
    assert set(seen) == {"observation.state", "observation.images.head", "task"}
    with pytest.raises(PolicyError, match="10 numbers"):
        action_of([0.0] * 10)


@pytest.mark.slow
@pytest.mark.parametrize(("item", "seed"), [("yellow block", 4), ("yellow block", 5), ("green can", 4)])
def test_a_policy_really_grasps_and_the_robot_carries_on(item: str, seed: int) -> None:
    chosen = ("camera.sensors=ideal", "manipulation.policy=examples.reach_policy:FromAbove")
    robot = Robot("minimal", seed=seed, settings=chosen)
    robot.advance(0.5)
    for goal_id, topic, answer, goal in (
        ("t.1", topics.NAVIGATION_GOAL, topics.NAVIGATION_STATUS, m.NavigationGoal(goal=f"find {item}", id="t.1")),
        ("t.2", topics.MANIPULATION_GOAL, topics.MANIPULATION_STATUS, m.ManipulationGoal(goal="grab", id="t.2")),
    ):
        robot.bus.send(topic, goal)
        ended: Any = None
        while ended is None or ended.goal_id != goal_id or ended.status in ("navigating", "executing"):
            robot.advance(0.1)
            assert robot.now < 90.0
            ended = codec.decode(answer, robot.bus.last[answer.key])
        assert ended.status in ("arrived", "done"), ended
    assert robot.truth()["holding"] == item
    assert robot.sim.physics.data.xpos[robot.sim.physics.bodies[item]][2] > 0.4
