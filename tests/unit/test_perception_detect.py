"""Detection on views that MuJoCo's ray casting renders: no GL needed."""

import math
from functools import cache

import numpy as np
import pytest

from common.household import told
from common.kinds import KINDS
from common.rendering.raycast import render
from common.scene import Scene, load_scene
from services.perception.detect import ClassicalDetector, Detection
from services.perception.shapes import known as shapes
from services.perception.views import colour
from services.perception.views.self_filter import RobotModel
from services.perception.views.view import View
from services.sim.layout import Placement, place_objects
from services.sim.model import own
from services.sim.world import world_mjcf
from tests.support import JOINT_NAMES

mujoco = pytest.importorskip("mujoco")
WIDTH, HEIGHT, FOVY = 400, 300, 62.0
HEAD = np.array([-0.12, 0.0, 1.30])


@cache
def world(seed: int) -> tuple[Scene, list[Placement], object, object]:
    scene = load_scene("apartment")
    placements = place_objects(scene, seed)
    model = mujoco.MjModel.from_xml_string(world_mjcf(scene, placements))
    return scene, placements, model, mujoco.MjData(model)


def view(seed: int, x: float, y: float, theta: float, camera: str = "head") -> View:
    """What a camera of a robot at (x, y, theta) sees."""
    _, _, model, data = world(seed)
    for name, value in zip(JOINT_NAMES[:10], (x, y, theta, *own().home), strict=True):
        data.qpos[model.joint(name).qposadr[0]] = value  # type: ignore[attr-defined]
    mujoco.mj_kinematics(model, data)
    mujoco.mj_camlight(model, data)
    number = model.camera(camera).id  # type: ignore[attr-defined]
    rotation = data.cam_xmat[number].reshape(3, 3)  # type: ignore[attr-defined]
    rgb, depth = render(model, data, data.cam_xpos[number], rotation, FOVY, WIDTH, HEIGHT)  # type: ignore[attr-defined]
    focal = HEIGHT / 2 / math.tan(math.radians(FOVY) / 2)
    return View(
        rgb=rgb,
        depth=depth.astype(np.float32),
        focal=(focal, focal),
        middle=(WIDTH / 2, HEIGHT / 2),
        position=np.array(data.cam_xpos[number]),  # type: ignore[attr-defined]
        rotation=rotation @ np.diag([1.0, -1.0, -1.0]),
    )


def before(seed: int, on: str, distance: float = 1.1) -> tuple[View, list[Placement]]:
    """A view of a receptacle from its first free side, and what stands on it."""
    scene, placements, _, _ = world(seed)
    r = scene.receptacle(on)
    assert r is not None
    ax, ay = r.approach[0]
    edge = (r.size[0] if ax else r.size[1]) / 2 + distance
    x, y = r.center[0] + ax * edge, r.center[1] + ay * edge
    return view(seed, x, y, math.atan2(-ay, -ax)), [p for p in placements if p.on == on]


def detect(seen: View, seed: int) -> list[Detection]:
    scene = world(seed)[0]
    body = RobotModel(own().mjcf)
    body.pose(np.array(own().home), 0.085)
    turn = math.atan2(seen.rotation[1, 2], seen.rotation[0, 2])
    base = (
        float(seen.position[0] - HEAD[0] * math.cos(turn)),
        float(seen.position[1] - HEAD[0] * math.sin(turn)),
        turn,
    )
    return ClassicalDetector(told(scene), 3.5).detect(seen, body.mask(seen, base))


@pytest.mark.parametrize("seed", range(6))
def test_what_stands_before_the_camera_is_named_and_placed(seed: int) -> None:
    scene, placements, _, _ = world(seed)
    on = max((r.name for r in scene.receptacles), key=lambda name: sum(p.on == name for p in placements))
    seen, there = before(seed, on)
    found = {d.label: d for d in detect(seen, seed) if d.on == on}
    for p in there:
        u, v, _ = seen.project(np.array([p.position]))[0]
        if not (25 < u < WIDTH - 25 and 25 < v < HEIGHT - 25):
            continue
        assert p.spec.name in found, (p.spec.name, sorted(found))
        assert math.dist(found[p.spec.name].position, p.position) < 0.015
        assert found[p.spec.name].colour == p.spec.colour
    assert set(found) <= {p.spec.name for p in there}


