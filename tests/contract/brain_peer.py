"""The real brain process and a scripted peer that knows nothing but zenoh and JSON."""

import json
import time
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from typing import Any, TypeVar

import zenoh

from evaluation.site import Site
from tests.support import Pulse

JOINTS = {"t": 0.0, "name": ["base_x"], "position": [0.0], "velocity": [0.0], "effort": [0.0]}


class BrainPeer:
    """Plays every other node."""

    def __init__(self, session: zenoh.Session) -> None:
        self.session = session
        self.joints = Pulse(session, "joint_states", json.dumps(JOINTS))

    def receive(self, sample: zenoh.Sample) -> None:
        """Take what the brain has sent."""
        raise NotImplementedError

    def raw(self, key: str, payload: str | bytes) -> float:
        """Send a payload; the moment [s] just before."""
        now = time.monotonic()
        self.session.put(key, payload)
        return now

    def put(self, key: str, **fields: Any) -> float:
        return self.raw(key, json.dumps(fields))

    def answer(self, key: str, goal: dict[str, Any], **fields: Any) -> float:
        return self.put(key, goal_id=goal["id"], attempt=goal["attempt"], **fields)

    def heard(self, goal: dict[str, Any], text: str) -> float:
        return self.answer("brain/speech_result", goal, text=text)

    def drove(self, goal: dict[str, Any], status: str = "arrived", **more: Any) -> float:
        return self.answer("brain/navigation_status", goal, status=status, **more)

    def did(self, goal: dict[str, Any], status: str = "done", **more: Any) -> float:
        return self.answer("brain/manipulation_status", goal, status=status, **more)


P = TypeVar("P", bound=BrainPeer)


@contextmanager
def brain(
    here: Site, kind: Callable[[zenoh.Session], P], pipeline: str, keys: Iterable[str], joints: bool = True, **more: str
) -> Iterator[P]:
    """A brain with more parameters, and its peer, which subscribes to some keys."""
    with here.session() as session:
        peer = kind(session)
        subscribers = [session.declare_subscriber(key, peer.receive) for key in keys]
        # Nobody speaks here: the brain waits for as long as a sentence would take, or this long.
        parameters = {"pipeline": pipeline, "say_timeout": "1.0", **more}
        changes = {f"TIDYBOT__BRAIN__{k.upper()}": v for k, v in parameters.items()}
        process = here.start("services.brain", TIDYBOT_CLOCK="wall", **changes)
        here.wait_alive(session, "brain")
        if joints:
            peer.joints.start()
        yield peer
        peer.joints.stop()
        assert process.poll() is None, here.log("services.brain")
        for subscriber in subscribers:
            subscriber.undeclare()
