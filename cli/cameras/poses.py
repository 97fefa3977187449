"""Arm poses for calibration: informative for the cameras' mounts, with a free way there. Pure."""

from collections.abc import Callable

import numpy as np
from scipy import ndimage

from cli.cameras.mounts import LEAST, Unseen
from cli.cameras.shot import STEP
from cli.cameras.surfaces import Arm, SeenRoom
from common.geometry import Array, quat_matrix
from common.messages import Rgbd
from common.robot.pictures import depths, rays

LOWEST, WITHIN = 0.36, 0.85
"""Height [m] above which the arm stays while it is looked at, just above the deck, and how far [m] from the base's
middle; what stands nearer than that is in its way."""
SPREAD, TRIES = 0.8, 3000
"""Largest change of each joint from the carry pose [rad], and how many poses are drawn."""
REACHED = 0.3
"""What a turn of the hand by 1 rad counts beside a shift [m] when poses are to differ."""
COARSE, OVERLAP = 80, 0.3
"""Every which row and column of a picture stands for it, the share of these rays that must meet what the other camera
saw."""
FREE = 0.15
"""By how much [m] what the camera sees must be farther along a ray than the arm's front: the arm is 0.1 m thick."""
AROUND = 5
"""Side [px of those cast] by which the arm's silhouette is widened where it hides what is behind it."""


class FreeSpace:
    """What a camera saw with the arm in its carry pose: the arm may move in front of it, and nowhere else."""

    def __init__(self, arm: Arm, image: Rgbd) -> None:
        ahead, depth = rays(image, STEP), depths(image)[::STEP, ::STEP]
        directions = ahead.reshape(-1, 3) @ quat_matrix(image.orientation).T
        lengths = np.linalg.norm(directions, axis=1)
        self._arm, self._origin, self._directions = arm, np.array(image.position), directions / lengths[:, None]
        arm.pose(arm.home, arm.open)
        hidden = ndimage.binary_dilation(self.cast().reshape(depth.shape) > 0.0, np.ones((AROUND, AROUND))).ravel()
        # Where the arm was nobody knows what is behind it; where nothing was measured nothing is near.
        self._limit = np.where(hidden | (depth.ravel() == 0.0), np.inf, depth.ravel() * lengths - FREE)

    def cast(self) -> Array:
        """Distance (n,) [m] of the arm along the picture's rays, -1 where it is not."""
        return self._arm.cast(self._origin, self._directions)[0]

    def holds(self, least: int = 0) -> bool:
        """The arm as it is posed is in front of everything, and at least so many rays meet it."""
        distances = self.cast()
        return bool((distances < self._limit).all()) and int((distances > 0.0).sum()) >= least


def poses(arm: Arm, image: Rgbd, count: int) -> list[Array]:
    """Joint angles (7,) [rad] in which a camera sees the arm in different ways, in straight reach of the carry pose.

    `image`: that camera's picture of the carry pose. The arm stays above `LOWEST`, within `WITHIN` of the base's middle
    and in front of what the picture shows.

    Raises:
        Unseen: hardly any pose is in view.
    """
    space = FreeSpace(arm, image)
    return _choose(arm, space, lambda: space.holds(3 * LEAST), count)


def _choose(arm: Arm, space: FreeSpace, useful: Callable[[], bool], count: int) -> list[Array]:
    """Choose, of random poses near the carry pose that are `useful` and safe, those that differ most."""
    rng = np.random.default_rng(0)
    found: list[Array] = []
    features: list[Array] = []
    for _ in range(TRIES):
        joints = np.clip(arm.home + rng.uniform(-SPREAD, SPREAD, len(arm.home)), arm.lowest, arm.highest)
        arm.pose(joints, arm.open)
        low, far = arm.reach()
        if low < LOWEST or far > WITHIN or arm.collides() or not useful():
            continue
        site = arm.data.site("pinch")
        feature = np.concatenate([site.xpos, REACHED * site.xmat[[2, 5, 8]]])
        if not all(_free(arm, space, arm.home + share * (joints - arm.home)) for share in np.linspace(0.1, 1.0, 10)):
            continue
        found.append(joints)
        features.append(feature)
        if len(found) >= 6 * count:
            break
    if len(found) < count:
        raise Unseen(f"of {TRIES} arm poses {len(found)} serve, {count} are needed")
    chosen = [0]
    while len(chosen) < count:
        apart = [min(float(np.linalg.norm(f - features[c])) for c in chosen) for f in features]
        chosen.append(int(np.argmax(apart)))
    return [found[c] for c in chosen]


def _free(arm: Arm, space: FreeSpace, joints: Array) -> bool:
    arm.pose(joints, arm.open)
    return arm.reach()[0] >= LOWEST and not arm.collides() and space.holds()


def overlooks(arm: Arm, before: Rgbd, image: Rgbd, room: SeenRoom, count: int) -> list[Array]:
    """Joint angles (7,) [rad] in which the camera on the hand looks from different sides at what `room` shows.

    `image`: its picture from the carry pose, `before`: the other camera's. The arm keeps the limits of `poses`.

    Raises:
        Unseen: hardly any pose looks there.
    """
    space = FreeSpace(arm, before)
    arm.pose(arm.home, arm.open)
    hand = arm.data.site("pinch")
    turn = hand.xmat.reshape(3, 3).T
    position, rotation = turn @ (np.array(image.position) - hand.xpos), turn @ quat_matrix(image.orientation)
    ahead = rays(image, COARSE).reshape(-1, 3)

    def looks() -> bool:
        site = arm.data.site("pinch")
        frame = site.xmat.reshape(3, 3)
        return room.share(site.xpos + frame @ position, ahead @ (frame @ rotation).T) > OVERLAP

    return _choose(arm, space, looks, count)
