"""Several machines and several robots: a mission across a cable that is cut, two robots on one router."""

import math
import shutil
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest
import zenoh

from cli.link import Link
from cli.main import main as tidybot
from cli.missions.conversation import Conversation
from cli.missions.verdict import Verdict, Witness
from common import messages as m
from common import topics
from common.bus import codec, delivery
from common.bus.session import open_session
from common.scene import load_scene
from common.time.clock import unix_time
from evaluation.site import Site, eventually
from tests.network import network

pytestmark = [pytest.mark.slow, pytest.mark.timeout(900)]

SCENE, THING = "minimal", "yellow block"
SETTINGS = {"TIDYBOT__RUNTIME__SCENE": SCENE, "TIDYBOT__BRAIN__PIPELINE": "fetch", "TIDYBOT__BRAIN__SETTLE": "0.3"}
PACED = ("camera", "perception", "navigation", "manipulation", "brain")
MOVING, STILL, PARTITION = 0.25, 0.01, 5.0
"""Speed [m/s] of a base that drives, way [m] of one that stands, where it trembles at up to 2 cm/s, and time [s]."""
STOP_WITHIN = 0.75
"""Time [s] for the base to stand: targets that stay away count for .2, half a metre a second takes .24 at three times
the configured acceleration, and messages of .3 may be under way on a busy machine."""


class Wheels:
    """Every odometry message, and when it was sent."""

    def __init__(self, session: zenoh.Session) -> None:
        self.samples: list[m.Odometry] = []
        self._sent: list[float] = []
        self._kept = session.declare_subscriber(topics.ODOMETRY.key, self._receive)

    def _receive(self, sample: zenoh.Sample) -> None:
        odometry = codec.decode(topics.ODOMETRY, sample.payload.to_bytes())
        self._sent.append(delivery.sent_at(sample))
        self.samples.append(odometry)

    @property
    def now(self) -> float:
        return self.samples[-1].t if self.samples else 0.0

    @property
    def speed(self) -> float:
        return math.hypot(self.samples[-1].vx, self.samples[-1].vy) if self.samples else 0.0

    def first_after(self, moment: float) -> float | None:
        """Robot time of the first message sent after a moment [unix s]; what is read late does not make it earlier."""
        return next((o.t for o, sent in zip(self.samples, self._sent, strict=False) if sent > moment), None)

    def way(self, since: float, until: float) -> float:
        """How far [m] the base has come, at most, from where it was at robot time `since`."""
        seen = [(o.x, o.y) for o in self.samples if since <= o.t <= until]
        return max(math.dist(seen[0], at) for at in seen)


class Mission:
    """One object asked for and followed to the end."""

    def __init__(self, link: Link, thing: str) -> None:
        self._witness = Witness(link, load_scene(SCENE), thing)
        self._talk = Conversation(link, lambda state: print(f"{state.t:8.1f}  {state.state}  {state.detail}"))
        eventually(self._ready, "the robot takes commands", 120)
        self._witness.begin()
        link.send(topics.VOICE_COMMAND, m.VoiceCommand(text=f"bring me the {thing}"))
        assert self._talk.accepted(180.0), self._talk.state

    def _ready(self) -> bool:
        self._talk.refresh()
        return not self._talk.closed()

    def verdict(self, timeout: float) -> Verdict:
        """Judged by physics."""
        outcome = self._talk.outcome(timeout, self._witness.look)
        verdict = self._witness.judge()
        return verdict if outcome.outcome == "delivered" else Verdict(False, f"{outcome.reason}; {verdict.why}")


