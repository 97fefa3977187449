"""The model's drawing against MuJoCo's own kinematics."""

import mujoco
import numpy as np
import pytest

from common.household import load_household
from common.scene import load_scene
from services.dashboard.scene.drawing import Drawing, Mesh, draw, posture
from services.dashboard.scene.view import COLOURS, fallback
from services.sim.physics import Physics


@pytest.fixture(scope="module")
def mjcf() -> str:
    return Physics(load_scene("minimal"), 0, ()).mjcf


@pytest.fixture(scope="module")
def drawing(mjcf: str) -> Drawing:
    return draw(mjcf)


def placed(drawing: Drawing, q: dict[str, float]) -> dict[str, tuple[np.ndarray, np.ndarray]]:
    """Every link's position and rotation in frame map."""
    found: dict[str, tuple[np.ndarray, np.ndarray]] = {"": (np.zeros(3), np.eye(3))}
    for link in drawing.links:
        place, turn = posture(link, q)
        above, around = found[link.parent]
        found[link.name] = (above + around @ place, around @ turn)
    return found


@pytest.mark.parametrize("seed", range(3))
def test_links_stand_where_mujoco_puts_them(mjcf: str, drawing: Drawing, seed: int) -> None:
    model = mujoco.MjModel.from_xml_string(mjcf)
    data = mujoco.MjData(model)
    rng = np.random.default_rng(seed)
    q = {joint.name: float(rng.uniform(-1, 1)) for link in drawing.links for joint in link.joints}
    assert {"base_x", "base_yaw", "joint_1", "joint_7", "left_driver", "right_driver"} <= q.keys()
    for name, value in q.items():
        data.qpos[model.joint(name).qposadr[0]] = value
    mujoco.mj_kinematics(model, data)
    for name, (place, turn) in placed(drawing, q).items():
        if name:
            body = model.body(name).id
            assert place == pytest.approx(data.xpos[body], abs=1e-9), name
            assert turn == pytest.approx(data.xmat[body].reshape(3, 3), abs=1e-9), name


def test_cameras_look_where_mujocos_do(mjcf: str, drawing: Drawing) -> None:
    model = mujoco.MjModel.from_xml_string(mjcf)
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    links = placed(drawing, {})
    assert {c.name for c in drawing.cameras} == {"head", "wrist"}
    for camera in drawing.cameras:
        above, around = links[camera.link]
        number = model.camera(camera.name).id
        assert above + around @ camera.position == pytest.approx(data.cam_xpos[number])
        # MuJoCo's cameras look along -z, optical frames along z.
        forward = -data.cam_xmat[number].reshape(3, 3)[:, 2]
        assert around @ camera.rotation[:, 2] == pytest.approx(forward)


def test_what_moves_by_itself_is_not_part_of_the_flat(drawing: Drawing) -> None:
    assert set(drawing.objects) == {o.name for o in load_scene("minimal").objects}
    assert drawing.flat is not None
    table = next(r for r in load_household("minimal").receptacles if r.name == "table")
    above = drawing.flat.vertices[:, 2] > table.center[2] + 0.01
    assert not above.any(), "something that stands on the table was drawn as furniture"


def test_walls_are_cut_and_apart(drawing: Drawing) -> None:
    assert drawing.walls is not None
    assert drawing.walls.vertices[:, 2].max() == pytest.approx(1.0)


def test_an_obstacle_that_wanders_is_not_drawn() -> None:
    quiet = draw("<mujoco><worldbody><geom type='box' size='1 1 1'/></worldbody></mujoco>")
    walker = draw(
        "<mujoco><worldbody><geom type='box' size='1 1 1'/>"
        "<body mocap='true' pos='3 0 1'><geom type='sphere' size='.2'/></body></worldbody></mujoco>"
    )
    assert quiet.flat is not None and walker.flat is not None
    assert len(quiet.flat.faces) == len(walker.flat.faces)


def test_no_model_says_so() -> None:
    with pytest.raises(ValueError):
        draw("<mujoco><worldbody><geom type='nonsense'/></worldbody></mujoco>")


@pytest.mark.parametrize("kind", ["mug", "apple", "block", "something new"])
def test_unknown_objects_have_their_size_and_colour(kind: str) -> None:
    mesh: Mesh = fallback(kind, (0.08, 0.08, 0.1), "red")
    extent = mesh.vertices.max(axis=0) - mesh.vertices.min(axis=0)
    assert extent == pytest.approx([0.08, 0.08, 0.1], rel=0.05)
    assert tuple(mesh.colours[0]) == COLOURS["red"]
    assert mesh.faces.max() < len(mesh.vertices)
