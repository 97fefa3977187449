import math
import os
import subprocess
import sys
import threading

import msgspec
import mujoco
import numpy as np
import pytest

from common import messages as m
from common import topics
from common.geometry import quat_matrix
from common.household import load_household
from common.rendering import backend, raycast
from common.rendering.renderer import Renderer
from common.scene import load_scene
from services.camera.config import CameraConfig
from services.camera.service import CameraService
from services.sim.physics import Physics
from tests.node import Node

TINY = """<mujoco><visual><quality offsamples="0"/></visual><worldbody>
<geom type="plane" size="5 5 .1" rgba="0 1 0 1"/>
<geom type="box" size=".2 .2 .25" pos="0 0 .25" rgba="1 0 0 1"/>
<camera name="down" pos="0 0 2" xyaxes="1 0 0 0 1 0" fovy="60"/>
</worldbody></mujoco>"""


@pytest.fixture(scope="module")
def physics() -> Physics:
    return Physics(load_scene("minimal"), 0)


def test_ray_cast_depth_and_colours_are_those_of_the_scene() -> None:
    model = mujoco.MjModel.from_xml_string(TINY)
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    rotation = data.cam_xmat[0].reshape(3, 3)
    rgb, depth = raycast.render(model, data, data.cam_xpos[0], rotation, 60.0, 80, 60)
    assert depth.shape == (60, 80) and rgb.shape == (60, 80, 3)
    assert depth[30, 40] == pytest.approx(1.5, abs=0.002), "the box's top"
    assert depth[2, 2] == pytest.approx(2.0, abs=0.002), "the floor, along the optical axis"
    assert rgb[30, 40].argmax() == 0 and rgb[2, 2].argmax() == 1


ONE_PASS = f"""
import mujoco, numpy
from common.rendering.renderer import Renderer
ours = Renderer('''{TINY}''', "auto")
ours.load(ours.data.qpos.tobytes(), b"")
rgb, depth = ours.rgbd("down", 80, 60)
theirs = mujoco.Renderer(ours.model, 60, 80)
theirs.update_scene(ours.data, "down")
assert ours.backend != "raycast" and numpy.array_equal(rgb, theirs.render())
theirs.enable_depth_rendering()
assert numpy.array_equal(depth, theirs.render())
assert abs(depth[30, 40] - 1.5) < 0.002 and abs(depth[2, 2] - 2.0) < 0.002
for rows in ((0, 20), (17, 43), (40, 60)):
    band = ours.band("down", 80, 60, rows)
    other = (numpy.abs(band.astype(int) - rgb[slice(*rows)]) > 1).any(axis=2)
    assert band.shape == (rows[1] - rows[0], 80, 3) and other.mean() < 0.02, "an edge may round to the next pixel"
"""


def test_colour_and_depth_of_one_pass_are_those_of_two() -> None:
    chosen = next((b for b in ("egl", "osmesa") if backend.works(b)), None)
    if chosen is None:
        pytest.skip("no GL library works here")
    run = [sys.executable, "-c", ONE_PASS]
    subprocess.run(run, env=os.environ | backend.environment(chosen), check=True, timeout=60)


LATE = f"""
import mujoco, os, sys
from common.rendering.renderer import Renderer
assert not hasattr(mujoco, "GLContext")
del os.environ["MUJOCO_GL"]
ours, chosen = Renderer('''{TINY}''', sys.argv[1]), sys.argv[1]
ours.load(ours.data.qpos.tobytes(), b"")
assert ours.backend == chosen and abs(ours.rgbd("down", 80, 60)[1][30, 40] - 1.5) < 0.002
assert Renderer('''{TINY}''', "auto").backend == chosen
assert Renderer('''{TINY}''', "osmesa" if chosen == "egl" else "egl").backend == "raycast", "one library a process"
"""


def test_a_library_is_loaded_after_mujoco_was_imported_without_any() -> None:
    chosen = next((b for b in ("egl", "osmesa") if backend.works(b)), None)
    if chosen is None:
        pytest.skip("no GL library works here")
    subprocess.run(
        [sys.executable, "-c", LATE, chosen], env={**os.environ, "MUJOCO_GL": "disable"}, check=True, timeout=60
    )


