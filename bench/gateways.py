"""CPU time of the gateways to ROS 2 and Foxglove with and without a listener, as shares of a core.

The simulation runs in real time beside them; CPU time is of the gateway's process alone. A ROS listener takes
`joint_states`, `tf`, `scan` and `odom`; a visitor of Foxglove the same and the scene.
"""

import argparse
import tempfile
import time
from collections.abc import Callable
from contextlib import AbstractContextManager, contextmanager
from pathlib import Path
from typing import Any

import psutil  # type: ignore[import-untyped]

from bench.peers.foxglove import FoxgloveClient
from bench.peers.ros import ros_peer
from cli.processes.ports import free_port
from evaluation.site import Site, eventually, site

SENSORS = {
    "joint_states": "sensor_msgs/msg/JointState",
    "tf": "tf2_msgs/msg/TFMessage",
    "scan": "sensor_msgs/msg/LaserScan",
    "odom": "nav_msgs/msg/Odometry",
}
SHOWN = ("joint_states", "base/odom", "viewer/tf", "viewer/scan", "viewer/scene")


@contextmanager
def ros_listener(here: Site, folder: Path) -> Any:
    with ros_peer(
        folder / "definitions", here.port, f"/{here.namespace.replace('-', '_')}", [*SENSORS.values()]
    ) as peer:
        for name, kind in SENSORS.items():
            peer.listen(name, kind)
        eventually(lambda: all(peer.heard.values()), "everything arrives")
        yield lambda: sum(map(len, peer.heard.values()))


@contextmanager
def visitor(port: int) -> Any:
    client = FoxgloveClient(f"ws://127.0.0.1:{port}")
    try:
        eventually(lambda: set(SHOWN) <= {*client.channels}, "the channels are there")
        client.watch(*SHOWN)
        eventually(lambda: all(client.heard[name] for name in SHOWN), "everything arrives")
        yield lambda: sum(map(len, client.heard.values()))
    finally:
        client.close()


def share(pid: int, seconds: float, count: Callable[[], int] = lambda: 0) -> tuple[float, float]:
    """CPU time of a process as a part of a core, and messages a second."""
    process = psutil.Process(pid)
    before, heard, began = process.cpu_times(), count(), time.perf_counter()
    time.sleep(seconds)
    after, wall = process.cpu_times(), time.perf_counter() - began
    return (after.user + after.system - before.user - before.system) / wall, (count() - heard) / wall


def report(name: str, here: Site, pid: int, seconds: float, listener: AbstractContextManager[Any]) -> None:
    """Two rows of the table."""
    idle, _ = share(pid, seconds)
    print(f"{name + ', nobody listens':34} {100 * idle:6.1f} % of a core", flush=True)
    with listener as count:
        busy, rate = share(pid, seconds, count)
    print(f"{name + ', a listener':34} {100 * busy:6.1f} % of a core  {rate:6.0f} messages a second", flush=True)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--seconds", type=float, default=10.0, help="of each measurement (default %(default)s)")
    args = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder, site(Path(folder)) as here, here.session() as session:
        port = free_port()
        here.start("services.sim")
        started = {
            name: here.start(f"services.{name}", TIDYBOT__FOXGLOVE__PORT=str(port)) for name in ("ros2", "foxglove")
        }
        here.wait_alive(session, "sim", *started)
        time.sleep(2.0)
        report("ros2", here, started["ros2"].pid, args.seconds, ros_listener(here, Path(folder)))
        report("foxglove", here, started["foxglove"].pid, args.seconds, visitor(port))


if __name__ == "__main__":
    main()
