"""`tidybot calibrate`: mounts from pictures of the arm, and the file they are kept in."""

from pathlib import Path

import numpy as np
import pytest

from cli.cameras.mounts import Unseen, fit
from cli.cameras.poses import LOWEST, WITHIN, FreeSpace, overlooks, poses
from cli.cameras.shot import Mount, Shot
from cli.cameras.surfaces import Arm, SeenRoom
from common.geometry import Array, matrix_quat
from common.messages import Rgbd
from common.rendering.renderer import Renderer
from common.robot import calibration
from common.scene import load_scene
from services.camera.sensor import StereoCamera
from services.sim.physics import Physics

WIDTH, HEIGHT = 640, 480
COUNT = 6
AS_DRAWN = Mount(np.zeros(3), np.zeros(3), np.zeros(3), np.zeros(3), 0.0, COUNT)


class Studio:
    """The robot at home, its arm posed by hand and its cameras displaced."""

    def __init__(self) -> None:
        physics = Physics(load_scene("apartment"), 0)
        self.renderer, self.arm = Renderer(physics.mjcf, "auto"), Arm(physics.robot.mjcf)
        self.sensors = {"head": StereoCamera(4), "wrist": StereoCamera(5)}

    def shot(self, camera: str, joints: Array, moment: int = 0, moved: bool = True) -> Shot:
        model, data = self.renderer.model, self.renderer.data
        for i, angle in enumerate(joints, 1):
            data.qpos[model.joint(f"joint_{i}").qposadr[0]] = angle
        self.renderer.load(data.qpos.tobytes(), b"")
        position, rotation = self.renderer.optical_pose(camera)
        sensor = self.sensors[camera]
        if moved:
            self.renderer.move(camera, sensor.offset, sensor.turn)
        focal = self.renderer.focal(camera, HEIGHT)
        taken = sensor.expose(*self.renderer.rgbd(camera, WIDTH, HEIGHT), focal, moment)
        image = Rgbd(
            t=0.0, id="", camera=camera, width=WIDTH, height=HEIGHT, fx=focal, fy=focal, cx=WIDTH / 2, cy=HEIGHT / 2,
            position=(position[0], position[1], position[2]), orientation=matrix_quat(rotation),
            rgb=taken.rgb.tobytes(), depth=taken.depth.astype("<u2").tobytes(),
        )  # fmt: skip
        return Shot(image, joints, self.arm.open)


@pytest.fixture(scope="module")
def studio() -> Studio:
    return Studio()


@pytest.fixture(scope="module")
def views(studio: Studio) -> list[Array]:
    return poses(studio.arm, studio.shot("head", studio.arm.home).image, COUNT)


def off(mount: Mount, sensor: StereoCamera) -> tuple[float, float]:
    """Errors of a mount [mm, deg]."""
    offset, turn = mount.offset - sensor.offset, np.degrees(mount.turn - sensor.turn)
    return 1000 * float(np.linalg.norm(offset)), float(np.linalg.norm(turn))


@pytest.mark.slow
def test_both_mounts_are_found_to_a_millimetre(studio: Studio, views: list[Array]) -> None:
    arm = studio.arm
    shots = [studio.shot("head", joints, n) for n, joints in enumerate(views)]
    head = fit(arm, shots)
    by, about = off(head, studio.sensors["head"])
    assert by < 0.3 and about < 0.03
    assert head.pictures == COUNT and head.offset_deviation.max() < 0.0003
    room = SeenRoom([shot.image for shot in shots], head)
    first = studio.shot("head", arm.home).image
    looks = overlooks(arm, first, studio.shot("wrist", arm.home).image, room, COUNT)
    wrist = fit(room, [studio.shot("wrist", joints, n) for n, joints in enumerate(looks)])
    by, about = off(wrist, studio.sensors["wrist"])
    assert by < 1.0 and about < 0.12


def test_a_camera_that_sits_as_drawn_is_found_there(studio: Studio, views: list[Array]) -> None:
    mount = fit(studio.arm, [studio.shot("head", joints, n, moved=False) for n, joints in enumerate(views)])
    assert mount.as_drawn() and AS_DRAWN.as_drawn()
    assert not Mount(np.array([0.003, 0.0, 0.0]), *[np.zeros(3)] * 3, 0.0, COUNT).as_drawn()


def test_the_arm_keeps_clear_of_the_base_itself_and_what_is_seen(studio: Studio, views: list[Array]) -> None:
    space = FreeSpace(studio.arm, studio.shot("head", studio.arm.home).image)
    for joints in views:
        studio.arm.pose(joints, studio.arm.open)
        low, far = studio.arm.reach()
        assert low >= LOWEST and far <= WITHIN and space.holds() and not studio.arm.collides()
    apart = [np.abs(a - b).max() for i, a in enumerate(views) for b in views[:i]]
    assert min(apart) > 0.1


@pytest.mark.slow
def test_pictures_that_do_not_show_the_arm_say_so(studio: Studio, views: list[Array]) -> None:
    blind = [studio.shot("wrist", joints) for joints in views]
    with pytest.raises(Unseen, match="0 of 6 pictures"):
        fit(studio.arm, blind)


MOUNT = ((0.001, -0.002, 0.003), (0.1, 0.2, -0.3))


def test_a_file_is_read_as_it_was_written(tmp_path: Path) -> None:
    path = tmp_path / "c.toml"
    path.write_text(calibration.text({"head": MOUNT}, {"head": "sure"}))
    assert calibration.read(path) == {"head": MOUNT}


@pytest.mark.parametrize(
    ("text", "why"),
    [
        ("[head", "Expected ']'"),
        ("[hat]\noffset=[0,0,0]\nturn=[0,0,0]", "no camera is called 'hat'"),
        ("[head]\noffset=[0,0]\nturn=[0,0,0]", "head.offset must be three numbers"),
        ("[head]\noffset=[0,0,1]\nturn=[0,0,0]", "from -0.05 to 0.05"),
        ("[head]\noffset=[0,0,0]\nturn=[0,nan,0]", "head.turn must be three numbers"),
        ("head = 1", "head.offset must be"),
    ],
)
def test_a_bad_file_is_refused_with_the_reason(tmp_path: Path, text: str, why: str) -> None:
    path = tmp_path / "c.toml"
    path.write_text(text)
    with pytest.raises(calibration.CalibrationError, match=why):
        calibration.read(path)


def test_a_missing_file_is_refused_with_the_command_that_makes_it(tmp_path: Path) -> None:
    with pytest.raises(calibration.CalibrationError, match="tidybot calibrate --out"):
        calibration.read(tmp_path / "c.toml")
