"""Overlays of the 3-D view: costmap, grasp candidates, and the objects that the robot asks about."""

from typing import Any

import numpy as np
import viser
from numpy.typing import NDArray

from common import messages as m
from common.cells import unpacked
from common.geometry import quat_matrix

FOOTPRINT = 0.3
"""Clearance [m] up to which the base's centre cannot be."""
FLOOR = 0.012
"""Height [m] of the costmap above the floor; chosen: the two do not flicker."""
NUMBER = 0.22
"""Height [m] of a number over an object's middle; chosen: above its name."""
STATES = {"open": (150, 150, 150), "failed": (224, 49, 49), "chosen": (47, 158, 68)}
FINGER, DEPTH, STEM = 0.05, 0.05, 0.08
"""Lengths [m] of the drawn fork: its fingers, how far its palm is behind the pinch point, its stem; chosen: about the
hand's own."""


def picture(costmap: m.Costmap) -> NDArray[np.uint8]:
    """RGBA (height, width, 4), first row south: red where the base cannot be, fading to nothing where it has room.

    Raises:
        ValueError: not as many cells as it says.
    """
    room = unpacked(costmap) * (costmap.far / 255)
    shown = np.zeros((costmap.height, costmap.width, 4), np.uint8)
    shown[..., 0] = np.where(room <= 0, 90, 230)
    shown[..., 1] = np.clip(room / costmap.far * 220, 0, 220)
    shown[..., 2] = np.where(room <= 0, 120, 40)
    fading = 110 * np.clip(1 - (room - FOOTPRINT) / max(costmap.far - FOOTPRINT, 1e-6), 0, 1) ** 2
    shown[..., 3] = np.where(room <= FOOTPRINT, 120, fading)
    return shown


def forks(candidates: list[m.GraspCandidate]) -> tuple[NDArray[np.float32], NDArray[np.uint8]]:
    """A fork for each candidate: line segments (n, 2, 3) in frame map and their colours (n, 2, 3)."""
    lines: list[NDArray[np.float64]] = []
    colours: list[tuple[int, int, int]] = []
    for one in candidates:
        half = max(one.width, 0.02) / 2 + 0.006
        # Stem, palm and two fingers in the grasp's own frame: z approaches, y is across the fingers.
        y, z = half, -DEPTH
        own = np.array(
            [
                [[0, 0, z - STEM], [0, 0, z]], [[0, -y, z], [0, y, z]],
                [[0, -y, z], [0, -y, z + FINGER]], [[0, y, z], [0, y, z + FINGER]],
            ]
        )  # fmt: skip
        lines.append(own @ quat_matrix(one.orientation).T + np.array(one.position))
        colours += [STATES[one.state]] * len(own)
    if not lines:
        return np.zeros((0, 2, 3), np.float32), np.zeros((0, 2, 3), np.uint8)
    each = np.array(colours, np.uint8)
    return np.concatenate(lines).astype(np.float32), np.stack([each, each], axis=1)


class Layers:
    """Draws the overlays into a viser server."""

    def __init__(self, server: viser.ViserServer) -> None:
        self._scene = server.scene
        self._costmap: Any = None
        self._place: tuple[float, ...] = ()
        self._cells = b""
        self._grasps: Any = None
        self._offered: list[m.Vec3] = []
        self._numbers: list[Any] = []

    def offered(self, places: list[m.Vec3]) -> None:
        """Number the objects that the person is asked about, in the order in which the question names them."""
        if places == self._offered:
            return
        for number in self._numbers:
            number.remove()
        self._offered = places
        self._numbers = [
            self._scene.add_label(f"/offered/{n}", f"{n}?", position=(x, y, z + NUMBER))
            for n, (x, y, z) in enumerate(places, 1)
        ]

    def costmap(self, costmap: m.Costmap | None, visible: bool) -> None:
        """Show the newest costmap.

        Raises:
            ValueError: it is none.
        """
        if costmap is not None and visible and costmap.cells != self._cells:
            self._cells = costmap.cells
            shown = picture(costmap)
            width, height = costmap.width * costmap.resolution, costmap.height * costmap.resolution
            place = (costmap.x, costmap.y, width, height)
            if self._costmap is not None and place == self._place:
                self._costmap.image = shown
            else:
                if self._costmap is not None:
                    self._costmap.remove()
                middle = (costmap.x + width / 2, costmap.y + height / 2, FLOOR)
                self._costmap = self._scene.add_image(
                    "/costmap", shown, width, height, format="png", position=middle, cast_shadow=False,
                    receive_shadow=False,
                )  # fmt: skip
                self._place = place
        if self._costmap is not None and self._costmap.visible != visible:
            self._costmap.visible = visible

    def grasps(self, found: m.GraspCandidates | None, visible: bool) -> None:
        """Show the candidates of a grab under way, none when there is no such."""
        if self._grasps is not None:
            self._grasps.remove()
            self._grasps = None
        if found is not None and visible and found.candidates:
            segments, colours = forks(found.candidates)
            self._grasps = self._scene.add_line_segments("/grasps", segments, colours, thickness=0.006)
