"""Perception: looks through the cameras, remembers objects, and finds the one that words mean."""

import math
import pkgutil

from common import topics
from common.approach import FOOTPRINT
from common.bus.port import Io, Job
from common.geometry import Pose2
from common.runtime import StartError
from services.perception.calibration_monitor import CalibrationMonitor
from services.perception.config import PerceptionConfig
from services.perception.detect import ClassicalDetector, Detector
from services.perception.detection import Detection
from services.perception.naming.naming import Naming
from services.perception.queries import Queries
from services.perception.tracking.association import lies_on_base, refines
from services.perception.tracking.beliefs import Beliefs
from services.perception.views.pictures import Pictures
from services.perception.views.self_filter import RobotModel
from services.perception.views.state_buffer import StateBuffer
from services.perception.views.view import View

HAND_RANGE = 0.35
"""Distance [m] from a working hand within which the head camera's detections are left out. Chosen: it may hide a part
of them."""
CLEAR = ("", "start", "look")
"""Phases of manipulation in which the arm is retracted."""
CLOSES = "grasp"
"""The phase in which the fingers close."""


class PerceptionService:
    """Pictures to objects, objects over time, words to an object."""

    NAME = "perception"
    HZ = 10
    CONFIG = PerceptionConfig
    READS, WRITES = topics.subscribed(NAME), topics.published(NAME)

    def __init__(self, config: PerceptionConfig, io: Io) -> None:
        self._config, self._io = config, io
        # Inside, surfaces are called as the file has them, whatever people call them meanwhile.
        self._detector = load_detector(config.detector)(io.loaded, config.max_range)
        self._world, self._told = "", io.household
        self._naming = Naming(io, config)
        self._state = StateBuffer(io)
        self._pictures = Pictures(config, io, self._state)
        self._beliefs = Beliefs(config, io, self._naming)
        self._queries = Queries(config, io, self._state, self._naming, self._beliefs, self._pictures)
        self._monitor = CalibrationMonitor()
        self._hand_at: tuple[float, float, float] | None = None
        self._was = ""
        self._looked_for_name = 0
        self._detecting: Job[tuple[View, list[Detection]]] | None = None

    def step(self, now: float) -> None:
        self._update_state(now)
        self._queries.receive()
        self._receive_picture(now)
        if self._detecting is not None and self._detecting.poll(now):
            self._track_objects(*self._detecting.result(), now)
            self._detecting = None
        if self._naming.step(now):
            self._beliefs.publish(now)
        self._queries.finish_reading()
        self._request_picture(now)

    def _update_state(self, now: float) -> None:
        io, state = self._io, self._state
        known = state.update()
        status = io.latest(topics.SIM_STATUS)
        if status is not None and status.world != self._world:
            if self._world:
                self._beliefs.forget()
                self._queries.forget()
                io.log.info("another world", world=status.world)
            self._world = status.world
        base = state.base
        # While a picture is looked at, the model belongs to the worker.
        if not known or base is None or self._detecting is not None:
            return
        robot = state.robot(now)
        if robot is not None:
            before, self._hand_at = self._hand_at, robot.hand(base)
            tracker, holds = self._beliefs.tracker, state.holds(robot)
            was, self._was = self._was, self._phase()
            if was == CLOSES != self._was and not holds:
                tracker.missed(before or self._hand_at)
            over_base = math.dist(self._hand_at[:2], base[:2]) < FOOTPRINT
            carried = tracker.carry(self._hand_at, holds, now, bool(self._was) or over_base)
            if carried or io.household is not self._told:
                self._told = io.household
                self._beliefs.publish(now)

    def _phase(self) -> str:
        """The phase of the manipulation under way, "" when the arm rests."""
        status = self._io.latest(topics.MANIPULATION_STATUS)
        return status.phase or "working" if status is not None and status.status == "executing" else ""

    def _request_picture(self, now: float) -> None:
        if self._detecting is not None or self._naming.busy:
            return
        wanted = self._queries.open or self._naming.wants_picture
        self._pictures.request(now, self._phase(), wanted, self._wants_fine_picture(), self._beliefs.laden)

    def _wants_fine_picture(self) -> bool:
        """Print is to be read, or what a name is taught for was seen and is to be seen better."""
        if self._queries.reading:
            return self._queries.wants_fine
        return self._naming.wants_picture and self._looked_for_name >= self._config.query_pictures

    def _receive_picture(self, now: float) -> None:
        for view, base in self._pictures.received():
            if self._pictures.fine:
                self._naming.see(view, self._beliefs.tracker.objects(), now, base, fine=True)
                self._queries.read()
                continue
            robot = self._state.robot(now, view.t)
            self._detecting = self._io.submit(
                detect, self._detector, view, base, robot, seconds=self._config.detection_seconds
            )

    def _track_objects(self, view: View, detections: list[Detection], now: float) -> None:
        tracker = self._beliefs.tracker
        base = self._state.base_at(view.t)
        detections = self._trusted(view, detections, base)
        seen = tracker.update(view, detections, view.t)
        if base is not None:
            self._naming.see(view, tracker.objects(), now, base)
            for camera, why in self._monitor.see(view, detections, base).items():
                self._io.log.warning(f"the {camera} camera contradicts its calibration", why=why)
        self._looked_for_name = self._looked_for_name + 1 if self._naming.wants_picture else 0
        self._beliefs.publish(now, bool(seen))
        self._queries.see(view, seen)

    def _trusted(self, view: View, detections: list[Detection], base: Pose2 | None) -> list[Detection]:
        """The detections that may be believed: half hidden by the hand, an object looks like another."""
        if base is not None:
            detections = [d for d in detections if not lies_on_base(d, base)]
        if view.camera == "wrist":
            return [d for d in detections if not d.known or refines(d, self._beliefs.published)]
        if self._phase() not in CLEAR and self._hand_at is not None:
            return [d for d in detections if math.dist(d.position, self._hand_at) > HAND_RANGE]
        return detections


def detect(detector: Detector, view: View, base: Pose2, robot: RobotModel | None) -> tuple[View, list[Detection]]:
    """The worker's part: find the robot in the view, then the objects beside it."""
    return view, detector.detect(view, robot.mask(view, base) if robot is not None else None)


def load_detector(name: str) -> type[Detector]:
    """The detector class of the configuration.

    Raises:
        StartError: no such module or class.
    """
    if name == "classical":
        return ClassicalDetector
    try:
        found = pkgutil.resolve_name(name)
    except (ImportError, AttributeError, ValueError) as error:
        raise StartError(
            f"perception.detector = {name!r}: {error}; expected classical or package.module:Class"
        ) from None
    if not isinstance(found, type):
        raise StartError(f"perception.detector = {name!r} is no class; expected classical or package.module:Class")
    return found
