"""A stream on the bus and the names of joints, for tests; processes are those of `evaluation.site`."""

import threading
from pathlib import Path

import zenoh

from common.robot.joints import ARM, BASE

ROOT = Path(__file__).resolve().parent.parent
JOINT_NAMES = (*BASE, *ARM, "gripper")
"""What `joint_states` tells of, in this order."""


class Pulse(threading.Thread):
    """Puts its `payload` on a key every 50 ms, as a driver's stream, from `start` to `stop`; not while `silent`."""

    def __init__(self, opened: zenoh.Session, key: str, payload: str) -> None:
        super().__init__(daemon=True)
        self._publisher, self.payload = opened.declare_publisher(key), payload
        self._ended = threading.Event()
        self.silent = False

    def run(self) -> None:
        while not self._ended.wait(0.05):
            if not self.silent:
                self._publisher.put(self.payload)

    def stop(self) -> None:
        self._ended.set()
        self.join()
        self._publisher.undeclare()
