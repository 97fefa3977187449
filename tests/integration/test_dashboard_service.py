"""The page's service on a memory bus with a real web server: what is drawn, and what is asked of the cameras."""

import json
import urllib.error
import urllib.request
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from math import pi

import mujoco
import numpy as np
import pytest

from common import messages as m
from common import topics
from common.household import load_household
from common.robot.model import Hand
from common.scene import load_scene
from evaluation.site import eventually
from services.dashboard.config import DashboardConfig
from services.dashboard.service import DashboardService
from services.dashboard.web.events import Click
from services.dashboard.web.server import Web
from services.sim.model import own
from services.sim.physics import Physics
from tests.node import Node
from tests.support import JOINT_NAMES

MJCF = Physics(load_scene("minimal"), 0, ()).mjcf
SIM_MODEL = m.SimModel(scene="minimal", seed=0, epoch="e", mjcf=MJCF)
MUG = m.WorldObject(
    label="red mug", kind="mug", colour="red", position=(2.0, 0.1, 0.65), size=(0.07, 0.07, 0.1), seen_at=9.0, id="1"
)


class Page(Node):
    """The service and its clock."""

    def __init__(self) -> None:
        super().__init__(
            DashboardService, DashboardConfig(port=0), load_household("minimal"), lockstep=False, tick=10_000
        )

    def step(self, seconds: float = 0.04, fed: bool = True) -> None:  # longer than a frame: what is new is drawn
        self.later(seconds)
        self.run()

    def joints(self, t: float, width: float = 0.085, **moved: float) -> None:
        values = dict(zip(JOINT_NAMES, (0.0, 0.0, 0.0, *own().home, width), strict=True)) | moved
        zeros = [0.0] * len(values)
        self.bus.send(
            topics.JOINT_STATES,
            m.JointStates(t=t, name=list(values), position=list(values.values()), velocity=zeros, effort=zeros),
        )

    def node(self, ending: str) -> object:
        nodes = self.service.scene.view.nodes
        return next(node for path, node in nodes.items() if path.endswith(ending))


@pytest.fixture
def page() -> Iterator[Page]:
    opened = Page()
    try:
        yield opened
    finally:
        opened.service.close()


@pytest.fixture
def drawn(page: Page, monkeypatch: pytest.MonkeyPatch) -> Page:
    """With somebody who looks, and the model on the screen."""
    monkeypatch.setattr(Web, "watched", True)
    page.bus.send(topics.SIM_MODEL, m.SimModel(scene="minimal", seed=0, epoch="e", mjcf=MJCF))
    page.joints(10.0)

    def there() -> bool:
        page.step()
        return bool(page.service.scene.view.drawing.links)

    eventually(there, "the model is drawn")
    return page


def test_the_robot_is_drawn_where_it_believes_to_be(drawn: Page) -> None:
    base = drawn.node("/base")
    drawn.joints(10.1, base_x=1.0)
    drawn.step()
    assert base.position[:2] == pytest.approx((1.0, 0.0))  # type: ignore[attr-defined]
    drawn.bus.send(topics.POSE, m.PoseEstimate(t=10.2, x=0.5, y=-0.4, theta=pi / 2))
    drawn.step()
    assert base.position[:2] == pytest.approx((0.5, -0.4))  # type: ignore[attr-defined]
    assert np.abs(base.wxyz) == pytest.approx([np.sqrt(0.5), 0, 0, np.sqrt(0.5)])  # type: ignore[attr-defined]


def test_the_fingers_are_as_far_apart_as_the_gripper_says(drawn: Page) -> None:
    hand = Hand(mujoco.MjModel.from_xml_string(MJCF))
    for width in (0.085, 0.02, 0.0):
        drawn.joints(11.0 + width, width=width)
        drawn.step()
        told = dict(zip(hand.joints, hand.posture(width), strict=True))["right_driver"]
        w, x, _, _ = drawn.node("/right_driver").wxyz  # type: ignore[attr-defined]
        assert 2 * np.arctan2(x, w) == pytest.approx(told, abs=1e-3)


def test_a_place_that_is_called_as_its_room_is_written_once(drawn: Page) -> None:
    parts = [
        m.HomePart(name="kitchen", kind="place", x=1.0),
        m.HomePart(name="kitchen", kind="room", x=2.0),
        m.HomePart(name="counter", kind="surface", room="kitchen", x=3.0),
    ]
    drawn.bus.send(topics.HOUSEHOLD_PARTS, m.HomeParts(parts=parts))
    drawn.step()
    shown = {label.text: label.position[0] for label in drawn.service.scene.view.part_labels}
    assert shown == {"kitchen": 2.0, "counter": 3.0}


