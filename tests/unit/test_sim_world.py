import json
import math
from pathlib import Path

import msgspec
import mujoco
import numpy as np
import pytest

from common import messages as m
from common import topics
from common.approach import HALF_WIDTH
from common.floor_plan import Box
from common.household import load_household
from common.plan_tables import SCENES
from common.runtime import StartError
from common.scene import SceneError, load_scene
from common.support import MARGIN
from common.topic import Topic
from services.sim.layout import place_objects
from services.sim.physics import Physics
from tests.simulation import Simulation
from tests.support import JOINT_NAMES

TWICE = ("palm", "floor", "table")
"""Names that a part of the robot, the floor and a receptacle have."""


@pytest.mark.parametrize(
    "pose",
    [
        (0.000109, -0.036428, 0.007356, 0.97908, -0.002399, -0.203458, -0.001327),
        (-0.001558, -0.03648, -0.016913, 0.996033, -0.001154, -0.088971, -0.001372),
        (-0.001521, -0.03649, 0.009674, 0.961262, -0.002435, -0.275559, 0.005973),
    ],
)
def test_a_pad_that_hardly_touches_a_can_is_not_deep_in_it(pose: tuple[float, ...]) -> None:
    """`pose`: of a can's axis before a pad, 72 to 84 um into it as a box of 8 mm."""
    tolerance = Physics(load_scene("minimal"), 0).model.opt.ccd_tolerance
    model = mujoco.MjModel.from_xml_string("""<mujoco><worldbody>
        <geom type="box" size="0.011 0.004 0.0094"/>
        <body><freejoint/><geom type="cylinder" size="0.0325 0.058"/></body></worldbody></mujoco>""")
    model.opt.ccd_tolerance = tolerance
    data = mujoco.MjData(model)
    data.qpos[:] = pose
    mujoco.mj_forward(model, data)
    assert data.ncon and data.contact.dist[: data.ncon].min() > -2e-4


class World(Simulation):
    def speed(self) -> float:
        physics = self.sim.physics
        return float(np.hypot(*physics.data.qvel[physics.qvel_at[:2]]))

    def reached(self) -> m.GoalReached:
        return self.last(topics.GOAL_REACHED)


def test_layouts_repeat_for_a_seed_and_stand_on_reachable_free_spots() -> None:
    scene = load_scene("apartment")
    for seed in range(50):
        placements = place_objects(scene, seed)
        assert placements == place_objects(scene, seed)
        assert len(placements) == len(scene.objects) >= 12
        for i, p in enumerate(placements):
            receptacle = scene.receptacle(p.on)
            assert receptacle is not None and receptacle.approach
            assert receptacle.contains(p.position[0], p.position[1], MARGIN)
            for q in placements[:i]:
                gap = math.dist(p.position[:2], q.position[:2])
                assert gap > (max(p.spec.size[:2]) + max(q.spec.size[:2])) / 2 + 0.08
    assert place_objects(scene, 1) != place_objects(scene, 2)


@pytest.mark.parametrize("seed", range(3))
def test_objects_stay_where_they_were_put(seed: int) -> None:
    world = World("apartment", seed)
    world.step(2.0)
    for name, found in world.truth()["objects"].items():  # type: ignore[attr-defined]
        placed = next(p for p in world.sim.physics.placements if p.spec.name == name)
        assert math.dist(found["position"], placed.position) < 0.01, name
        assert found["on"] == placed.on


def test_truth_has_the_fields_of_the_wire() -> None:
    truth = World().truth()
    assert set(truth) == {"t", "epoch", "base", "holding", "objects", "goal_regions", "obstacles", "contacts"}
    assert truth["holding"] is None and truth["base"] == pytest.approx([0, 0, 0], abs=1e-6)
    mug = truth["objects"]["red mug"]  # type: ignore[index]
    assert set(mug) == {"kind", "colour", "position", "quaternion", "on", "touching_gripper"}