def test_a_mission_across_two_machines_outlives_a_cut_cable(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    here, there = ("router", "sim", "manipulation"), ("camera", "perception", "navigation", "speech", "brain")
    with network(tmp_path) as net:
        one, two = net.one, net.two
        keys = tmp_path / "one"
        assert tidybot(["keys", "--dir", str(keys), "--host", one.address, "--host", net.door]) == 0
        for name in there:
            shutil.copytree(keys / name, tmp_path / "two" / name)  # all that the other machine gets
        common = {**SETTINGS, "TIDYBOT_STATE_DIR": str(tmp_path)}
        at_home = {**common, "TIDYBOT_KEYS": str(keys), "TIDYBOT_CONNECT": "tls/127.0.0.1:7447"}
        # Nobody waits for anybody here: at full speed a busy machine is late with the arm's set-points.
        at_home["TIDYBOT__SIM__SPEED"] = "0.3"
        away = {**common, "TIDYBOT_KEYS": str(tmp_path / "two"), "TIDYBOT_CONNECT": f"tls/{one.address}:7447"}
        one.start("services.router", "--listen", "tls/0.0.0.0:7447", label="router", TIDYBOT_KEYS=str(keys))
        for name in here[1:]:
            one.start(f"services.{name}", label=name, **at_home)
        for name in there:
            two.start(f"services.{name}", label=name, **away)
        monkeypatch.setenv("TIDYBOT_KEYS", str(keys))
        door = f"tls/{net.door}:7447"
        with open_session(door, patience=60) as session:
            link, wheels = Link(session, door), Wheels(session)
            eventually(lambda: {*here[1:], *there} <= link.alive(), "everybody is alive on both machines", 90)
            mission = Mission(link, THING)
            eventually(lambda: wheels.speed > MOVING, "the base drives", 120)
            net.cable.cut()
            moment = unix_time()
            cut = eventually(lambda: wheels.first_after(moment), "the simulation goes on")
            eventually(lambda: wheels.now > cut + PARTITION, "5 s of robot time without the other machine", 120)
            assert wheels.way(cut + STOP_WITHIN, cut + PARTITION) < STILL
            eventually(lambda: set(there).isdisjoint(link.alive()), "the cable was really cut", 60)
            net.cable.heal()
            eventually(lambda: set(there) <= link.alive(), "the other machine is back", 60)
            verdict = mission.verdict(timeout=500)
            assert verdict.delivered, verdict.why
            assert all(p.poll() is None for p in (*one.processes.values(), *two.processes.values()))


@contextmanager
def robot(site: Site, link: Link, namespace: str, seed: int) -> Iterator[None]:
    """The services of one robot, in lockstep as fast as they can."""
    extra = {
        **SETTINGS,
        "TIDYBOT_CONNECT": site.connect,
        "TIDYBOT_NAMESPACE": namespace,
        "TIDYBOT_STATE_DIR": str(site.log_dir / namespace),
        "TIDYBOT__RUNTIME__SEED": str(seed),
        "TIDYBOT__RUNTIME__LOCKSTEP": "true",
        "TIDYBOT__SIM__SPEED": "max",
        "TIDYBOT__SIM__WAIT_FOR": str(list(PACED)).replace("'", '"'),
    }
    for name in ("sim", *PACED):
        site.start(f"services.{name}", **extra)
    with open_session(site.connect, namespace, name="speech", patience=60) as ears:
        # Commands are typed: somebody who is there is all of speech that a mission needs.
        kept = ears.liveliness().declare_token(topics.ALIVE_KEY.format(name="speech"))
        ears.declare_subscriber(topics.SPEECH_GOAL.key, lambda sample: None)
        eventually(lambda: {"sim", *PACED} <= link.alive(), f"{namespace} is alive", 120)
        yield
        kept.undeclare()


def test_two_robots_on_one_router_do_not_disturb_each_other(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    keys = tmp_path / "keys"
    for namespace in ("alpha", "beta"):
        assert tidybot(["keys", "--dir", str(keys), "--namespace", namespace]) == 0
        (tmp_path / namespace).mkdir()
    monkeypatch.setenv("TIDYBOT_KEYS", str(keys))
    site = Site(tmp_path)
    site.connect = f"tls/127.0.0.1:{site.port}"
    site.environment = lambda **extra: Site.environment(site, **{"TIDYBOT_KEYS": str(keys), **extra})  # type: ignore[method-assign]
    try:
        site.start("services.router", "--listen", site.connect)
        with (
            open_session(site.connect, "alpha", patience=60) as first,
            open_session(site.connect, "beta", patience=60) as second,
        ):
            alpha, beta = Link(first, site.connect), Link(second, site.connect)
            with robot(site, alpha, "alpha", 1), robot(site, beta, "beta", 2):
                pair = [Mission(alpha, THING), Mission(beta, "green can")]
                for mission in pair:
                    verdict = mission.verdict(timeout=400)
                    assert verdict.delivered, verdict.why
                assert alpha.alive() == beta.alive() == {"sim", "speech", *PACED}
                epochs = [{n: h.epoch for n, h in link.health().items()} for link in (alpha, beta)]
                assert set(epochs[0].values()).isdisjoint(epochs[1].values())
                # A stop is for the one robot only.
                alpha.send(topics.ROBOT_STOP, m.RobotStop(reason="test", source="test"))
                eventually(lambda: _state(alpha) == "stopped", "alpha stands")
                assert _state(beta) == "running"
    finally:
        site.close()


def _state(link: Link) -> str:
    status = link.latest(topics.SIM_STATUS)
    return status.state if status else ""
