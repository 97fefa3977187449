"""A robot of MuJoCo Menagerie in place of our own; a stand-in of ours has the official one's names."""

import os
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import mujoco
import numpy as np
import pytest

from cli import conformance
from common import messages as m
from common import topics
from common.bus import codec
from common.bus.memory import MemoryBus, MemoryIo
from common.robot import Hand
from common.runtime import StartError
from common.scene import load_scene
from services.dashboard.scene.drawing import draw
from services.manipulation.arm_model import ArmModel, Pose
from services.manipulation.ik import InverseKinematics, seeds
from services.perception.body import Body
from services.sim import menagerie
from services.sim.adapt import FACES
from services.sim.calibrate import bounds
from services.sim.config import SimConfig
from services.sim.model import Robot, load_robot
from services.sim.robot import HULL_GROUP, ROBOT_GROUP
from services.sim.service import SimService
from tests import standin
from tests.simulation import Simulation

NAME = "official"
SCENE = load_scene("minimal")


@pytest.fixture(scope="module")
def root(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return standin.write(tmp_path_factory.mktemp("menagerie"))


@pytest.fixture(scope="module")
def robot(root: Path) -> Robot:
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv(menagerie.ROOT, str(root))
        load_robot.cache_clear()
        return load_robot(NAME)


def _shared() -> Path | None:
    """The official models, where MENAGERIE_ROOT or a folder beside the project has them."""
    named = os.environ.get(menagerie.ROOT, "")
    root = Path(named) if named else Path(__file__).parents[3] / "shared" / "models" / "menagerie"
    return root if (root / "stanford_tidybot" / "tidybot.xml").is_file() else None


@pytest.fixture(scope="module", params=["stand-in", "official"])
def pair(request: pytest.FixtureRequest, root: Path) -> Iterator[tuple[Any, Any, Robot]]:
    """A model as its file has it, the world's model with the adapted one in it, and the adapted robot."""
    folder = root if request.param == "stand-in" else _shared()
    if folder is None:
        pytest.skip("the official model is not here: set MENAGERIE_ROOT to a checkout of MuJoCo Menagerie")
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv(menagerie.ROOT, str(folder))
        load_robot.cache_clear()
        adapted = load_robot(NAME)
    theirs = mujoco.MjModel.from_xml_path(str(folder / "stanford_tidybot" / "tidybot.xml"))
    assets, body = f"<asset>{adapted.assets}</asset>", f"<worldbody>{adapted.body}</worldbody>"
    text = f"<mujoco><compiler angle='radian'/>{assets}{body}</mujoco>"
    yield theirs, mujoco.MjModel.from_xml_string(text), adapted
    load_robot.cache_clear()


def _placed(model: Any) -> tuple[Any, dict[str, list[int]]]:
    """Kinematics at zero, and the geoms of each body by its name in the original."""
    data = mujoco.MjData(model)
    mujoco.mj_kinematics(model, data)
    names = {"base": "base_link", "gripper": "base"} if model.body("base").parentid[0] == 0 else {}
    found: dict[str, list[int]] = {}
    for g in range(model.ngeom):
        name = model.body(model.geom_bodyid[g]).name
        if model.geom(g).name not in ("mast", "head"):
            found.setdefault(names.get(name, name), []).append(g)
    return data, found


def test_every_shape_is_where_the_original_has_it(pair: tuple[Any, Any, Robot]) -> None:
    theirs, ours, _ = pair
    (there, wanted), (here, found) = _placed(theirs), _placed(ours)
    assert found.keys() == wanted.keys()
    for name, geoms in wanted.items():
        solid = [bool(theirs.geom_contype[g]) for g in geoms]
        assert [bool(ours.geom_contype[g]) for g in found[name]] == solid, name
        for a, b in zip(geoms, found[name], strict=True):
            assert theirs.geom_type[a] == ours.geom_type[b]
            corners = np.array([bounds(theirs, there, a), bounds(ours, here, b)])
            fine = 0.0015 if theirs.geom_contype[a] else 0.003
            assert corners[0] == pytest.approx(corners[1], abs=fine), f"{name}, geom {a}"


def test_meshes_to_look_at_stay_meshes_and_hulls_are_out_of_sight(pair: tuple[Any, Any, Robot]) -> None:
    theirs, ours, adapted = pair
    looks = [g for g in range(ours.ngeom) if not ours.geom_contype[g]]
    assert len(looks) == sum(1 for g in range(theirs.ngeom) if not theirs.geom_contype[g]) > 0
    assert all(ours.geom_group[g] == ROBOT_GROUP and ours.geom_rgba[g, 3] == 1 for g in looks)
    dressed = {int(ours.geom_bodyid[g]) for g in looks}
    assert all(
        ours.geom_group[g] == (HULL_GROUP if int(ours.geom_bodyid[g]) in dressed else ROBOT_GROUP)
        for g in range(ours.ngeom)
        if ours.geom_contype[g] and ours.geom(g).name not in ("mast", "head")
    )
    assert max(ours.mesh_facenum) < 2 * FACES
    planned = mujoco.MjModel.from_xml_string(adapted.mjcf)
    assert all(planned.geom_contype), "who plans needs nothing to look at"


def test_the_mast_stands_on_the_base(pair: tuple[Any, Any, Robot]) -> None:
    _, ours, _ = pair
    data, found = _placed(ours)
    low, high = np.array([bounds(ours, data, g) for g in found["base_link"]]).swapaxes(0, 1)
    mast = bounds(ours, data, ours.geom("mast").id)
    assert (mast[0][:2] >= low.min(axis=0)[:2] - 1e-6).all() and (mast[1][:2] <= high.max(axis=0)[:2] + 1e-6).all()
    assert mast[0][2] == pytest.approx(high.max(axis=0)[2] - 0.022, abs=0.002), "on top, but for the capsule's end"


def test_what_is_held_is_at_the_pinch_point(pair: tuple[Any, Any, Robot]) -> None:
    _, _, adapted = pair
    arm = ArmModel(adapted.mjcf)
    arm.hold(np.array([0.02, 0.03, 0.05]), np.array([0.01, 0.02, 0.03]))
    for q in (arm.home, arm.home + 0.4):
        pinch = arm.pose(q)
        held = arm.data.geom("held")
        assert held.xpos == pytest.approx(pinch.position + pinch.rotation @ [0.01, 0.02, 0.03], abs=1e-5)
        assert held.xmat.reshape(3, 3) == pytest.approx(pinch.rotation, abs=1e-4)


class Sim(Simulation):
    """The simulation of the stand-in."""

    def __init__(self) -> None:
        super().__init__(SCENE, robot=NAME, odometry_slip=0, odometry_veer=0, odometry_noise=0)

    def after(self, seconds: float) -> m.JointStates:
        self.step(seconds)
        return self.last(topics.JOINT_STATES)


@pytest.fixture
def sim(robot: Robot) -> Sim:
    return Sim()


def test_limits_mount_carry_pose_and_opening_come_from_the_model(robot: Robot) -> None:
    arm = ArmModel(robot.mjcf)
    assert np.allclose(arm.home, standin.RETRACT)
    assert arm.forward == pytest.approx(0.0), "the stand-in's arm stands in the middle of its base"
    assert arm.high[[1, 3, 5]].tolist() == [2.24, 2.57, 2.09]
    assert arm.unlimited.tolist() == [True, False, True, False, True, False, True]
    assert 0.07 < arm.widest < 0.08
    assert not arm.collides(arm.home)
    assert conformance.missing_in(robot.mjcf) == ""


def test_inverse_kinematics_reaches_and_keeps_its_limits(robot: Robot) -> None:
    arm = ArmModel(robot.mjcf)
    solver = InverseKinematics(arm)
    rng = np.random.default_rng(3)
    for _ in range(8):
        q = arm.home + rng.uniform(-0.5, 0.5, 7)
        wanted = arm.pose(np.clip(q, arm.low, arm.high))
        found = solver.solve(wanted, [arm.home, *seeds(arm, wanted, arm.home)])
        assert found is not None
        assert np.linalg.norm(arm.pose(found).position - wanted.position) < 0.002
        assert (found >= arm.low - 1e-6).all() and (found <= arm.high + 1e-6).all()


def test_the_pinch_point_lies_between_the_pads_and_looks_along_the_approach(robot: Robot) -> None:
    model = mujoco.MjModel.from_xml_string(robot.mjcf)
    data = mujoco.MjData(model)
    hand = Hand(model)
    data.qpos[[model.joint(j).qposadr[0] for j in hand.joints]] = hand.posture(hand.open / 2)
    mujoco.mj_kinematics(model, data)
    pads = {s: np.mean([data.geom(f"{s}_pad{i}").xpos for i in (0, 1)], axis=0) for s in ("left", "right")}
    pinch = data.site("pinch")
    axes = pinch.xmat.reshape(3, 3)
    assert np.linalg.norm((pads["left"] + pads["right"]) / 2 - pinch.xpos) < 0.004
    across = pads["left"] - pads["right"]
    assert across @ axes[:, 1] == pytest.approx(np.linalg.norm(across), rel=1e-3)
    assert np.linalg.norm(across) == pytest.approx(hand.open / 2 + 0.008, abs=0.001), "two pads of 8 mm"
    palm = data.body("gripper").xpos
    assert (pinch.xpos - palm) @ axes[:, 2] > 0.1


def test_the_base_drives_and_says_so(sim: Sim) -> None:
    home = SCENE.home
    sim.bus.send(topics.BASE_TARGET, m.BaseTarget(x=home.x - 0.3, y=home.y, theta=home.theta + 0.5, id="there"))
    states = sim.after(3.0)
    reached = codec.decode(topics.GOAL_REACHED, sim.bus.last["base/goal_reached"])
    assert (reached.reached, reached.target_id) == (True, "there")
    assert states.position[:3] == pytest.approx([home.x - 0.3, home.y, home.theta + 0.5], abs=0.03)


def test_the_arm_follows_and_refuses_what_its_joints_cannot(sim: Sim) -> None:
    q = np.array(standin.RETRACT)
    for _ in range(60):
        q = q + np.array([0.005, 0.01, 0, 0, 0, 0.01, 0])
        sim.bus.send(topics.ARM_COMMAND, m.ArmCommand(position=q.tolist(), period=0.02))
        states = sim.after(0.02)
    assert states.position[3:10] == pytest.approx(q.tolist(), abs=0.05)
    beyond = q.copy()
    beyond[5] = 2.2
    sim.bus.send(topics.ARM_COMMAND, m.ArmCommand(position=beyond.tolist(), period=0.02))
    sim.after(0.05)
    assert sim.io.drops["arm/command"] == 1


def test_the_gripper_closes_on_its_own_travel(sim: Sim) -> None:
    states = sim.after(0.1)
    assert states.position[-1] == pytest.approx(0.0838, abs=0.002)
    sim.bus.send(topics.GRIPPER_COMMAND, m.GripperCommand(position=1.0, max_effort=25.0))
    assert sim.after(1.0).position[-1] < 0.002
    sim.bus.send(topics.GRIPPER_COMMAND, m.GripperCommand(position=0.5, max_effort=25.0))
    assert 0.03 < sim.after(1.0).position[-1] < 0.05


def test_perception_knows_this_body(robot: Robot) -> None:
    body = Body(robot.mjcf)
    body.pose(np.array(standin.RETRACT), 0.04)
    hand = np.array(body.hand((0.0, 0.0, 0.0)))
    arm = ArmModel(robot.mjcf)
    pose: Pose = arm.pose(np.array(standin.RETRACT))
    assert np.allclose(hand, pose.position, atol=1e-6)
    # Base box of 0.5 x 0.48 x 0.24 m from 0.08 m upwards: a mesh in the stand-in.
    points = np.array([[0.26, 0.0, 0.25], [0.2, 0.2, 0.2], [0.0, 0.34, 0.2], [0.0, 0.0, 0.02]])
    distance = np.min([body.distance_to(points, g) for g in body.solid], axis=0)
    assert distance[:3] == pytest.approx([0.01, 0.0, 0.1], abs=1e-4)


def test_the_page_draws_its_fingers_where_physics_has_them(sim: Sim) -> None:
    drawing = draw(codec.decode(topics.SIM_MODEL, sim.bus.last["sim/model"]).mjcf)
    sim.bus.send(topics.GRIPPER_COMMAND, m.GripperCommand(position=0.6, max_effort=25.0))
    width = sim.after(1.0).position[-1]
    assert drawing.hand is not None
    told = dict(zip(drawing.hand.joints, drawing.hand.posture(width), strict=True))
    model, data = sim.service.physics.model, sim.service.physics.data
    assert len(told) == 4
    for name, value in told.items():
        assert data.qpos[model.joint(name).qposadr[0]] == pytest.approx(value, abs=0.01)


def test_the_world_shows_the_robot_with_our_names(sim: Sim) -> None:
    described = codec.decode(topics.SIM_MODEL, sim.bus.last["sim/model"])
    model = mujoco.MjModel.from_xml_string(described.mjcf)
    for camera in ("head", "wrist"):
        assert model.camera(camera).id >= 0
    assert model.body("base").mass[0] == pytest.approx(60.0)
    assert model.camera("wrist").fovy[0] == pytest.approx(42.0)
    assert [model.joint(i).name for i in range(3)] == ["base_x", "base_y", "base_yaw"]


@pytest.mark.parametrize(
    ("left_out", "named"),
    [
        ('<joint name="joint_th"/>', None),
        ('<key name="retract"', "key retract"),
        ('name="pinch_site"', "site pinch_site"),
        ('name="fingers_actuator"', "actuator fingers_actuator"),
    ],
)
def test_a_model_that_lacks_something_is_refused_by_name(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, left_out: str, named: str | None
) -> None:
    standin.write(tmp_path)
    path = tmp_path / "stanford_tidybot" / "tidybot.xml"
    path.write_text(path.read_text().replace(left_out, left_out.replace('name="', 'name="not_')))
    monkeypatch.setenv(menagerie.ROOT, str(tmp_path))
    load_robot.cache_clear()
    with pytest.raises(menagerie.RobotError) as refused:
        load_robot(NAME)
    assert str(path) in str(refused.value)
    if named:
        assert f"lacks {named}" in str(refused.value) and "stanford_tidybot.toml" in str(refused.value)


def test_a_model_under_another_file_name_is_found(tmp_path: Path) -> None:
    standin.write(tmp_path, file="my_tidybot.xml")
    folder = tmp_path / "stanford_tidybot"
    assert menagerie._below(folder, "tidybot.xml") == folder / "my_tidybot.xml"


@pytest.mark.parametrize(
    ("name", "root", "cure"),
    [
        ("menagerie:stanford_tidybot", "empty", "Set MENAGERIE_ROOT"),
        ("menagerie:stanford_tidybot", None, "pip install mujoco-menagerie"),
        ("menagerie:unitree_go2", None, "known: menagerie:stanford_tidybot"),
        ("r2d2", None, "expected tidybot, official or menagerie:"),
    ],
)
def test_what_is_not_there_is_said_with_the_cure(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, name: str, root: str | None, cure: str
) -> None:
    monkeypatch.setattr(menagerie, "PACKAGE", "no_such_package")
    monkeypatch.delenv(menagerie.ROOT, raising=False)
    if root is not None:
        monkeypatch.setenv(menagerie.ROOT, str(tmp_path))
    load_robot.cache_clear()
    io = MemoryIo(MemoryBus(), "sim", SimService.READS, SimService.WRITES, scene=SCENE)
    with pytest.raises(StartError) as refused:
        SimService(SimConfig(robot=name), io)
    assert cure in str(refused.value)


class Package:
    """The part of `mujoco_menagerie` that is used."""

    class MenagerieError(Exception): ...

    def __init__(self, folder: Path | None) -> None:
        self._folder = folder

    def get(self, name: str) -> "Package":
        assert name == "stanford_tidybot"
        return self

    def xml(self, entry: str) -> Path:
        if self._folder is None:
            raise self.MenagerieError("no network")
        return self._folder / f"{entry}.xml"


def test_the_package_is_asked_when_no_root_is_set(root: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv(menagerie.ROOT, raising=False)
    monkeypatch.setattr(menagerie.importlib, "import_module", lambda name: Package(root / "stanford_tidybot"))
    assert menagerie.find("stanford_tidybot", "tidybot.xml").is_file()
    monkeypatch.setattr(menagerie.importlib, "import_module", lambda name: Package(None))
    with pytest.raises(menagerie.RobotError, match="no network"):
        menagerie.find("stanford_tidybot", "tidybot.xml")


def test_a_placeholder_of_an_inertia_becomes_that_of_a_solid_box(pair: tuple[Any, Any, Robot]) -> None:
    _, _, adapted = pair
    inertia = mujoco.MjModel.from_xml_string(adapted.mjcf).body("base").inertia
    # 60 kg: the stand-in says 1 kg m2 and keeps it; the official model says .001, a box of 0.48 m has 2.3.
    assert inertia[2] == pytest.approx(1.0) or inertia[2] == pytest.approx(2.3, abs=0.1)
