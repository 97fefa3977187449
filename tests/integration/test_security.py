"""Certificates and access control with a real router: every pair of certificate and key, allowed or denied."""

import importlib
import os
import threading
from collections.abc import Callable, Iterator
from contextlib import ExitStack
from pathlib import Path
from typing import Any

import pytest
import zenoh

from cli.fleet.robots import Desk
from cli.main import main as tidybot
from cli.processes.services import NAMES
from common import topics
from common.bus import delivery
from common.bus.session import open_session
from evaluation.site import Site, eventually

SERVICES = tuple(n for n in NAMES if n != "router")
LAST = "service/test/health"
PER_SERVICE = ("service/{}/health", "log/{}")
QUESTIONS = {
    topics.BRAIN_MISSIONS: "brain", topics.SIM_RESET: "sim", topics.SIM_PAUSE: "sim", topics.SIM_SNAPSHOT: "sim",
    topics.SIM_TRUTH: "sim",
}  # fmt: skip
KEYS = [t.key for t in topics.TABLE] + [k.format(n) for n in SERVICES for k in PER_SERVICE] + list(QUESTIONS)
CLOCKS = {t.key for t in topics.CLOCKS}
SUBJECTS = (*SERVICES, "operator", "looker", "agent", "desk")
AGENT_WRITES = {"voice_command", "robot/stop", "camera/request"}
AGENT_READS = {
    "brain/state", "system_status", "speech/status", "sim/status", "world/objects", "navigation/pose",
    "navigation/costmap", "camera/head/rgbd", "camera/wrist/rgbd",
}  # fmt: skip

DESK_READS = {
    "brain/state", "sim/status", "world/objects", "navigation/pose", "navigation/path", "navigation/costmap",
    "robot/battery",
}  # fmt: skip


def kind(name: str) -> Any:
    """The service class itself: expectations come from it, not from the table that the access control is made of."""
    module = importlib.import_module(f"services.{name}.service")
    return next(v for v in vars(module).values() if isinstance(v, type) and getattr(v, "NAME", None) == name)


def may_write(subject: str) -> set[str]:
    if subject == "looker":
        return set()
    if subject == "agent":
        return AGENT_WRITES
    if subject == "desk":
        return {"voice_command", "robot/stop"}
    if subject == "operator":
        return {t.key for t in topics.TABLE if "*" in t.writers}
    clocks = CLOCKS if subject == "sim" else {topics.LOCKSTEP_ACK.key}
    own = {t.key for t in topics.TABLE if subject in t.writers} | {t.key for t in kind(subject).WRITES}
    return own | clocks | {k.format(subject) for k in PER_SERVICE}


def may_read(subject: str) -> set[str]:
    if subject in ("operator", "looker"):
        return set(KEYS)
    if subject == "agent":
        return AGENT_READS | {f"service/{n}/health" for n in SERVICES}
    if subject == "desk":
        return DESK_READS | {f"service/{n}/health" for n in SERVICES}
    clocks = {topics.LOCKSTEP_ACK.key} if subject == "sim" else CLOCKS
    read = {t.key for t in kind(subject).READS if t.key in topics.BY_KEY}
    read |= heard_of_all(subject)
    if subject in topics.VIEWERS:
        read |= {f"log/{n}" for n in SERVICES}
    return read | clocks | {f"service/{n}/health" for n in SERVICES}


def heard_of_all(subject: str) -> set[str]:
    """What it hears of every robot on the router, its own among them, and may not ask for."""
    return {t.key for t in topics.TABLE if subject in t.abroad}


def may_ask(subject: str) -> set[str]:
    if subject == "operator":
        return set(KEYS)
    if subject == "looker":
        changing = {topics.SIM_RESET, topics.SIM_PAUSE, topics.SIM_SNAPSHOT}
        return set(KEYS) - changing - {f"log/{n}" for n in SERVICES}
    logs = {f"log/{n}" for n in SERVICES}
    missions = {topics.BRAIN_MISSIONS} if subject in ("dashboard", "agent") else set()
    return may_read(subject) - logs - heard_of_all(subject) | missions


