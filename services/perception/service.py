"""Perception: looks through the cameras, remembers objects, and finds the one that words mean."""

import importlib
import math
from dataclasses import dataclass
from typing import Literal

import msgspec

from common import messages as m
from common import topics
from common.bus.port import Io, Job
from common.geometry import Pose2, wrap
from common.goal_inbox import GoalInbox
from common.kinds import kind_of
from common.likeness import PLAIN
from common.runtime import StartError
from services.perception.calibration_monitor import CalibrationMonitor
from services.perception.config import PerceptionConfig
from services.perception.detect import ClassicalDetector, Detector
from services.perception.detection import Detection
from services.perception.grounding import Grounding, as_called, ground, may_be_meant, parsed, possible
from services.perception.naming.naming import Naming
from services.perception.object_tracker import SURE, ObjectTracker
from services.perception.picture import jpeg
from services.perception.self_filter import RobotModel
from services.perception.state_buffer import StateBuffer
from services.perception.view import View, view_of

MOVING = 0.02
"""Change of the base's pose [m, rad] from which it moves. Chosen: above the noise of localisation at rest."""
HAND_RANGE = 0.35
"""Distance [m] from a working hand within which the head camera's detections are left out. Chosen: it may hide a part
of them."""
CLEAR = ("", "start", "look")
"""Phases of manipulation in which the arm is retracted."""
AIM = "aim"
"""Phase in which the hand is in front of the object and waits for the wrist camera's sighting."""
REFINED = 0.05
"""Most [m] that the wrist camera's sighting may be off the believed position of the object that it refines. Chosen:
less than the distance to a neighbour."""
PICTURES = (topics.HEAD_RGBD, topics.WRIST_RGBD)


