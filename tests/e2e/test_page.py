"""The operator's page in a real browser, while the whole robot is up and on a mission."""

import json
import os
import re
import shutil
import subprocess
import sys
import wave
from collections.abc import Iterator
from pathlib import Path
from typing import Any
from urllib.parse import urlsplit

import numpy as np
import pytest

from cli.link import Link
from cli.processes.ports import free_port
from common import topics
from common.bus.session import open_session
from evaluation.site import eventually
from services.dashboard.config import DashboardConfig
from services.dashboard.web.events import Sound, Words
from services.dashboard.web.server import Web
from tests.support import ROOT

playwright = pytest.importorskip("playwright.sync_api", reason="playwright is not installed")
CHROMIUM = os.environ.get("CHROMIUM") or shutil.which("chromium") or shutil.which("chromium-browser")
VOICE = ROOT / "docs" / "audio" / "bring_me_the_red_mug.wav"
SHOTS = Path(os.environ.get("TIDYBOT_SCREENSHOTS") or ROOT / "out" / "page")
PATIENCE = 240_000
FLAGS = [
    "--no-sandbox", "--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader",
    "--use-fake-ui-for-media-stream", "--use-fake-device-for-media-stream",
]  # fmt: skip
pytestmark = [
    pytest.mark.long,
    pytest.mark.skipif(not CHROMIUM, reason="Chromium is not installed; on Debian: apt-get install chromium"),
    pytest.mark.timeout(900),
    # playwright and Chromium leave sockets to the garbage collector.
    pytest.mark.filterwarnings("ignore::ResourceWarning"),
    pytest.mark.filterwarnings("ignore::pytest.PytestUnraisableExceptionWarning"),
]


@pytest.fixture(scope="module")
def robot(tmp_path_factory: pytest.TempPathFactory) -> Iterator[str]:
    """Every process of `tidybot up`; gives the router's address."""
    directory = tmp_path_factory.mktemp("page") / "run"
    port = free_port()
    clean = {k: v for k, v in os.environ.items() if not k.startswith("TIDYBOT")}
    environ = {**clean, "PYTHONPATH": str(ROOT), "TIDYBOT_RUN_DIR": str(directory)}
    command = [sys.executable, "-m", "cli.main"]
    settings = ["--scene", "minimal", "--speed", "2", "--set", "dashboard.port=0", "--set", "dashboard.frame_rate=1"]
    up = [*command, "up", "--detach", "--port", str(port), *settings]
    try:
        done = subprocess.run(up, env=environ, cwd=ROOT, capture_output=True, text=True, timeout=300)
        assert done.returncode == 0, done.stdout + done.stderr
        assert "page " in done.stdout
        yield f"tcp/127.0.0.1:{port}"
    finally:
        subprocess.run([*command, "down"], env=environ, cwd=ROOT, capture_output=True, timeout=180)


@pytest.fixture(scope="module")
def link(robot: str) -> Iterator[Link]:
    with open_session(robot, patience=10) as session:
        yield Link(session, robot)


@pytest.fixture(scope="module")
def browser(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Any]:
    """Its microphone hears the recording over and over, with pauses from which the ear knows where it ends."""
    played = tmp_path_factory.mktemp("voice") / "voice.wav"
    with wave.open(str(VOICE)) as source, wave.open(str(played), "wb") as file:
        file.setparams(source.getparams())
        pause = bytes(2 * round(1.5 * source.getframerate()))
        file.writeframes(pause + source.readframes(source.getnframes()) + pause)
    flags = [*FLAGS, f"--use-file-for-fake-audio-capture={played}"]
    with playwright.sync_playwright() as started:
        opened = started.chromium.launch(executable_path=CHROMIUM, args=flags)
        yield opened
        opened.close()


class Visitor:
    """A browser window on the page, and everything that it asked the network for."""

    def __init__(self, browser: Any, url: str) -> None:
        self.asked: list[str] = []
        self.errors: list[str] = []
        self.page = browser.new_page(viewport={"width": 480, "height": 360})
        self.page.set_default_timeout(PATIENCE)
        self.page.on("request", lambda request: self.asked.append(request.url))
        self.page.on("websocket", lambda opened: self.asked.append(opened.url))
        self.page.on("pageerror", lambda error: self.errors.append(str(error)))
        self.page.goto(url)

    def until(self, state: str) -> None:
        self.wait(f"/^({state})$/.test(document.getElementById('state').textContent)")

    def wait(self, condition: str) -> None:
        # Not at each frame: frames are rare on a machine that draws without a graphics card.
        self.page.wait_for_function(condition, polling=100)

    def shot(self, name: str) -> None:
        SHOTS.mkdir(parents=True, exist_ok=True)
        self.page.screenshot(path=SHOTS / f"{name}.png", timeout=PATIENCE)

    def outside(self) -> list[str]:
        """Requests to any other machine."""
        return [u for u in self.asked if urlsplit(u).scheme not in ("blob", "data") and not _local(u)]


