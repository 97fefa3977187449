"""What the hand feels in the joints' torques, and what is decided by it."""

from types import SimpleNamespace
from typing import Any

import mujoco
import numpy as np
import pytest

from common import topics
from services.manipulation.arm.arm_model import ArmModel, Pose
from services.manipulation.arm.ik import seeds
from services.manipulation.arm.touch import (
    BLOCKED,
    HIT,
    MET,
    STRAIN,
    TOO_HEAVY,
    TOUCHED,
    Guard,
    Reaction,
    Way,
    load_limit,
    tells_weight,
    watch,
)
from services.manipulation.arm.trajectory import back_along, divided, legs, timed, turned_back, whole
from services.manipulation.execution.closing import FARTHEST, STANDS, Yielding, close
from services.manipulation.execution.place_executor import lower
from services.manipulation.execution.recovery import go_home
from services.manipulation.execution.robot import DT, Failure, Robot, Steps
from services.manipulation.execution.robot import SLOWLY as BACK_SLOWLY
from services.manipulation.execution.setting_down import PRESSED, STANDING, set_down
from services.manipulation.grasps.grasp import approach_rotation
from services.manipulation.grasps.grasped_object import GraspedObject
from services.manipulation.planning.motion_planner import Planner
from services.manipulation.planning.plan_place import PlacePlan
from services.manipulation.planning.straight_grab import RESERVE, with_reserve
from services.sim.model import own
from tests.unit.test_manipulation_service import CONFIG, Arm


@pytest.fixture(scope="module")
def arm() -> ArmModel:
    return ArmModel(own().mjcf)


def torques(arm: ArmModel, force: tuple[float, float, float]) -> np.ndarray:
    """What the joints need to press with `force` [N] in the arm's home pose, by MuJoCo's own transposed Jacobian."""
    data, found = mujoco.MjData(arm.model), np.zeros(arm.model.nv)
    data.qpos[arm.qpos_at] = arm.home
    mujoco.mj_forward(arm.model, data)
    body = arm.model.site_bodyid[arm.pinch]
    mujoco.mj_applyFT(arm.model, data, np.array(force), np.zeros(3), data.site_xpos[arm.pinch], body, found)
    return found[arm.dof_at]


@pytest.mark.parametrize("force", [(0.0, 0.0, -40.0), (12.0, -7.0, 3.0)])
def test_torques_tell_the_force_on_the_hand(arm: ArmModel, force: tuple[float, float, float]) -> None:
    assert Reaction(arm).force(arm.home, torques(arm, force)) == pytest.approx(force, abs=0.1)


@pytest.mark.parametrize(
    ("joints", "inertia"),
    [
        ((0.04, 0.77, 3.43, -0.34, -0.23, -2.05, 0.13), (0.4, -0.5, 0.3, -1.6, 0.4, 0.6, 0.3)),
        ((0.02, 0.38, 3.12, -2.06, -0.09, 0.08, 1.67), (2.32, 2.35, -1.03, -0.77, -0.1, 0.38, 0.17)),
    ],
)
def test_an_arm_takes_its_own_inertia_for_no_contact(
    arm: ArmModel, joints: tuple[float, ...], inertia: tuple[float, ...]
) -> None:
    """Bench, stretched at the start of a motion, and on the way down with a can: torques of an arm in the air."""
    assert np.linalg.norm(Reaction(arm).force(np.array(joints), np.array(inertia))) < MET / 2


@pytest.mark.parametrize(
    ("force", "way", "code"),
    [
        ((0.0, 0.0, -MET - 1), "any", TOUCHED),
        ((0.0, MET + 1, 0.0), "any", TOUCHED),
        ((0.0, 0.0, -MET + 1), "any", ""),
        ((0.0, 0.0, load_limit(25.0) + 1), "up", TOO_HEAVY),
        ((0.0, 0.0, load_limit(25.0) - 1), "up", ""),
        ((0.0, 50.0, -50.0), "up", ""),
        ((0.0, 0.0, -MET - 1), "down", TOUCHED),
        ((0.0, 50.0, 50.0), "down", ""),
    ],
)
def test_a_motion_ends_at_what_it_should_not_meet(
    arm: ArmModel, force: tuple[float, float, float], way: Way, code: str
) -> None:
    rest = torques(arm, (3.0, 0.0, 9.0))
    guard = Guard(Reaction(arm), rest, load_limit(25.0) if way == "up" else MET, way)
    found, _ = guard.feel(arm.home, rest + torques(arm, force))
    assert found == code


