"""Does what the cameras see contradict where they are believed to sit? Watched while the robot works."""

import math
from collections import deque

import numpy as np

from common.floor_plan import Vec3
from common.geometry import Array, Pose2
from services.perception.detection import Detection
from services.perception.views.view import View

LOOKS = 12
"""Looks whose median counts [count]; chosen: what stands on the floor, or a person's foot, spoils some of them."""
DRAWN, MEASURED = (0.6, 0.020), (0.2, 0.008)
"""Tilt [deg] and distance [m] that contradict a camera's drawing and a calibration. A bracket may be off by .3 degrees
and 3 mm along each axis, what `tidybot calibrate` finds is ten times as true; the floor is measured to .05 degrees."""
SAME = 0.08
"""Distance [m] beyond which two sightings are of two objects that are called alike; chosen: a mug's width."""
STEP = 16
"""Every which row and column of a picture is taken."""
RANGE, NEAR_FLOOR, FLAT = 2.5, 0.06, 0.02
"""Depth up to which the floor is measured, height up to which a point may belong to it, and distance from the plane
up to which it does [m]."""
ENOUGH, SPREAD = 120, 0.15
"""Points [count] and their standard deviation along and across [m] from which a plane is fitted."""


class CalibrationMonitor:
    """`contradictions` says for each camera what is wrong with it; nothing while all is well."""

    def __init__(self) -> None:
        self._floor: deque[Array] = deque(maxlen=LOOKS)
        self._aside: deque[Array] = deque(maxlen=LOOKS)
        self._from_head: dict[str, Vec3] = {}
        self.contradictions: dict[str, str] = {}

    def see(self, view: View, detections: list[Detection], base: Pose2) -> dict[str, str]:
        """Take a picture and what was found in it, seen from `base`; what has begun to contradict, by camera."""
        before = set(self.contradictions)
        if view.camera == "head":
            self.look(view, base)
            self._from_head |= {d.label: d.position for d in detections if d.label and d.whole}
        else:
            for d in detections:
                self.compare(d.label, d.position, view.calibrated)
        return {c: f"{why}; `tidybot calibrate`" for c, why in self.contradictions.items() if c not in before}

    def look(self, view: View, base: Pose2) -> None:
        """Take a picture of the head camera, seen from `base`: is the floor where it should be?"""
        found = floor_error(view, base[2])
        if found is None:
            return
        self._floor.append(found)
        if len(self._floor) == LOOKS:
            forward, left, height = np.median(self._floor, axis=0)
            tilt = float(np.degrees(np.hypot(forward, left)))
            most, farthest = MEASURED if view.calibrated else DRAWN
            wrong = tilt > most or abs(height) > farthest
            what = f"the floor looks tilted by {tilt:.1f} degrees and {1000 * height:+.0f} mm high"
            self._report("head", what if wrong else "")

    def compare(self, label: str, position: Vec3, calibrated: bool) -> None:
        """Take where the wrist camera sees an object; its first look after one of the head camera counts."""
        from_head = self._from_head.pop(label, None)
        if from_head is None or math.dist(position, from_head) > SAME:
            return
        self._aside.append(np.subtract(position, from_head))
        if len(self._aside) == LOOKS:
            distance = float(np.linalg.norm(np.median(self._aside, axis=0)))
            limit = MEASURED[1] if calibrated else DRAWN[1]
            what = f"it sees objects {1000 * distance:.0f} mm from where the head camera does"
            self._report("wrist", what if distance > limit else "")

    def _report(self, camera: str, what: str) -> None:
        if what:
            self.contradictions[camera] = what
        else:
            self.contradictions.pop(camera, None)


def floor_error(view: View, yaw: float) -> Array | None:
    """Slopes along the robot's x and y [rad] and height under the camera [m] of the floor as it is seen (3,).

    All are 0 for a camera that sits where it is believed to; None where too little of the floor is in view.
    """
    points = view.points[::STEP, ::STEP].reshape(-1, 3).astype(np.float64)
    depth = view.depth[::STEP, ::STEP].ravel()
    points = points[(depth > 0.0) & (depth < RANGE) & (np.abs(points[:, 2]) < NEAR_FLOOR)]
    c, s = np.cos(yaw), np.sin(yaw)
    local = (points[:, :2] - view.position[:2]) @ np.array([[c, -s], [s, c]])
    rows = np.column_stack([local, np.ones(len(local))])
    on_it = np.ones(len(rows), bool)
    plane = np.zeros(3)
    for _ in range(3):
        if on_it.sum() < ENOUGH or (local[on_it].std(axis=0) < SPREAD).any():
            return None
        plane = np.linalg.lstsq(rows[on_it], points[on_it, 2], rcond=None)[0]
        on_it = np.abs(points[:, 2] - rows @ plane) < FLAT
    return np.asarray(plane)