def test_an_empty_floor_and_the_robot_itself_are_nothing() -> None:
    seen = view(0, 0.9, -1.4, math.pi)
    assert [d for d in detect(seen, 0) if not d.on] == []


@pytest.mark.parametrize("camera", ["head", "wrist"])
def test_no_edge_of_the_body_is_left_in_the_picture(camera: str) -> None:
    seen = view(0, 0.0, 0.0, 0.0, camera)
    body = RobotModel(own().mjcf)
    body.pose(np.array(own().home), 0.085)
    points = seen.points.reshape(-1, 3).astype(np.float64)
    close = np.flatnonzero(np.hypot(points[:, 0], points[:, 1]) < 1.0)
    touching = close[np.min([body.distance_to(points[close], g) for g in body.solid], axis=0) < 0.002]
    assert len(touching) > 300 and body.mask(seen, (0.0, 0.0, 0.0)).reshape(-1)[touching].all()


@pytest.mark.parametrize(
    ("kind", "size"), [("can", (0.066, 0.066, 0.115)), ("box", (0.06, 0.08, 0.13)), ("ball", (0.066, 0.066, 0.066))]
)
def test_a_shape_is_placed_from_the_half_that_is_seen(kind: str, size: tuple[float, float, float]) -> None:
    rng = np.random.default_rng(1)
    x, y, yaw, floor = 0.3, -0.2, 0.4, 0.7
    cloud = rng.uniform(-0.08, 0.08, (60000, 3)) + np.array([x, y, floor + size[2] / 2])
    shell = cloud[shapes.distances(KINDS[kind], size, cloud, floor, x, y, yaw) < 0.001]
    camera = np.array([-0.8, 0.1, 1.3])
    facing = shell[(shell - np.array([x, y, floor + size[2] / 2])) @ (camera - np.array([x, y, floor])) > 0]
    fit = shapes.fit(KINDS[kind], size, facing, floor, camera)
    assert math.hypot(fit.x - x, fit.y - y) < 0.004
    assert fit.residual < 0.002
    if kind == "box":
        assert abs(math.remainder(fit.yaw - yaw, math.pi)) < 0.05


@pytest.mark.parametrize("yaw", [0.0, 0.1, 0.75, 1.45, 1.57, 2.07, 2.3])
@pytest.mark.parametrize("size", [(0.06, 0.08, 0.13), (0.13, 0.06, 0.08)])
def test_a_box_of_which_one_face_is_seen_ends_where_its_points_do(size: tuple[float, float, float], yaw: float) -> None:
    rng = np.random.default_rng(2)
    middle, camera = np.array([0.3, -0.2, 0.7 + size[2] / 2]), np.array([-1.4, -0.2, 1.3])
    turn = np.array([[math.cos(yaw), -math.sin(yaw), 0.0], [math.sin(yaw), math.cos(yaw), 0.0], [0.0, 0.0, 1.0]])
    faces = []
    for axis in range(3):
        for side in (-0.5, 0.5):
            normal = turn[:, axis] * side
            points = rng.uniform(-0.5, 0.5, (400, 3))
            points[:, axis] = side
            if (camera - middle - normal * size[axis]) @ normal > 0.05:
                faces.append(middle + points * np.array(size) @ turn.T)
    fit = shapes.fit(KINDS["box"], size, np.concatenate(faces), 0.7, camera)
    assert math.hypot(fit.x - middle[0], fit.y - middle[1]) < 0.003
    assert abs(math.remainder(fit.yaw - yaw, math.pi)) < 0.05