def test_the_way_back_never_goes_deeper_first() -> None:
    path = [np.full(7, 0.1 * n) for n in range(5)]
    for now, first in ((0.4, 0.3), (0.27, 0.2), (0.33, 0.2), (0.02, 0.0), (9.0, 0.3)):
        back = back_along(path, np.full(7, now))
        assert back[0][0] == pytest.approx(first) and back[-1][0] == 0.0


@pytest.mark.parametrize("reached", [0.1, 0.6, 1.0])
def test_what_is_met_is_left_on_the_path_on_which_it_was_met(reached: float) -> None:
    """All joints brake and turn together: by themselves those of the wrist would be still while the shoulder moves."""
    ratio = np.array([1.0, -0.2, 0.5, 0.0, 0.9, -0.4, 0.1])
    path = timed([np.zeros(7), ratio], 1.0, 2.5, DT)
    sent = np.concatenate([np.zeros((1, 7)), path[: int(reached * len(path))]])
    joints, before = sent[-3], float(sent[-1][0] - sent[-2][0])
    back = turned_back(sent, joints, 0.3, 0.12, 5.0, DT)
    assert np.abs(back - back[:, :1] * ratio).max() < 1e-6
    speeds = np.diff(np.concatenate([[sent[-1][0]], back[:, 0]]))
    assert np.abs(np.diff(np.concatenate([[before], speeds]))).max() < 1.5 * 5.0 * DT * DT
    assert speeds.min() >= -0.3 * DT - 1e-9
    assert back[-1][0] == pytest.approx(max(0.0, joints[0] - 0.12), abs=1e-6)


def test_a_divided_path_is_the_same_way() -> None:
    path = [np.full(7, v) for v in (0.0, 0.5, 0.4, 1.0)]
    for most, end in ((0.3, 0.3), (0.7, 0.7)):
        near, far = divided(path, lambda q, most=most: q[0] < most)
        assert near[-1] == pytest.approx(np.full(7, end), abs=0.061) and near[-1] is far[0]
        assert [*near[:-1], *far[1:]] == path
    assert divided(path, lambda q: True) == (path, [])


def test_a_short_way_in_the_open_between_near_things_is_followed_as_slowly() -> None:
    path = [np.full(7, v) for v in (0.0, 1.0, 2.0)]
    for gap, expected in ((0.2, [False, True, False]), (0.6, [False, True, False, True, False])):
        parts = legs(path, lambda q, gap=gap: 0.3 < q[0] < 0.7 or 0.7 + gap < q[0] < 1.7)
        assert [leg.near for leg in parts] == expected
        assert [q for q in whole(parts) if any(q is corner for corner in path)] == path


@pytest.mark.parametrize(("way", "force"), [("any", -40.0), ("down", -40.0), ("up", 40.0)])
def test_a_guarded_motion_lets_go_of_its_set_point_unless_it_would_fall(way: Way, force: float) -> None:
    node = Arm()
    node.step(1.0)
    robot = node.service._robot
    guard = robot.guard(np.zeros(7), way=way)
    assert robot.planner is not None and guard is not None
    robot.torques = torques(robot.planner.arm, (0.0, 0.0, force))
    steps = robot.follow([robot.joints + 0.3], CONFIG.joint_speed, guard)
    with pytest.raises(Failure, match="40 N on the hand"):
        for _ in steps:
            pass
    left = np.array(node.sent(topics.ARM_COMMAND)[-1].position) - robot.joints
    assert bool(left.any()) == (way == "up")


