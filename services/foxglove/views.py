"""The server with its channels: the topics as recordings have them, and well-known messages that panels can draw."""

from collections.abc import Callable
from typing import Any, NamedTuple

import foxglove
import msgspec
from foxglove import channels
from foxglove.websocket import Capability

from common import messages as m
from common import topics
from common.household import Household
from common.robot.frames import FramePose
from common.robot.shapes import Shape
from common.schemas import schema_of
from common.topic import Topic
from services.foxglove import drawing
from services.foxglove.config import FoxgloveConfig
from services.foxglove.listener import Listener

NAME = "TidyBot"
CAPABILITIES = (Capability.ClientPublish, Capability.Parameters, Capability.Time)


class Row(NamedTuple):
    """Channel `name` shows what `convert` makes of `topic`."""

    name: str
    channel: Callable[..., Any]
    topic: Topic[Any]
    convert: Callable[[Any], Any]


def _camera(name: str, topic: Topic[Any]) -> tuple[Row, ...]:
    return (
        Row(f"viewer/{name}/image", channels.CompressedImageChannel, topic, drawing.image),
        Row(f"viewer/{name}/depth", channels.RawImageChannel, topic, drawing.depth),
        Row(f"viewer/{name}/calibration", channels.CameraCalibrationChannel, topic, drawing.calibration),
    )


ROWS = (
    Row("viewer/map", channels.GridChannel, topics.COSTMAP, drawing.grid),
    Row("viewer/scan", channels.LaserScanChannel, topics.SCAN, drawing.scan),
    Row("viewer/path", channels.PosesInFrameChannel, topics.NAV_PATH, drawing.path),
    Row("viewer/log", channels.LogChannel, topics.LOG, drawing.log),
    *_camera("head", topics.HEAD_RGBD),
    *_camera("wrist", topics.WRIST_RGBD),
)
"""Beside these, `viewer/tf` and `viewer/scene`, which are of several topics."""


class Channel(NamedTuple):
    """A channel that visitors may look at; without `convert` its messages go out as JSON."""

    out: Any
    topics: tuple[Topic[Any], ...]
    convert: Callable[[Any], Any] | None = None

    def show(self, message: Any, t: float) -> None:
        """Send a message of robot time `t` [s] to who looks.

        Raises:
            ValueError: it holds something else than it says.
        """
        shown = self.convert(message) if self.convert else msgspec.json.encode(message)
        self.out.log(shown, log_time=nanoseconds(t))


def nanoseconds(t: float) -> int:
    """Robot time [s] as channels are stamped; before its beginning there is none."""
    return max(0, round(t * 1e9))


class Server:
    """The WebSocket server, open from the start; `close` ends it.

    Raises:
        OSError: the port is taken.
    """

    def __init__(self, config: FoxgloveConfig, listener: Listener, shown: tuple[Topic[Any], ...]) -> None:
        self._context = foxglove.Context()
        made = [self._json(topic) for topic in shown if not topic.bulk]
        made += [Channel(row.channel(row.name, context=self._context), (row.topic,), row.convert) for row in ROWS]
        moving = (topics.ODOMETRY, topics.POSE, topics.JOINT_STATES, topics.ROBOT_DESCRIPTION, topics.SCAN)
        self.tf = Channel(channels.FrameTransformsChannel("viewer/tf", context=self._context), moving)
        drawn = (topics.ROBOT_DESCRIPTION, topics.WORLD_OBJECTS)
        self.scene = Channel(channels.SceneUpdateChannel("viewer/scene", context=self._context), drawn)
        self.channels: dict[int, Channel] = {int(c.out.id()): c for c in (*made, self.tf, self.scene)}
        try:
            self._server = foxglove.start_server(
                name=NAME,
                host=config.host,
                port=config.port,
                capabilities=[*CAPABILITIES],
                supported_encodings=["json"],
                server_listener=listener,
                context=self._context,
            )
        except RuntimeError as error:
            raise OSError(str(error)) from None
        self.url = f"ws://{config.host}:{self._server.port}"

    def _json(self, topic: Topic[Any]) -> Channel:
        kind: Any = topic.type
        schema = foxglove.Schema(name=f"tidybot.{topic.type.__name__}", encoding="jsonschema", data=schema_of(kind))
        out = foxglove.Channel(topic.key, schema=schema, message_encoding="json", context=self._context)
        return Channel(out, (topic,))

    def draw_home(self, household: Household, t: float) -> None:
        """Send the drawing of the home as the robot was told of it."""
        self._draw(drawing.home(household), t)

    def draw_robot(self, solids: list[Shape], t: float) -> None:
        """Send the drawing of the robot's links."""
        self._draw(drawing.robot(solids), t)

    def draw_objects(self, known: m.WorldObjects, gone: set[str]) -> None:
        """The objects that are known, without those labelled as in `gone`."""
        self._draw(drawing.objects(known, gone), known.t)

    def _draw(self, update: Any, t: float) -> None:
        self.scene.out.log(update, log_time=nanoseconds(t))

    def move(self, poses: list[FramePose], t: float) -> None:
        """Send the moving frames at robot time `t` [s]."""
        self.tf.out.log(drawing.frames(poses), log_time=nanoseconds(t))

    def tell_time(self, t: float) -> None:
        """Tell visitors the robot's time [s]."""
        self._server.broadcast_time(nanoseconds(t))

    def tell_parameters(self, values: dict[str, Any]) -> None:
        """Send the present parameters to visitors who subscribe to them."""
        self._server.publish_parameter_values([foxglove.Parameter(n, value=v) for n, v in values.items()])

    def warn(self, words: str) -> None:
        """Show a warning to every visitor."""
        self._server.publish_status(words, foxglove.StatusLevel.Warning)

    def close(self) -> None:
        self._server.stop()
