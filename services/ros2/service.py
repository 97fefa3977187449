"""A ROS 2 node without ROS: publishes the robot's messages for rmw_zenoh's tools and takes their commands."""

import queue
from collections import deque
from functools import partial
from typing import Any

from common import messages as m
from common import topics
from common.bus import codec
from common.bus.port import Io
from common.gateway import refusal
from common.picture_requests import PictureRequests
from common.robot.frames import FramePose, camera_pose, lidar_pose
from common.robot.moving_frames import MovingFrames
from common.robot.urdf import pivots, urdf
from common.runtime import StartError
from common.topic import Topic
from services.ros2 import incoming, outgoing
from services.ros2.config import Ros2Config
from services.ros2.types import MISSING, Types
from services.ros2.wire import MAX_DOMAIN, Outlet, Qos, RosNode, RosTopic, ros_name

NODE = "tidybot"
WAITING = 256
"""Messages from peers that may wait for a step [count]; chosen: 2 s of a stream at 100 Hz, more is counted and lost."""
REMEMBERED = 32
"""Messages of peers by which their return from the robot's own bus is known [count]; chosen: those of a few steps."""
TF = "tf2_msgs/msg/TFMessage"
TF_TOPICS = (topics.ODOMETRY, topics.POSE, topics.JOINT_STATES, topics.ROBOT_DESCRIPTION)
ALL = tuple(dict.fromkeys((*(row.topic for row in outgoing.ROWS), *TF_TOPICS)))
"""What may have to be subscribed to."""


def describe(mjcf: str) -> tuple[str, list[FramePose]]:
    """A robot's description as URDF, and its fixed frames.

    Raises:
        ValueError: it cannot be said in URDF.
        KeyError: not of this robot's build.
    """
    return urdf(mjcf), pivots(mjcf)


