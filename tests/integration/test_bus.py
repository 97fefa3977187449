"""The bus and the runtime over real Zenoh, with a real process on the other side."""

import signal
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager

import msgspec
import pytest
import zenoh

from common import messages as m
from common import topics
from common.bus import codec, delivery
from common.bus.delivery import Publisher
from evaluation.site import PATIENCE, Site, eventually
from tests.support import ROOT

STATUS = topics.NAVIGATION_STATUS.key
SCENE = 'name="t"\nlow=[-1.0,-1.0]\nhigh=[1.0,1.0]\nhome={name="home",x=0.0,y=0.0}\n'


@contextmanager
def heard(session: zenoh.Session, key: str) -> Iterator[list[bytes]]:
    """Every payload on a key, as a plain subscriber sees it."""
    got: list[bytes] = []
    subscriber = session.declare_subscriber(key, lambda sample: got.append(sample.payload.to_bytes()))
    yield got
    subscriber.undeclare()


def start_echo(here: Site, *args: str, **extra: str) -> "subprocess.Popen[bytes]":
    scene = here.log_dir / "empty.toml"
    if not scene.exists():  # else a process that starts could read it half written
        scene.write_text(SCENE)
    extra.setdefault("TIDYBOT_CLOCK", "wall")
    return here.start("tests.fakes", *args, TIDYBOT__RUNTIME__SCENE=str(scene), **extra)


def details(payloads: list[bytes]) -> list[str]:
    return [msgspec.json.decode(p, type=m.NavigationStatus).detail.split(" at ")[0] for p in payloads]


def health(session: zenoh.Session) -> m.Health:
    answer = eventually(lambda: delivery.fetch(session, "service/echo/health"), "health answers a get")
    return codec.decode_as(m.Health, next(iter(answer.values())))


def test_a_plain_peer_is_heard_in_every_form_and_the_status_is_latched(here: Site) -> None:
    start_echo(here)
    with here.session() as session:
        here.wait_alive(session, "echo")
        with heard(session, STATUS) as got:
            session.put("brain/navigation_goal", "find red mug")
            session.put("brain/navigation_goal", '"goto kitchen"')
            session.put("brain/navigation_goal", '{"goal": "stop", "id": "m.1"}')
            eventually(lambda: len(got) == 3, "three answers")
        assert details(got) == ["find red mug", "goto kitchen", "stop"]
        assert details(list(delivery.fetch(session, "brain/**").values())) == ["stop"]


def test_noise_is_counted_and_harms_nothing(here: Site) -> None:
    start_echo(here)
    with here.session() as session:
        here.wait_alive(session, "echo")
        with heard(session, STATUS) as got:
            for junk in (b"\xff\xfe", b"\x00" * 100, b'{"goal":', b"", b"\xc1" * 9):
                session.put("brain/navigation_goal", junk)
            session.put("joint_states", b"\xff\x00junk")
            session.put("brain/state", b"\xff")
            session.put("service/other/health", b"\xff")
            session.put("brain/navigation_goal", "still here")
            eventually(lambda: got, "an answer after the noise")
        assert details(got) == ["still here"]
        counted = eventually(lambda: (h := health(session)).drops >= 6 and h, "the drops are in the health record")
        assert counted.by_key["brain/navigation_goal"] == 5


def test_goals_survive_a_router_outage_in_order(here: Site) -> None:
    start_echo(here)
    with here.session() as session:
        here.wait_alive(session, "echo")
        goals = Publisher(session, topics.NAVIGATION_GOAL)
        with heard(session, STATUS) as got:

            def ask(text: str) -> None:
                goals.put(codec.encode(topics.NAVIGATION_GOAL, m.NavigationGoal(goal=text, id=f"m.{text}")), None)

            ask("before")
            eventually(lambda: got, "an answer before the outage")
            router = here.processes[0]
            router.kill()
            router.wait()
            for n in range(5):
                ask(f"during {n}")
            here.start_router()
            ask("after")
            eventually(lambda: len(set(details(got))) >= 7, "every goal was answered")
        expected = ["before", *(f"during {n}" for n in range(5)), "after"]
        assert list(dict.fromkeys(details(got))) == expected


def test_a_goal_from_before_the_start_is_not_acted_on(here: Site) -> None:
    with here.session() as session:
        goals, topic = Publisher(session, topics.NAVIGATION_GOAL), topics.NAVIGATION_GOAL
        goals.put(codec.encode(topic, m.NavigationGoal(goal="old", id="m.1")), None)
        before = session.new_timestamp()
        with heard(session, STATUS) as got:
            start_echo(here)
            here.wait_alive(session, "echo")
            # The history may come before or after what is new; this one comes for certain.
            session.put(topic.key, codec.encode(topic, m.NavigationGoal(goal="older", id="m.0")), timestamp=before)
            goals.put(codec.encode(topic, m.NavigationGoal(goal="new", id="m.2")), None)
            eventually(lambda: got, "an answer to the new goal")
            stale = f"{topic.key} (stale)"
            eventually(lambda: health(session).by_key.get(stale, 0) > 0, "counted as stale")
            assert details(got) == ["new"]


