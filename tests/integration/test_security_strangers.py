"""Who has no certificate, a bad one or one of another authority gets in nowhere, and is told why."""

import json
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
import zenoh

from cli.keys.authority import Authority, hosts_of
from cli.main import main as tidybot
from cli.processes.ports import free_port
from common import topics
from common.bus.delivery import Publisher
from common.bus.session import BusError, open_session
from common.security import tls_diagnosis
from common.security.access import Subject
from common.security.certificate import Identity
from evaluation.site import Site, eventually
from tests.network import Machine, network

ROUTER = Subject(name="router", role="router")
OPERATOR = Subject(name="operator", role="operator")


def authority(directory: Path, days: float = 1.0, router_days: float = 1.0, hosts: tuple[str, ...] = ()) -> Path:
    """Keys of a router, speech and an operator."""
    made = Authority(directory)
    made.found(2)
    made.issue(ROUTER, router_days, hosts if hosts else hosts_of(hosts))
    for subject in (Subject(name="speech"), OPERATOR):
        made.issue(subject, days)
    made.register([ROUTER, Subject(name="speech"), OPERATOR])
    return directory


@pytest.fixture
def ours(tmp_path: Path) -> Path:
    return authority(tmp_path / "ours")


@pytest.fixture
def closed(tmp_path: Path, ours: Path) -> Iterator[Site]:
    """A router with keys, and a service's secret on it."""
    opened = Site(tmp_path)
    opened.namespace, opened.connect = "", f"tls/127.0.0.1:{opened.port}"
    try:
        opened.start("services.router", "--listen", opened.connect, TIDYBOT_KEYS=str(ours))
        eventually(opened.listening, "the router listens")
        yield opened
    finally:
        opened.close()


def refused(closed: Site, keys: str, monkeypatch: pytest.MonkeyPatch, connect: str = "", name: str = "operator") -> str:
    """What somebody is told who comes with these keys."""
    monkeypatch.setenv("TIDYBOT_KEYS", keys)
    with pytest.raises(BusError) as caught, open_session(connect or closed.connect, name=name, patience=40):
        pass
    return str(caught.value)