class Ros2Service:
    """Gateway to ROS 2 tools that speak rmw_zenoh, on the robot's own router."""

    NAME = "ros2"
    HZ = 100
    CLOCK = "wall"
    CONFIG = Ros2Config
    READS, WRITES = (*topics.subscribed(NAME), topics.SIM_CLOCK), topics.published(NAME)
    ON_DEMAND = tuple(t for t in READS if t is not topics.BRAIN_STATE)  # which says whether others may move the robot

    def __init__(self, config: Ros2Config, io: Io) -> None:
        self._config, self._io = config, io
        if not 0 <= config.domain <= MAX_DOMAIN:
            raise StartError(f"ros2.domain = {config.domain}: expected 0 to {MAX_DOMAIN}")
        try:
            self._types = Types(config.distro)
        except ImportError:
            raise StartError(MISSING) from None
        if io.outside is None:
            raise StartError("the ROS 2 gateway needs a router")
        namespace = ros_name(config.namespace or io.outside.namespace)
        self._prefix = f"/{namespace}" if namespace else ""
        self._node = RosNode(io.outside.open(), NODE, self._prefix, config.domain)
        self._outlets = [(row, self._outlet(row.name, row.type, row.qos)) for row in outgoing.ROWS]
        self._tf = self._outlet("tf", TF, Qos(depth=100))
        self._tf_static = self._outlet("tf_static", TF, outgoing.LATCHED)
        self._robot = self._outlet("robot_description", outgoing.STRING, outgoing.LATCHED)
        self._waiting: queue.Queue[tuple[incoming.Row, bytes]] = queue.Queue(WAITING)
        self._lost = 0
        for row in incoming.ROWS:
            self._node.subscribe(self._topic(row.name, row.type), partial(self._receive, row))
        self._sent: deque[bytes] = deque(maxlen=REMEMBERED)
        self._newest: dict[str, m.Message] = {}
        self._fed: set[Outlet] = set()
        self._cameras = PictureRequests(io, config.camera_rate, config.camera_width, config.camera_height)
        self._frames = MovingFrames(io, describe)
        self._static: dict[str, FramePose] = {}
        io.log.info("ros graph", node=f"{self._prefix}/{NODE}", domain=config.domain, distro=config.distro)

    def _topic(self, name: str, kind: str, qos: Qos | None = None) -> RosTopic:
        absolute = name if name.startswith("/") else f"{self._prefix}/{name}"
        return RosTopic(absolute, kind, self._types.hash(kind), qos or Qos())

    def _outlet(self, name: str, kind: str, qos: Qos) -> Outlet:
        return self._node.publish(self._topic(name, kind, qos))

    def _receive(self, row: incoming.Row, payload: bytes) -> None:
        try:
            self._waiting.put_nowait((row, payload))
        except queue.Full:
            self._lost += 1

    def step(self, now: float) -> None:
        """Pass on the messages of peers, then publish for those who subscribe."""
        self._take_in()
        wanted = self._wanted()
        for topic in ALL:
            self._io.demand(topic, topic in wanted)
        for topic in wanted:
            for message in self._io.take_all(topic):
                self._pass_on(topic, message)
        for row, outlet in self._outlets:
            self._greet(row, outlet)
        self._cameras.step(now, wanted & {*topics.PICTURES.values()})
        self._send_frames(now)

    # --- from ROS
    def _take_in(self) -> None:
        io = self._io
        if self._lost:
            lost, self._lost = self._lost, 0
            io.count_drop("ros", f"{lost} messages over the queue limit")
        while not self._waiting.empty():
            row, payload = self._waiting.get_nowait()
            name = f"ros:{row.name}"
            if why := row.moves and refusal(io.latest(topics.BRAIN_STATE)):
                io.count_drop(name, why)
                continue
            try:
                message = incoming.message_of(row, self._types, io, payload)
            except ValueError as error:
                io.count_drop(name, str(error))
                continue
            self._sent.append(codec.encode(row.topic, message))
            io.publish(row.topic, message)

    # --- to ROS
    def _wanted(self) -> set[Topic[Any]]:
        """The robot's topics that somebody waits for."""
        found = {row.topic for row, outlet in self._outlets if outlet.wanted}
        if self._tf.wanted:
            found |= {*TF_TOPICS}
        if self._tf_static.wanted:
            found |= {topics.ROBOT_DESCRIPTION, topics.SCAN}
        if self._robot.wanted:
            found.add(topics.ROBOT_DESCRIPTION)
        return found

    def _pass_on(self, topic: Topic[Any], message: m.Message) -> None:
        if topic.command and codec.encode(topic, message) in self._sent:
            return  # a peer's own, which its subscribers have from the peer
        self._newest[topic.key] = message
        self._frames.take(message)
        if isinstance(message, m.LaserScan):
            self._fix(lidar_pose(message))
        elif isinstance(message, m.Rgbd) and self._tf.wanted:
            self._put(self._tf, self._types.frames([camera_pose(message)]))
        for row, outlet in self._outlets:
            if row.topic is topic and outlet.wanted:
                self._fed.add(outlet)
                self._convert(row, outlet, message)

    def _greet(self, row: outgoing.Row, outlet: Outlet) -> None:
        """Who comes first to a latched topic gets the present value; the next have it from the outlet's own cache."""
        if not outlet.wanted:
            self._fed.discard(outlet)
        elif outlet not in self._fed and row.qos.transient and (newest := self._newest.get(row.topic.key)) is not None:
            self._fed.add(outlet)
            self._convert(row, outlet, newest)

    def _convert(self, row: outgoing.Row, outlet: Outlet, message: m.Message) -> None:
        try:
            converted = row.convert(self._types, message)
        except ValueError as error:
            self._io.count_drop(row.topic.key, str(error))
            return
        if converted is not None:
            self._put(outlet, converted)

    def _put(self, outlet: Outlet, message: Any) -> None:
        outlet.put(self._types.encode(outlet.topic.type, message))

    # --- frames
    def _send_frames(self, now: float) -> None:
        if (found := self._frames.described(now)) is not None:
            text, fixed = found
            self._put(self._robot, self._types.text(text))
            self._fix(*fixed)
        if self._tf.wanted and (poses := self._frames.poses(now, self._config.tf_rate)):
            self._put(self._tf, self._types.frames(poses))

    def _fix(self, *poses: FramePose) -> None:
        """Publish the frames that do not move, when there are others than before."""
        fixed = {pose.child: pose._replace(t=0.0) for pose in poses}
        if fixed.items() <= self._static.items():
            return
        self._static |= fixed
        self._put(self._tf_static, self._types.frames([*self._static.values()]))

    def close(self) -> None:
        """Leave the ROS graph."""
        self._node.close()
