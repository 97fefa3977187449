"""Several brains on one router, each with a body of joint states and a pose: who is there, and who gets the command."""

import json
import signal
import threading
import zlib
from collections.abc import Iterator
from contextlib import ExitStack
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import zenoh

from cli.fleet.dispatch import Dispatch
from cli.fleet.robots import Desk, RobotNow
from cli.fleet.watch_room import WatchRoom
from cli.main import main
from common import messages as m
from common import topics
from common.bus import codec
from common.bus.session import open_session
from common.topic import Topic
from evaluation.site import Site, eventually, site

MUG = m.WorldObject(label="red mug", kind="mug", colour="red", position=(3.0, 0.0, 0.5))
TEXT = "bring me the red mug"


class Body:
    """What a robot's other services tell of it, so that its brain takes commands and the desk can choose."""

    def __init__(self, stack: ExitStack, router: Site, name: str, x: float, knows: bool = True) -> None:
        self.name, self._site = name, router
        config = zenoh.Config.from_json5(f'{{mode: "client", connect: {{endpoints: ["{router.connect}"]}}}}')
        config.insert_json5("namespace", json.dumps(name))
        self.session = stack.enter_context(zenoh.open(config))
        self.heard: list[m.VoiceCommand] = []
        self.plans: list[m.PlanRequest] = []
        peers = ("speech", "planner", "navigation", "manipulation", "perception")
        self._tokens = [self.session.liveliness().declare_token(topics.ALIVE_KEY.format(name=n)) for n in peers]
        self._kept = [
            self._listen(topics.VOICE_COMMAND, self.heard.append),
            self._listen(topics.PLAN_REQUEST, self.plans.append),
            self._listen(topics.SPEECH_GOAL, lambda goal: None),
            self._answer(topics.POSE, m.PoseEstimate(t=0.0, x=x, y=0.0, theta=0.0)),
            self._answer(topics.WORLD_OBJECTS, m.WorldObjects(t=0.0, objects=[MUG] if knows else [])),
            self._answer(topics.BATTERY, m.BatteryState(t=0.0, charge=0.8)),
        ]
        self._over = threading.Event()
        self._beat = threading.Thread(target=self._live)
        self._beat.start()
        stack.callback(self._end)
        self.start()

    def start(self) -> None:
        state = str(self._site.log_dir / f"state-{self.name}")
        extra = {"TIDYBOT_NAMESPACE": self.name, "TIDYBOT_CLOCK": "wall", "TIDYBOT_STATE_DIR": state}
        self.brain = self._site.start("services.brain", **extra)

    def _live(self) -> None:
        joints = m.JointStates(t=0.0, name=["base_x"], position=[0.0], velocity=[0.0], effort=[0.0])
        cells = zlib.compress(np.full((40, 200), 255, np.uint8).tobytes())
        free = m.Costmap(t=0.0, x=-10.0, y=-2.0, resolution=0.1, width=200, height=40, far=2.0, cells=cells)
        while not self._over.wait(0.05):
            self.session.put(topics.COSTMAP.key, codec.encode(topics.COSTMAP, free))
            self.session.put(topics.JOINT_STATES.key, codec.encode(topics.JOINT_STATES, joints))

    def _end(self) -> None:
        self._over.set()
        self._beat.join()

    def _listen(self, topic: Topic[Any], take: Any) -> Any:
        return self.session.declare_subscriber(topic.key, lambda s: take(codec.decode(topic, s.payload.to_bytes())))

    def _answer(self, topic: Topic[Any], message: m.Message) -> Any:
        return self.session.declare_queryable(topic.key, lambda q: q.reply(topic.key, codec.encode(topic, message)))


@pytest.fixture
def router(tmp_path: Path) -> Iterator[Site]:
    with site(tmp_path) as opened:
        yield opened


@pytest.fixture
def desk(router: Site) -> Iterator[Desk]:
    with open_session(router.connect, prefixed=False) as opened:
        yield Desk(opened)


def ready(desk: Desk, count: int) -> list[RobotNow]:
    """Every robot, once all of them take commands."""

    def all_wait() -> list[RobotNow]:
        rows = desk.look()
        return rows if len([r for r in rows if r.free]) == count else []

    return eventually(all_wait, f"{count} robots wait for commands", 30)


