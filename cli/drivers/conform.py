"""`tidybot conform`: does a driver, simulated or of real hardware, serve what the rest of the robot relies on?

It is asked only over the bus. Times are the driver's own (`t` of joint_states), so that a slow simulation can pass.
"""

import argparse

from cli.drivers.driver import STALL, Driver, Unmet
from cli.drivers.requirements import LISTENING, MOVING
from cli.errors import CliError
from cli.link import linked, robot_command
from cli.output import show
from common import topics
from common.time.clock import monotonic, sleep

RIVALS = {"navigation", "manipulation", "brain"}
LISTEN = 2.0
"""Time [s] for which streams are counted: 20 messages of the slowest (10 Hz)."""


def examine(driver: Driver, move: bool) -> list[dict[str, object]]:
    """One row for each requirement: name, what it asks, met, why not."""
    end = monotonic() + STALL
    while not driver.heard[topics.JOINT_STATES.key] and monotonic() < end:
        sleep(0.05)
    rows: list[dict[str, object]] = []
    try:
        driver.wait(LISTEN)
    except Unmet as error:
        return [{"name": "joint_states", "asks": "joint_states that go on", "met": False, "why": str(error)}]
    for check in (*LISTENING, *(MOVING if move else ())):
        why = ""
        try:
            check(driver)
        except Unmet as error:
            why = str(error)
        rows.append({"name": check.__name__, "asks": check.__doc__, "met": not why, "why": why})
    return rows


def conform(args: argparse.Namespace) -> int:
    with linked(args) as link:
        rivals = sorted(link.alive() & RIVALS)
        if args.move and rivals:
            raise CliError(
                f"{', '.join(rivals)} would steer as well; start the driver alone: tidybot up --only router,sim"
            )
        rows = examine(Driver(link), args.move)
    lines = [f"{'ok    ' if row['met'] else 'FAILED'}  {row['name']:13} {row['why'] or row['asks']}" for row in rows]
    if not args.move:
        lines.append("not asked to move: `--move` adds driving 0.2 m, a turn of the wrist, the gripper and robot/stop")
    show(args, rows, lines)
    return 0 if all(row["met"] for row in rows) else 1


def register(commands: "argparse._SubParsersAction[argparse.ArgumentParser]") -> None:
    parser = robot_command(
        commands, conform, "does a driver (simulated or real) serve what the robot relies on?", json=True
    )
    parser.add_argument(
        "--move", action="store_true", help="let it move too: 0.3 m of free floor are needed all around"
    )
