"""The 3-D view kept up to date from the bus: flat, robot, objects, and plans of navigation and manipulation."""

from functools import partial

import viser

from common import messages as m
from common import topics
from common.bus.port import Io, Job
from common.geometry import Pose2
from services.dashboard.panels.tracking_error import off_path
from services.dashboard.panels.widgets import Panels
from services.dashboard.scene.drawing import Drawing, draw
from services.dashboard.scene.follow_camera import FollowCamera
from services.dashboard.scene.layers import Layers
from services.dashboard.scene.view import View

GHOSTS = 0.25
"""Period [s] in which objects that were not seen again for long fade; chosen: as often as a person sees it."""
GRABBING = ("reach", "aim", "grasp")
"""Phases of a grab in which its candidates are shown."""


class LiveScene:
    """Updates the view from messages; `base` is the estimated pose of the robot."""

    def __init__(self, server: viser.ViserServer, io: Io, panels: Panels, ghost_after: float) -> None:
        self._io, self._panels, self._ghost_after = io, panels, ghost_after
        self.view, self._layers = View(server), Layers(server)
        self._camera = FollowCamera(server, io.household)
        self.base: Pose2 = (0.0, 0.0, 0.0)
        self._mjcf = ""
        self._drawn: Job[Drawing] | None = None
        self._path: list[tuple[float, float]] = []
        self._seen_grasps: tuple[object, bool] = (None, False)
        self._world: m.WorldObjects | None = None
        self._ghosts_at = float("-inf")

    def redraw_model(self, now: float) -> None:
        """Draw flat and robot anew when the simulation says what they are."""
        model = self._io.latest(topics.SIM_MODEL)
        if self._drawn is not None and self._drawn.poll(now):
            job, self._drawn = self._drawn, None
            try:
                self.view.show(job.result())
            except ValueError as error:
                self._io.count_drop(topics.SIM_MODEL.key, str(error))
        if model is not None and model.mjcf != self._mjcf and self._drawn is None:
            self._mjcf = model.mjcf
            self._drawn = self._io.submit(partial(draw, model.mjcf, model.files))

    def move(self, now: float, t: float) -> None:
        """Draw everything where it is now; `t`: robot time [s]."""
        io, panels, view = self._io, self._panels, self.view
        joints, pose = io.latest(topics.JOINT_STATES), io.latest(topics.POSE)
        q = dict(zip(joints.name, joints.position, strict=False)) if joints is not None else {}
        if pose is not None:
            self.base = (pose.x, pose.y, pose.theta)
        elif joints is not None:
            self.base = (q.get("base_x", 0.0), q.get("base_y", 0.0), q.get("base_yaw", 0.0))
        view.pose(q, self.base, q.get("gripper", 0.0))
        if pose is not None or joints is not None:
            self._camera.step(self.base, panels.follow.value)
        for scan in io.take_all(topics.SCAN):
            try:
                view.scan(scan, self.base, panels.scan.value)
            except ValueError as error:
                io.count_drop(topics.SCAN.key, str(error))
        for path in io.take_all(topics.NAV_PATH):
            self._path = path.points
            view.path(path.points)
        self._overlay()
        view.parts(io.latest(topics.HOUSEHOLD_PARTS), panels.labels.value)
        world = io.latest(topics.WORLD_OBJECTS)
        if world is not None and (world is not self._world or now >= self._ghosts_at):
            self._world, self._ghosts_at = world, now + GHOSTS
            view.objects(world.objects, t, self._ghost_after, panels.labels.value)

    def _overlay(self) -> None:
        """What navigation and manipulation think, and what the brain asks about."""
        brain = self._io.latest(topics.BRAIN_STATE)
        self._layers.offered(brain.offered if brain is not None else [])
        try:
            self._layers.costmap(self._io.latest(topics.COSTMAP), self._panels.costmap.value)
        except ValueError as error:
            self._io.count_drop(topics.COSTMAP.key, str(error))
        found, doing = self._io.latest(topics.GRASPS), self._io.latest(topics.MANIPULATION_STATUS)
        under_path = doing is not None and doing.status == "executing" and doing.phase in GRABBING
        shown = (found, under_path and self._panels.grasps.value)
        if shown != self._seen_grasps:
            self._seen_grasps = shown
            self._layers.grasps(*shown)

    @property
    def off_path(self) -> float:
        """Distance [m] of the base from its path, 0 while it follows none."""
        driving = self._io.latest(topics.NAVIGATION_FEEDBACK)
        return off_path(self._path, self.base) if driving is not None and driving.status == "navigating" else 0.0
