"""The command line's access to the bus: a session, latched values, queries and subscriptions."""

import argparse
import os
import queue
import uuid
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any, Generic, TypeVar

import msgspec

from cli.errors import CliError
from cli.processes.supervision import Supervision, run_dir
from common import messages as m
from common import topics
from common.bus import codec, delivery
from common.bus.session import default_connect, open_session
from common.security.access import OPERATOR
from common.security.keys import OFF
from common.time.clock import monotonic
from common.topic import Topic

M = TypeVar("M", bound=m.Message)
A = TypeVar("A", bound=m.Message)
FIRST = 3.0
"""Time [s] for a value that is there already to come over a fresh link."""


class Link:
    """An open session with the operations that commands need."""

    def __init__(self, session: Any, connect: str, namespace: str = "") -> None:
        self.session, self.connect, self.namespace = session, connect, namespace

    def latest(self, topic: Topic[M]) -> M | None:
        """The latched value, None when its writer does not answer."""
        for payload in delivery.fetch(self.session, topic.key).values():
            try:
                return codec.decode(topic, payload)
            except codec.DecodeError as error:
                raise CliError(f"{topic.key}: {error}") from None
        return None

    def present(self, topic: Topic[M]) -> M:
        """The latched value.

        Raises:
            CliError: its writer does not answer.
        """
        if (value := self.latest(topic)) is None:
            raise unanswered(topic)
        return value

    def alive(self) -> set[str]:
        """Names of the services whose liveliness token is seen."""
        replies = self.session.liveliness().get(topics.ALIVE_KEY.format(name="*"), timeout=2.0)
        return {str(r.ok.key_expr).split("/")[1] for r in replies if r.ok is not None}

    def health(self) -> dict[str, m.Health]:
        """The last health record of every live service."""
        found = {}
        for payload in delivery.fetch(self.session, topics.HEALTH.key).values():
            try:
                record = codec.decode_as(m.Health, payload)
            except codec.DecodeError:
                continue
            found[record.name] = record
        return found

    def send(self, topic: Topic[M], message: M) -> None:
        delivery.send(self.session, topic, message)

    def ask(self, topic: Topic[M], request: M, answers: Topic[A], seconds: float, who: str) -> A:
        """The answer whose `goal_id` is the request's id.

        Raises:
            CliError: `who` has not answered within `seconds`.
        """
        watch = Subscription(self, answers)
        self.send(topic, request)
        answer = watch.until(lambda one: one.goal_id == request.id, seconds)  # type: ignore[attr-defined]
        if answer is None:
            raise CliError(f"{who} did not answer within {seconds:.0f} s; see `tidybot ps`")
        return answer

    def picture(self, camera: m.CameraName, width: int, height: int, seconds: float) -> m.Rgbd:
        """A fresh picture of a camera in that size [pixels].

        Raises:
            CliError: it has not come within `seconds`.
        """
        watch, wanted = Subscription(self, topics.PICTURES[camera]), fresh_id()
        self.send(topics.CAMERA_REQUEST, m.CameraRequest(id=wanted, camera=camera, width=width, height=height))
        seen = watch.until(lambda one: one.id == wanted, seconds)
        if seen is None:
            raise CliError(f"no picture of the {camera} camera within {seconds:.0f} s; see `tidybot logs camera`")
        return seen

    def query(self, key: str, request: dict[str, object] | None = None) -> Any:
        """The JSON answer of a queryable.

        Raises:
            CliError: nobody answers.
        """
        payload = msgspec.json.encode(request) if request is not None else b""
        answers = delivery.fetch(self.session, key, payload, timeout=5.0)
        if not answers:
            raise CliError(f"nothing answers on {key}; is the simulation up? See `tidybot ps`")
        return msgspec.json.decode(next(iter(answers.values())))