@dataclass
class Reading:
    """A query whose answer waits until the worker has looked at the objects that a picture (`view`) has shown (`seen`).

    `fine`: it waits for a finer picture as well, to read what is printed; `taken`: that has come, or none is needed.
    """

    seen: set[str]
    view: View
    taken: bool = False
    fine: bool = True


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
        self._reset()
        self._state = StateBuffer(io)
        self._monitor = CalibrationMonitor()
        self._calibrated: dict[str, bool] = {}
        self._hand_at: tuple[float, float, float] | None = None
        self._picture = ""
        self._fine = False
        self._pictures = 0
        self._looked_for_name = 0
        self._asked_at = -1e9
        self._detecting: Job[tuple[View, list[Detection]]] | None = None
        self._looked_from: tuple[Pose2, str] | None = None
        self._inbox: GoalInbox[m.ObjectQuery, m.ObjectPose] = GoalInbox(
            io, (topics.OBJECT_QUERY,), self._take_query, self._repeat
        )

    def _reset(self) -> None:
        self._tracker = ObjectTracker(self._io.loaded, self._config.gone_after, self._config.min_confidence)
        self._published: list[m.WorldObject] = []
        self._naming.reset()
        self._reading: Reading | None = None
        self._io.publish(topics.WORLD_OBJECTS, m.WorldObjects(t=0.0, objects=[], source="perception"))

    def step(self, now: float) -> None:
        self._update_state(now)
        self._inbox.receive()
        self._receive_picture(now)
        if self._detecting is not None and self._detecting.poll(now):
            self._track_objects(self._detecting, now)
            self._detecting = None
        if self._naming.step(now):
            self._publish_objects(now)
        self._finish_reading()
        self._request_picture(now)

    # --- the robot
    def _update_state(self, now: float) -> None:
        io, state = self._io, self._state
        known = state.update()
        status = io.latest(topics.SIM_STATUS)
        if status is not None and status.world != self._world:
            if self._world:
                self._reset()
                io.log.info("another world", world=status.world)
            self._world = status.world
        base = state.base
        # While a picture is looked at, the model belongs to the worker.
        if not known or base is None or self._detecting is not None:
            return
        robot = state.robot(now)
        if robot is not None:
            self._hand_at = robot.hand(base)
            if self._tracker.carry(self._hand_at, state.holds(robot), now) or io.household is not self._told:
                self._told = io.household
                self._publish_objects(now)

    def _phase(self) -> str:
        """The phase of the manipulation under way, "" when the arm rests."""
        status = self._io.latest(topics.MANIPULATION_STATUS)
        return status.phase or "working" if status is not None and status.status == "executing" else ""

    # --- pictures
    def _request_picture(self, now: float) -> None:
        """Request the next picture when one is due."""
        config = self._config
        waiting = bool(self._picture) and now - self._asked_at < config.picture_timeout
        here = self._state.base
        if (
            waiting
            or self._detecting is not None
            or self._naming.busy
            or here is None
            or self._state.turning() > config.max_turn
        ):
            return
        phase = self._phase()
        period = config.idle_period if self._shown(here, phase) else config.period
        wanted = self._inbox.active is not None or self._naming.wants_picture
        if not wanted and now - self._asked_at < period and phase != AIM:
            return
        self._looked_from = here, phase
        self._picture, self._asked_at, self._fine = self._io.new_id("picture"), now, self._wants_fine_picture()
        camera: Literal["head", "wrist"] = "wrist" if phase == AIM and not wanted else "head"
        width, height = (config.fine_width, config.fine_height) if self._fine else (config.width, config.height)
        request = m.CameraRequest(id=self._picture, camera=camera, width=width, height=height)
        self._io.publish(topics.CAMERA_REQUEST, request)

    def _shown(self, here: Pose2, phase: str) -> bool:
        """The last picture shows what one from `here` would: the robot rests, or drives and has not come far yet."""
        if self._looked_from is None or self._looked_from[1] != phase:
            return False
        there, config = self._looked_from[0], self._config
        if not self._state.driving():
            return _within(there, here, MOVING, MOVING)
        # Who carries something looks for nothing.
        stride = config.laden_stride if any(o.held for o in self._published) else config.stride
        return _within(there, here, stride, config.sweep)

    def _wants_fine_picture(self) -> bool:
        """Print is to be read, or what a name is taught for was seen and is to be seen better."""
        if self._reading is not None:
            return not self._reading.taken
        return self._naming.wants_picture and self._looked_for_name >= self._config.query_pictures

    def _receive_picture(self, now: float) -> None:
        for key, image in ((t.key, image) for t in PICTURES for image in self._io.take_all(t)):
            base = self._state.base_at(image.t)
            if not self._picture or image.id != self._picture or base is None:
                continue
            self._picture = ""
            try:
                view = view_of(image, base)
            except ValueError as error:
                self._io.count_drop(key, str(error))
                continue
            if self._fine:
                self._naming.see(view, self._tracker.objects(), now, base, fine=True)
                if self._reading is not None:
                    self._reading.taken = True
                continue
            self._calibrated[image.camera] = image.calibrated
            robot = self._state.robot(now, image.t)
            self._detecting = self._io.submit(
                detect, self._detector, view, base, robot, seconds=self._config.detection_seconds
            )

    def _track_objects(self, job: Job[tuple[View, list[Detection]]], now: float) -> None:
        view, detections = job.result()
        if view.camera == "wrist":
            detections = [d for d in detections if self._refines(d)]
        elif self._phase() not in CLEAR and self._hand_at is not None:
            # Half hidden by the hand, an object looks like another.
            detections = [d for d in detections if math.dist(d.position, self._hand_at) > HAND_RANGE]
        seen = self._tracker.update(view, detections, view.t)
        base = self._state.base_at(view.t)
        if base is not None:
            self._naming.see(view, self._tracker.objects(), now, base)
            calibrated = self._calibrated.get(view.camera, False)
            for camera, why in self._monitor.see(view, detections, base, calibrated).items():
                self._io.log.warning(f"the {camera} camera contradicts its calibration", why=why)
        self._looked_for_name = self._looked_for_name + 1 if self._naming.wants_picture else 0
        self._publish_objects(now, bool(seen))
        query = self._inbox.active
        if query is not None and view.t >= query.since:
            self._pictures += 1
            self._answer_query(seen, view)

    def _refines(self, d: Detection) -> bool:
        """True for what the wrist camera may say of an object: where it is more exactly, and of round objects from any
        part of them."""
        known = any(o.label == d.label and math.dist(o.position, d.position) < REFINED for o in self._published)
        return known and (kind_of(d.kind).straight or (d.whole and d.confidence >= SURE))

    def _publish_objects(self, now: float, seen: bool = False) -> None:
        """Publish what is believed when it has changed or was `seen` again."""
        objects = self._naming.annotated(self._objects())
        if seen or [_outline(o) for o in objects] != [_outline(o) for o in self._published]:
            self._published = objects
            self._io.publish(topics.WORLD_OBJECTS, m.WorldObjects(t=now, objects=objects, source="perception"))

    def _objects(self, since: float = -math.inf) -> list[m.WorldObject]:
        """What is believed, on surfaces as people call them."""
        objects, home = self._tracker.objects(since), self._io.household
        for o in objects:
            surface = home.receptacle(o.on)
            o.on = surface.name if surface else o.on
        return objects

    # --- queries
    def _repeat(self, query: m.ObjectQuery, answer: m.ObjectPose | None) -> None:
        if answer is not None:
            self._io.publish(topics.OBJECT_POSE, answer)

    def _take_query(self, query: m.ObjectQuery) -> None:
        # A picture that is under way was not taken for this question.
        self._pictures, self._picture = 0, ""
        self._reading = None

    def _answer_query(self, seen: set[str], view: View) -> None:
        query = self._inbox.active
        if query is None:
            return
        if self._naming.busy:
            self._reading = Reading(seen, view, taken=True, fine=self._reading is not None and self._reading.fine)
            return
        result = self._ground(query)
        found = result.found
        if found is None and not result.candidates and self._pictures < self._config.query_pictures:
            return
        if found is not None and found.id not in seen and self._pictures < self._config.query_pictures:
            return
        read = self._reading is not None and self._reading.fine
        if not read and self._naming.unread(query.query, found is not None or bool(result.candidates)):
            self._reading = Reading(seen, view)
            return
        if found is None and not result.candidates and self._naming.consult(query, self._published):
            self._reading = Reading(seen, view, taken=True, fine=read)
            return
        answer = _pose_answer(query, result, jpeg(view) if query.since else b"")
        if found is None and not result.candidates:
            answer.unsure = self._unsure(query.query)
        self._reading = None
        # Kept for a query that is sent again, without what costs memory.
        self._inbox.end(query, msgspec.structs.replace(answer, picture=b""))
        self._io.log.info("asked", query=query.query, found=answer.label, detail=answer.detail)
        self._io.publish(topics.OBJECT_POSE, answer)

    def _unsure(self, query: str) -> list[str]:
        """Labels of objects that have to be seen from nearer to tell whether they are meant."""
        base, seen = self._state.base or (0.0, 0.0, 0.0), self._published
        doubtful = self._tracker.doubtful()
        blurred = may_be_meant(query, seen, doubtful, self._io.household, base)
        return list(dict.fromkeys([*self._naming.unsure(query, seen, base), *blurred]))

    def _finish_reading(self) -> None:
        """Answer the query once the fine picture for it was read."""
        reading = self._reading
        if reading is not None and reading.taken and not self._naming.busy:
            if not reading.fine:
                self._reading = None
            self._answer_query(reading.seen, reading.view)

    def _ground(self, query: m.ObjectQuery) -> Grounding:
        base, household, config = self._state.base or (0.0, 0.0, 0.0), self._io.household, self._config
        objects = self._naming.annotated(self._objects(query.since or -math.inf))
        objects = [o for o in objects if o.id not in query.excluded]
        if meant := next((o for o in objects if o.id == query.meant and not o.held), None):
            return Grounding(meant)
        looks = objects
        doubtful = self._tracker.doubtful()
        objects = [as_called(o) if o.id in doubtful else o for o in objects]
        # What was put down is asked for by its label, whatever it looks like from there.
        least = 0.0 if query.since else PLAIN
        result = ground(query.query, objects, household, base, config.synonyms, self._naming.match, least)
        if result.found or result.candidates:
            return result
        phrase = parsed(query.query, household, config.synonyms)
        chosen = self._naming.chosen(query, objects)
        read = [] if chosen else self._naming.perhaps(query.query, looks)
        perhaps = [] if chosen else [*read, *possible(phrase, looks, household, taught=self._naming.knows(query.query))]
        return Grounding(chosen, result.reason, perhaps=perhaps)


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
    module, _, attribute = name.partition(":")
    try:
        found: type[Detector] = getattr(importlib.import_module(module), attribute)
    except (ImportError, AttributeError, ValueError) as error:
        raise StartError(
            f"perception.detector = {name!r}: {error}; expected classical or package.module:Class"
        ) from None
    return found