def test_with_the_right_keys_it_opens(closed: Site, ours: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("TIDYBOT_KEYS", str(ours))
    with open_session(closed.connect, patience=40) as session:
        assert session.info.routers_zid()


def test_without_keys_one_is_told_that_they_are_needed(closed: Site, monkeypatch: pytest.MonkeyPatch) -> None:
    plain = closed.connect.replace("tls/", "tcp/")
    assert "takes certificates only" in refused(closed, "off", monkeypatch, plain)
    assert "needs certificates" in refused(closed, "off", monkeypatch)


def test_keys_of_another_authority(closed: Site, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    theirs = authority(tmp_path / "theirs")
    assert "of another authority" in refused(closed, str(theirs), monkeypatch)


def test_a_forged_certificate_is_refused_by_the_router(
    closed: Site, ours: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Theirs knows our router, but ours did not sign it."""
    theirs = authority(tmp_path / "theirs")
    forged = Identity(theirs / "speech", "speech")
    forged.ca = ours / "speech" / "ca.pem"
    assert "refuses us: certificate of speech" in tls_diagnosis.trouble(closed.connect, forged)


def test_plain_endpoints_are_not_used_when_there_are_keys(
    closed: Site, ours: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    plain = closed.connect.replace("tls/", "tcp/")
    assert "only tls/ endpoints" in refused(closed, str(ours), monkeypatch, plain)


def test_a_router_without_keys_is_not_talked_to(here: Site, ours: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    said = refused(here, str(ours), monkeypatch, here.connect.replace("tcp/", "tls/"))
    assert "takes no keys" in said


@pytest.mark.parametrize(
    ("options", "expected"),
    [
        ({"router_days": -0.5}, "certificate of the router at .* expired"),
        ({"hosts": ("elsewhere.example",)}, "not for '127.0.0.1'.*--host 127.0.0.1"),
    ],
)
def test_a_router_with_a_bad_certificate(
    tmp_path: Path, options: dict[str, Any], expected: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    keys = authority(tmp_path / "keys", **options)
    opened = Site(tmp_path)
    opened.connect = f"tls/127.0.0.1:{opened.port}"
    try:
        # Zenoh itself takes an expired certificate to listen with, so it goes by the file made for zenohd.
        config = keys / "router" / "router.json5"
        opened.start("services.router", "--config", str(config), "--listen", opened.connect)
        eventually(opened.listening, "the router listens")
        monkeypatch.setenv("TIDYBOT_KEYS", str(keys))
        with pytest.raises(BusError, match=expected), open_session(opened.connect, patience=40):
            pass
    finally:
        opened.close()


def test_a_service_and_a_router_with_an_expired_certificate_end_and_say_so(tmp_path: Path) -> None:
    keys = authority(tmp_path / "keys", days=-0.5, router_days=-0.5)
    opened = Site(tmp_path)
    connect = f"tls/127.0.0.1:{opened.port}"
    try:
        router = opened.start("services.router", "--listen", connect, TIDYBOT_KEYS=str(keys))
        speech = opened.start("services.speech", TIDYBOT_KEYS=str(keys), TIDYBOT_CONNECT=connect, TIDYBOT_NAMESPACE="")
        assert router.wait(30) == 2
        assert speech.wait(60) == 2
        for name in ("router", "speech"):
            said = opened.log(f"services.{name}")
            assert f"certificate of {name} expired on 20" in said
            assert "tidybot keys --force" in said
            assert "Traceback" not in said
    finally:
        opened.close()


@pytest.mark.parametrize(
    ("listen", "expected"),
    [
        ("tcp/0.0.0.0:0", "let in everybody on the network"),
        ("tcp/[::]:0", "let in everybody on the network"),
        ("tls/127.0.0.1:0", "needs certificates"),
    ],
)
def test_without_keys_a_router_serves_this_machine_only(tmp_path: Path, listen: str, expected: str) -> None:
    opened = Site(tmp_path)
    try:
        assert opened.start("services.router", "--listen", listen).wait(30) == 2
        assert expected in opened.log("services.router")
    finally:
        opened.close()


def test_with_keys_a_router_does_not_listen_without(tmp_path: Path, ours: Path) -> None:
    opened = Site(tmp_path)
    try:
        router = opened.start("services.router", "--listen", "tcp/127.0.0.1:0", TIDYBOT_KEYS=str(ours))
        assert router.wait(30) == 2
        assert "only tls/ is used" in opened.log("services.router")
    finally:
        opened.close()


def test_up_names_the_expired_certificate_before_anything_starts(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    keys = tmp_path / "keys"
    assert tidybot(["keys", "--dir", str(keys)]) == 0
    Authority(keys).issue(Subject(name="navigation"), days=-0.5)
    monkeypatch.setenv("TIDYBOT_RUN_DIR", str(tmp_path / "run"))
    assert tidybot(["up", "--keys", str(keys), "--port", str(free_port())]) == 1
    assert "certificate of navigation expired on 20" in capsys.readouterr().err
    assert not (tmp_path / "run").exists()
    assert tidybot(["up", "--keys", "--port", str(free_port())]) == 1
    assert "no keys in" in capsys.readouterr().err


def visit(machine: Machine, label: str, endpoint: str, tls: dict[str, Any]) -> dict[str, Any]:
    """What a stranger on that machine saw."""
    process = machine.start("tests.stranger", endpoint, json.dumps(tls), label=label)
    assert process.wait(60) == 0, machine.log(label)
    told: dict[str, Any] = json.loads(machine.log(label).splitlines()[-1])
    return told


@pytest.mark.slow
def test_a_stranger_on_another_machine_sees_nothing(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    with network(tmp_path) as net:
        keys = tmp_path / "keys"
        assert tidybot(["keys", "--dir", str(keys), "--host", net.one.address, "--host", net.door]) == 0
        theirs = authority(tmp_path / "theirs")
        net.one.start("services.router", "--listen", "tls/0.0.0.0:7447", TIDYBOT_KEYS=str(keys))
        monkeypatch.setenv("TIDYBOT_KEYS", str(keys))
        got: list[str] = []
        with open_session(f"tls/{net.door}:7447", name="sim", patience=40) as session:
            session.declare_subscriber(topics.BASE_TARGET.key, lambda s: got.append(s.payload.to_string()))
            session.declare_subscriber(topics.ROBOT_STOP.key, lambda s: got.append(s.payload.to_string()))
            state = Publisher(session, topics.SIM_STATUS)
            state.put(b'{"state": "running"}', None)
            token = session.liveliness().declare_token("service/sim/alive")
            address = f"{net.one.address}:7447"
            known = {"root_ca_certificate": str(keys / "speech" / "ca.pem")}
            forged = {
                **known,
                "enable_mtls": True,
                "connect_certificate": str(theirs / "speech" / "cert.pem"),
                "connect_private_key": str(theirs / "speech" / "key.pem"),
            }
            for label, endpoint, tls in (
                ("plain", f"tcp/{address}", {}),
                ("nameless", f"tls/{address}", known),
                ("forged", f"tls/{address}", forged),
            ):
                told = visit(net.two, label, endpoint, tls)
                assert not told["opened"], (label, told)
                assert told["seen"] == [], (label, told)
            # The same visitor sees what it may as soon as it has a certificate: the road is open.
            speech = {
                k: str(keys / "speech" / f)
                for k, f in (("connect_certificate", "cert.pem"), ("connect_private_key", "key.pem"))
            }
            told = visit(net.two, "speech", f"tls/{address}", {**forged, **speech})
            assert told["opened"], told
            assert told["seen"] == [], "and even then not what is not its own"
            del token
        assert set(got) <= {""}, "nobody drives the base; a certificate of speech may stop the robot"
        assert got, "and it does"


def test_a_certificate_that_the_router_does_not_list_opens_no_key(
    closed: Site, ours: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A client that was removed from the list keeps its certificate, and has no use for it."""
    Authority(ours).issue(Subject(name="mallory", role="operator"), days=1)
    monkeypatch.setenv("TIDYBOT_KEYS", str(ours))
    heard: list[str] = []
    with (
        open_session(closed.connect, name="operator", patience=40) as operator,
        open_session(closed.connect, name="speech", patience=40) as speech,
        open_session(closed.connect, name="mallory", patience=40) as mallory,
    ):
        for name, session in (("operator", operator), ("mallory", mallory)):
            elsewhere = zenoh.Locality.REMOTE
            session.declare_subscriber("**", lambda s, name=name: heard.append(name), allowed_origin=elsewhere)
        speech.declare_subscriber(topics.SPEECH_TEXT.key, lambda s: heard.append(s.payload.to_string()))

        def talk() -> bool:
            mallory.put(topics.SPEECH_TEXT.key, "from mallory")
            speech.put(topics.SPEECH_STATUS.key, "status")
            operator.put(topics.SPEECH_TEXT.key, "from operator")
            return {"operator", "from operator"} <= set(heard)

        eventually(talk, "the others talk")
        eventually(lambda: talk() and heard.count("from operator") > 5, "and go on talking")
        assert not {"mallory", "from mallory"} & set(heard)