def test_objects_come_go_and_turn_into_ghosts(drawn: Page) -> None:
    def show(*objects: m.WorldObject, t: float = 10.0) -> None:
        drawn.bus.send(topics.WORLD_OBJECTS, m.WorldObjects(t=t, objects=list(objects)))
        drawn.joints(t)
        drawn.step()

    view = drawn.service.scene.view
    show(MUG, t=10.0)
    solid = view.object_nodes["1"][0]
    assert solid.opacity is None
    assert tuple(solid.position) == pytest.approx(MUG.position)
    show(MUG, t=60.0)
    assert view.object_nodes["1"][0].opacity is not None
    show(t=61.0)
    assert view.object_nodes == {}


def test_cameras_are_asked_only_while_somebody_looks(page: Page, monkeypatch: pytest.MonkeyPatch) -> None:
    for _ in range(75):
        page.step()
    assert page.count(topics.CAMERA_REQUEST) == 0
    monkeypatch.setattr(Web, "watched", True)
    for _ in range(75):
        page.step()
    requests = page.sent(topics.CAMERA_REQUEST)
    assert {r.camera for r in requests} == {"head"}, "the wrist's pictures are not wanted unless its box is ticked"
    assert 5 <= len(requests) <= 7, "twice a second"


def test_a_picture_with_too_few_pixels_is_counted(page: Page, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(Web, "watched", True)
    page.bus.send(
        topics.HEAD_RGBD,
        m.Rgbd(
            t=1.0, id="a", camera="head", width=9999, height=9999, fx=1.0, fy=1.0, cx=1.0, cy=1.0,
            position=(0.0, 0.0, 0.0), orientation=(1.0, 0.0, 0.0, 0.0), rgb=b"123", depth=b"12",
        ),
    )  # fmt: skip
    page.step()
    assert page.io.drops[topics.HEAD_RGBD.key] == 1


def test_a_model_that_is_none_is_counted_and_a_later_one_is_drawn(drawn: Page) -> None:
    drawn.bus.send(topics.SIM_MODEL, m.SimModel(scene="x", seed=0, epoch="f", mjcf="<mujoco><nonsense/></mujoco>"))

    def counted() -> bool:
        drawn.step()
        return drawn.io.drops[topics.SIM_MODEL.key] > 0

    eventually(counted, "the bad model is counted")
    assert drawn.service.scene.view.drawing.links, "the old one stays"


def test_clicks_obey_the_check_box(drawn: Page) -> None:
    goals = drawn.bus.tap(topics.NAV_GOAL)
    drawn.bus.send(topics.BRAIN_STATE, m.BrainState(state="LISTENING"))
    click = Click(np.array([-1.0, 1.0, 3.0]), np.array([0.0, 0.0, -1.0]))
    drawn.service.web.inbox.put(click)
    drawn.step()
    assert len(goals) == 1
    drawn.service.panels.clicks.value = False
    drawn.service.web.inbox.put(click)
    drawn.step()
    assert len(goals) == 1


def test_services_are_listed_from_their_health(page: Page) -> None:
    health = m.Health(name="sim", epoch="a", t=0.0, uptime=1.0, hz=100.0, drops=3, rss_mb=80.0, pid=1)
    page.bus.send(topics.HEALTH, health)
    page.step(2.0)
    shown = page.service.panels.texts["services"]
    assert "sim" in shown
    assert "gone" in shown, "its token is not there"


def test_a_mission_has_a_page(page: Page) -> None:
    record = {
        "id": "m-1", "command": "bring me the <mug>", "started": 1.0, "outcome": "delivered", "reason": "",
        "ended": 9.0, "steps": 3, "date": 0.0, "entries": [],
    }  # fmt: skip
    page.bus.handlers[topics.BRAIN_MISSIONS] = lambda asked: json.dumps(record if b"m-1" in asked else None).encode()

    def get(name: str) -> tuple[int, str]:
        address = f"http://127.0.0.1:{page.service.web.port}/mission/{name}"
        with ThreadPoolExecutor(1) as visitor:
            answer = visitor.submit(urllib.request.urlopen, address, timeout=10)

            def come() -> bool:
                page.step()
                return answer.done()

            eventually(come, "the page has come")
            try:
                with answer.result() as opened:
                    return opened.status, opened.read().decode()
            except urllib.error.HTTPError as error:
                with error:
                    return error.code, ""

    code, text = get("m-1")
    assert code == 200
    assert "bring me the &lt;mug&gt;" in text and "<svg" in text
    assert get("m-2")[0] == 404