def _pose_answer(query: m.ObjectQuery, result: Grounding, picture: bytes) -> m.ObjectPose:
    found = result.found
    if found is None:
        detail, candidates = result.reason, result.candidates
        return m.ObjectPose(
            query_id=query.id, found=False, detail=detail, candidates=candidates, perhaps=result.perhaps,
            picture=picture,
        )  # fmt: skip
    return m.ObjectPose(
        query_id=query.id, found=True, label=found.label, confidence=found.confidence, position=found.position,
        orientation=found.orientation, size=found.size, seen_at=found.seen_at,
        detail=f"on the {found.on}" if found.on else "", on=found.on, id=found.id, tilt=found.tilt, picture=picture,
    )  # fmt: skip


def _within(a: Pose2, b: Pose2, way: float, turn: float) -> bool:
    """Two poses are less than `way` [m] and `turn` [rad] apart."""
    return math.hypot(a[0] - b[0], a[1] - b[1]) < way and abs(wrap(a[2] - b[2])) < turn


def _outline(o: m.WorldObject) -> tuple[object, ...]:
    """What others care about: a change below 2 mm is none."""
    x, y, z = (round(v / 0.002) for v in o.position)
    return o.id, o.label, o.on, o.held, round(o.tilt, 1), x, y, z, *o.names, o.text