def _local(url: str) -> bool:
    return urlsplit(url).hostname in ("127.0.0.1", "localhost")


@pytest.fixture(scope="module")
def visitor(browser: Any, link: Link) -> Iterator[Visitor]:
    """One window for all tests of the robot's page: loading it takes a machine without graphics five seconds."""
    found = eventually(lambda: link.latest(topics.PAGE_STATUS), "the page says where it is")
    assert found is not None
    opened = Visitor(browser, found.url)
    try:
        yield opened
    finally:
        opened.page.close()


def test_the_hand_is_led_as_long_as_a_key_a_button_or_a_stick_is_held(browser: Any) -> None:
    """Without a robot, as for the base: dead-man switch of keys, touch and gamepad, and the stop before all of them."""
    web = Web(DashboardConfig(port=0))
    told: list[Words] = []

    def until(do: str, text: str) -> None:
        while not told or (told[-1].do, told[-1].text) != (do, text):
            event = web.inbox.get(timeout=60)
            if isinstance(event, Words):
                told.append(event)

    rest = "0.00 0.00 0.00 0.00 0.00 0.00"
    try:
        window = Visitor(browser, web.url)
        page = window.page
        window.wait("document.getElementById('link').textContent !== 'connecting'")
        page.keyboard.press("w")
        page.locator("#drive").click()
        page.locator("#hand").click()
        assert page.locator("#pad").is_hidden() and web.inbox.empty(), "one of the two has the keys"
        page.keyboard.down("w")
        until("hand", "1.00 0.00 0.00 0.00 0.00 0.00")
        page.keyboard.down("r")
        until("hand", "1.00 0.00 1.00 0.00 0.00 0.00")
        page.keyboard.press("Space")
        until("stop", "")
        page.keyboard.up("w")
        page.keyboard.up("r")
        until("hand", rest)
        page.keyboard.press("c")
        until("hand", f"{rest} close")
        until("hand", rest)
        home = page.locator("[data-hand='home']")
        home.dispatch_event("pointerdown")
        until("hand", "home")
        home.dispatch_event("pointerup")
        until("hand", rest)
        page.locator("[data-hand='0 0 -1 0 0 0']").dispatch_event("pointerdown")
        until("hand", "0.00 0.00 -1.00 0.00 0.00 0.00")
        page.evaluate("window.dispatchEvent(new Event('blur'))")
        until("hand", rest)
        # A gamepad's sticks count only while a shoulder button is held.
        page.evaluate(
            "window.pads = [{ axes: [0, -0.5, 0, 1], buttons: Array.from({ length: 8 }, () => ({ pressed: false })) }];"
            "navigator.getGamepads = () => window.pads"
        )
        page.wait_for_timeout(200)
        assert web.inbox.empty()
        page.evaluate("window.pads[0].buttons[5].pressed = true")
        until("hand", "0.50 0.00 -1.00 0.00 0.00 0.00")
        page.evaluate("window.pads[0].buttons[5].pressed = false")
        until("hand", rest)
        page.locator("#hand").click()
        page.keyboard.down("w")
        page.wait_for_timeout(200)
        assert web.inbox.empty() and all(w.do in ("hand", "stop") for w in told) and window.errors == []
        page.close()
    finally:
        web.close()


