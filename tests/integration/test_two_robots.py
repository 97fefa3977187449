"""Two whole robots in one simulated flat on one router: the best one is sent, a process and then a robot is killed."""

import math
import os
import signal
from collections.abc import Iterator
from contextlib import ExitStack
from pathlib import Path

import pytest

from cli.fleet.dispatch import Dispatch
from cli.fleet.robots import Desk
from cli.link import Link
from common import topics
from common.bus.session import open_session
from evaluation.site import eventually
from tests.integration.test_cli_up import Run

pytestmark = [pytest.mark.long, pytest.mark.slow]

ANNA, BERT = "anna", "bert"
AT = "x = -1.5, y = -1.2, theta = -1.57"
"""Where bert starts: before the living table with both things, of which anna knows nothing."""
WORLD = """
plan = "apartment"
objects = [
  { name = "red mug", kind = "mug", colour = "red", size = [0.074, 0.074, 0.095], mass = 0.3, rgba = [0.8, 0.1, 0.1, 1], on = "living table" },
  { name = "green can", kind = "can", colour = "green", size = [0.066, 0.066, 0.115], mass = 0.3, rgba = [0.1, 0.6, 0.2, 1], on = "living table" },
]
"""  # noqa: E501
DRIVEN = 1.0
"""Way [m] from which a robot is under way, and what others have to get to is no longer behind it."""


class Flat:
    """One run for each robot, and a desk that sees both; the simulation is anna's."""

    def __init__(self, directory: Path, stack: ExitStack) -> None:
        self.runs = {name: Run(directory / name) for name in (ANNA, BERT)}
        for run in self.runs.values():
            run.port = self.runs[ANNA].port
            stack.callback(run.close)
        world = directory / "flat.toml"
        world.write_text(WORLD)
        guest = f'sim.guests=[{{ name = "{BERT}", {AT} }}]'
        self.up(ANNA, "dashboard", "--world", str(world), "--household", "apartment", "--set", guest)
        self.up(BERT, "dashboard,sim,router", "--household", "apartment", "--set", "navigation.initial_pose=unknown")
        self.desk = Desk(stack.enter_context(open_session(f"tcp/127.0.0.1:{self.runs[ANNA].port}", prefixed=False)))

    def up(self, name: str, without: str, *words: str) -> None:
        fixed = ("--namespace", name, "--without", without, "--speed", "max", "--seed", "1")
        done = self.runs[name].detached(*fixed, *words)
        assert done.returncode == 0, done.stdout + done.stderr

    def free(self) -> set[str]:
        return {robot.name for robot in self.desk.look() if robot.free}

    def begin(self, text: str, best: str) -> Dispatch:
        """A command that `best` takes up, and drives off for."""
        order = Dispatch(self.desk, text)
        assert order.offer() and order.by == best, order.candidates
        self.drives(best)
        return order

    def drives(self, name: str) -> None:
        start = self.place(name)
        eventually(lambda: math.dist(self.place(name), start) > DRIVEN, f"{name} drives", 120)

    def place(self, name: str) -> tuple[float, float]:
        pose = eventually(lambda: self.desk.look({name}, objects=False)[0].pose, f"{name} says where it is")
        return pose[0], pose[1]

    def end(self, order: Dispatch, thing: str) -> None:
        """It is followed to its end, and by physics the thing is where it belongs."""
        eventually(lambda: order.follow(True), f"{order.text!r} has ended", 300)
        assert order.outcome is not None and order.outcome.outcome == "delivered", order.outcome
        with open_session(f"tcp/127.0.0.1:{self.runs[ANNA].port}", ANNA) as session:
            truth = Link(session, "").query(topics.SIM_TRUTH)
        assert truth["objects"][thing]["on"] == "delivery tray", truth["objects"][thing]


@pytest.fixture
def flat(tmp_path: Path) -> Iterator[Flat]:
    with ExitStack() as stack:
        yield Flat(tmp_path, stack)


@pytest.mark.timeout(900)
def test_the_best_one_delivers_through_a_kill_and_the_other_takes_over_when_all_of_it_dies(flat: Flat) -> None:
    eventually(lambda: flat.free() == {ANNA, BERT}, "both take commands", 60)
    eventually(lambda: {"red mug", "green can"} <= set(flat.desk.look({BERT})[0].knows), "bert sees both things", 60)
    # One process of the best robot is killed on the way; its supervisor brings it back.
    first = flat.begin("bring me the red mug", BERT)
    navigation = flat.runs[BERT].rows()["navigation"]
    os.kill(int(str(navigation["pid"])), signal.SIGKILL)
    flat.end(first, "red mug")
    assert first.by == BERT and not first.lost
    # At once the next one: it is still the best while it reports on the last.
    second = flat.begin("bring me the green can", BERT)
    # Everything of it dies on the way; the other one, which has never seen the can, goes round what is left of it.
    flat.runs[BERT].close()
    flat.end(second, "green can")
    assert (second.by, second.lost) == (ANNA, [BERT])