def test_a_killed_process_loses_its_token_and_its_successor_has_another_epoch(here: Site) -> None:
    first = start_echo(here)
    with here.session() as session:
        here.wait_alive(session, "echo")
        epoch = health(session).epoch
        first.send_signal(signal.SIGKILL)
        first.wait()
        alive = "service/echo/alive"
        eventually(lambda: not list(session.liveliness().get(alive, timeout=1.0)), "the token is gone")
        start_echo(here)
        here.wait_alive(session, "echo")
        assert health(session).epoch != epoch


@pytest.mark.parametrize("number", [signal.SIGTERM, signal.SIGINT])
def test_signals_end_a_process_with_status_0(here: Site, number: signal.Signals) -> None:
    process = start_echo(here)
    with here.session() as session:
        here.wait_alive(session, "echo")
    process.send_signal(number)
    assert process.wait(PATIENCE) == 0
    assert "Traceback" not in here.log("tests.fakes")


def test_a_node_started_before_its_router_keeps_trying(here: Site) -> None:
    router = here.processes[0]
    router.kill()
    router.wait()
    process = start_echo(here)
    quitter = start_echo(here)
    eventually(lambda: here.log("tests.fakes").count("waiting for a router") == 2, "both say what they wait for")
    quitter.terminate()
    assert quitter.wait(PATIENCE) == 0, "it also ends on a signal while it waits"
    assert process.poll() is None
    here.start_router()
    with here.session() as session:
        here.wait_alive(session, "echo")


LATE = """
import os, signal, sys, time
from common.bus.session import BusError, open_session

class Waker:
    # Deleted when Python already ends: the router wakes then, and what still waits for it has half a second to return.
    def __del__(self, wake=os.kill, number=signal.SIGCONT, router=int(sys.argv[2]), sleep=time.sleep):
        wake(router, number)
        sleep(0.5)

waker = Waker()
try:
    with open_session(sys.argv[1], patience=0.3):
        sys.exit(3)
except BusError as error:
    sys.exit(str(error))
"""


def test_a_router_that_wakes_while_a_tool_ends_does_not_abort_it(here: Site) -> None:
    router = here.processes[0]
    router.send_signal(signal.SIGSTOP)
    line = [sys.executable, "-c", LATE, here.connect, str(router.pid)]
    ended = subprocess.run(line, env=here.environment(), cwd=ROOT, capture_output=True, text=True, timeout=60)
    assert (ended.returncode, "FATAL" in ended.stderr) == (1, False), ended.stderr
    assert "nothing answers at" in ended.stderr


def test_an_error_in_a_step_is_logged_and_survived(here: Site) -> None:
    process = start_echo(here)
    with here.session() as session:
        here.wait_alive(session, "echo")
        with heard(session, STATUS) as got:
            session.put("brain/navigation_goal", "raise")
            eventually(lambda: "asked to fail" in here.log("tests.fakes"), "the error is logged")
            session.put("brain/navigation_goal", "goto kitchen")
            eventually(lambda: got, "an answer after the error")
        assert process.poll() is None
        eventually(lambda: health(session).last_error == "step failed", "the error is in the health record")


SLOW = pytest.mark.slow
WRONG = (
    (["--set", "echo.wrod=x"], {}, "unknown key 'wrod'"),
    ([], {"TIDYBOT_CONNECT": "nonsense"}, "nonsense"),
    pytest.param([], {"TIDYBOT__ECHO__WORD": "[1]"}, "Expected `str`", marks=SLOW),
    pytest.param([], {"TIDYBOT_CLOCK": "sundial"}, "expected sim or wall", marks=SLOW),
    pytest.param(["--set", "runtime.scene=castle"], {}, "no scene file", marks=SLOW),
    pytest.param(["--set", "runtime.log_level=loud"], {}, "Invalid enum value 'loud'", marks=SLOW),
)


@pytest.mark.parametrize(("args", "extra", "expected"), WRONG)
def test_a_bad_configuration_ends_with_status_2_and_a_reason(
    here: Site, args: list[str], extra: dict[str, str], expected: str
) -> None:
    process = start_echo(here, *args, **extra)
    assert process.wait(20) == 2
    log = here.log("tests.fakes")
    assert expected in log
    assert "Traceback" not in log


def test_a_second_router_on_the_port_says_that_it_is_in_use(here: Site) -> None:
    second = here.start("services.router", "--listen", here.connect)
    assert second.wait(20) == 2
    assert "the port is in use" in here.log("services.router")