def test_the_base_is_driven_as_long_as_a_key_or_a_button_is_held(browser: Any) -> None:
    """Without a robot: what comes out of the page's server while a key is down, and after; nothing before "Drive"."""
    web = Web(DashboardConfig(port=0))

    def wishes(until: str) -> list[str]:
        found: list[str] = []
        while not found or found[-1] != until:
            event = web.inbox.get(timeout=60)
            if event != Sound(b""):
                assert isinstance(event, Words) and event.do == "drive", event
                found.append(event.text)
        return found

    rest = "0.00 0.00 0.00"
    try:
        window = Visitor(browser, web.url)
        page = window.page
        window.wait("document.getElementById('link').textContent !== 'connecting'")
        page.keyboard.press("w")
        page.locator("#drive").click()
        page.keyboard.down("ArrowUp")
        assert wishes("1.00 0.00 0.00") == ["1.00 0.00 0.00"], "the key before Drive was pressed did nothing"
        page.keyboard.down("q")
        wishes("1.00 0.00 1.00")
        page.keyboard.up("q")
        page.keyboard.up("ArrowUp")
        wishes(rest)
        button = page.locator("#pad [data-drive='0 -1 0']")
        button.dispatch_event("pointerdown")
        wishes("0.00 -1.00 0.00")
        page.evaluate("window.dispatchEvent(new Event('blur'))")
        wishes(rest)
        page.locator("#text").click()
        page.keyboard.type("was")
        page.locator("#drive").click()
        page.keyboard.down("ArrowUp")
        page.wait_for_timeout(300)
        page.fill("#text", "")
        page.locator("#name").click()
        assert page.evaluate("document.activeElement.id") == "text", "the name is to be typed first"
        assert web.inbox.empty(), "neither typing nor a closed pad drives"
        assert window.errors == []
        page.close()
    finally:
        web.close()


