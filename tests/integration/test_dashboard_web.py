"""The page's web server with real sockets: who gets in, what gets through, and what a browser that hangs does."""

import contextlib
import json
import socket
import urllib.error
import urllib.request
from collections.abc import Iterator
from http.client import HTTPResponse

import numpy as np
import pytest
import viser
from websockets.exceptions import InvalidStatus
from websockets.sync.client import ClientConnection, connect
from websockets.typing import Origin, Subprotocol

from common import messages as m
from common import topics
from common.bus.memory import MemoryBus, MemoryIo
from common.household import load_household
from evaluation.site import eventually
from services.dashboard.config import DashboardConfig
from services.dashboard.service import DashboardService
from services.dashboard.web.events import Sound, Words
from services.dashboard.web.listener import PageError
from services.dashboard.web.server import Web

TOKEN = "a token for these tests"


@contextlib.contextmanager
def serving(**settings: object) -> Iterator[Web]:
    web = Web(DashboardConfig(**{"port": 0, **settings}))  # type: ignore[arg-type]
    try:
        yield web
    finally:
        web.close()


@pytest.fixture(scope="module")
def web() -> Iterator[Web]:
    with serving() as opened:
        yield opened


@pytest.fixture(scope="module")
def locked() -> Iterator[Web]:
    with serving(token=TOKEN) as opened:
        yield opened


def get(web: Web, path: str, **headers: str) -> tuple[int, bytes, HTTPResponse | None]:
    request = urllib.request.Request(f"http://127.0.0.1:{web.port}{path}", headers=headers)
    try:
        with urllib.request.urlopen(request, timeout=10) as answer:
            return answer.status, answer.read(), answer
    except urllib.error.HTTPError as error:
        with error:
            return error.code, error.read(), None


def talk(web: Web, path: str = "/live", origin: str | None = None, **headers: str) -> ClientConnection:
    return connect(
        f"ws://127.0.0.1:{web.port}{path}",
        origin=Origin(origin) if origin else None,
        additional_headers=headers,
        proxy=None,
        open_timeout=10,
    )


def test_the_page_and_what_it_needs_are_there(web: Web) -> None:
    status, body, answer = get(web, "/")
    assert status == 200
    assert answer is not None
    assert "default-src 'self'" in answer.headers["Content-Security-Policy"]
    assert b'id="stop"' in body
    for path in ("/page/page.js", "/page/keys.js", "/page/recorder.js", "/page/page.css", "/view/"):
        status, content, _ = get(web, path)
        assert status == 200, path
        assert b"https://cdn" not in content
    assert get(web, "/page/../web.py")[0] == 404
    assert get(web, "/nothing")[0] == 404


@pytest.mark.parametrize("path", ["/", "/view/", "/page/page.js"])
def test_a_foreign_name_that_leads_here_is_refused(web: Web, path: str) -> None:
    assert get(web, path, Host="evil.example")[0] == 403


@pytest.mark.parametrize("path", ["/live", "/view"])
def test_a_foreign_page_cannot_connect(web: Web, path: str) -> None:
    with pytest.raises(InvalidStatus) as refused:
        talk(web, path, origin="http://evil.example")
    assert refused.value.response.status_code == 403


def test_without_the_token_nothing_opens(locked: Web) -> None:
    for path in ("/", "/view/", "/page/page.js", "/?token=wrong"):
        assert get(locked, path)[0] == 401, path
    for path in ("/live", "/view"):
        with pytest.raises(InvalidStatus) as refused:
            talk(locked, path)
        assert refused.value.response.status_code == 401


def test_the_token_opens_and_is_then_a_cookie(locked: Web) -> None:
    assert TOKEN in urllib.request.unquote(locked.entrance)  # type: ignore[attr-defined]
    opener = urllib.request.build_opener(urllib.request.HTTPCookieProcessor())
    address = f"http://127.0.0.1:{locked.port}/?token={urllib.request.quote(TOKEN)}"  # type: ignore[attr-defined]
    with opener.open(address, timeout=10) as answer:
        assert answer.status == 200
        assert "token" not in answer.url
    with opener.open(f"http://127.0.0.1:{locked.port}/view/", timeout=10) as answer:
        assert answer.status == 200


def test_words_and_sound_arrive_in_order(web: Web) -> None:
    with talk(web) as page:
        page.send(json.dumps({"do": "say", "text": "hello"}))
        page.send(b"\1\2\3\4")
        page.send("not JSON")
        page.send(json.dumps({"do": 5}))
        page.send(json.dumps({"do": "stop"}))
        found = [web.inbox.get(timeout=10) for _ in range(3)]
    assert found == [Words("say", "hello"), Sound(b"\1\2\3\4"), Words("stop")]
    assert web.inbox.get(timeout=10) == Sound(b""), "a page that closes ends what its microphone began"


def test_a_late_page_is_told_the_present_state(web: Web) -> None:
    web.say("state", {"n": 1})
    web.say("state", {"n": 2})
    with talk(web) as page:
        assert json.loads(page.recv(timeout=10)) == {"kind": "state", "value": {"n": 2}}
        web.play(b"\5\6", 22050)
        assert page.recv(timeout=10) == (22050).to_bytes(4, "little") + b"\5\6"