def test_a_hidden_end_of_a_box_is_not_where_its_points_end() -> None:
    size, camera = (0.06, 0.08, 0.13), np.array([-1.0, 0.0, 1.3])
    across, up = np.meshgrid(np.linspace(-0.03, 0.03, 40), np.linspace(0.0, 0.13, 40))
    face = np.stack([np.zeros(1600), across.ravel(), 0.7 + up.ravel()], axis=1)
    left = face[face[:, 1] > 0.0]
    fit = shapes.fit(KINDS["box"], size, left, 0.7, camera, (False, True))
    assert abs(math.remainder(fit.yaw, math.pi / 2)) < 0.05
    front, side = (0.08, 0.06) if abs(math.sin(fit.yaw)) > 0.5 else (0.06, 0.08)
    assert math.hypot(fit.x - front / 2, fit.y - (0.03 - side / 2)) < 0.004


@pytest.mark.parametrize("side", ["x", "y"])
def test_a_box_that_was_knocked_over_is_still_that_box(side: str) -> None:
    _, placements, model, data = world(8)
    box = next(p for p in placements if p.spec.name == "white box")
    height = box.spec.size[0 if side == "y" else 1]
    top = box.position[2] - box.spec.size[2] / 2
    address = model.joint("white_box").qposadr[0]  # type: ignore[attr-defined]
    stood = data.qpos[address : address + 7].copy()  # type: ignore[attr-defined]
    half = math.sqrt(0.5)
    data.qpos[address + 2] = top + height / 2  # type: ignore[attr-defined]
    data.qpos[address + 3 : address + 7] = (half, half, 0, 0) if side == "x" else (half, 0, half, 0)  # type: ignore[attr-defined]
    found = {d.label: d for d in detect(before(8, "desk")[0], 8)}
    data.qpos[address : address + 7] = stood  # type: ignore[attr-defined]
    assert math.dist(found["white box"].position, (*box.position[:2], top + height / 2)) < 0.015
    assert found["white box"].size[2] == height and sorted(found["white box"].size) == sorted(box.spec.size)


def turn_of(yaw: float, roll: float) -> np.ndarray:
    """The quaternion of a thing that lies: its own z axis along `yaw`, turned by `roll` about that axis."""
    steps = ((0.0, 0.0, yaw), (0.0, math.pi / 2, 0.0), (0.0, 0.0, roll))
    whole = np.array([1.0, 0.0, 0.0, 0.0])
    for step in steps:
        angle = math.hypot(*step)
        part = np.array([math.cos(angle / 2), *(math.sin(angle / 2) * np.array(step) / max(angle, 1e-9))])
        product = np.zeros(4)
        mujoco.mju_mulQuat(product, whole, part)
        whole = product
    return whole


@pytest.mark.parametrize("yaw", [-2.0, -0.6, 0.9, 2.2])
@pytest.mark.parametrize("name", ["red mug", "green can", "blue bottle"])
def test_a_round_thing_that_was_knocked_over_is_known_and_lies(name: str, yaw: float) -> None:
    scene, _, model, data = world(0)
    spec, tray = scene.object(name), scene.receptacle("delivery tray")
    assert spec is not None and tray is not None
    radius = spec.size[0] / 2
    address = model.joint(name.replace(" ", "_")).qposadr[0]  # type: ignore[attr-defined]
    stood = data.qpos[address : address + 7].copy()  # type: ignore[attr-defined]
    place = (0.70, 0.04, tray.center[2] + radius)
    # The mug's handle is up.
    data.qpos[address : address + 7] = (*place, *turn_of(yaw, math.pi))  # type: ignore[attr-defined]
    found = [d for d in detect(view(0, -0.4, 0.0, 0.0), 0) if d.on == tray.name]
    data.qpos[address : address + 7] = stood  # type: ignore[attr-defined]
    assert [d.label for d in found] == [name]
    assert found[0].tilt == pytest.approx(math.pi / 2) and found[0].confidence > 0.6
    assert math.dist(found[0].position, place) < 0.015
    # The ends of a can are alike, and so are those of a mug whose opening is not in view.
    told_apart = spec.kind == "bottle" or (spec.kind == "mug" and abs(yaw) < 1.0)
    assert abs(math.remainder(found[0].yaw - yaw, math.tau if told_apart else math.pi)) < 0.1
    assert found[0].size == (spec.size[2], spec.size[0], spec.size[0])