def test_the_microphone_arrives_as_16_khz_samples(browser: Any) -> None:
    """Without a robot: what the browser's fake microphone plays against what comes out of the page's server."""
    with wave.open(str(VOICE)) as file:
        spoken = np.frombuffer(file.readframes(file.getnframes()), "<i2").astype(float)
        assert file.getframerate() == 16000
    web = Web(DashboardConfig(port=0))
    try:
        window = Visitor(browser, web.url)
        box, mouse = window.page.locator("#talk").bounding_box(), window.page.mouse
        # Held at its edge: the button grows narrower than that as its words change.
        mouse.move(box["x"] + box["width"] - 2, box["y"] + box["height"] / 2)
        mouse.down()
        window.wait("document.getElementById('talk').textContent === 'Talking'")
        window.page.locator("#talk").dispatch_event("pointerleave", {"pointerId": 7})
        pieces: list[bytes] = []
        # A whole recording is in it wherever the player was: the rest of one, the pauses of 3 s, the next one.
        while sum(map(len, pieces)) < 2 * (2 * len(spoken) + round(3.2 * 16000)):
            event = web.inbox.get(timeout=60)
            assert isinstance(event, Sound)
            pieces.append(event.data)
        mouse.up()
        while (event := web.inbox.get(timeout=60)) != Sound(b""):
            assert isinstance(event, Sound)
        window.page.close()
    finally:
        web.close()
    assert {len(piece) for piece in pieces} == {3200}
    heard = np.frombuffer(b"".join(pieces), "<i2").astype(float)
    # The loudness over time must be that of the recording, wherever the player was when the button went down.
    step = 160
    loudness = [np.sqrt(np.mean(x[: len(x) // step * step].reshape(-1, step) ** 2, axis=1)) for x in (heard, spoken)]
    a, b = loudness[0] - loudness[0].mean(), loudness[1] - loudness[1].mean()
    likeness = np.correlate(a, b, "valid") / (np.linalg.norm(b) * np.sqrt(np.convolve(a**2, np.ones(len(b)), "valid")))
    assert likeness.max() > 0.8


def sim_state(link: Link) -> str:
    status = link.latest(topics.SIM_STATUS)
    return status.state if status is not None else ""


def last_outcome(link: Link) -> tuple[str, str]:
    state = link.latest(topics.BRAIN_STATE)
    last = state.last if state is not None else None
    return (last.id, last.outcome) if last is not None else ("", "")


def test_a_command_a_stop_and_a_delivery(visitor: Visitor, link: Link) -> None:
    page = visitor.page
    visitor.until("WAITING|LISTENING")
    page.fill("#text", "bring me the red mug")
    page.press("#text", "Enter")
    visitor.until("NAVIGATING")
    page.evaluate("document.activeElement.blur()")
    page.keyboard.press("Space")
    visitor.until("STOPPED")
    assert sim_state(link) == "stopped"
    # The brain says a moment later than the brake what has become of the mission.
    visitor.wait("!document.getElementById('goon').hidden")
    assert page.inner_text("#resume") == "Release only"
    before = last_outcome(link)
    assert before[1] == "cancelled"
    visitor.shot("stopped")
    page.click("#goon")
    eventually(lambda: sim_state(link) == "running", "the brake is released")
    visitor.until("NAVIGATING|GRABBING")
    assert not page.is_visible("#goon") and not page.is_visible("#resume")
    told = page.inner_text("#detail")
    assert re.match(r"“bring me the red mug” · \d+(:\d\d min| s)", told), told
    assert "cancelled" not in told
    visitor.shot("mission")
    visitor.wait("document.body.dataset.outcome === 'delivered'")
    eventually(lambda: last_outcome(link) == (before[0], "delivered"), "the same mission, gone on with")
    panel = page.frame_locator("#view")
    panel.get_by_text("bring me the red mug: delivered").wait_for()
    visitor.shot("delivered")
    assert visitor.outside() == []
    assert visitor.errors == []


def test_the_space_bar_stops_from_inside_the_view(visitor: Visitor, link: Link) -> None:
    visitor.until("WAITING|LISTENING")
    view = visitor.page.locator("#view").element_handle().content_frame()
    view.wait_for_selector("canvas")
    view.evaluate("document.body.tabIndex = 0; document.body.focus()")
    visitor.page.keyboard.press("Space")
    visitor.until("STOPPED")
    assert sim_state(link) == "stopped"
    assert not visitor.page.is_visible("#goon"), "there is nothing to go on with"
    visitor.page.click("#resume")
    eventually(lambda: sim_state(link) == "running", "the brake is released")


def test_a_telephone_has_stop_question_and_talk_button_in_sight(visitor: Visitor) -> None:
    page = visitor.page
    page.set_viewport_size({"width": 390, "height": 780})
    try:
        # At once: the page hides the question again with the next state that asks nothing.
        boxes = page.evaluate("""() => {
            document.getElementById('ask').hidden = false;
            document.getElementById('question').textContent = 'Did you say bring me the red mug from the kitchen?';
            return Object.fromEntries(['stop', 'talk', 'question', 'yes', 'no', 'text'].map(id =>
                ['#' + id, document.getElementById(id).getBoundingClientRect().toJSON()]));
        }""")
        for name, box in boxes.items():
            assert (
                box["width"] > 0
                and box["x"] >= 0
                and box["x"] + box["width"] <= 390
                and box["y"] + box["height"] <= 300
            ), (
                name,
                box,
            )
        assert min(boxes[n]["height"] for n in ("#stop", "#talk", "#yes", "#no")) >= 40, "wide enough for a finger"
        assert page.evaluate("document.documentElement.scrollWidth") <= 390
        panels = page.frame_locator("#view")
        panels.get_by_role("tab", name="Health").click()
        button = panels.locator("[data-restart='sim']")
        button.wait_for()
        # Laid out anew at the next frame, of which there are few without a graphics card.
        eventually(
            lambda: (box := button.bounding_box()) and box["x"] + box["width"] <= 390, "the table is not cut off"
        )
        tops = [tab.bounding_box()["y"] for tab in panels.get_by_role("tab").all()]
        assert len(tops) == 6 and max(tops) == min(tops), "the tabs are in one row"
        panels.get_by_role("tab", name="Mission").click()
        visitor.shot("telephone")
    finally:
        page.set_viewport_size({"width": 480, "height": 360})


@pytest.mark.slow
def test_a_command_by_microphone(visitor: Visitor, link: Link) -> None:
    page = visitor.page
    visitor.until("WAITING|LISTENING")
    heard: list[str] = []
    watch = link.session.declare_subscriber(
        topics.SPEECH_RESULT.key, lambda sample: heard.append(json.loads(sample.payload.to_string())["text"])
    )
    commands: list[str] = []
    listener = link.session.declare_subscriber(
        topics.VOICE_COMMAND.key, lambda sample: commands.append(json.loads(sample.payload.to_string())["text"])
    )
    try:
        button = page.locator("#talk")
        button.dispatch_event("pointerdown")
        visitor.wait("document.getElementById('talk').textContent === 'Talking'")
        eventually(lambda: "bring me the red mug" in (*heard, *commands), f"understood; heard {heard}", 120)
        button.dispatch_event("pointerup")
    finally:
        watch.undeclare()
        listener.undeclare()
    visitor.until("CONFIRMING|PLANNING|GROUNDING|NAVIGATING|GRABBING")
    if page.is_visible("#ask"):
        assert "red mug" in page.inner_text("#question")
        visitor.shot("asking")
        page.click("#yes")
        visitor.until("PLANNING|GROUNDING|NAVIGATING|GRABBING")
    visitor.shot("talked")
    page.click("#stop")
    visitor.until("STOPPED")
    page.click("#resume")