def test_the_base_runs_to_its_target_within_limits_and_says_so() -> None:
    world = World("apartment")
    world.bus.send(topics.BASE_TARGET, m.BaseTarget(x=0.2, y=1.1, theta=1.0, id="a"))
    fastest = 0.0
    for _ in range(800):
        world.step(0.01)
        fastest = max(fastest, world.speed())
        if world.reached() == m.GoalReached(reached=True, target_id="a"):
            break
    assert world.reached() == m.GoalReached(reached=True, target_id="a")
    assert world.truth()["base"] == pytest.approx([0.2, 1.1, 1.0], abs=0.02)
    assert 0.3 < fastest < 0.55


def test_stop_brakes_at_once_and_holds_until_resume() -> None:
    world = World("apartment")
    world.bus.send(topics.BASE_TARGET, m.BaseTarget(x=-1.2, y=-1.2, theta=0.0, id="a"))
    world.step(1.1)
    before = world.speed()
    assert before > 0.4
    world.bus.put(topics.ROBOT_STOP, b"enough")
    world.step(0.06)
    assert world.speed() < before / 2
    world.step(0.24)
    assert world.speed() < 0.01
    world.bus.send(topics.BASE_TARGET, m.BaseTarget(x=-1.2, y=-1.2, theta=0.0, id="b"))
    world.step(0.5)
    assert world.speed() < 0.01, "commands are ignored while stopped"
    world.bus.put(topics.ROBOT_RESUME, b"me")
    world.step(0.5)
    assert world.speed() < 0.01, "nothing from before resumes by itself"
    world.bus.send(topics.BASE_TARGET, m.BaseTarget(x=-1.2, y=-1.2, theta=0.0, id="c"))
    world.step(1.0)
    assert world.speed() > 0.2


def test_a_silent_velocity_stream_means_hold() -> None:
    world = World("apartment")
    for _ in range(10):
        world.bus.send(topics.CMD_VEL, m.CmdVel(vx=0.0, vy=0.3, omega=0.0))
        world.step(0.1)
    assert world.speed() > 0.2
    world.step(0.7)
    assert world.speed() < 0.01


def test_joint_states_name_every_joint_at_100_hz() -> None:
    world = World()
    tap = world.bus.tap(topics.JOINT_STATES)
    world.step(0.5)
    assert len(tap) == 50
    state = msgspec.msgpack.decode(tap[-1], type=m.JointStates)
    assert tuple(state.name) == JOINT_NAMES
    assert len(state.position) == len(state.velocity) == len(state.effort) == len(JOINT_NAMES)
    assert state.position[-1] == pytest.approx(0.085, abs=0.002)


def test_the_lidar_sees_walls_and_of_the_robot_only_the_posts_around_it() -> None:
    world = World()
    tap = world.bus.tap(topics.SCAN)
    world.step(0.2)
    scan = msgspec.msgpack.decode(tap[-1], type=m.LaserScan)
    ranges = np.frombuffer(scan.ranges, "<f4")
    angles = scan.angle_min + np.arange(len(ranges)) * scan.angle_increment
    behind = ranges[np.abs(np.abs(angles) - math.pi) < 0.02]
    assert behind == pytest.approx(1.5 - 0.06, abs=0.03)
    own = np.abs(np.stack([np.cos(angles), np.sin(angles)]) * ranges).max(axis=0) < HALF_WIDTH
    assert own.mean() < 0.13 and ranges[~own].min() > 0.4


