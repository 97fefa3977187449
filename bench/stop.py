"""How fast `robot/stop` stops the base: `python -m bench.stop --trials 200`.

The simulation alone, no other service alive, drives at full speed on a stream of velocities. At a random moment a
client puts `robot/stop`; the table counts robot time from that moment. The peer lets the stream fall silent instead,
which is what stops a robot whose driver has died.
"""

import argparse
import math
import sys

import numpy as np

from common import messages as m
from common import topics
from evaluation.stack import Stack, paced_services

HALF, REST = 0.25, 0.01
"""Speeds [m/s] that count as half and as rest."""
FULL = 0.5
"""Speed [m/s] from which it is stopped."""
LIMIT = 3.0
"""Robot time [s] that is waited for rest."""


def trial(stack: Stack, rng: np.random.Generator, stop: bool) -> tuple[float, float, float]:
    """Seconds from the stop (or from the last velocity) to half speed and to rest, and the distance [m]."""
    # Sideways from home there is room.
    heading = rng.choice((-1, 1)) * rng.uniform(math.radians(75), math.radians(105))
    twist = m.CmdVel(vx=FULL * math.cos(heading), vy=FULL * math.sin(heading), omega=0.0)
    stack.sim.physics.reset()
    stack.bus.get(topics.SIM_RESET, b"{}")
    stack.bus.send(topics.ROBOT_RESUME, m.RobotResume(source="bench"))
    driven = 0
    # Full speed for a random while: stops come at any phase of the stream.
    while speed(stack) < 0.9 * FULL or driven < 60 + int(rng.integers(10)):
        if driven % 5 == 0:
            stack.bus.send(topics.CMD_VEL, twist)
        stack.tick()
        driven += 1
        if driven > 300:
            raise SystemExit("the base never reached full speed")
    if stop:
        stack.bus.send(topics.ROBOT_STOP, m.RobotStop(reason="bench", source="bench"))
    began, start = stack.now, place(stack)
    half = rest = math.nan
    while stack.now - began < LIMIT and math.isnan(rest):
        stack.tick()
        if math.isnan(half) and speed(stack) <= HALF:
            half = stack.now - began
        if speed(stack) <= REST:
            rest = stack.now - began
    end = place(stack)
    return half, rest, math.dist(start, end)


def speed(stack: Stack) -> float:
    return float(np.hypot(*stack.sim.physics.rates[:2]))


def place(stack: Stack) -> tuple[float, float]:
    x, y, *_ = stack.sim.physics.joints.tolist()
    return x, y


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--trials", type=int, default=200)
    parser.add_argument("--seed", type=int, default=0)
    args = parser.parse_args()
    rng = np.random.default_rng(args.seed)
    print(f"{args.trials} stops from {FULL} m/s, robot time, every other service dead")
    print(f"{'':24} {'half speed ms':>22} {'rest ms':>22} {'distance cm':>16}")
    print(f"{'':24} {'p50':>10} {'p99':>11} {'p50':>10} {'p99':>11} {'p50':>8} {'p99':>7}")
    stack = Stack("apartment", seed=args.seed, without=paced_services())
    try:
        for name, stop in (("robot/stop", True), ("the stream falls silent", False)):
            rows = np.array([trial(stack, rng, stop) for _ in range(args.trials)])
            half, rest, distance = (np.percentile(rows[:, i], (50, 99)) for i in range(3))
            print(
                f"{name:24} {half[0] * 1e3:10.0f} {half[1] * 1e3:11.0f} {rest[0] * 1e3:10.0f} {rest[1] * 1e3:11.0f} "
                f"{distance[0] * 100:8.1f} {distance[1] * 100:7.1f}"
            )
    finally:
        stack.close()
    return 0


if __name__ == "__main__":
    sys.exit(main())
