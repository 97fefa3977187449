"""The robot notices a camera that does not sit where it is believed to, and leaves one in peace that does."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from services.perception.calibration_monitor import LOOKS, CalibrationMonitor, floor_error
from services.perception.detection import Detection
from services.perception.views.view import View

POSITION = np.array([1.0, 2.0, 1.3])
SIZE, FOCAL = (240, 320), 260.0


def mount(yaw: float) -> np.ndarray:
    """The optical frame in map of a camera that looks 35 degrees down, on a base turned by `yaw`."""
    optical = np.array([[0.0, 0.0, 1.0], [-1.0, 0.0, 0.0], [0.0, -1.0, 0.0]])
    found: np.ndarray = (Rotation.from_euler("ZY", [yaw, np.radians(35)])).as_matrix() @ optical
    return found


def view(
    turn: tuple[float, float, float] = (0, 0, 0),
    lift: float = 0.0,
    yaw: float = 0.0,
    things: bool = False,
    calibrated: bool = False,
) -> View:
    """The floor as a camera sees it that is turned [deg, optical frame] and lifted [m] from where it is believed."""
    believed = mount(yaw)
    true = believed @ Rotation.from_rotvec(turn, degrees=True).as_matrix()
    v, u = np.mgrid[: SIZE[0], : SIZE[1]]
    rays = np.stack([(u + 0.5 - SIZE[1] / 2) / FOCAL, (v + 0.5 - SIZE[0] / 2) / FOCAL, np.ones(SIZE)], -1) @ true.T
    depth = np.where(rays[..., 2] < -0.05, -(POSITION[2] + lift) / np.minimum(rays[..., 2], -0.05), 0.0)
    rng = np.random.default_rng(3)
    depth = depth + rng.normal(0.0, 0.0015, SIZE) * depth**2
    if things:
        depth[100:180, 60:140] *= 0.97
    return View(
        np.zeros((*SIZE, 3), np.uint8), depth.astype(np.float32), (FOCAL, FOCAL), (SIZE[1] / 2, SIZE[0] / 2), POSITION,
        believed, calibrated=calibrated,
    )  # fmt: skip


@pytest.mark.parametrize("yaw", [0.0, 2.0])
def test_a_tilted_camera_sees_a_tilted_floor_along_the_robots_own_axes(yaw: float) -> None:
    assert floor_error(view(yaw=yaw), yaw) == pytest.approx(np.zeros(3), abs=2e-3)
    pitched = floor_error(view((1.0, 0.0, 0.0), yaw=yaw), yaw)
    assert pitched is not None and abs(pitched[0]) == pytest.approx(np.radians(1.0), rel=0.15)
    assert pitched[1] == pytest.approx(0.0, abs=2e-3)
    raised = floor_error(view(lift=0.03, yaw=yaw), yaw)
    assert raised is not None and raised == pytest.approx([0.0, 0.0, -0.03], abs=4e-3)


def mug(position: tuple[float, float, float], label: str = "mug", whole: bool = True) -> Detection:
    return Detection(
        label=label, kind="mug", colour="red", position=position, yaw=0.0, size=(0.07, 0.07, 0.09), confidence=0.9,
        on="", distance=1.0, whole=whole,
    )  # fmt: skip


HERE = (0.0, 0.0, 0.0)


def test_without_floor_in_view_nothing_is_measured() -> None:
    nothing = view()
    nothing.depth[:] = 0.0
    assert floor_error(nothing, 0.0) is None


@pytest.mark.parametrize(
    ("turn", "lift", "calibrated", "wrong"),
    [
        ((0, 0, 0), 0.0, True, False),
        ((0.25, 0.2, -0.2), 0.002, False, False),
        ((0.4, 0.0, 0.0), 0.0, True, True),
        ((0.4, 0.0, 0.0), 0.0, False, False),
        ((1.0, 0.0, 0.0), 0.0, False, True),
        ((0.0, 0.0, 0.0), 0.03, False, True),
    ],
)
def test_a_camera_is_judged_by_what_is_known_of_it(
    turn: tuple[float, float, float], lift: float, calibrated: bool, wrong: bool
) -> None:
    monitor = CalibrationMonitor()
    for n in range(LOOKS):
        assert not monitor.contradictions, "not on one picture"
        monitor.look(view(turn, lift, things=n % 3 == 0, calibrated=calibrated), HERE)
    assert ("head" in monitor.contradictions) is wrong
    for _ in range(LOOKS):
        monitor.look(view(calibrated=calibrated), HERE)
    assert not monitor.contradictions, "and it is over when it is mended"


@pytest.mark.parametrize(
    ("aside", "calibrated", "wrong"), [(0.03, False, True), (0.012, False, False), (0.012, True, True)]
)
def test_the_wrist_camera_is_held_against_the_head(aside: float, calibrated: bool, wrong: bool) -> None:
    monitor, rng, said = CalibrationMonitor(), np.random.default_rng(1), []
    nothing = view(calibrated=calibrated)
    nothing.depth[:] = 0.0
    wrist = replace(nothing, camera="wrist")
    for _ in range(LOOKS + 3):
        x, y, z = rng.normal(0.0, 1.0, 3)
        monitor.see(nothing, [mug((x, y, z)), mug((x, y, z), ""), mug((x, y, z), "half a can", whole=False)], HERE)
        seen = [
            mug((x, y + aside + rng.normal(0.0, 0.003), z)),
            mug((x, y + 0.05, z), "half a can"),
            mug((x, y + 0.05, z), ""),
        ]
        said += monitor.see(wrist, seen, HERE)
        said += monitor.see(wrist, [mug((x, y + 1.0, z))], HERE)
    assert said == (["wrist"] if wrong else []), "and it is said once"