@pytest.mark.parametrize(
    ("topic", "message"),
    [
        (topics.BASE_TARGET, m.BaseTarget(x=1e9, y=0.0, theta=0.0)),
        (topics.CMD_VEL, m.CmdVel(vx=1e30, vy=0.0, omega=0.0)),
        (topics.ARM_COMMAND, m.ArmCommand(position=[0.0] * 3)),
        (topics.ARM_COMMAND, m.ArmCommand(position=[float("nan")] * 7)),
        (topics.ARM_COMMAND, m.ArmCommand(position=[3.0] * 7)),
        (topics.GRIPPER_COMMAND, m.GripperCommand(position=7.0)),
    ],
)
def test_impossible_commands_are_counted_and_move_nothing(topic: Topic[m.Message], message: m.Message) -> None:
    world = World()
    before = world.sim.physics.data.qpos[:10].copy()
    world.bus.send(topic, message)
    world.step(0.3)
    assert world.io.drops[topic.key] == 1
    assert world.sim.physics.data.qpos[:10] == pytest.approx(before, abs=1e-3)


def test_the_arm_follows_its_stream_and_holds_when_it_ends() -> None:
    world = World()
    physics = world.sim.physics
    start = physics.data.qpos[physics.qpos_at[3:]].copy()
    for step in range(50):
        goal = start.copy()
        goal[0] += 0.01 * (step + 1)
        world.bus.send(topics.ARM_COMMAND, m.ArmCommand(position=goal.tolist(), period=0.02))
        world.step(0.02)
    world.step(1.0)
    assert physics.data.qpos[physics.qpos_at[3]] - start[0] == pytest.approx(0.5, abs=0.02)


def test_queries_reset_pause_and_save() -> None:
    world = World("apartment", seed=1)
    first = world.truth()["objects"]
    assert json.loads(world.bus.get("sim/reset", b'{"seed": 2}') or b"")["seed"] == 2
    assert world.truth()["objects"] != first
    assert json.loads(world.bus.get("sim/pause", b'{"paused": true}') or b"")["paused"] is True
    assert world.sim.paused
    with pytest.raises(msgspec.DecodeError):
        world.bus.get("sim/reset", b"not json")


def test_a_snapshot_restores_the_whole_state(tmp_path: Path) -> None:
    world = World(snapshot_dir=str(tmp_path))
    world.bus.send(topics.BASE_TARGET, m.BaseTarget(x=-0.5, y=0.3, theta=0.5, id="a"))
    world.step(1.0)
    saved = json.loads(world.bus.get("sim/snapshot") or b"{}")
    assert Path(saved["path"]).stat().st_size == saved["bytes"]
    state = np.load(saved["path"])
    before = world.sim.physics.data.qpos.copy()
    world.step(0.5)
    world.sim.physics.restore(state)
    assert np.array_equal(world.sim.physics.data.qpos, before)


@pytest.mark.parametrize(
    ("change", "expected"),
    [
        (("[2.9, 1.5]", '"x"'), "scene.toml: high: Expected"),
        (
            ('kind = "table"', 'kind = "tabel"'),
            "receptacles 'table': kind: Invalid enum value 'tabel'; there are bin, counter, shelf, sink, table, tray",
        ),
        (("size = [0.60, 1.60]", "size = [0.60]"), "receptacles 'table': size: Expected `array` of length 2"),
        (("size = [0.60, 1.60]", "size = [0.60, 0]"), "receptacle 'table' needs a positive size"),
        (("size = [0.60, 1.60]", "size = [60, 160]"), "lengths are metres"),
        (("size = [0.60, 1.60]", "size = [0.60, 1.60], yaw = 90"), "angles are radians (90.0 degrees are 1.571)"),
        (("size = [0.60, 1.60]", "size = [0.60, 1.60], rotation = 90"), "there are name, kind, center, size, yaw"),
        (("center = [2.30, 0.0", "center = [23.0, 0.0"), "receptacle 'table' is at (23.0, 0.0), outside of low"),
        (
            ("center = [2.30, 0.0", "center = [2.86, 0.0"),
            "'table' has its middle in wall 2, from (2.9, -1.5) to (2.9, 1.5)",
        ),
        (("x = 0.0, y = 0.0", "x = 0.4, y = 0.0"), "home (0.4, 0.0) is 0.12 m from what stands there"),
        (("x = 0.0, y = 0.0", "x = 30.0, y = 0.0"), "home (30.0, 0.0) is outside of low"),
        (("mass = 0.12", "mass = -1.0"), "'yellow block' needs a positive size and mass"),
        (('name = "green can"', 'name = "red mug"'), "object 'red mug' is defined twice"),
        (('name = "green can"', 'name = "Tom & Jerry"'), "name 'Tom & Jerry' has & in it"),
        (('delivery = "delivery tray"', 'delivery = "trey"'), "delivery 'trey' is no receptacle"),
        (('name = "minimal"', 'name = "minimal"\nfloor = 1'), "unknown field `floor`"),
    ],
)
def test_a_typo_in_a_scene_is_named(tmp_path: Path, change: tuple[str, str], expected: str) -> None:
    text = (SCENES / "minimal.toml").read_text()
    path = tmp_path / "scene.toml"
    path.write_text(text.replace(*change, 1))
    with pytest.raises(SceneError, match=r"scene\.toml") as error:
        load_scene(str(path))
    assert expected in str(error.value)