def may_answer(subject: str) -> set[str]:
    if subject in ("operator", "looker", "agent", "desk"):
        return set()
    own = kind(subject).WRITES
    latched = {t.key for t in topics.TABLE if t.latched and (subject in t.writers or t in own)}
    return latched | {k for k, n in QUESTIONS.items() if n == subject} | {f"service/{subject}/health"}


@pytest.fixture(scope="module")
def directory(tmp_path_factory: pytest.TempPathFactory) -> Path:
    made = tmp_path_factory.mktemp("security") / "keys"
    for words in (
        [],
        ["--client", "looker", "--observer"],
        ["--client", "rviz", "--ros"],
        ["--client", "desk", "--fleet"],
        ["--namespace", "kitchen"],
        ["--namespace", "hall"],
    ):
        assert tidybot(["keys", "--dir", str(made), *words]) == 0
    return made


class Guarded(Site):
    """A router that takes certificates only."""

    def __init__(self, log_dir: Path, keys: Path) -> None:
        super().__init__(log_dir)
        self.namespace, self.keys = "", keys
        self.connect = f"tls/127.0.0.1:{self.port}"

    def environment(self, **extra: str) -> dict[str, str]:
        return super().environment(**{"TIDYBOT_KEYS": str(self.keys), **extra})

    def open(self, stack: ExitStack, name: str, namespace: str = "") -> zenoh.Session:
        return stack.enter_context(open_session(self.connect, namespace, name=name, patience=20))


@pytest.fixture(scope="module")
def guarded(directory: Path, tmp_path_factory: pytest.TempPathFactory) -> Iterator[Guarded]:
    before = os.environ.get("TIDYBOT_KEYS")
    os.environ["TIDYBOT_KEYS"] = str(directory)
    opened = Guarded(tmp_path_factory.mktemp("router"), directory)
    try:
        opened.start_router()
        yield opened
    finally:
        opened.close()
        if before is None:
            del os.environ["TIDYBOT_KEYS"]
        else:
            os.environ["TIDYBOT_KEYS"] = before


Opener = Callable[[ExitStack, str], zenoh.Session]


def heard_puts(open_session: Opener) -> set[tuple[str, str]]:
    """(subject, key) of every message that came through when every subject sends on every key."""
    got: set[tuple[str, str]] = set()
    with ExitStack() as stack:
        witness = open_session(stack, "router")
        witness.declare_subscriber("**", lambda s: got.add((s.payload.to_string(), str(s.key_expr))))
        witness.declare_queryable(LAST, lambda query: query.reply(LAST, b"here"))
        for subject in SUBJECTS:
            session = open_session(stack, subject)
            eventually(lambda s=session: delivery.fetch(s, LAST), "the witness answers")
            for key in KEYS:
                session.put(key, subject)
            # A question follows what was sent before it, so its answer says that everything has arrived.
            assert delivery.fetch(session, LAST, timeout=20.0)
    return got


def test_every_certificate_publishes_its_own_keys_and_no_other(guarded: Guarded) -> None:
    got = heard_puts(guarded.open)
    for subject in SUBJECTS:
        assert {k for s, k in got if s == subject} == may_write(subject), subject


