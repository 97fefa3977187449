"""The robot as URDF, read back by MuJoCo, and as frames: both put every link where the description has it."""

from xml.etree import ElementTree as Xml

import mujoco
import numpy as np
import pytest

from common import messages as m
from common.geometry import compose, quat_matrix
from common.robot.frames import BASE_LINK, MAP, ODOM, BaseFrames, FramePose
from common.robot.joints import ARM
from common.robot.link_frames import LinkFrames
from common.robot.model import Hand, RobotKinematics
from common.robot.urdf import pivots, urdf
from common.scene import load_scene
from services.sim.physics import Physics

POSTURES = [(np.zeros(7), 0.08), (np.linspace(-1.5, 1.5, 7), 0.03), (np.full(7, 0.7), 0.0)]


@pytest.fixture(scope="module")
def mjcf() -> str:
    return Physics(load_scene("minimal"), 0).robot.mjcf


def chained(poses: list[FramePose]) -> dict[str, tuple[np.ndarray, np.ndarray]]:
    """Position and rotation of every frame in the base."""
    found = {BASE_LINK: (np.zeros(3), np.eye(3))}
    for pose in poses:
        place, turn = found[pose.parent]
        found[pose.child] = place + turn @ np.array(pose.position), turn @ quat_matrix(pose.orientation)
    return found


@pytest.mark.parametrize(("arm", "width"), POSTURES)
def test_every_link_stands_where_the_description_has_it(mjcf: str, arm: np.ndarray, width: float) -> None:
    links, truth = LinkFrames(mjcf), RobotKinematics(mjcf)
    hand = Hand(truth.model)
    fingers = dict(zip(hand.joints, hand.posture(width), strict=True))
    joints = m.JointStates(t=1.0, name=[*ARM, "gripper"], position=[*arm, width], velocity=[], effort=[])
    frames = chained(links.poses(joints))
    truth.pose(arm, width)
    read = mujoco.MjModel.from_xml_string(urdf(mjcf))
    data = mujoco.MjData(read)
    for name, value in {**dict(zip(ARM, arm, strict=True)), **fingers}.items():
        data.qpos[read.joint(name).qposadr[0]] = value
    mujoco.mj_kinematics(read, data)
    named = {read.body(b).name for b in range(read.nbody)}
    assert len(frames) > 15
    for name, (place, turn) in frames.items():
        body = truth.model.body("base" if name == BASE_LINK else name).id
        assert place == pytest.approx(truth.data.xpos[body], abs=1e-6), name
        assert turn == pytest.approx(truth.data.xmat[body].reshape(3, 3), abs=1e-6), name
        if name in named:  # MuJoCo joins what is fixed to what holds it
            assert data.body(name).xpos == pytest.approx(place, abs=1e-5), name


def test_the_urdf_has_mass_limits_and_shapes(mjcf: str) -> None:
    root, model = Xml.fromstring(urdf(mjcf)), mujoco.MjModel.from_xml_string(mjcf)
    masses = sum(float(mass.attrib["value"]) for mass in root.iter("mass"))
    assert masses == pytest.approx(model.body_mass.sum(), rel=1e-6)
    limits = {j.attrib["name"]: j.find("limit") for j in root.iter("joint")}
    low, high = model.joint("joint_2").range
    found = limits["joint_2"]
    assert found is not None and (float(found.attrib["lower"]), float(found.attrib["upper"])) == pytest.approx(
        (low, high)
    )
    assert limits["joint_1"] is None, "it turns freely"
    shapes = {shape.tag for geometry in root.iter("geometry") for shape in geometry}
    assert shapes <= {"box", "cylinder", "sphere"} and len(list(root.iter("visual"))) > 15
    added = {pose.child for pose in pivots(mjcf)}
    assert added == {link.attrib["name"] for link in root.iter("link")} - {*chained_names(mjcf)}


def chained_names(mjcf: str) -> set[str]:
    joints = m.JointStates(t=0.0, name=[*ARM], position=[0.0] * 7, velocity=[], effort=[])
    return {BASE_LINK, *(pose.child for pose in LinkFrames(mjcf).poses(joints))}


def test_the_base_is_where_navigation_believes_it_is_and_moves_on_with_the_wheels() -> None:
    frames = BaseFrames()
    assert frames.poses() == []
    frames.odometry(m.Odometry(t=1.0, x=1.0, y=0.0, theta=0.5))
    frames.odometry(m.Odometry(t=1.1, x=1.5, y=0.2, theta=0.7))
    frames.estimate(m.PoseEstimate(t=1.0, x=4.0, y=2.0, theta=1.0))
    first, second = frames.poses()
    assert [(p.parent, p.child) for p in (first, second)] == [(MAP, ODOM), (ODOM, BASE_LINK)]
    at_estimate = compose(_plane(first), (1.0, 0.0, 0.5))
    assert at_estimate == pytest.approx((4.0, 2.0, 1.0))
    assert _plane(second) == pytest.approx((1.5, 0.2, 0.7)) and second.t == 1.1


def _plane(pose: FramePose) -> tuple[float, float, float]:
    return pose.position[0], pose.position[1], 2 * float(np.arctan2(pose.orientation[3], pose.orientation[0]))
