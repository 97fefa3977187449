"""The robot against MuJoCo Menagerie's stanford_tidybot, and that model's meshes as its skin."""

import os
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import mujoco
import numpy as np
import pytest

from common.body_extent import bounds
from common.bus.memory import MemoryBus, MemoryIo
from common.config import ConfigError
from common.geometry import yaw_matrix
from common.household import told
from common.scene import load_scene
from services.manipulation.arm.arm_model import ArmModel
from services.sim import menagerie
from services.sim.config import SimConfig
from services.sim.model import Robot, load_robot, own
from services.sim.robot import HULL_GROUP, MAST, ROBOT_GROUP
from services.sim.service import SimService
from services.sim.skin import FACES, MERGED, THEIRS
from tests import standin
from tests.simulation import Simulation

SCENE = load_scene("minimal")


@pytest.fixture(scope="module")
def root(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return standin.write(tmp_path_factory.mktemp("menagerie"))


def _official() -> Path:
    """The official models, where MENAGERIE_ROOT or a folder beside the project has them."""
    named = os.environ.get(menagerie.ROOT, "")
    found = Path(named) if named else Path(__file__).parents[3] / "shared" / "models" / "menagerie"
    if not (found / "stanford_tidybot" / "tidybot.xml").is_file():
        pytest.skip("the official model is not here: set MENAGERIE_ROOT to a checkout of MuJoCo Menagerie")
    return found


@pytest.fixture(scope="module")
def theirs() -> Any:
    return mujoco.MjModel.from_xml_path(str(_official() / "stanford_tidybot" / "tidybot.xml"))


@pytest.fixture(scope="module")
def ours() -> Any:
    return mujoco.MjModel.from_xml_string(own().mjcf)


@pytest.fixture(scope="module", params=["stand-in", "official"])
def pair(request: pytest.FixtureRequest, root: Path) -> Iterator[tuple[Any, Any, Robot]]:
    """A model as its file has it, the world's model of the robot under its skin, and that robot."""
    folder = root if request.param == "stand-in" else _official()
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv(menagerie.ROOT, str(folder))
        load_robot.cache_clear()
        dressed = load_robot("official")
    file = mujoco.MjModel.from_xml_path(str(folder / "stanford_tidybot" / "tidybot.xml"))
    assets, body = f"<asset>{dressed.assets}</asset>", f"<worldbody>{dressed.body}</worldbody>"
    text = f"<mujoco><compiler angle='radian' autolimits='true'/>{assets}{body}{dressed.rest}</mujoco>"
    yield file, mujoco.MjModel.from_xml_string(text), dressed
    load_robot.cache_clear()


# --- the same machine
def _their_joint(name: str) -> str:
    base = {"base_x": "joint_x", "base_y": "joint_y", "base_yaw": "joint_th"}
    return base.get(name, name if name.startswith("joint_") else f"{name}_joint")


def test_every_body_is_where_the_official_model_has_it(theirs: Any, ours: Any) -> None:
    here, there, rng = mujoco.MjData(ours), mujoco.MjData(theirs), np.random.default_rng(0)
    for _ in range(20):
        for j in range(ours.njnt):
            angle = rng.uniform(-2, 2)
            here.qpos[ours.jnt_qposadr[j]] = angle
            there.qpos[theirs.joint(_their_joint(ours.joint(j).name)).qposadr[0]] = angle
        mujoco.mj_kinematics(ours, here)
        mujoco.mj_kinematics(theirs, there)
        for b in range(1, ours.nbody):
            name = ours.body(b).name
            other = there.body(THEIRS.get(name, name))
            assert here.xpos[b] == pytest.approx(other.xpos, abs=0.001), name
            assert here.xmat[b] == pytest.approx(other.xmat, abs=0.001), name


def test_every_joint_and_motor_is_the_official_models(theirs: Any, ours: Any) -> None:
    assert ours.njnt == theirs.njnt and ours.nu == theirs.nu and ours.neq == theirs.neq
    for j in range(ours.njnt):
        one, other = ours.joint(j), theirs.joint(_their_joint(ours.joint(j).name))
        for field in ("limited", "range", "damping", "armature", "stiffness"):
            assert getattr(one, field) == pytest.approx(getattr(other, field), abs=1e-9), f"{one.name} {field}"
    arm = [ours.actuator(f"joint_{n}").id for n in range(1, 8)]
    assert ours.actuator_forcerange[arm] == pytest.approx(theirs.actuator_forcerange[3:10])
    assert ours.actuator_gainprm[arm] == pytest.approx(theirs.actuator_gainprm[3:10])
    assert ours.actuator_biasprm[arm] == pytest.approx(theirs.actuator_biasprm[3:10])
    gripper, fingers = ours.actuator("gripper"), theirs.actuator("fingers_actuator")
    for field in ("forcerange", "ctrlrange", "gainprm", "biasprm"):
        assert getattr(gripper, field) == pytest.approx(getattr(fingers, field)), field


def test_every_mass_is_the_official_models(theirs: Any, ours: Any) -> None:
    for b in range(1, ours.nbody):
        one = ours.body(b)
        other = theirs.body(THEIRS.get(one.name, one.name))
        assert one.mass == pytest.approx(other.mass), one.name
        assert one.ipos == pytest.approx(other.ipos, abs=1e-6), one.name
        if one.name != "base":
            assert one.inertia == pytest.approx(other.inertia, rel=1e-3), one.name
    width, depth, height = 0.4814, 0.4814, 0.3084
    box = 60 / 12 * np.array([depth**2 + height**2, width**2 + height**2, width**2 + depth**2])
    assert ours.body("base").inertia == pytest.approx(box, rel=0.01), "a solid box of the base's size"


def test_shapes_are_as_large_as_the_official_models(theirs: Any, ours: Any) -> None:
    for b in range(1, ours.nbody):
        name = ours.body(b).name
        want = _corners(theirs, THEIRS.get(name, name), solid=True)
        have = _corners(ours, name, solid=True, without=MAST)
        assert have == pytest.approx(want, abs=0.012), f"{name}: lowest and highest corners {have} for {want}"


def test_pads_are_those_of_the_official_model(theirs: Any, ours: Any) -> None:
    for name in ("left_pad1", "left_pad2", "right_pad1", "right_pad2"):
        one, other = ours.geom(name), theirs.geom(name)
        for field in ("pos", "size", "solref", "solimp", "priority"):
            assert getattr(one, field) == pytest.approx(getattr(other, field)), f"{name} {field}"
        assert one.friction[0] == other.friction[0] and one.friction[1] > other.friction[1]


def _corners(model: Any, name: str, solid: bool, without: tuple[str, ...] = ()) -> np.ndarray:
    """Lowest and highest corners (2, 3) [m] of a body's colliding geoms, or of those that are only to look at."""
    data = mujoco.MjData(model)
    mujoco.mj_kinematics(model, data)
    body = model.body(name).id
    turn, at = data.xmat[body].reshape(3, 3), data.xpos[body]
    found = []
    for g in range(model.ngeom):
        if model.geom_bodyid[g] == body and bool(model.geom_contype[g]) == solid and model.geom(g).name not in without:
            own = turn.T @ data.geom_xmat[g].reshape(3, 3)
            found.append(bounds(model, g, own, turn.T @ (data.geom_xpos[g] - at)))
    low, high = np.array(found).swapaxes(0, 1)
    return np.array([low.min(axis=0), high.max(axis=0)])


# --- the skin
def test_every_mesh_is_where_the_official_model_has_it(pair: tuple[Any, Any, Robot]) -> None:
    file, dressed, _ = pair
    merged = {ours: theirs for theirs, ours in MERGED.items()}
    for b in range(1, dressed.nbody):
        name = dressed.body(b).name
        want = _corners(file, THEIRS.get(name, name), solid=False)
        if name in merged:
            more = _corners(file, merged[name], solid=False)
            want = np.array([np.minimum(want[0], more[0]), np.maximum(want[1], more[1])])
        assert _corners(dressed, name, solid=False) == pytest.approx(want, abs=0.003), name


def test_what_the_skin_covers_collides_unseen_and_nothing_else_has_changed(pair: tuple[Any, Any, Robot]) -> None:
    file, dressed, robot = pair
    looks = [g for g in range(dressed.ngeom) if not dressed.geom_contype[g]]
    assert len(looks) == sum(1 for g in range(file.ngeom) if not file.geom_contype[g]) > 0
    assert all(dressed.geom_group[g] == ROBOT_GROUP and dressed.geom_rgba[g, 3] == 1 for g in looks)
    solid = [g for g in range(dressed.ngeom) if dressed.geom_contype[g]]
    assert all(dressed.geom_group[g] == (ROBOT_GROUP if dressed.geom(g).name in MAST else HULL_GROUP) for g in solid)
    assert max(dressed.mesh_facenum) < 2 * FACES
    plain = mujoco.MjModel.from_xml_string(robot.mjcf)
    assert robot.mjcf == own().mjcf and len(solid) == plain.ngeom, "who plans sees the same robot"
    assert dressed.body_mass == pytest.approx(plain.body_mass)
    assert dressed.body_inertia == pytest.approx(plain.body_inertia)


def test_the_mast_stands_on_the_base(ours: Any) -> None:
    data = mujoco.MjData(ours)
    mujoco.mj_kinematics(ours, data)
    g = ours.geom("mast").id
    low, high = _corners(ours, "base", solid=True, without=MAST)
    mast = bounds(ours, g, data.geom_xmat[g].reshape(3, 3), data.geom_xpos[g])
    assert (mast[0][:2] >= low[:2] - 1e-6).all() and (mast[1][:2] <= high[:2] + 1e-6).all()
    assert mast[0][2] == pytest.approx(ours.geom("mast").size[0] * -1 + 0.325, abs=0.002), "on top, but for its end"


def test_what_is_held_is_at_the_pinch_point() -> None:
    arm = ArmModel(own().mjcf)
    arm.hold(np.array([0.02, 0.03, 0.05]), np.array([0.01, 0.02, 0.03]))
    for q in (arm.home, arm.home + 0.4):
        pinch = arm.pose(q)
        held = arm.data.geom("held")
        assert held.xpos == pytest.approx(pinch.position + pinch.rotation @ [0.01, 0.02, 0.03], abs=1e-5)
        assert held.xmat.reshape(3, 3) == pytest.approx(pinch.rotation, abs=1e-4)
    arm.hold(np.array([0.02, 0.03, 0.05]), np.zeros(3), yaw_matrix(0.8))
    pinch = arm.pose(arm.home)
    turned = arm.data.geom("held").xmat.reshape(3, 3)
    assert turned == pytest.approx(pinch.rotation @ yaw_matrix(0.8), abs=1e-4), "along its own axes"


def test_physics_does_not_know_the_skin(root: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv(menagerie.ROOT, str(root))
    load_robot.cache_clear()
    sims = [Simulation(SCENE, robot=name) for name in ("tidybot", "official")]
    for sim in sims:
        sim.step(0.3)
    plain, dressed = (sim.service.physics.data.qpos for sim in sims)
    assert dressed.tolist() == plain.tolist()


# --- where it comes from
@pytest.mark.parametrize("body", ["forearm_link", "gripper"])
def test_a_model_that_lacks_something_is_refused_by_name(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, body: str
) -> None:
    standin.write(tmp_path, without=body)
    monkeypatch.setenv(menagerie.ROOT, str(tmp_path))
    load_robot.cache_clear()
    with pytest.raises(menagerie.RobotError) as refused:
        load_robot("official")
    assert str(tmp_path / "stanford_tidybot" / "tidybot.xml") in str(refused.value)
    assert f"nothing to look at for body {THEIRS.get(body, body)}" in str(refused.value)


def test_the_model_s_own_name_is_the_official_robot(root: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv(menagerie.ROOT, str(root))
    load_robot.cache_clear()
    plain, dressed, same = (load_robot(name).assets for name in ("tidybot", "official", "menagerie:stanford_tidybot"))
    assert same == dressed != plain


def test_a_model_under_another_file_name_is_found(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    standin.write(tmp_path, file="my_tidybot.xml")
    monkeypatch.setenv(menagerie.ROOT, str(tmp_path))
    assert menagerie.find() == tmp_path / "stanford_tidybot" / "my_tidybot.xml"


@pytest.mark.parametrize(
    ("name", "root", "cure"),
    [
        ("official", "empty", "Set MENAGERIE_ROOT"),
        ("official", None, "pip install mujoco-menagerie"),
        ("r2d2", None, "expected tidybot or official"),
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
    io = MemoryIo(MemoryBus(), "sim", SimService.READS, SimService.WRITES, household=told(SCENE), world=SCENE)
    with pytest.raises(ConfigError) as refused:
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
    assert menagerie.find().is_file()
    monkeypatch.setattr(menagerie.importlib, "import_module", lambda name: Package(None))
    with pytest.raises(menagerie.RobotError, match="no network"):
        menagerie.find()