def test_a_page_that_hangs_is_dropped_and_the_others_hear_everything(web: Web) -> None:
    hung = socket.create_connection(("127.0.0.1", web.port))
    hung.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 4096)
    hung.sendall(
        f"GET /live HTTP/1.1\r\nHost: 127.0.0.1:{web.port}\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
        "Sec-WebSocket-Version: 13\r\nSec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n\r\n".encode()
    )
    pages = [talk(web) for _ in range(3)]
    try:
        for page in pages:
            page.recv(timeout=10)
        eventually(lambda: len(web.visitors) == 4, "all four are in")
        sent = 400
        for n in range(sent):
            web.play(bytes(20000), 16000 + n)
            for page in pages:
                heard = page.recv(timeout=10)
                assert isinstance(heard, bytes)
                assert int.from_bytes(heard[:4], "little") == 16000 + n
        eventually(lambda: len(web.visitors) == 3, "the one that hangs was let go")
    finally:
        hung.close()
        for page in pages:
            page.close()


def test_the_view_is_passed_on_with_its_stream(web: Web) -> None:
    protocol = Subprotocol(f"viser-v{viser.__version__}")
    address = f"ws://127.0.0.1:{web.port}/view"
    with connect(address, subprotocols=[protocol], proxy=None, max_size=None) as view:
        assert view.subprotocol == protocol
        assert isinstance(view.recv(timeout=10), bytes)
    eventually(lambda: not web.watched, "the visitor has gone")


def test_a_view_that_hangs_holds_up_nobody(web: Web) -> None:
    protocol = Subprotocol(f"viser-v{viser.__version__}")
    with socket.create_connection(("127.0.0.1", web.port)) as hung:
        _beside_one_that_hangs(web, hung, protocol)
    eventually(lambda: not web.watched and not web.viser._websock_server._live_connections, "both have gone")


def _beside_one_that_hangs(web: Web, hung: socket.socket, protocol: Subprotocol) -> None:
    hung.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 4096)
    hung.sendall(
        f"GET /view HTTP/1.1\r\nHost: 127.0.0.1:{web.port}\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
        f"Sec-WebSocket-Version: 13\r\nSec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n"
        f"Sec-WebSocket-Protocol: {protocol}\r\n\r\n".encode()
    )
    cursors = web.viser._websock_server._broadcast_buffer.generator_cursors
    eventually(lambda: len(cursors) == 1, "the one that hangs is in")
    with connect(f"ws://127.0.0.1:{web.port}/view", subprotocols=[protocol], proxy=None, max_size=None) as view:
        eventually(lambda: len(cursors) == 2, "both are in")
        # More than all buffers on the way hold; the other must have each piece before the next is sent.
        cloud = web.viser.scene.add_point_cloud("/cloud", np.zeros((1, 3), np.float32), (0, 0, 0))
        for n in range(50):
            points = np.full((120_000, 3), n + 1, np.float32)
            cloud.points = points
            while points.astype(np.float16).tobytes() not in view.recv(timeout=10):  # type: ignore[operator]
                pass
        behind, ahead = sorted(cursors.values())
        assert behind < ahead, "the one that hangs was really held up"
        cloud.remove()


def test_visers_own_port_answers_nobody(web: Web) -> None:
    inner = web.viser.get_port()
    assert inner != web.port
    with pytest.raises(urllib.error.HTTPError) as refused:
        urllib.request.urlopen(f"http://127.0.0.1:{inner}/", timeout=10)
    assert refused.value.code == 403
    refused.value.close()
    with pytest.raises(InvalidStatus):
        connect(f"ws://127.0.0.1:{inner}/", proxy=None, open_timeout=10)


def test_a_busy_port_gives_way_or_says_so() -> None:
    with socket.socket() as taken:
        taken.bind(("127.0.0.1", 0))
        taken.listen(1)
        port = taken.getsockname()[1]
        with serving(port=port, port_tries=20) as moved:
            assert port < moved.port < port + 20
        with pytest.raises(PageError, match=rf"{port}.*dashboard\.port"):
            Web(DashboardConfig(port=port, port_tries=1))


def test_a_short_token_is_refused() -> None:
    with pytest.raises(PageError, match="16"):
        Web(DashboardConfig(port=0, token="short"))


def test_beyond_loopback_a_token_is_made_up() -> None:
    with serving(host="0.0.0.0") as opened:
        assert "?token=" in opened.entrance
        assert "token" not in opened.url
        assert get(opened, "/")[0] == 401


def test_stop_on_the_page_is_a_stop_on_the_bus_within_one_step() -> None:
    bus = MemoryBus()
    io = MemoryIo(
        bus,
        "dashboard",
        DashboardService.READS,
        DashboardService.WRITES,
        household=load_household("minimal"),
        lockstep=False,
    )
    stops = bus.tap(topics.ROBOT_STOP)
    service = DashboardService(DashboardConfig(port=0), io)
    try:
        bus.send(topics.BRAIN_STATE, m.BrainState(state="CONFIRMING", step="Did you say mug?"))
        bus.send(topics.SIM_STATUS, m.SimStatus(state="stopped"))
        io.begin(None, 0.0)
        service.step(0.0)
        with talk(service.web) as page:
            told = json.loads(page.recv(timeout=10))["value"]
            assert (told["asking"], told["stopped"], told["question"]) == (True, True, "Did you say mug?")
            page.send(json.dumps({"do": "stop"}))
            eventually(lambda: not service.web.inbox.empty(), "the stop has arrived")
            io.begin(None, 0.03)
            service.step(0.03)
            assert len(stops) == 1
    finally:
        service.close()