def reaching() -> tuple[Arm, Robot, Planner, Pose, np.ndarray]:
    """An arm and what moves it, and a pose of the hand above a table with the joints (7,) for it."""
    node = Arm()
    node.step(1.0)
    robot = node.service._robot
    assert robot.planner is not None
    planner, above = robot.planner, Pose(np.array([0.55, 0.0, 0.6]), approach_rotation(0.0, np.pi / 2))
    top = planner.ik.solve(above, seeds(planner.arm, above, planner.arm.home))
    assert top is not None
    return node, robot, planner, above, top


def test_what_is_in_the_hand_goes_down_slowly_from_the_top_of_its_way() -> None:
    node, robot, planner, above, top = reaching()
    down = planner.straight(top, above, above.moved(np.array([0.0, 0.0, -0.12])))
    assert down is not None
    robot.joints = top
    for _ in set_down(robot, [top, *down], None):
        robot.joints = np.array(node.sent(topics.ARM_COMMAND)[-1].position)
    heights = [planner.reaction.position(np.array(c.position))[2] for c in node.sent(topics.ARM_COMMAND)]
    assert heights[0] - heights[-1] == pytest.approx(0.12, abs=0.005)
    assert 0.02 < -np.diff(heights).min() / DT < 0.1, "m/s"


def test_what_braked_the_arm_is_no_part_of_its_weight() -> None:
    _, robot, _, _, _ = reaching()
    still, found = np.arange(7.0), None
    steps, robot.torques = robot.at_rest(), still + 9.0
    while found is None:
        try:
            next(steps)
            robot.torques = still + 0.5 * (robot.torques - still)
        except StopIteration as stop:
            found = stop.value
    assert found == pytest.approx(still, abs=0.2)


@pytest.mark.parametrize(("surface", "grounded", "ends"), [(0.02, False, True), (0.2, True, True), (0.2, False, False)])
def test_the_hand_opens_where_it_is_felt_to_stand_or_is_on_the_surface_itself_and_nowhere_else(
    surface: float, grounded: bool, ends: bool
) -> None:
    """`surface`: how far [m] below the end of the way down what is held meets it."""
    node, robot, planner, above, top = reaching()
    end = above.moved(np.array([0.0, 0.0, -0.08]))
    down = planner.straight(top, above, end)
    assert down is not None
    deeper = planner.straight(down[-1], end, end.moved(np.array([0.0, 0.0, -0.05])))
    assert deeper is not None
    plan = PlacePlan([top], [top, *down], deeper, grounded, [], [], (0.55, 0.0))
    held = GraspedObject("jar", "", above.rotation, np.array([0.0, 0.0, 0.05]), (0.06, 0.06, 0.1), 0.06, 0.0)
    robot.joints, code = top, ""
    try:
        for _ in lower(robot, plan, held, falls=False):
            sent = node.sent(topics.ARM_COMMAND)
            robot.joints = np.array(sent[-1].position) if sent else top
            deep = end.position[2] - surface - planner.reaction.position(robot.joints)[2]
            pressed = np.array([0.0, 0.0, -1.5 * STANDING]) * bool(deep > 0)
            robot.torques = planner.reaction.torques(robot.joints, pressed)
    except Failure as failure:
        code = failure.code
    fell_short = end.position[2] - planner.reaction.position(robot.joints)[2]
    assert code == ("" if ends else "NOT_MET")
    assert fell_short == pytest.approx(min(surface, 0.05), abs=0.003)