class Subscription(Generic[M]):
    """Subscription to one topic; a latched one yields its present value first, and again after an outage."""

    REFRESH = 2.0
    """Silence [s] after which the present value is asked for: an outage of the router may have cost one."""

    def __init__(self, link: Link, topic: Topic[M]) -> None:
        self._link, self.topic = link, topic
        self._inbox: queue.SimpleQueue[bytes] = queue.SimpleQueue()
        self.last: M | None = None
        self._kept = link.session.declare_subscriber(topic.key, lambda s: self._inbox.put(s.payload.to_bytes()))
        self._refreshed = float("-inf")

    def next(self, timeout: float) -> M | None:
        """The next message; None after `timeout` seconds without one."""
        end = monotonic() + timeout
        while True:
            if self.topic.latched and self._inbox.empty() and monotonic() - self._refreshed > self.REFRESH:
                self._refreshed = monotonic()
                present = self._link.latest(self.topic)
                if present is not None and present != self.last and self._inbox.empty():
                    self.last = present
                    return present
            try:
                payload = self._inbox.get(timeout=min(0.2, max(0.0, end - monotonic())))
                self.last = codec.decode(self.topic, payload)
                self._refreshed = monotonic()
                return self.last
            except (queue.Empty, codec.DecodeError):
                if monotonic() >= end:
                    return None

    def drain(self) -> Iterator[M]:
        """The messages that have arrived already."""
        while (message := self.next(0.0)) is not None:
            yield message

    def until(self, wanted: Callable[[M], bool], seconds: float) -> M | None:
        """The first message that is `wanted`; None when none comes within so many seconds."""
        end = monotonic() + seconds
        while (left := end - monotonic()) > 0.0:
            if (message := self.next(min(left, 0.2))) is not None and wanted(message):
                return message
        return None

    def first(self) -> M:
        """The present value of a latched topic, when the link is fresh.

        Raises:
            CliError: its writer does not answer.
        """
        if (value := self.next(FIRST)) is None:
            raise unanswered(self.topic)
        return value

    def close(self) -> None:
        self._kept.undeclare()


def unanswered(topic: Topic[Any]) -> CliError:
    """The error for a latched topic whose writer does not answer."""
    return CliError(f"{topic.writers[0]} does not answer; see `tidybot ps`")


def add_options(parser: argparse.ArgumentParser) -> None:
    """`--connect` and `--namespace` for commands that talk to the robot."""
    which = parser.add_argument_group("which robot")
    which.add_argument("--connect", metavar="ENDPOINTS", help="router endpoints (default: the run's, TIDYBOT_CONNECT)")
    which.add_argument("--namespace", metavar="NAME", help="the robot's namespace (default: TIDYBOT_NAMESPACE)")


def robot_command(
    commands: "argparse._SubParsersAction[argparse.ArgumentParser]",
    run: Callable[[argparse.Namespace], int],
    what: str,
    json: bool = False,
    **more: Any,
) -> argparse.ArgumentParser:
    """The parser of a command that talks to the robot, called like its function; `what` it does, for the help."""
    parser = commands.add_parser(run.__name__, help=what, **more)
    parser.set_defaults(run=run)
    if json:
        parser.add_argument("--json", action="store_true", help="as JSON")
    add_options(parser)
    return parser


def address(args: argparse.Namespace) -> tuple[str, str]:
    """Endpoints and namespace: options, then environment, then the run that is up, then the default."""
    connect = getattr(args, "connect", None) or os.environ.get("TIDYBOT_CONNECT")
    namespace = getattr(args, "namespace", None)
    if namespace is None:
        namespace = os.environ.get("TIDYBOT_NAMESPACE")
    if connect is None:
        try:
            info = Supervision(run_dir()).info()
        except CliError:
            return default_connect(), namespace or ""
        use_keys(info.keys or OFF)
        return info.connect, info.namespace if namespace is None else namespace
    return connect, namespace or ""


def use_keys(directory: str) -> None:
    """Show certificates from there on, unless the environment says otherwise already."""
    os.environ.setdefault("TIDYBOT_KEYS", directory)


@contextmanager
def linked(args: argparse.Namespace, name: str = OPERATOR) -> Iterator[Link]:
    """A link to the robot, under the certificate of `name` where there are keys.

    Raises:
        BusError: no router, or a bad endpoint.
    """
    connect, namespace = address(args)
    with open_session(connect, namespace, name=name) as session:
        yield Link(session, connect)


def fresh_id() -> str:
    """An id of a request from here."""
    return f"cli-{uuid.uuid4().hex[:8]}"


def known_keys() -> list[str]:
    """All keys of the topic table, including those of each process."""
    return [t.key for t in topics.TABLE]
