"""Measurement of the cameras' mounts on a running robot: moves the arm from pose to pose and takes pictures."""

from collections.abc import Iterator, Sequence
from pathlib import Path

import numpy as np

from cli.cameras.mounts import Unseen, fit
from cli.cameras.poses import overlooks, poses
from cli.cameras.shot import Mount, Shot
from cli.cameras.surfaces import Arm, SeenRoom
from cli.drivers.driver import PERIOD, Driver, Unmet
from cli.errors import CliError
from cli.link import Link
from common import messages as m
from common import topics
from common.files.atomic_file import replace
from common.geometry import Array
from common.robot import calibration
from common.robot.joints import ARM

SPEED = 0.6
"""Of the fastest joint [rad/s]; chosen: slow enough to be watched."""
REST, PATIENCE = 0.6, 15.0
"""Seconds of the robot for the arm to come to rest before a picture, and of the clock that are waited for one."""
AT_HOME = 0.15
"""Largest deviation of a joint from the carry pose [rad] at the start."""
WIDTH, HEIGHT = 640, 480
"""Size of the pictures [px]: those that perception works with."""


class Photographer:
    """Moves the arm and takes pictures."""

    def __init__(self, driver: Driver, arm: Arm) -> None:
        self._driver, self._arm = driver, arm

    def shot(self, camera: m.CameraName) -> Shot:
        """Take a picture with the arm at rest.

        Raises:
            CliError: none comes.
        """
        image = self._driver.link.picture(camera, WIDTH, HEIGHT, PATIENCE)
        return Shot(image, self.angles(), self._driver.joints()["gripper"])

    def angles(self) -> Array:
        joints = self._driver.joints()
        return np.array([joints[name] for name in ARM])

    def visit(self, goals: Sequence[Array]) -> Iterator[Array]:
        """Move the arm to each of `goals` (7,) [rad] in turn, from the carry pose and back to it; yields at each."""
        for goal in goals:
            self.move(goal)
            yield goal
            self.move(self._arm.home)

    def move(self, goal: Array) -> None:
        """Move the arm on a straight line in joint space, gently at both ends.

        Raises:
            CliError: the arm does not follow.
        """
        driver, start = self._driver, self.angles()
        begin, seconds = driver.t, max(float(np.abs(goal - start).max()) / SPEED * 1.5, 0.5)

        def along() -> None:
            share = float(np.clip((driver.t - begin + PERIOD) / seconds, 0.0, 1.0))
            position = start + share * share * (3 - 2 * share) * (goal - start)
            driver.link.send(topics.ARM_COMMAND, m.ArmCommand(position=position.tolist(), period=PERIOD, t=driver.t))

        driver.wait(seconds + 0.2, each=along)
        driver.wait(REST)
        off = np.abs(self.angles() - goal)
        if float(off.max()) > AT_HOME:
            raise CliError(
                f"{ARM[int(off.argmax())]} stays {off.max():.2f} rad from where it is told to go; "
                "is something in the arm's way, or the robot stopped?"
            )


def run(link: Link, out: Path, count: int) -> int:
    """Measure the mounts and write the file; returns the exit status.

    Raises:
        CliError: the robot does not do its part, or too little is to be seen.
    """
    described = link.latest(topics.ROBOT_DESCRIPTION)
    if described is None:
        raise CliError("the simulation does not describe the robot; see `tidybot ps`")
    driver, arm = Driver(link), Arm(described.mjcf)
    try:
        mounts, in_use = _measure(Photographer(driver, arm), driver, arm, count)
    except (Unmet, Unseen) as error:
        raise CliError(str(error)) from None
    if in_use:
        return _check(mounts)
    found = {name: (_vector(mount.offset), _vector(np.degrees(mount.turn))) for name, mount in mounts.items()}
    content = calibration.text(found, {name: _sure(mount) for name, mount in mounts.items()})
    if why := replace(out, content.encode()):
        raise CliError(f"{out}: {why}")
    for name, mount in mounts.items():
        print(f"{name:6} {_sure(mount)}")
    print(f"written to {out}; `tidybot up --set camera.calibration={out.resolve()}` uses it")
    return 0


def _check(mounts: dict[str, Mount]) -> int:
    """Exit status 1 when what was seen contradicts the calibration in use."""
    wrong = [name for name, mount in mounts.items() if not mount.as_drawn()]
    for name, mount in mounts.items():
        print(f"{name:6} {_sure(mount, 'calibration')}")
    if not wrong:
        print("the calibration in use is right; nothing is written")
        return 0
    print(f"the calibration in use is wrong for {' and '.join(wrong)}: start without it to measure anew")
    return 1


def _measure(photographer: Photographer, driver: Driver, arm: Arm, count: int) -> tuple[dict[str, Mount], bool]:
    """The cameras' mounts, and whether a calibration is in use, which they then are relative to."""
    driver.wait(0.5)
    if float(np.abs(photographer.angles() - arm.home).max()) > AT_HOME:
        raise CliError("the arm is not in its carry pose; restart the robot, or let it finish what it does")
    first = {camera: photographer.shot(camera).image for camera in topics.PICTURES}
    print(f"choosing {count} poses of the arm", flush=True)
    shots = []
    for number, _ in enumerate(photographer.visit(poses(arm, first["head"], count)), 1):
        shots.append(photographer.shot("head"))
        print(f"head: picture {number} of {count}", flush=True)
    mounts = {"head": fit(arm, shots)}
    room = SeenRoom([shot.image for shot in shots], mounts["head"])
    shots = []
    for number, _ in enumerate(photographer.visit(overlooks(arm, first["head"], first["wrist"], room, count)), 1):
        shots.append(photographer.shot("wrist"))
        print(f"wrist: picture {number} of {count}", flush=True)
    mounts["wrist"] = fit(room, shots)
    return mounts, first["head"].calibrated or first["wrist"].calibrated


def _vector(values: Array) -> calibration.Vector:
    return float(values[0]), float(values[1]), float(values[2])


def _sure(mount: Mount, believed: str = "drawing") -> str:
    """How far a camera sits off where it is `believed` to be, and the 95 % limits, in words."""
    off, turned = 1000 * float(np.linalg.norm(mount.offset)), np.degrees(float(np.linalg.norm(mount.turn)))
    by, about = (
        1960 * float(np.linalg.norm(mount.offset_deviation)),
        1.96 * np.degrees(float(np.linalg.norm(mount.turn_deviation))),
    )
    return (
        f"{off:.1f} mm (+- {by:.1f}) and {turned:.2f} deg (+- {about:.2f}) off its {believed}, "
        f"from {mount.pictures} pictures, residual {1000 * mount.residual:.1f} mm"
    )
