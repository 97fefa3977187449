"""Every service object among hostile messages: no step raises, refusals are counted, and each still does its job."""

import math
from collections.abc import Iterator
from typing import Any

import msgspec
import numpy as np
import pytest

from bench.fuzz.payloads import Payloads
from common import messages as m
from common import topics
from common.bus import codec
from evaluation.stack import Stack, service_class

PAYLOADS, BURST = 2400, 40


@pytest.fixture(scope="module")
def battered() -> Iterator[Stack]:
    """The whole robot after a storm on everything that its services read."""
    robot = Stack("minimal", seed=2, settings=("brain.enable_confirmation=false",))
    robot.advance(1.0)
    make = Payloads(4, gentle=True)
    read = {t.key: t for name in (*robot.members, "sim") for t in service_class(name).READS}
    for topic in read.values():
        payload = robot.bus.last.get(topic.key)
        if payload is not None:
            make.learn(topic, codec.decode(topic, payload))
    for _ in range(PAYLOADS // BURST):
        for _ in range(BURST):
            topic = make.rng.choice([*read.values()])
            robot.bus.put(topic, make.of(topic))
        robot.tick()
    yield robot
    robot.close()


@pytest.mark.slow
def test_every_service_counted_what_it_refused(battered: Stack) -> None:
    for name in (*battered.members, "sim"):
        io = battered.bus.ios[name]
        commands = [t.key for t in service_class(name).READS if t.keep == "all"]
        assert sum(io.drops[k] for k in commands) > 0, name


@pytest.mark.slow
def test_physics_is_unharmed(battered: Stack) -> None:
    assert np.isfinite(battered.sim.physics.data.qpos).all()
    assert np.isfinite(battered.sim.physics.data.ctrl).all()
    x, y, _ = battered.truth()["base"]
    low, high = battered.scene.low, battered.scene.high
    assert low[0] - 1 < x < high[0] + 1 and low[1] - 1 < y < high[1] + 1


@pytest.mark.slow
def test_they_still_do_their_jobs(battered: Stack) -> None:
    robot, bus = battered, battered.bus
    bus.send(topics.VOICE_COMMAND, m.VoiceCommand(text="cancel", id="calm"))
    bus.send(topics.ROBOT_RESUME, m.RobotResume(source="test"))
    bus.get(topics.SIM_RESET, b'{"seed": 2}')
    robot.advance(3.0)

    def answers(topic: Any, ask: Any, question: m.Message, **wanted: object) -> None:
        heard = bus.tap(topic)
        bus.send(ask, question)
        for _ in range(60):
            robot.advance(0.1)
            found = [codec.decode(topic, p) for p in heard]
            if any(all(getattr(f, k) == v for k, v in wanted.items()) for f in found):
                return
        raise AssertionError(f"{ask.key}: {question} had no answer with {wanted}, but {heard[-3:]}")

    unknown = m.NavigationGoal(goal="goto the moon", id="t.1")
    answers(topics.NAVIGATION_STATUS, topics.NAVIGATION_GOAL, unknown, goal_id="t.1", code="UNKNOWN_PLACE")
    juggle = m.ManipulationGoal(goal="juggle", id="t.2")
    answers(topics.MANIPULATION_STATUS, topics.MANIPULATION_GOAL, juggle, goal_id="t.2", code="UNKNOWN_GOAL")
    sing = m.SpeechGoal(goal="sing", id="t.3")
    answers(topics.SPEECH_RESULT, topics.SPEECH_GOAL, sing, goal_id="t.3", code="UNKNOWN_GOAL")
    plan = m.PlanRequest(id="t.4", command="juggle the moon")
    answers(topics.ACTION_PLAN, topics.PLAN_REQUEST, plan, request_id="t.4")
    picture = m.CameraRequest(id="t.5", camera="head", width=64, height=48)
    answers(topics.HEAD_RGBD, topics.CAMERA_REQUEST, picture, id="t.5", width=64)


def hostile(value: float) -> dict[Any, m.Message]:
    return {
        topics.BASE_TARGET: m.BaseTarget(x=value, y=0.0, theta=0.0, id="n"),
        topics.CMD_VEL: m.CmdVel(vx=0.0, vy=0.0, omega=value),
        topics.ARM_COMMAND: m.ArmCommand(position=[0.0] * 6 + [value]),
        topics.GRIPPER_COMMAND: m.GripperCommand(position=0.5, max_effort=value),
        topics.NAV_GOAL: m.NavGoal(id="n", x=value, y=0.0),
    }


def test_what_is_no_number_never_reaches_physics() -> None:
    robot = Stack("minimal", seed=2, without=("camera", "perception", "planner", "speech", "brain"))
    try:
        robot.advance(1.0)
        before, start = robot.sim.physics.data.ctrl.copy(), robot.truth()["base"]
        values = (math.nan, math.inf, -math.inf, 1e308)
        for value in values:
            for topic, message in hostile(value).items():
                robot.bus.put(topic, msgspec.msgpack.encode(message))
            robot.tick()
        robot.advance(0.5)
        assert np.allclose(robot.sim.physics.data.ctrl, before, atol=1e-3)
        assert robot.truth()["base"] == pytest.approx(start, abs=0.01)
        for topic in hostile(0.0):
            io = robot.bus.ios["navigation" if topic is topics.NAV_GOAL else "sim"]
            assert io.drops[topic.key] == len(values), topic.key
    finally:
        robot.close()
