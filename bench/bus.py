"""Round trips through the router: a typed message and its typed answer, against raw zenoh in the same run."""

import subprocess
import sys
import tempfile
import threading
import time
from collections.abc import Callable
from pathlib import Path
from statistics import median

from common import messages as m
from common import topics
from common.bus import codec
from common.bus.delivery import Publisher
from common.bus.session import open_session
from evaluation.site import Site, site

ROUNDS = 1000
"""Round trips of a measurement, of which the first tenth is left out."""
PAIRS = 5
"""Measurements, of which the median counts."""
PING, PONG = topics.NAVIGATION_GOAL, topics.NAVIGATION_STATUS


def echo(connect: str, namespace: str, raw: bool) -> None:
    """The answering process: answers every message until it is ended."""
    with open_session(connect, namespace) as session:
        publisher = session.declare_publisher("raw/pong") if raw else Publisher(session, PONG)

        def answer(payload: bytes) -> None:
            if raw:
                publisher.put(payload)  # type: ignore[call-arg]
                return
            goal = codec.decode(PING, payload)
            status = m.NavigationStatus(status="arrived", goal_id=goal.id, attempt=goal.attempt)
            publisher.put(codec.encode(PONG, status), None)  # type: ignore[call-arg, arg-type]

        session.declare_subscriber("raw/ping" if raw else PING.key, lambda s: answer(s.payload.to_bytes()))
        threading.Event().wait()


def rounds(here: Site, raw: bool) -> list[float]:
    """Durations [s] of the round trips."""
    command = [sys.executable, "-m", "bench.bus", "--echo", here.connect, here.namespace, str(int(raw))]
    here.processes.append(subprocess.Popen(command))
    times: list[float] = []
    with here.session() as session:
        arrived = threading.Event()

        def receive(payload: bytes) -> None:
            if not raw:
                codec.decode(PONG, payload)
            arrived.set()

        session.declare_subscriber("raw/pong" if raw else PONG.key, lambda s: receive(s.payload.to_bytes()))
        publisher = session.declare_publisher("raw/ping") if raw else Publisher(session, PING)
        payload = codec.encode(PING, m.NavigationGoal(goal="find red mug", id="m.1"))

        def send(n: int) -> None:
            if raw:
                publisher.put(payload)  # type: ignore[call-arg]
            else:
                goal = m.NavigationGoal(goal="find red mug", id=f"m.{n}")
                publisher.put(codec.encode(PING, goal), None)  # type: ignore[call-arg, arg-type]

        _until(lambda: send(0), arrived)
        for n in range(ROUNDS):
            arrived.clear()
            began = time.perf_counter()
            send(n)
            arrived.wait(5.0)
            times.append(time.perf_counter() - began)
    here.processes.pop().kill()
    return times[ROUNDS // 10 :]


def _until(send: Callable[[], None], arrived: threading.Event) -> None:
    while not arrived.wait(0.2):
        send()


def main() -> None:
    pairs = []
    with tempfile.TemporaryDirectory() as folder, site(Path(folder)) as here:
        for _ in range(PAIRS):
            pairs.append((median(rounds(here, raw=True)), median(rounds(here, raw=False))))
    raw, typed = (median(column) for column in zip(*pairs, strict=True))
    ratio = median(b / a for a, b in pairs)
    print(f"{'round trip, p50':20} {'us':>8} {'ratio':>6}")
    print(f"{'raw zenoh':20} {raw * 1e6:8.0f} {1.0:6.2f}")
    print(f"{'typed bus':20} {typed * 1e6:8.0f} {ratio:6.2f}")


if __name__ == "__main__":
    if sys.argv[1:2] == ["--echo"]:
        echo(sys.argv[2], sys.argv[3], sys.argv[4] == "1")
    main()
