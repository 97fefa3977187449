"""The robot live in Foxglove: channels as in the recordings, drawings, parameters, and commands where allowed."""

from collections import Counter
from math import inf
from typing import Any

import msgspec
import mujoco

from common import messages as m
from common import topics
from common.bus.port import Io
from common.config import settings
from common.gateway import refusal
from common.picture_requests import PictureRequests
from common.robot.frames import FramePose, camera_pose, lidar_pose
from common.robot.moving_frames import MovingFrames
from common.robot.shapes import Shape, shapes
from common.robot.urdf import urdf
from common.runtime import StartError
from common.topic import Topic
from services.foxglove import incoming
from services.foxglove.config import FoxgloveConfig
from services.foxglove.listener import Listener, Sent, Set, Subscribed

MISSING = "the Foxglove server needs the package foxglove-sdk: pip install 'tidybot-zenoh[foxglove]'"
LOCAL = ("127.0.0.1", "::1", "localhost")
TICKS = topics.SIM_CLOCK_10HZ
DESCRIPTION = "robot_description"
"""The parameter from which Foxglove's URDF layer takes the robot."""
LIVE = ("foxglove.tf_rate", "foxglove.camera_rate")
"""Parameters that visitors may change: those of the server itself, rates [Hz]."""
FASTEST = 50.0
"""Highest rate that a visitor may set [Hz]: that of the service's steps."""


def may_set(name: str, value: Any) -> bool:
    """True for a parameter and value that visitors may set while the robot runs."""
    return name in LIVE and isinstance(value, (int, float)) and not isinstance(value, bool) and 0 <= value <= FASTEST