def test_furniture_may_be_called_what_a_part_of_the_robot_is() -> None:
    scene = load_scene("minimal")
    boxes = (Box(name=name, center=(1.0, 1.0 + n / 9, 0.5), size=(0.1, 0.1, 1.0)) for n, name in enumerate(TWICE))
    model = Physics(msgspec.structs.replace(scene, furniture=tuple(boxes)), 0).model
    assert {"palm", "palm_", "floor_", "table_"} <= {model.geom(n).name for n in range(model.ngeom)}


def test_what_the_robot_mapped_itself_is_taken_as_it_was_measured(tmp_path: Path) -> None:
    text = (SCENES / "minimal.toml").read_text()
    (tmp_path / "household.toml").write_text(text.replace("center = [2.30, 0.0", "center = [2.95, 0.0"))
    with pytest.raises(SceneError, match="outside of low"):
        load_household(str(tmp_path / "household.toml"))
    (tmp_path / "map.yaml").touch()
    assert load_household(str(tmp_path / "household.toml")).receptacles


def test_a_surface_has_the_sides_that_are_free_where_the_file_leaves_them_out(tmp_path: Path) -> None:
    """As a person does who draws a plan: of a table against a wall the other three; the yard outside does not count."""
    text = (
        (SCENES / "minimal.toml").read_text().replace("size = [0.60, 1.60], approach = [[-1, 0]]", "size = [0.6, 1.2]")
    )
    text = text.replace("high = [2.9, 1.5]\nhome", "high = [12.9, 9.5]\nhome")
    path = tmp_path / "scene.toml"
    path.write_text(text)
    free, unsaid = load_scene(str(path)).receptacle("table"), load_household(str(path)).receptacle("table")
    assert free is not None and free == unsaid and set(free.approach) == {(-1.0, 0.0), (0.0, 1.0), (0.0, -1.0)}
    assert load_scene("minimal").receptacle("table").approach == ((-1.0, 0.0),)  # type: ignore[union-attr]


@pytest.mark.parametrize("speed", ["fast", "-1", "0", "nan"])
def test_a_bad_speed_says_what_is_expected(speed: str) -> None:
    with pytest.raises(StartError, match="expected realtime, max or a factor"):
        World(speed=speed)


@pytest.mark.parametrize("rate", [0.3, -0.6])
def test_the_arm_does_not_trail_a_set_point_that_moves_evenly(rate: float) -> None:
    physics = Physics(load_scene("minimal"), seed=0)
    at = physics.joints.copy()
    step = np.zeros(10)
    step[5], step[8] = rate * 0.01, abs(rate) * 0.01  # joint 6 the other way folds the hand onto the forearm
    for _ in range(60):
        physics.advance(at, at + step)
        at = at + step
    assert np.abs(physics.joints[3:] - at[3:]).max() < 0.004, "without the lead joint 6 would be 19 mrad behind"
