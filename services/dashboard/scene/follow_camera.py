"""Every visitor's camera: opens on the robot with its room filling the view, and moves along with the robot."""

from math import cos, hypot, radians, sin, tan
from typing import Any

import numpy as np
import viser

from common.floor_plan import FloorPlan
from common.geometry import Array, Pose2

AZIMUTH, ELEVATION = 225.0, 48.0
"""Where the camera looks from [deg]: from the south-west as plans are drawn, above the walls' upper edges."""
HEIGHT = 0.4
"""Of the point looked at [m]: the middle of the robot."""
SPAN = 5.0
"""Width [m] of a room where the floor plan names none; chosen: a living room's."""
FILLED = 0.95
"""Share of the view's narrower side that the room's width takes up at the point looked at; chosen: only the near
corners of the floor are cut off."""
TOWARDS_MIDDLE = 0.4
"""How far the point looked at is from the robot towards the middle of its room; chosen: both are well in the view."""
FIELD = 75.0
"""Vertical field of view [deg] of a visitor whose browser has not said; viser's default."""
MOVED = 0.01
"""The camera follows in steps of so much [m]; chosen: smaller than a pixel at these distances."""
AWAY = 0.5
"""Distance [m] of the robot from where "reset view" leads, after which it leads there anew."""


def opening_view(
    base: Pose2, floor_plan: FloorPlan, fov: float = radians(FIELD), aspect: float = 1.0
) -> tuple[Array, Array]:
    """Position (3,) and point looked at (3,) [m], frame map, for a robot at `base`.

    `fov`: vertical field of view [rad], `aspect`: width by height of the view.
    """
    x, y, _ = base
    room = floor_plan.room_at(x, y)
    span, middle = SPAN, (x, y)
    if room is not None:
        span, middle = max(room.outline.length, room.outline.width), room.middle
    target = np.array([x + TOWARDS_MIDDLE * (middle[0] - x), y + TOWARDS_MIDDLE * (middle[1] - y), HEIGHT])
    distance = FILLED * span / (2 * tan(fov / 2) * min(1.0, max(aspect, 0.3)))
    a, e = radians(AZIMUTH), radians(ELEVATION)
    return target + distance * np.array([cos(e) * cos(a), cos(e) * sin(a), sin(e)]), target


class FollowCamera:
    """Moves the cameras of a viser server's visitors; every call is from the service's thread."""

    def __init__(self, server: viser.ViserServer, floor_plan: FloorPlan) -> None:
        self._server, self._floor_plan = server, floor_plan
        self._followed: dict[int, Pose2] = {}
        self._reset: Pose2 | None = None

    def step(self, base: Pose2, follow: bool) -> None:
        """Open the view of new visitors at `base`; if `follow`, move the others by as much as the robot moved."""
        clients = self._server.get_clients()
        self._lead_back(base)
        for number, client in clients.items():
            if not client.camera.update_timestamp:
                continue
            before = self._followed.get(number)
            if before is None:
                self._open(client, base)
                self._followed[number] = base
            elif hypot(base[0] - before[0], base[1] - before[1]) > MOVED:
                if follow:
                    step = np.array([base[0] - before[0], base[1] - before[1], 0.0])
                    # viser moves the point looked at along with the position.
                    client.camera.position = client.camera.position + step
                self._followed[number] = base
        for number in self._followed.keys() - clients.keys():
            del self._followed[number]

    def _open(self, client: Any, base: Pose2) -> None:
        camera = client.camera
        position, target = opening_view(base, self._floor_plan, float(camera.fov), float(camera.aspect))
        with client.atomic():
            camera.position = position
            camera.look_at = target

    def _lead_back(self, base: Pose2) -> None:
        """Where "reset view" leads follows the robot."""
        if self._reset is None or hypot(base[0] - self._reset[0], base[1] - self._reset[1]) > AWAY:
            self._reset = base
            camera = self._server.initial_camera
            camera.position, camera.look_at = opening_view(base, self._floor_plan)
