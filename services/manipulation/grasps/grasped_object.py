"""The object attached to the hand, with the pose in which it was grasped."""

from dataclasses import dataclass, field

import numpy as np

from common.geometry import Array, quantile, yaw_matrix
from common.kinds import kind_of
from services.manipulation.grasps.grasp import Grasp
from services.manipulation.grasps.target import Target

SHRINK = 0.008
"""How much smaller [m] than the object its collision box is on every side. Chosen: the errors of size and grasp, so
that the box is clear of the surface that the object stands on."""
LEAST_HALF = 0.004
"""Least half extent [m] of that box. Chosen: half of the thinnest object that is carried."""
PLAY = 0.008
"""How much farther [m] than the object is wide the fingers open where one of them may be in its handle or below it: a
mug that lies is taken through it, and 22 mm of room leave 8 beside a finger."""
ABOVE_EACH_OTHER = 0.7
"""Vertical part of the closing direction, as a share, from which one finger is below what they hold. Chosen: between
the steepest hold of a plate's rim and the flattest of a bowl's."""
PART = 0.6
"""Share of the least extent of something below which what is between the pads is a part of it. Chosen: a chord of what
is round is wider, its handle or wall is not."""
LEVEL = 0.35
"""Vertical part of the approach, as a share, up to which the hand is level. Chosen: at 20 degrees the knuckles of a
2F-85, 60 mm below its axis and 70 behind the pads, are as low as its lower finger."""
SEEN = 0.98
"""Share of the points seen of something that are no mixed pixels at its edge."""
USUAL_SIZE = (0.06, 0.06, 0.10)
"""Full extents [m] of an object in the hand that nobody described. Chosen: near those of a mug."""


@dataclass(frozen=True)
class GraspedObject:
    """An object in the gripper: `size` its full extents, `width` between the pads [m].

    `rotation` (3, 3) of the hand and `offset` (3,) [m] of the pinch point are relative to the centre of the object's
    underside, in a frame with upright z in which the object is turned by `yaw` [rad].

    `part`: only a part of it is between the pads, and a finger may be within what else it has. `guessed`: how it is
    turned in the hand is not known.

    What lay or stood on its head is described as if it had stood, so that it is put down upright; `as_found` is for
    where that cannot be.
    """

    label: str
    kind: str
    rotation: Array
    offset: Array
    size: tuple[float, float, float]
    width: float
    yaw: float
    as_found: "GraspedObject | None" = None
    part: bool = False
    guessed: bool = False
    points: Array | None = field(default=None, compare=False, repr=False)

    @property
    def from_below(self) -> bool:
        """One finger is below it, and has to come out from under it once it is put down."""
        return abs(float(self.rotation[2, 1])) > ABOVE_EACH_OTHER

    @property
    def level(self) -> bool:
        """One finger is below it, and the hand points level: its knuckles reach farther down than that finger."""
        return self.from_below and abs(float(self.rotation[2, 2])) < LEVEL

    @property
    def at_rim(self) -> bool:
        """Only a side of it is between the pads."""
        return self.width < min(self.size) / 2

    @property
    def entangled(self) -> bool:
        """A finger may be in its handle, or is below it: moved other than straight back the hand takes it along."""
        return self.part or self.from_below or (self.as_found is not None and kind_of(self.kind).handle > 0)

    @property
    def opening(self) -> float | None:
        """How far apart [m] the fingers go to let go of it; None: as far as they do.

        A finger that is in a handle has to come out of it, and not to spread it; one that is below has no more room.
        """
        return self.width + PLAY if self.entangled else None

    def reaches(self, turn: Array) -> float:
        """How far [m] down from its middle it reaches, turned by `turn` (3, 3): as far as up, by what was seen of it,
        or else by its extents."""
        half = float(np.abs((turn @ yaw_matrix(self.yaw))[2]) @ self.size) / 2
        if self.points is None:
            return half
        return min(half, quantile(np.abs(self.points @ turn[2]), SEEN))

    def box(self, lower: float = 0.0) -> tuple[Array, Array, Array]:
        """Half extents (3,) [m] of the object's collision box along its own axes, or the hand's where those are only
        guessed, its centre (3,) and rotation (3, 3) in the frame of the pinch point; `lower`: how much farther down it
        reaches than believed [m]."""
        center = self.rotation.T @ (np.array([0, 0, (self.size[2] - lower) / 2]) - self.offset)
        half, turned = np.array([*self.size[:2], self.size[2] + lower]) / 2, self.rotation.T @ yaw_matrix(self.yaw)
        if self.guessed:
            half, turned = np.abs(turned) @ half, np.eye(3)
        return np.maximum(half - SHRINK, LEAST_HALF), center, turned


def lying_rotation(axis: float) -> Array:
    """Rotation (3, 3) from an upright object to one that lies with its upper end towards `axis` [rad]."""
    c, s = np.cos(axis), np.sin(axis)
    return np.array([[0.0, -s, c], [0.0, c, s], [-1.0, 0.0, 0.0]])


def turned_over(approach: Array) -> Array:
    """Rotation (3, 3) by half a turn about the level part of an approach (3,)."""
    level = np.array([approach[0], approach[1], 0.0])
    level /= np.linalg.norm(level)
    found: Array = 2.0 * np.outer(level, level) - np.eye(3)
    return found


def attach(target: Target, grasp: Grasp) -> GraspedObject:
    """The object as it is attached to the hand once a grasp has closed."""
    hand, (x, y, z) = grasp.pose, target.position
    label, kind, width = target.label, target.kind, grasp.width
    offset = hand.position - np.array([x, y, target.bottom])
    part = grasp.on_surface and width < PART * min(target.size)
    as_found = GraspedObject(
        label, kind, hand.rotation, offset, target.size, width, target.yaw, part=part, points=target.points
    )
    if grasp.turns_over:
        turn = turned_over(hand.rotation[:, 2])
        offset = turn @ (hand.position - np.array([x, y, target.bottom + target.size[2]]))
        yaw = 2 * float(np.arctan2(hand.rotation[1, 2], hand.rotation[0, 2])) - target.yaw
        return GraspedObject(label, kind, turn @ hand.rotation, offset, target.size, width, yaw, as_found, part)
    if grasp.axis is None:
        return as_found
    turn = lying_rotation(grasp.axis)
    length, across, up = target.size
    foot = np.array([x - length / 2 * np.cos(grasp.axis), y - length / 2 * np.sin(grasp.axis), z])
    offset = turn.T @ (hand.position - foot)
    return GraspedObject(label, kind, turn.T @ hand.rotation, offset, (up, across, length), width, 0.0, as_found, part)