@pytest.mark.parametrize("tilt", [0.0, math.pi])
@pytest.mark.parametrize("spot", [(0.64, 0.0), (0.70, 0.12)])
@pytest.mark.parametrize("name", ["red mug", "white mug", "yellow bowl"])
def test_a_vessel_is_upside_down_only_when_its_foot_is_seen(name: str, spot: tuple[float, float], tilt: float) -> None:
    """On the tray before the robot at home, whose arm hides a part of it."""
    scene, _, model, data = world(0)
    spec, tray = scene.object(name), scene.receptacle("delivery tray")
    assert spec is not None and tray is not None
    address = model.joint(name.replace(" ", "_")).qposadr[0]  # type: ignore[attr-defined]
    stood = data.qpos[address : address + 7].copy()  # type: ignore[attr-defined]
    turn = (math.cos(tilt / 2), math.sin(tilt / 2), 0.0, 0.0)
    data.qpos[address : address + 7] = (*spot, tray.center[2] + spec.size[2] / 2, *turn)  # type: ignore[attr-defined]
    found = {d.label: d for d in detect(view(0, 0.0, 0.0, 0.0), 0) if d.on == tray.name}
    data.qpos[address : address + 7] = stood  # type: ignore[attr-defined]
    assert name in found and found[name].tilt in (0.0, tilt), found
    if spot[1] > 0.1:
        assert found[name].tilt == tilt


def test_a_can_explains_a_mug_worse_than_a_mug_does() -> None:
    size = (0.074, 0.074, 0.095)
    angle = np.linspace(0, 2 * math.pi, 200)
    ring = [
        np.stack([r * np.cos(angle), r * np.sin(angle), np.full(200, z)], axis=1)
        for r, z in ((0.035, 0.05), (0.033, 0.03), (0.037, 0.09))
    ]
    points = np.concatenate(ring)
    camera = np.array([-1.0, 0.0, 1.0])
    mug, can = (shapes.fit(KINDS[kind], size, points, 0.0, camera) for kind in ("mug", "can"))
    assert mug.residual < can.residual


def test_colours_have_their_everyday_names_in_bright_and_dim_light() -> None:
    for spec in load_scene("apartment").objects:
        for light in (1.0, 0.6):
            named = colour.name(np.array(spec.rgba[:3]) * light)
            assert named == spec.colour or (spec.colour == "white" and named == "grey" and light < 1)


def test_the_typical_colour_ignores_a_small_part_of_another() -> None:
    rgb = np.array([[30, 130, 50]] * 80 + [[230, 230, 230]] * 20, np.uint8)
    assert colour.name(colour.typical(rgb)) == "green"


@pytest.mark.parametrize(("kind", "size"), [("mug", (0.074, 0.074, 0.095)), ("bowl", (0.14, 0.14, 0.06))])
@pytest.mark.parametrize("lowest", [0.4, 0.7])
def test_a_vessel_whose_front_is_hidden_is_not_taken_to_begin_at_its_far_wall(
    kind: str, size: tuple[float, float, float], lowest: float
) -> None:
    rng, row, camera = np.random.default_rng(3), KINDS[kind], np.array([0.3, -0.8, 1.3])
    angle, height = rng.uniform(0.35, math.pi - 0.35, 500), rng.uniform(lowest, 1.0, 500) * size[2]
    inside = size[0] / 2 - row.wall - (size[2] - height) * math.tan(row.lean)
    points = np.stack([0.3 + inside * np.cos(angle), -0.2 + inside * np.sin(angle), 0.7 + height], axis=1)
    fit = shapes.fit(row, size, points + rng.normal(0, 0.0015, points.shape), 0.7, camera)
    assert math.hypot(fit.x - 0.3, fit.y + 0.2) < 0.01