@pytest.mark.parametrize("turns", [True, False])
def test_what_hangs_far_lower_is_pressed_back_or_put_down_as_it_hangs_the_next_time(
    turns: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Its far end is met 6 cm too high: turned by its weight, or, held in its middle, it turns back with 16 N."""
    node, robot, planner, above, top = reaching()

    def at_once(work: Any, *of: Any) -> Steps[Any]:
        yield
        return work(*of)

    monkeypatch.setattr(robot, "work", at_once)
    end = above.moved(np.array([0.0, 0.0, -0.08]))
    down = planner.straight(top, above, end)
    assert down is not None
    plan = PlacePlan([top], [top, *down], [], True, [], [], (0.55, 0.0))
    offset = np.array([0.0 if turns else 0.05, 0.0, 0.015])
    held = GraspedObject("rattle", "", above.rotation, offset, (0.2, 0.03, 0.03), 0.03, 0.0)
    robot.joints, robot.grasped, code, most, was = top, held, "", 0.0, 1.0
    try:
        for _ in lower(robot, plan, held, falls=False):
            sent = node.sent(topics.ARM_COMMAND)
            robot.joints = np.array(sent[-1].position) if sent else top
            height = float(planner.reaction.position(robot.joints)[2] - end.position[2])
            stiff = 8000.0 * max(0.0, 0.06 - height)
            # It gives way, but not to the blow of the first contact.
            force = min(stiff, 16.0 if was - height < 0.0008 else 24.0) if turns else stiff
            was = height
            most = max(most, force)
            robot.torques = planner.reaction.torques(robot.joints, np.array([0.0, 0.0, -force]))
    except Failure as failure:
        code = failure.code
    left = float(planner.reaction.position(robot.joints)[2] - end.position[2])
    assert code == ("" if turns else "BLOCKED")
    assert robot.grasped is not None
    assert (robot.grasped.rotation == pytest.approx(held.rotation)) == turns
    assert left < 0.01 if turns else left > 0.07, "it touches nothing as the next attempt begins"
    assert most < 2 * PRESSED


def test_the_hand_keeps_room_to_open_when_it_is_wedged(arm: ArmModel) -> None:
    openings = [with_reserve(arm.hand, width) for width in (0.04, arm.hand.open - 0.002, arm.hand.open + 0.01)]
    assert openings == pytest.approx([arm.hand.open - RESERVE, arm.hand.open - 0.001, arm.hand.open])


@pytest.mark.parametrize("weighs", [False, True])
@pytest.mark.parametrize(
    ("carried", "push", "code"),
    [
        (0.0, (0.0, HIT - 2, 0.0), ""),
        (0.0, (0.0, 0.0, HIT + 2), BLOCKED),
        (12.0, (0.0, HIT - 2, 0.0), ""),
        (12.0, (HIT + 8, 0.0, 0.0), BLOCKED),
        (12.0, (0.0, 0.0, -HIT - 8), BLOCKED),
    ],
)
def test_in_free_motion_the_arm_notices_what_it_meets_beside_its_load(
    arm: ArmModel, weighs: bool, carried: float, push: tuple[float, float, float], code: str
) -> None:
    """An arm whose drivers take its own weight off their torques, and one that tells it too."""
    reaction = Reaction(arm)
    own_weight = reaction.weight(arm.home) * weighs
    rest = own_weight + torques(arm, (0.0, 0.0, carried))
    if not carried:
        assert tells_weight(reaction, arm.home, rest) == weighs
    watching = watch(reaction, arm.home, rest, bool(carried), weighs)
    assert watching.feel(arm.home, rest + torques(arm, push))[0] == code


def test_what_moves_slowly_notices_less(arm: ArmModel) -> None:
    reaction, light = Reaction(arm), torques(arm, (0.0, MET + 2, 0.0))
    codes = [watch(reaction, arm.home, np.zeros(7), False, False, most).feel(arm.home, light)[0] for most in (MET, HIT)]
    assert codes == [BLOCKED, ""]


def test_a_blow_on_the_elbow_shows_in_the_joints_below_it(arm: ArmModel) -> None:
    reaction = Reaction(arm)
    watching = watch(reaction, arm.home, np.zeros(7), False, False)
    blow = np.array([0.0, STRAIN + 1, 0.0, 0.0, 0.0, 0.0, 0.0])
    assert watching.feel(arm.home, blow)[0] == BLOCKED
    assert watching.feel(arm.home, blow / 2)[0] == ""


def test_fingers_that_press_a_thing_on_its_surface_stop_and_those_that_push_it_aside_do_not() -> None:
    node = Arm()
    node.step(1.0)
    robot = node.service._robot
    assert robot.planner is not None
    guard = robot.guard(np.zeros(7), HIT, "down")
    for force, code in (((0.0, HIT + 5, 0.0), ""), ((0.0, 0.0, -HIT - 5), BLOCKED)):
        robot.torques = robot.planner.reaction.torques(robot.joints, np.array(force))
        ended = ""
        try:
            for _ in close(robot, robot.joints, guard):
                pass
        except Failure as failure:
            ended = failure.code
        assert ended == code


@pytest.mark.parametrize("push", [(0.0, -14.0, 0.0), (0.0, 0.0, 20.0), (2.0, 0.0, 2.0)])
def test_a_hand_that_closes_gives_way_to_what_it_presses_on(push: tuple[float, float, float]) -> None:
    """What the hand presses on bends it by 1 mm for 6 N, until it has come so far."""
    _, robot, planner, _, top = reaching()
    guard, feel, felt = robot.guard(np.zeros(7)), planner.reaction, np.array(push)
    assert guard is not None
    hand, begin = Yielding(guard, top), feel.position(top)
    for _ in range(200):
        came = feel.position(hand.at) - begin
        force = felt + 6000.0 * came if np.linalg.norm(felt) > STANDS else felt
        hand.step(top, feel.torques(top, force))
    came = feel.position(hand.at) - begin
    if np.linalg.norm(felt) <= STANDS:
        assert not came.any()
    else:
        assert float(np.linalg.norm(felt + 6000.0 * came)) < STANDS + 1.0
        assert float(came @ felt) < 0
    for _ in range(200):
        hand.step(top, feel.torques(top, 10 * felt))
    assert float(np.linalg.norm(feel.position(hand.at) - begin)) < FARTHEST + 1e-3


@pytest.mark.parametrize("times", [1, 2])
def test_what_is_met_on_the_way_home_is_backed_off_and_passed_slowly(times: int) -> None:
    node = Arm()
    node.step(1.0)
    robot = node.service._robot
    assert robot.planner is not None
    arm = robot.planner.arm
    robot.joints = start = arm.home + np.array([0.0, 0.6, 0.0, 0.4, 0.0, 0.0, 0.0])
    driven, pushed, met = [start], 0, 0
    steps = go_home(robot)
    try:
        for _ in steps:
            sent = node.sent(topics.ARM_COMMAND)
            if sent:
                robot.joints = np.array(sent[-1].position)
            driven.append(robot.joints)
            pushed = pushed - 1 if pushed else 0
            if met < times and np.abs(robot.joints - start).max() > 0.2 + 0.1 * met:
                met, pushed = met + 1, 3
            pressed = np.array([0.0, 0.0, -HIT - 10]) * bool(pushed)
            robot.torques = robot.planner.reaction.torques(robot.joints, pressed)
            robot.now += DT
    except Failure as failure:
        assert (failure.code, times) == (BLOCKED, 2)
        return
    assert times == 1
    way = np.array([np.abs(q - start).max() for q in driven])
    assert np.diff(way).min() < 0.0, "it goes back a little"
    after = int(np.argmax(np.diff(way) < 0.0))
    speeds = np.abs(np.diff(np.array(driven), axis=0)).max(axis=1) / DT
    assert speeds[after + 1 :].max() <= BACK_SLOWLY * CONFIG.joint_speed + 1e-6
    assert driven[-1] == pytest.approx(arm.home, abs=0.01)


def test_the_fingers_grip_in_steps_in_which_it_is_felt_that_they_press_something_down() -> None:
    pressed: list[float] = []

    def move(closed: float, effort: float = 0.0, guard: object = None, hand: object = None) -> Steps[None]:
        pressed.append(effort or CONFIG.grip_effort)
        if len(pressed) == 2 and guard is not None:
            raise Failure(TOUCHED, "31 N on the hand")
        yield

    robot: Any = SimpleNamespace(move_gripper=move)
    list(close(robot, np.zeros(7), None))
    assert pressed == sorted(pressed) and pressed[-1] == CONFIG.grip_effort and len(pressed) > 2
    pressed.clear()
    guard: Any = object()
    with pytest.raises(Failure, match="press it down"):
        list(close(robot, np.zeros(7), guard))
    assert max(pressed) < CONFIG.grip_effort