def say(desk: Desk, lines: list[str]) -> Dispatch:
    order = Dispatch(desk, TEXT, tell=lines.append)
    order.offer()
    return order


def test_the_command_goes_to_the_best_one_and_to_no_other(
    router: Site, desk: Desk, capsys: pytest.CaptureFixture[str]
) -> None:
    with ExitStack() as stack:
        near, far = Body(stack, router, "near", 2.0), Body(stack, router, "far", -4.0)
        rows = ready(desk, 2)
        assert [(r.name, r.pose, r.battery) for r in rows] == [("far", (-4.0, 0, 0), 0.8), ("near", (2.0, 0, 0), 0.8)]
        first = say(desk, [])
        assert first.by == "near" and [c.name for c in first.candidates] == ["near", "far"]
        assert len(near.heard) == 1 and not far.heard and near.heard[0].id == first.id
        # The next best takes the next one, and then nobody is left.
        second = say(desk, [])
        assert second.by == "far" and "is busy" in second.candidates[-1].why
        third = say(desk, [])
        assert third.by is None and [c.why for c in third.candidates] == [f"is busy: {TEXT}"] * 2
        assert len(near.heard) == len(far.heard) == 1
        # Withdrawn by its id, from whoever has it.
        at = ("--connect", router.connect, "--json")
        assert main(["fleet", "recall", *at, first.id]) == 0
        eventually(lambda: first.follow(False), "the first one has ended")
        assert first.outcome is not None and first.outcome.outcome == "cancelled"
        capsys.readouterr()
        assert main(["fleet", *at]) == 0
        listed = {r["name"]: r for r in json.loads(capsys.readouterr().out)}
        assert listed["near"]["last"]["command_id"] == first.id and listed["far"]["command"] == TEXT
        assert main(["fleet", "stop", *at]) == 0 and json.loads(capsys.readouterr().out) == ["far", "near"]
        eventually(lambda: desk.look({"far"})[0].last, "the brain has heard of the stop")


@pytest.mark.slow
def test_a_robot_that_is_lost_hands_over_and_leaves_it_when_it_is_back(router: Site, desk: Desk) -> None:
    lines: list[str] = []
    with ExitStack() as stack:
        near, far = Body(stack, router, "near", 2.0), Body(stack, router, "far", -4.0)
        ready(desk, 2)
        order = say(desk, lines)
        eventually(lambda: near.plans, "the nearer one plans it", 20)
        near.brain.send_signal(signal.SIGKILL)
        near.brain.wait()
        eventually(lambda: order.follow(True) or order.by == "far", "the other one has it", 60)
        assert order.lost == ["near"] and len(near.heard) == len(far.heard) == 1
        assert far.heard[0].id == order.id == near.heard[0].id
        before = len(near.plans)
        near.start()
        eventually(lambda: order.follow(True) or not order.lost, "the lost one leaves it", 60)
        (row,) = desk.look({"near"})
        assert row.last is not None and row.last.outcome == "cancelled" and len(near.plans) <= before + 1
        assert order.by == "far" and not any(c.withdraws for c in far.heard)
    told = "; ".join(lines)
    assert "near is lost" in told and "far has taken it over" in told and "near is back" in told


@pytest.mark.slow
def test_the_page_shows_all_robots_and_what_became_of_its_commands(router: Site, desk: Desk) -> None:
    with ExitStack() as stack:
        near, far = Body(stack, router, "near", 2.0), Body(stack, router, "far", -4.0)
        ready(desk, 2)
        room = WatchRoom(desk)
        stack.callback(room.close)
        eventually(lambda: room.shown()["map"], "a map is drawn", 20)
        shown = room.shown()
        assert [r["name"] for r in shown["robots"]] == ["far", "near"] and shown["robots"][1]["pose"][0] == 2.0
        room.say(TEXT, hand_over=False)
        eventually(lambda: near.plans, "the nearer one plans it", 20)
        eventually(lambda: room.shown()["orders"][0]["by"] == "near", "the page says who has it", 20)
        assert not far.plans
        room.stop("near")
        eventually(lambda: room.shown()["orders"][0]["state"].startswith("cancelled"), "the stop has ended it", 20)
        far.brain.kill()
        eventually(lambda: room.shown()["robots"][0]["lost"], "the other one is shown as lost", 20)