def test_who_wants_no_library_gets_cast_pictures(monkeypatch: pytest.MonkeyPatch) -> None:
    for name in backend.GL:
        monkeypatch.delitem(sys.modules, f"mujoco.{name}", raising=False)
    monkeypatch.setenv("MUJOCO_GL", "disable")
    assert backend.choose("auto") == "raycast"
    monkeypatch.setenv("MUJOCO_GL", "osmesa")
    assert backend.choose("auto") == "osmesa" and backend.choose("raycast") == "raycast"


@pytest.mark.parametrize("case", [0.0, 0.01])
def test_ray_cast_points_lie_where_they_are_also_close_and_off_the_axis(case: float) -> None:
    """A slanted view of the floor from 20 cm, from inside a case or without one."""
    box = f'<geom type="box" size="{case} {case} {case}"/>' if case else ""
    camera = f'<body name="hand" pos="0.3 0.1 0.2">{box}<camera name="near" euler="40 10 0" fovy="70"/></body>'
    model = mujoco.MjModel.from_xml_string(TINY.replace("</worldbody>", camera + "</worldbody>"))
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    camera_id, width, height = model.camera("near").id, 64, 48
    eye, rotation = data.cam_xpos[camera_id], data.cam_xmat[camera_id].reshape(3, 3)
    body = int(model.cam_bodyid[camera_id])
    rgb, depth = raycast.render(model, data, eye, rotation, 70.0, width, height, body)
    focal = height / 2 / math.tan(math.radians(35))
    u, v = np.meshgrid(np.arange(width) + 0.5 - width / 2, np.arange(height) + 0.5 - height / 2)
    points = eye + (np.stack([u / focal, -v / focal, -np.ones_like(u)], axis=-1) * depth[..., None]) @ rotation.T
    floor = (depth > 0) & (rgb.argmax(axis=-1) == 1)
    assert floor.sum() > 200
    assert np.abs(points[floor][:, 2]).max() < 1e-6


class Lens(Node):
    """The service, rendering by ray casting."""

    def __init__(self, monkeypatch: pytest.MonkeyPatch) -> None:
        monkeypatch.setenv("MUJOCO_GL", "")
        super().__init__(CameraService, CameraConfig(backend="raycast"), load_household("minimal"))

    def state(self, physics: Physics) -> None:
        model = m.SimModel(scene="minimal", seed=0, epoch="e", mjcf=physics.mjcf)
        self.bus.send(topics.SIM_MODEL, model)
        qpos = physics.data.qpos.tobytes()
        self.bus.send(topics.SIM_STATE, m.SimState(t=1.5, tick=150, epoch="e", qpos=qpos))

    def ask(self, **fields: object) -> None:
        request = {"id": "r", "camera": "head", "width": 64, "height": 48, **fields}
        self.bus.put(topics.CAMERA_REQUEST, msgspec.json.encode(request))
        self.step(0.5)


def test_an_image_carries_intrinsics_and_the_pose_of_its_frame(
    physics: Physics, monkeypatch: pytest.MonkeyPatch
) -> None:
    node = Lens(monkeypatch)
    node.state(physics)
    node.ask()
    image = node.sent(topics.HEAD_RGBD)[-1]
    assert (image.id, image.camera, image.t, image.backend) == ("r", "head", 1.5, "raycast")
    assert image.fy == pytest.approx(24 / math.tan(math.radians(62.0) / 2))
    assert image.position == pytest.approx((-0.1687, 0.0, 1.30), abs=1e-3)
    forward = quat_matrix(image.orientation)[:, 2]
    assert forward == pytest.approx([math.cos(0.62), 0.0, -math.sin(0.62)], abs=1e-3)
    depth = np.frombuffer(image.depth, "<u2").reshape(48, 64)
    assert len(image.rgb) == 64 * 48 * 3
    u, v = 5, 44
    ray = quat_matrix(image.orientation) @ [(u + 0.5 - image.cx) / image.fx, (v + 0.5 - image.cy) / image.fy, 1.0]
    point = np.array(image.position) + ray * depth[v, u] / 1000
    assert point[2] == pytest.approx(0.0, abs=0.01), "a pixel beside the tray sees the floor"


