"""The gripper's linkage as it was measured on the model, in the simulation and to those who see or draw it."""

import mujoco
import numpy as np
import pytest

from cli.drivers import requirements as conformance
from common import messages as m
from common import topics
from common.bus import codec
from common.robot.model import Hand
from services.dashboard.scene.drawing import draw
from services.manipulation.arm.arm_model import ArmModel
from services.perception.views.self_filter import RobotModel
from services.sim.model import own
from tests.simulation import Simulation


def after(sim: Simulation, seconds: float) -> m.JointStates:
    sim.step(seconds)
    return sim.last(topics.JOINT_STATES)


def test_the_pinch_point_lies_between_the_pads_and_looks_along_the_approach() -> None:
    model = mujoco.MjModel.from_xml_string(own().mjcf)
    data = mujoco.MjData(model)
    hand = Hand(model)
    data.qpos[[model.joint(j).qposadr[0] for j in hand.joints]] = hand.posture(hand.open / 2)
    mujoco.mj_kinematics(model, data)
    pads = {s: np.mean([data.geom(f"{s}_pad{i}").xpos for i in (1, 2)], axis=0) for s in ("left", "right")}
    pinch = data.site("pinch")
    axes = pinch.xmat.reshape(3, 3)
    assert np.linalg.norm((pads["left"] + pads["right"]) / 2 - pinch.xpos) < 0.004
    across = pads["left"] - pads["right"]
    assert across @ axes[:, 1] == pytest.approx(np.linalg.norm(across), rel=1e-3)
    assert np.linalg.norm(across) == pytest.approx(hand.open / 2 + 0.008, abs=0.001), "two pads of 8 mm"
    palm = data.body("gripper").xpos
    assert (pinch.xpos - palm) @ axes[:, 2] > 0.1
    assert conformance.missing_in(own().mjcf) == ""


def test_the_gripper_closes_on_its_own_travel() -> None:
    sim = Simulation()
    assert after(sim, 0.1).position[-1] == pytest.approx(0.085, abs=0.001), "opens to 85 mm"
    sim.bus.send(topics.GRIPPER_COMMAND, m.GripperCommand(position=1.0, max_effort=25.0))
    assert after(sim, 1.0).position[-1] < 0.002
    sim.bus.send(topics.GRIPPER_COMMAND, m.GripperCommand(position=0.5, max_effort=25.0))
    assert 0.03 < after(sim, 1.0).position[-1] < 0.05


def test_a_closed_empty_hand_presses_on_itself_with_no_more_than_its_motor() -> None:
    sim = Simulation()
    sim.bus.send(topics.GRIPPER_COMMAND, m.GripperCommand(position=1.0, max_effort=25.0))
    states = after(sim, 1.0)
    assert states.effort[-1] <= 25.0
    assert [t for t in sim.sim.physics.contacts.touches if t.kind == "self"] == []


def test_perception_knows_this_body() -> None:
    body = RobotModel(own().mjcf)
    body.pose(np.array(own().home), 0.04)
    arm = ArmModel(own().mjcf)
    assert np.allclose(body.hand((0.0, 0.0, 0.0)), arm.pose(np.array(own().home)).position, atol=1e-6)
    # The chassis of 0.46 x 0.46 m, a prism with rounded edges, and the deck, a little wider.
    points = np.array([[0.25, 0.0, 0.25], [0.2, 0.1, 0.28], [0.0, 0.33, 0.25], [0.0, 0.0, 0.01]])
    distance = np.min([body.distance_to(points, g) for g in body.solid], axis=0)
    assert distance[:3] == pytest.approx([0.0199, 0.0, 0.0975], abs=1e-3)


def test_the_page_draws_its_fingers_where_physics_has_them() -> None:
    sim = Simulation()
    drawing = draw(codec.decode(topics.SIM_MODEL, sim.bus.last["sim/model"]).mjcf)
    sim.bus.send(topics.GRIPPER_COMMAND, m.GripperCommand(position=0.6, max_effort=25.0))
    width = after(sim, 1.0).position[-1]
    assert drawing.hand is not None
    told = dict(zip(drawing.hand.joints, drawing.hand.posture(width), strict=True))
    model, data = sim.sim.physics.model, sim.sim.physics.data
    assert len(told) == 8
    for name, value in told.items():
        assert data.qpos[model.joint(name).qposadr[0]] == pytest.approx(value, abs=0.01)