class FoxgloveService:
    """A WebSocket server for Foxglove on this machine."""

    NAME = "foxglove"
    HZ = 50
    CLOCK = "wall"
    CONFIG = FoxgloveConfig
    READS, WRITES = (*topics.subscribed(NAME), TICKS), topics.published(NAME)
    ON_DEMAND: tuple[Topic[Any], ...] = tuple(
        t for t in READS if t is not topics.BRAIN_STATE
    )  # which says whether others may move the robot

    def __init__(self, config: FoxgloveConfig, io: Io) -> None:
        if config.host not in LOCAL and not config.open:
            raise StartError(
                f"foxglove.host = {config.host!r}: there is no password, so it listens on this machine only; from "
                f"elsewhere use `ssh -L {config.port}:127.0.0.1:{config.port}` (foxglove.open = true, where the "
                "network itself is closed)"
            )
        try:
            from services.foxglove.views import Server
        except ImportError:
            raise StartError(MISSING) from None
        self._config, self._io = config, io
        own = {f"{self.NAME}.{name}": value for name, value in msgspec.structs.asdict(config).items()}
        self._listener = Listener(settings() | own, may_set)
        try:
            self.server = Server(config, self._listener, topics.subscribed(self.NAME))
        except OSError as error:
            raise StartError(f"foxglove.port = {config.port}: {error}; choose another, or 0 for any") from None
        self._watched: Counter[int] = Counter()
        self._newest: dict[str, m.Message] = {}
        self._gone: set[str] = set()
        self._frames = MovingFrames(io, _read)
        self._shapes: list[Shape] = []
        self._fixed: dict[str, FramePose] = {}
        self._pictures = PictureRequests(io, config.camera_rate, config.camera_width, config.camera_height)
        self._t = 0.0
        io.log.info("listening", url=self.server.url, commands=config.commands)

    def step(self, now: float) -> None:
        """Carry out what visitors have done, then send them what is new on their channels."""
        self._hear()
        wanted = self._wanted()
        for topic in self.ON_DEMAND:
            self._io.demand(topic, topic in wanted)
        self._keep_time(now, wanted)
        for topic in wanted - {TICKS}:
            for message in self._io.take_all(topic):
                self._take(topic, message)
        self._pictures.step(now, wanted & {*topics.PICTURES.values()})
        self._describe(now)
        self._move(now)

    def _wanted(self) -> set[Topic[Any]]:
        found = {t for number, count in self._watched.items() if count > 0 for t in self.server.channels[number].topics}
        return found | {TICKS} if found else found

    def _keep_time(self, now: float, wanted: set[Topic[Any]]) -> None:
        """Robot time: the simulation's, or the host's where there is none."""
        ticks = self._io.take_all(TICKS) if TICKS in wanted else []
        if ticks:
            self._t = ticks[-1].t
            self.server.tell_time(self._t)
        elif self._io.age(TICKS, now) == inf:
            self._t = now

    # --- from visitors
    def _hear(self) -> None:
        events = self._listener.events
        if self._listener.lost:
            lost, self._listener.lost = self._listener.lost, 0
            self._io.count_drop("visitors", f"{lost} messages too long or over the queue limit")
        while not events.empty():
            event = events.get_nowait()
            if isinstance(event, Sent):
                self._command(event)
            elif isinstance(event, Set):
                self._set(event)
            else:
                self._look(event)

    def _look(self, event: Subscribed) -> None:
        """Who begins to look sees how things stand; nothing is kept for those who come later."""
        self._watched[event.channel] += event.change
        channel = self.server.channels.get(event.channel)
        if event.change < 0 or channel is None:
            return
        if channel is self.server.scene:
            self._draw()
        for topic in channel.topics:
            if (newest := self._newest.get(topic.key)) is not None and topic.latched:
                self._show(event.channel, topic, newest)

    def _command(self, event: Sent) -> None:
        io, name = self._io, event.topic.strip("/")
        row = incoming.BY_NAME.get(name)
        if row is None:
            self._refuse("visitors", f"nothing listens on {event.topic!r}; known: {', '.join(incoming.BY_NAME)}")
        elif not (self._config.commands or row.always):
            self._refuse(name, "commands are off; `tidybot up --foxglove --set foxglove.commands=true` takes them")
        elif row.moves and (why := refusal(io.latest(topics.BRAIN_STATE))):
            self._refuse(name, why)
        else:
            try:
                io.publish(row.topic, incoming.message_of(row, io, event.data))
            except ValueError as error:
                self._refuse(name, str(error))

    def _refuse(self, key: str, why: str) -> None:
        self._io.count_drop(f"foxglove:{key}", why)
        self.server.warn(f"{key}: {why}")

    def _set(self, event: Set) -> None:
        """The listener has answered; here it takes effect, or the visitor is told why it does not."""
        if not event.allowed:
            why = f"cannot be changed while the robot runs; {', '.join(LIVE)} can, from 0 to {FASTEST:g}"
            self._refuse("parameters", f"{event.name} {why}; `tidybot up --set {event.name}=VALUE` sets the others")
        self._pictures.rate = self._rate("camera_rate")

    def _rate(self, name: str) -> float:
        return float(self._listener.parameters[f"{self.NAME}.{name}"])

    # --- to visitors
    def _take(self, topic: Topic[Any], message: m.Message) -> None:
        before = self._newest.get(topic.key)
        self._newest[topic.key] = message
        self._frames.take(message)
        if isinstance(message, m.LaserScan):
            self._fixed["lidar"] = lidar_pose(message)
        elif isinstance(message, m.Rgbd):
            self._fixed[message.camera] = camera_pose(message)
        elif isinstance(message, m.WorldObjects):
            labels = {one.label for one in message.objects}
            self._gone = {o.label for o in before.objects} - labels if isinstance(before, m.WorldObjects) else set()
            self.server.draw_objects(message, self._gone)
        for number, channel in self.server.channels.items():
            if topic in channel.topics and self._watched[number] > 0:
                self._show(number, topic, message)

    def _show(self, number: int, topic: Topic[Any], message: m.Message) -> None:
        channel = self.server.channels[number]
        if channel in (self.server.tf, self.server.scene):
            return
        t = getattr(message, "t", None)
        try:
            channel.show(message, self._t if t is None else t)
        except ValueError as error:
            self._io.count_drop(topic.key, str(error))

    def _describe(self, now: float) -> None:
        if (found := self._frames.described(now)) is None:
            return
        self._shapes, text = found
        self._listener.parameters[DESCRIPTION] = text
        self.server.tell_parameters({DESCRIPTION: text})
        self._draw()

    def _draw(self) -> None:
        """The robot, its home, and the objects that are known."""
        self.server.draw_home(self._io.household, self._t)
        self.server.draw_robot(self._shapes, self._t)
        known = self._newest.get(topics.WORLD_OBJECTS.key)
        if isinstance(known, m.WorldObjects):
            self.server.draw_objects(known, self._gone)

    def _move(self, now: float) -> None:
        if not self._watched[int(self.server.tf.out.id())]:
            return
        if poses := self._frames.poses(now, self._rate("tf_rate")):
            t = poses[0].t
            self.server.move([*poses, *(pose._replace(t=t) for pose in self._fixed.values())], t)

    def close(self) -> None:
        """End the server."""
        self.server.close()


def _read(mjcf: str) -> tuple[list[Shape], str]:
    """What a robot's links look like, and its description as URDF.

    Raises:
        ValueError: not a model, or one that cannot be said in URDF.
    """
    model: Any = mujoco.MjModel.from_xml_string(mjcf)
    return shapes(model), urdf(mjcf)
