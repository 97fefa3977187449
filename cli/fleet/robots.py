"""Discovery of all reachable robots, whatever their namespaces, and their states."""

from typing import Any, TypeVar

import msgspec
import zenoh
from zenoh import handlers

from common import messages as m
from common import topics
from common.bus import codec, delivery
from common.mission_log.states import under_way
from common.topic import Topic

M = TypeVar("M", bound=m.Message)
BRAIN_ALIVE = topics.ALIVE_KEY.format(name="brain")
ANSWER = 1.0
"""How long a robot's answer is waited for [s]; chosen: many round trips over WiFi, and a look a second."""
TOLD: dict[str, Topic[Any]] = {
    "brain": topics.BRAIN_STATE,
    "pose": topics.POSE,
    "sim": topics.SIM_STATUS,
    "battery": topics.BATTERY,
    "world": topics.WORLD_OBJECTS,
}
"""What a robot is asked for, by the argument of `robot`."""


class RobotNow(msgspec.Struct, frozen=True, kw_only=True):
    """The state of one robot; what it does not publish is None or empty.

    `name` is its namespace. `battery` from 0 to 1. `braked`: somebody has stopped it. `question`: what it asks a person
    and waits for. `knows`: labels of the objects it knows of with where they are (x, y) [m, map]. `holding`: the label
    of what is in its hand.
    """

    name: str
    state: str = ""
    detail: str = ""
    command: str = ""
    command_id: str = ""
    mission_id: str = ""
    last: m.MissionOutcome | None = None
    pose: tuple[float, float, float] | None = None
    battery: float | None = None
    braked: bool = False
    question: str = ""
    holding: str = ""
    knows: dict[str, tuple[float, float]] = {}

    @property
    def free(self) -> bool:
        """True when the robot would take a command now."""
        return self.state in m.OPEN_STATES and not self.braked


class Desk:
    """A session outside of all namespaces, which asks every robot in turn what only it knows."""

    def __init__(self, session: zenoh.Session) -> None:
        self.session = session

    def names(self) -> set[str]:
        """The namespaces of the robots whose brain is alive."""
        replies = self.session.liveliness().get(f"**/{BRAIN_ALIVE}", timeout=2.0)
        keys = (str(r.ok.key_expr) for r in replies if r.ok is not None)
        return {key.removesuffix(BRAIN_ALIVE).rstrip("/") for key in keys}

    def look(self, among: set[str] | None = None, *, objects: bool = True) -> list[RobotNow]:
        """The state of every robot, or of those in `among`; one that does not answer in time has none."""
        names = sorted(self.names() if among is None else among)
        asked = {k: t for k, t in TOLD.items() if objects or k != "world"}
        # All at once: the slowest answer is waited for, not their sum.
        replies = {name: {k: self._get(name, t) for k, t in asked.items()} for name in names}
        return [robot(name, **{k: _first(asked[k], heard) for k, heard in replies[name].items()}) for name in names]

    def state(self, name: str) -> m.BrainState | None:
        """The robot's `brain/state`, None when it does not answer."""
        return _first(topics.BRAIN_STATE, self._get(name, topics.BRAIN_STATE))

    def send(self, name: str, topic: Topic[M], message: M) -> None:
        """One message to one robot."""
        payload = codec.encode(topic, message)
        self.session.put(below(name, topic.key), payload, encoding=codec.encoding_of(topic))

    def listen(self, name: str, topic: Topic[M], receive: Any) -> Any:
        """Call `receive(message)` for what the robot publishes from now on; keep what comes back."""

        def decode(sample: zenoh.Sample) -> None:
            try:
                receive(codec.decode(topic, sample.payload.to_bytes()))
            except codec.DecodeError:
                return

        return delivery.listen(self.session, below(name, topic.key), decode)

    def _get(self, name: str, topic: Topic[Any]) -> Any:
        return self.session.get(below(name, topic.key), handlers.FifoChannel(16), timeout=ANSWER)


def below(name: str, key: str) -> str:
    """A key of the robot as seen from outside of its namespace."""
    return f"{name}/{key}" if name else key


def _first(topic: Topic[M], replies: Any) -> M | None:
    for reply in replies:
        if reply.ok is not None:
            try:
                return codec.decode(topic, reply.ok.payload.to_bytes())
            except codec.DecodeError:
                continue
    return None


def robot(
    name: str,
    brain: m.BrainState | None = None,
    pose: m.PoseEstimate | None = None,
    sim: m.SimStatus | None = None,
    battery: m.BatteryState | None = None,
    world: m.WorldObjects | None = None,
) -> RobotNow:
    """The state of one robot from its answers."""
    objects = world.objects if world is not None else []
    now = RobotNow(
        name=name,
        pose=(pose.x, pose.y, pose.theta) if pose is not None else None,
        battery=battery.charge if battery is not None else None,
        braked=sim is not None and sim.state == "stopped",
        holding=next((o.label for o in objects if o.held), ""),
        knows={n: (o.position[0], o.position[1]) for o in objects if not o.held for n in (o.label, *o.names)},
    )
    if brain is None:
        return now
    return msgspec.structs.replace(
        now,
        state=brain.state,
        detail=brain.detail,
        command=brain.command if under_way(brain) else "",
        question=brain.step if brain.state == "CONFIRMING" else "",
        command_id=brain.command_id,
        mission_id=brain.mission_id,
        last=brain.last,
    )
