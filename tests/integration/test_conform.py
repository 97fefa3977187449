"""`tidybot conform` against the simulation, and against drivers with a fault each."""

import math
import threading
from collections.abc import Callable
from typing import Any

import pytest
import zenoh

from cli.drivers import requirements as conformance
from cli.drivers.conform import examine
from cli.drivers.driver import Driver, Unmet
from cli.link import Link
from common import messages as m
from common import topics
from common.bus import codec
from common.topic import Topic
from evaluation.site import Site, eventually
from services.sim.model import own


def unmet(rows: list[dict[str, object]]) -> dict[str, object]:
    return {str(row["name"]): row["why"] for row in rows if not row["met"]}


@pytest.mark.timeout(600)
@pytest.mark.slow
def test_the_simulation_conforms(here: Site) -> None:
    here.start("services.sim", TIDYBOT__RUNTIME__SCENE="minimal")
    with here.session() as session:
        here.wait_alive(session, "sim")
        rows = examine(Driver(Link(session, here.connect)), move=True)
    assert unmet(rows) == {}
    assert [row["name"] for row in rows] == [c.__name__ for c in (*conformance.LISTENING, *conformance.MOVING)]


class Puppet:
    """A driver in the test's hands: says what a good one says, unless a fault changes it."""

    def __init__(
        self, session: zenoh.Session, change: Callable[[str, Any], Any] = lambda key, message: message
    ) -> None:
        self._session, self._change = session, change
        self._n = 0
        self._over = threading.Event()
        self._token = session.liveliness().declare_token(topics.ALIVE_KEY.format(name="sim"))
        self._thread = threading.Thread(target=self._run)
        self._thread.start()

    def _put(self, topic: Topic[Any], message: Any) -> None:
        changed = self._change(topic.key, message)
        if changed is not None:
            self._session.put(topic.key, codec.encode(topic, changed))

    def _run(self) -> None:
        while not self._over.wait(0.003):
            t = self._n * 0.01
            names = list(conformance.JOINTS)
            zeros = [0.0] * len(names)
            self._put(topics.JOINT_STATES, m.JointStates(t=t, name=names, position=zeros, velocity=zeros, effort=zeros))
            self._put(topics.ODOMETRY, m.Odometry(t=t, x=0.0, y=0.0, theta=0.0))
            if self._n % 10 == 0:
                ranges = bytes(4 * 360)
                self._put(topics.SCAN, m.LaserScan(t=t, ranges=ranges, angle_increment=math.tau / 360))
            self._n += 1

    def close(self) -> None:
        self._over.set()
        self._thread.join()
        self._token.undeclare()


def nothing(key: str, message: Any) -> Any:
    return message


def slow(key: str, message: Any) -> Any:
    if key == topics.ODOMETRY.key:
        message.t *= 5
    return message


def unnamed(key: str, message: Any) -> Any:
    if key == topics.JOINT_STATES.key:
        message.name = [*message.name[:-1], "hand"]
    return message


def half_blind(key: str, message: Any) -> Any:
    if key == topics.SCAN.key:
        message.angle_increment /= 2
    return message


def frozen(key: str, message: Any) -> Any:
    if key == topics.ODOMETRY.key:
        message.t = 1.0
    return message


def mute(key: str, message: Any) -> Any:
    return None if key == topics.SCAN.key else message


@pytest.mark.parametrize(
    ("fault", "check", "why"),
    [
        (nothing, "", ""),
        (slow, "odometry", "20 Hz"),
        (unnamed, "joint_states", "gripper"),
        (half_blind, "scan", "180 degrees"),
        (frozen, "odometry", "must rise"),
        (mute, "scan", "0 messages"),
    ],
)
def test_a_faulty_driver_is_told_what_is_wrong(here: Site, fault: Any, check: str, why: str) -> None:
    with here.session() as hand, here.session() as session:
        puppet = Puppet(hand, fault)
        try:
            driver = Driver(Link(session, here.connect))
            eventually(lambda: driver.heard[topics.JOINT_STATES.key], "the puppet speaks")
            found = unmet(examine(driver, move=False))
        finally:
            puppet.close()
    # A puppet answers no get, whatever its fault.
    assert set(found) - {"description", "latched"} == ({check} if check else set())
    if check:
        assert why in str(found[check])


def test_a_driver_that_does_not_obey_fails_each_command(here: Site) -> None:
    with here.session() as hand, here.session() as session:
        puppet = Puppet(hand)
        try:
            driver = Driver(Link(session, here.connect))
            eventually(lambda: driver.heard[topics.JOINT_STATES.key], "the puppet speaks")
            for check in (conformance.target, conformance.velocity, conformance.arm, conformance.gripper):
                with pytest.raises(Unmet):
                    check(driver)
            with pytest.raises(Unmet, match="sim/status says nothing"):
                conformance.stop(driver)
        finally:
            puppet.close()


@pytest.mark.parametrize(
    ("was", "becomes", "lacks"),
    [
        ("", "", ""),
        ("<worldbody>", "<world>", "MuJoCo cannot read it"),
        ('<key name="home"', '<key name="rest"', "keyframe home"),
        ('<site name="pinch"', '<site name="tool"', "site pinch"),
        ('name="left_pad', 'name="left_tip', "geom left_pad"),
    ],
)
def test_a_description_must_say_what_planning_needs(was: str, becomes: str, lacks: str) -> None:
    mjcf = own().mjcf
    assert was in mjcf
    found = conformance.missing_in(mjcf.replace(was, becomes) if was else mjcf)
    assert lacks in found if lacks else not found