@pytest.mark.parametrize("fields", [{"width": 0}, {"height": -1}, {"width": 9999}, {"camera": "tail"}, {"width": "x"}])
def test_impossible_requests_are_counted(
    fields: dict[str, object], physics: Physics, monkeypatch: pytest.MonkeyPatch
) -> None:
    node = Lens(monkeypatch)
    node.state(physics)
    node.ask(**fields)
    assert node.io.drops["camera/request"] == 1 and not node.count(topics.HEAD_RGBD)


def test_a_request_before_the_first_state_is_counted(monkeypatch: pytest.MonkeyPatch) -> None:
    node = Lens(monkeypatch)
    node.ask()
    assert node.io.drops["camera/request"] == 1 and not node.count(topics.HEAD_RGBD)


def test_a_state_of_another_model_is_counted_and_the_next_one_works(
    physics: Physics, monkeypatch: pytest.MonkeyPatch
) -> None:
    node = Lens(monkeypatch)
    node.state(physics)
    node.bus.send(topics.SIM_STATE, m.SimState(t=1.0, tick=1, epoch="e", qpos=b"\0" * 16))
    node.ask()
    assert node.io.drops["sim/state"] == 1 and not node.count(topics.HEAD_RGBD)
    node.state(physics)
    node.ask()
    assert node.count(topics.HEAD_RGBD) == 1


def test_the_renderer_is_freed_in_the_thread_that_made_it(physics: Physics, monkeypatch: pytest.MonkeyPatch) -> None:
    closed: list[str] = []
    monkeypatch.setattr(Renderer, "close", lambda self: closed.append(threading.current_thread().name))
    node = Lens(monkeypatch)
    node.state(physics)
    node.ask()
    node.ask(id="under way when it ends", width=320, height=240)
    node.service.close()
    node.io.shutdown()
    assert len(closed) == 1 and closed[0].startswith("camera-worker")


SPECIAL = """<mujoco><visual><quality shadowsize="0" offsamples="0"/></visual>
<asset><material name="tin" specular=".9" shininess=".9"/></asset><worldbody>
<geom type="plane" size="3 3 .1" rgba="0 1 0 1"/>
<geom type="box" size=".1 .1 .25" pos=".3 0 .25" material="tin" rgba="1 0 0 1"/>
<geom type="box" size=".1 .1 .25" pos="-.3 0 .25" rgba="0 0 1 .3"/>
<camera name="down" pos="0 0 2" xyaxes="1 0 0 0 1 0" fovy="60"/>
<camera name="away" pos="0 1 .7" xyaxes="1 0 0 0 0 1" fovy="20"/>
</worldbody></mujoco>"""
LOOKS = f"""
import mujoco, numpy
from common.rendering.renderer import Renderer
for backend in ("auto", "raycast"):
    ours = Renderer('''{SPECIAL}''', backend)
    ours.backend = backend if backend == "raycast" else ours.backend
    ours.load(ours.data.qpos.tobytes(), b"")
    rgb, depth = ours.rgbd("down", 80, 60)
    seen = ours.surfaces("down", depth)
    assert abs(seen.gloss[30, 50] - 0.8) < 1e-6 and not seen.clear[30, 50], backend
    assert seen.clear[30, 30] and seen.gloss[30, 30] == 0.0, backend
    assert seen.gloss[2, 2] == 0.0 and not seen.clear[2, 2], backend
    assert ours.surfaces("away", ours.rgbd("away", 80, 60)[1]) is None, backend
    behind = 2.0 if backend == "auto" else 1.5
    assert abs(depth[30, 50] - 1.5) < 0.002 and abs(depth[30, 30] - behind) < 0.002, (backend, depth[30, 30])
    ours.close()
"""


def test_the_renderer_knows_what_is_glossy_and_looks_through_what_is_transparent() -> None:
    chosen = next((b for b in ("egl", "osmesa") if backend.works(b)), None)
    if chosen is None:
        pytest.skip("no GL library works here")
    environ = os.environ | backend.environment(chosen)
    subprocess.run([sys.executable, "-c", LOOKS], env=environ, check=True, timeout=60)