def test_without_access_control_everything_would_come_through(here: Site, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("TIDYBOT_KEYS", "off")

    def plain(stack: ExitStack, name: str) -> zenoh.Session:
        return stack.enter_context(open_session(here.connect))

    assert heard_puts(plain) == {(s, k) for s in SUBJECTS for k in KEYS}, "or the tests above would show nothing"


def test_every_certificate_receives_its_own_keys_and_no_other(guarded: Guarded) -> None:
    got: set[tuple[str, str, str]] = set()

    def listen(session: zenoh.Session, subject: str) -> None:
        def note(sample: zenoh.Sample) -> None:
            got.add((subject, str(sample.key_expr), sample.payload.to_string()))

        for key in (*KEYS, "**", "brain/**", LAST):
            session.declare_subscriber(key, note)

    with ExitStack() as stack:
        witness = guarded.open(stack, "router")
        for subject in SUBJECTS:
            listen(guarded.open(stack, subject), subject)

        def all_hear(word: str) -> bool:
            witness.put(LAST, word)
            return all((s, LAST, word) in got for s in SUBJECTS)

        eventually(lambda: all_hear("begin"), "everybody listens")
        for key in KEYS:
            witness.put(key, "secret")
        eventually(lambda: all_hear("end"), "everything has arrived")
    for subject in SUBJECTS:
        assert {k for s, k, word in got if s == subject and word == "secret"} == may_read(subject), subject


def test_every_certificate_asks_and_answers_its_own_keys_and_no_other(guarded: Guarded) -> None:
    asked: set[tuple[str, str]] = set()
    answered: set[tuple[str, str]] = set()

    def reply(query: zenoh.Query) -> None:
        key = str(query.key_expr)
        if query.payload is not None:
            asked.add((query.payload.to_string(), key))
        query.reply(key, b"x")

    with ExitStack() as stack:
        witness = guarded.open(stack, "router")
        serving = witness.declare_queryable("**", reply)
        sessions = {s: guarded.open(stack, s) for s in SUBJECTS}
        for subject, session in sessions.items():
            eventually(lambda s=session: delivery.fetch(s, LAST), "the witness answers")
            for key in KEYS:
                session.get(key, lambda reply: None, payload=subject, timeout=2.0)
            assert delivery.fetch(session, LAST, timeout=20.0)
        serving.undeclare()
        for subject, session in sessions.items():

            def tell(query: zenoh.Query, name: str = subject) -> None:
                query.reply(query.key_expr, name)

            for key in KEYS:
                session.declare_queryable(key, tell)
        expected = {(s, k) for s in SUBJECTS for k in may_answer(s)}

        def ask_all() -> bool:
            done = threading.Semaphore(0)
            for key in KEYS:

                def note(answer: zenoh.Reply, key: str = key) -> None:
                    if answer.ok is not None:
                        answered.add((answer.ok.payload.to_string(), key))
                    done.release()

                witness.get(key, note, target=zenoh.QueryTarget.ALL, consolidation=zenoh.ConsolidationMode.NONE)
            return expected <= answered

        eventually(ask_all, "everybody answers")
    for subject in SUBJECTS:
        assert {k for s, k in asked if s == subject} == may_ask(subject), subject
    assert answered == expected


def test_a_ros_peer_meets_the_gateway_in_its_domain_and_reaches_nothing_else(guarded: Guarded) -> None:
    got: set[str] = set()
    with ExitStack() as stack:
        witness, peer = guarded.open(stack, "router"), guarded.open(stack, "rviz")
        gateway = stack.enter_context(open_session(guarded.connect, name="ros2", prefixed=False, patience=20))
        witness.declare_subscriber("**", lambda s: got.add(f"witness {s.key_expr}"))
        gateway.declare_subscriber("0/**", lambda s: got.add(f"gateway {s.key_expr}"))
        for key in ("**", "0/**"):  # what others send: its own it has anyway
            peer.declare_subscriber(key, lambda s: got.add(f"peer {s.key_expr}"), allowed_origin=zenoh.Locality.REMOTE)
        token = gateway.liveliness().declare_token("@ros2_lv/0/zid/0/0/NN/%/%/tidybot")

        def both_ways() -> bool:
            for key in (*KEYS, "1/chatter/type/hash"):
                peer.put(key, "ros")
            peer.put("0/chatter/type/hash", "ros")
            gateway.put("0/answer/type/hash", "ros")
            witness.put(topics.SYSTEM_STATUS.key, "secret")
            nodes = [r.ok.key_expr for r in peer.liveliness().get("@ros2_lv/0/**", timeout=2.0) if r.ok is not None]
            return {"gateway 0/chatter/type/hash", "peer 0/answer/type/hash"} <= got and bool(nodes)

        eventually(both_ways, "peer and gateway meet")
        token.undeclare()
    allowed = {"0/chatter/type/hash", "0/answer/type/hash"}
    assert {line for line in got if line.partition(" ")[2] not in allowed} <= {f"witness {topics.SYSTEM_STATUS.key}"}


def test_the_gateway_itself_carries_a_ros_peer_s_words_to_the_brain(guarded: Guarded) -> None:
    pytest.importorskip("rosbags", reason="the extra ros2 is not installed")
    words: list[bytes] = []
    gateway = guarded.start("services.ros2")
    with ExitStack() as stack:
        brain, peer = guarded.open(stack, "brain"), guarded.open(stack, "rviz")
        brain.declare_subscriber(topics.VOICE_COMMAND.key, lambda s: words.append(s.payload.to_bytes()))

        def heard() -> bool:
            found = peer.liveliness().get("@ros2_lv/0/*/*/*/MS/*/*/tidybot/%voice_command/**", timeout=2.0)
            for reply in found:
                if reply.ok is not None:
                    _, _, kind, type_hash, _ = str(reply.ok.key_expr).rsplit("/", 4)
                    # CDR, little endian: a string with its length and a zero at the end.
                    peer.put(f"0/voice_command/{kind}/{type_hash}", b"\0\1\0\0" + b"\5\0\0\0stop\0")
            return bool(words)

        eventually(heard, "the words arrive")
    assert b'"stop"' in words[0]
    gateway.terminate()
    assert gateway.wait(20) == 0


def test_a_question_to_many_reaches_all_of_them(guarded: Guarded) -> None:
    with ExitStack() as stack:
        for name in SERVICES:
            session, key = guarded.open(stack, name), f"service/{name}/health"
            session.declare_queryable(key, lambda query, key=key: query.reply(key, b"well"))
        for asking in ("operator", "looker", "brain"):
            session = guarded.open(stack, asking)
            everybody = {f"service/{n}/health" for n in SERVICES if n != asking}
            eventually(
                lambda s=session, e=everybody: e <= set(delivery.fetch(s, "service/*/health")), f"{asking} hears"
            )


def test_a_wide_subscription_is_served_by_a_publisher_that_sends_only_what_is_wanted(guarded: Guarded) -> None:
    got: list[str] = []
    with ExitStack() as stack:
        brain, navigation = guarded.open(stack, "brain"), guarded.open(stack, "navigation")
        brain.declare_subscriber("service/*/health", lambda s: got.append(s.payload.to_string()))
        publisher = navigation.declare_publisher("service/navigation/health")
        eventually(lambda: publisher.matching_status.matching, "the publisher hears of the subscription")
        publisher.put("well")
        eventually(lambda: got == ["well"], "health arrives")


def test_navigation_hears_which_way_another_robot_takes_and_nothing_else_of_it(guarded: Guarded) -> None:
    got: list[tuple[str, str]] = []
    with ExitStack() as stack:
        kitchen = guarded.open(stack, "navigation", "kitchen")
        planner = guarded.open(stack, "planner", "kitchen")
        hall = stack.enter_context(
            open_session(guarded.connect, "hall", name="navigation", prefixed=False, patience=20)
        )
        for key in (topics.DRIVE_INTENT.key, topics.POSE.key):
            hall.declare_subscriber(f"**/{key}", lambda s: got.append((str(s.key_expr), s.payload.to_string())))
        way = kitchen.declare_publisher(topics.DRIVE_INTENT.key)
        eventually(lambda: way.matching_status.matching, "the publisher hears of the subscription")
        kitchen.put(topics.POSE.key, "secret")
        planner.put(topics.DRIVE_INTENT.key, "forged")

        def heard() -> bool:
            way.put("mine")
            return (f"kitchen/{topics.DRIVE_INTENT.key}", "mine") in got

        eventually(heard, "the way arrives")
    assert {word for _, word in got} == {"mine"}


def test_a_certificate_shows_only_itself_as_alive(guarded: Guarded) -> None:
    with ExitStack() as stack:
        witness = guarded.open(stack, "router")
        kept = []
        for subject in SUBJECTS:
            session = guarded.open(stack, subject)
            kept += [session.liveliness().declare_token(f"service/{n}/alive") for n in (*SERVICES, "ear")]

        def alive() -> set[str]:
            replies = witness.liveliness().get("service/*/alive", timeout=5.0)
            return {str(r.ok.key_expr).split("/")[1] for r in replies if r.ok is not None}

        eventually(lambda: alive() == {*SERVICES, "ear"}, "everybody is alive")
    with ExitStack() as stack:
        witness, speech = guarded.open(stack, "router"), guarded.open(stack, "speech")
        kept = [speech.liveliness().declare_token(f"service/{n}/alive") for n in SERVICES]
        eventually(lambda: alive() == {"speech"}, "one token, and only one")


def test_a_robot_does_not_reach_into_another(guarded: Guarded) -> None:
    got: set[tuple[str, str]] = set()
    with ExitStack() as stack:
        ours, theirs = guarded.open(stack, "operator"), guarded.open(stack, "operator", "kitchen")
        elsewhere = zenoh.Locality.REMOTE
        ours.declare_subscriber("**", lambda s: got.add(("ours", str(s.key_expr))), allowed_origin=elsewhere)
        theirs.declare_subscriber("**", lambda s: got.add(("theirs", str(s.key_expr))), allowed_origin=elsewhere)
        speech = guarded.open(stack, "speech", "kitchen")
        home = guarded.open(stack, "speech")

        def both() -> bool:
            speech.put("speech/status", "kitchen")
            home.put("speech/status", "home")
            ours.put("kitchen/robot/stop", "reach")
            return {("ours", "speech/status"), ("theirs", "speech/status")} <= got

        eventually(both, "each robot hears itself")
        # What was sent before an answer has arrived.
        guarded.open(stack, "router").declare_queryable(LAST, lambda query: query.reply(LAST, b""))
        eventually(lambda: delivery.fetch(ours, LAST), "everything has arrived")
        both()
        assert delivery.fetch(ours, LAST)
    assert got == {("ours", "speech/status"), ("theirs", "speech/status")}


def test_the_fleet_s_desk_reaches_every_robot_with_words_and_the_brake_alone(guarded: Guarded) -> None:
    got: set[str] = set()
    with ExitStack() as stack:
        desk = stack.enter_context(open_session(guarded.connect, name="desk", prefixed=False, patience=20))
        witness, brain = guarded.open(stack, "router"), guarded.open(stack, "brain", "kitchen")
        witness.declare_subscriber("**", lambda s: got.add(str(s.key_expr)))
        brain.declare_subscriber("voice_command", lambda s: got.add(f"heard {s.key_expr}"))
        alive = brain.liveliness().declare_token("service/brain/alive")
        brain.declare_queryable("brain/state", lambda query: query.reply("brain/state", b"here"))

        def words_arrive() -> bool:
            for key in ("kitchen/nav_goal", "kitchen/robot/resume", "kitchen/voice_command", "nav_goal", "robot/stop"):
                desk.put(key, b"desk")
            return {"kitchen/voice_command", "heard voice_command", "robot/stop"} <= got

        eventually(words_arrive, "words to the one, the brake of the other")
        eventually(lambda: delivery.fetch(desk, "kitchen/brain/state"), "the desk sees a robot's state")
        eventually(lambda: Desk(desk).names() == {"kitchen"}, "the desk sees who is there")
        alive.undeclare()
    assert not {key for key in got if key.endswith(("nav_goal", "resume"))}


def test_the_clients_file_is_all_that_a_plain_zenoh_tool_needs(guarded: Guarded) -> None:
    config = zenoh.Config.from_file(str(guarded.keys / "operator" / "client.json5"))
    config.insert_json5("connect/endpoints", f'["{guarded.connect}"]')
    got: list[str] = []
    with ExitStack() as stack:
        brain = guarded.open(stack, "brain")
        with zenoh.open(config) as session:
            session.declare_subscriber("**", lambda s: got.append(str(s.key_expr)))
            eventually(lambda: (brain.put(topics.BRAIN_STATE.key, "x"), got)[1], "the tool hears the brain")
