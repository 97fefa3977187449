"""Mapping: explores an unknown home by frontiers, makes its map, and writes the household that the robot lives with."""

import math
from collections import deque
from collections.abc import Callable
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from common import messages as m
from common import topics
from common.bus.port import Io, Job
from common.files.map_file import MapError
from common.geometry import Pose2, compose
from common.robot.pictures import PictureError
from common.runtime import StartError
from services.mapping.barriers import Met
from services.mapping.config import MappingConfig
from services.mapping.exploration import Exploration
from services.mapping.mapper import Mapper
from services.mapping.odometry import OdometryBuffer
from services.mapping.save import Saved, SaveError, resume, save
from services.mapping.scan import scan_of
from services.mapping.views import Survey

PUBLISHED_EVERY = 0.8
"""Time between two maps while the robot drives [s]; chosen: navigation plans anew once a second."""
MAX_TURN = 0.3
"""Turn [rad/s] above which a picture is not worth having: 45 ms of it are 0.8 degrees."""
AGE = 0.045
"""How much older than its stamp a picture is [s]: the middle of what is measured of USB cameras."""
WAITING = 12
"""Pieces of work that may wait [count]; more scans and pictures of a robot on its way are dropped."""


class MappingService:
    """Explores and maps; publishes `mapping/map` with the pose of frame odom in it, by which navigation drives."""

    NAME = "mapping"
    HZ = 20
    CONFIG = MappingConfig
    READS, WRITES = topics.subscribed(NAME), topics.published(NAME)

    def __init__(self, config: MappingConfig, io: Io) -> None:
        if missing := [name for name in ("gtsam", "small_gicp") if find_spec(name) is None]:
            raise StartError(f"mapping needs {' and '.join(missing)}: pip install 'tidybot-zenoh[mapping]'")
        self._config, self._io = config, io
        self._mapper = Mapper(io.household.low, io.household.high)
        if config.resume:
            try:
                resume(Path(config.resume).expanduser(), self._mapper)
            except SaveError as error:
                raise StartError(f"mapping.resume: {error}") from None
        self._odometry = OdometryBuffer()
        self._work: deque[tuple[Job[Any], Callable[[Any], None]]] = deque()
        self._states: NDArray[np.uint8] | None = None
        self._odom: Pose2 = (0.0, 0.0, 0.0)
        self._met: list[float] = []
        self._published, self._changed = -1.0, False
        self._asked: dict[str, bool] = {}
        self._asked_at = -1.0
        self._exploration = Exploration(config, io.new_id)
        self._due = False
        self._saved, self._saves = "", 0
        self._surfaces = 0
        self._shown = (-1, "")

    def step(self, now: float) -> None:
        """Take measurements, pass work to the worker and take its results, and decide where to look next."""
        io = self._io
        self._odometry.take(io.take_all(topics.ODOMETRY))
        scans = io.take_all(topics.SCAN)
        if scans:
            self._scan(scans[-1])
        for image in io.take_all(topics.HEAD_RGBD):
            self._picture(image)
        while self._work and self._work[0][0].poll(now):
            job, done = self._work.popleft()
            try:
                result = job.result()
            except PictureError as error:
                io.count_drop(topics.HEAD_RGBD.key, str(error))
                continue
            done(result)
        for goal in io.take_all(topics.MAPPING_GOAL):
            self._command(goal)
        if self._states is not None:
            self._explore(now)
            if self._changed and now - self._published >= PUBLISHED_EVERY:
                self._publish(now)
        self._report(now)

    def _submit(self, done: Callable[[Any], None], fn: Callable[..., Any], *args: Any, seconds: float) -> None:
        self._work.append((self._io.submit(fn, *args, seconds=seconds), done))

    # --- measurements
    def _scan(self, message: m.LaserScan) -> None:
        odometry = self._odometry.at(message.t) if math.isfinite(message.t) else None
        config = self._config
        if odometry is None or self._due or len(self._work) > WAITING:
            return
        # Another keyframe only when the worker has taken the one before: it decides from where to count.
        if not self._mapper.trajectory.due(odometry, config.keyframe_distance, config.keyframe_turn):
            return
        try:
            scan = scan_of(message)
        except ValueError as error:
            self._io.count_drop(topics.SCAN.key, str(error))
            return
        self._due = True
        self._submit(self._scanned, self._mapper.add_scan, scan, odometry, seconds=config.match_seconds)

    def _scanned(self, states: NDArray[np.uint8]) -> None:
        self._due = False
        self._odom = self._mapper.trajectory.odom
        self._drawn(states)

    def _drawn(self, states: NDArray[np.uint8]) -> None:
        self._states, self._changed = states, True

    def _picture(self, image: m.Rgbd) -> None:
        still = self._asked.pop(image.id, None)
        if still is None or self._states is None:
            return
        odometry = self._odometry.at(image.t - AGE) if math.isfinite(image.t) else None
        if odometry is not None and (still or abs(self._odometry.turning) < MAX_TURN) and len(self._work) < WAITING:
            seconds = self._config.match_seconds
            self._submit(self._drawn, self._mapper.add_picture, image, odometry, still, seconds=seconds)
        if still:
            self._exploration.pictures += 1

    def _ask(self, still: bool, now: float) -> None:
        config = self._config
        own = self._io.new_id("mapping")
        self._asked = {own: still} if still else {**self._asked, own: False}
        self._asked_at = now
        request = m.CameraRequest(id=own, camera="head", width=config.width, height=config.height)
        self._io.publish(topics.CAMERA_REQUEST, request)

    # --- exploring
    def _explore(self, now: float) -> None:
        here = self._odometry.newest
        if here is None:
            return
        pose = compose(self._odom, here)
        for feedback in self._io.take_all(topics.NAVIGATION_FEEDBACK):
            self._exploration.take_feedback(feedback, now)
            if feedback.met and feedback.met != self._met:
                self._met = feedback.met
                met = Met(pose[:2], (feedback.met[0], feedback.met[1]))
                self._submit(self._drawn, self._mapper.meet, met, seconds=self._config.plan_seconds)
        wanted = self._exploration.step(pose, now, busy=bool(self._work))
        if wanted == "picture" and (not self._asked or now - self._asked_at > 1.5):
            self._ask(True, now)
        elif wanted == "survey":
            barred, seconds = list(self._exploration.barred), self._config.plan_seconds
            self._submit(self._surveyed, self._mapper.survey, pose, barred, seconds=seconds)
        elif wanted == "save":
            self._submit(self._done, self._save, seconds=self._config.save_seconds)
        elif isinstance(wanted, m.NavGoal):
            self._publish(now)
            self._io.publish(topics.NAV_GOAL, wanted)
            self._io.log.info("view", x=wanted.x, y=wanted.y, left=self._exploration.frontiers)
        elif self._exploration.driving and now - self._asked_at > self._config.picture_period:
            self._ask(False, now)

    def _surveyed(self, found: tuple[Survey, NDArray[np.uint8]]) -> None:
        survey, states = found
        self._drawn(states)
        self._exploration.take_survey(survey)

    def _save(self) -> Saved | str:
        """The files that were written, or why they could not be."""
        try:
            return save(Path(self._config.out).expanduser(), self._config.name, self._mapper)
        except (SaveError, MapError) as error:
            return str(error)

    def _done(self, saved: Saved | str) -> None:
        if isinstance(saved, str):
            self._io.log.error("not saved", reason=saved)
            self._exploration.phase, self._exploration.detail = "failed", saved
            return
        self._odom, self._states = self._mapper.trajectory.odom, self._mapper.grid.states()
        self._saved, self._surfaces = saved.directory, saved.surfaces
        self._saves += 1
        self._shown = (-1, "")
        if self._exploration.phase == "saving":
            self._exploration.phase = "done"
        self._io.log.info("saved", directory=saved.directory, surfaces=saved.surfaces)

    def _command(self, goal: m.MappingGoal) -> None:
        words = goal.goal.strip()
        if words == "save" and self._states is not None:
            self._submit(self._done, self._save, seconds=self._config.save_seconds)
        elif words == "finish":
            self._exploration.finish()
        else:
            self._io.count_drop(topics.MAPPING_GOAL.key, f"{words!r}: expected save or finish")

    # --- telling
    def _publish(self, now: float) -> None:
        if self._states is None:
            return
        self._published, self._changed = now, False
        self._io.publish(topics.MAP_GRID, self._mapper.grid.message(now, self._odom, self._states))

    def _report(self, now: float) -> None:
        exploration = self._exploration
        shown = int(now), exploration.phase
        if shown == self._shown:
            return
        self._shown = shown
        self._io.publish(
            topics.MAPPING_STATUS,
            m.MappingStatus(
                t=now, phase=exploration.phase, area=exploration.area, frontiers=exploration.frontiers,
                surfaces=self._surfaces, keyframes=len(self._mapper.trajectory), loops=self._mapper.trajectory.loops,
                pictures=len(self._mapper.shots), saved=self._saved, saves=self._saves, detail=exploration.detail,
            ),
        )  # fmt: skip
