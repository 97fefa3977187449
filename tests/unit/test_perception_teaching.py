"""The perception service before painted boxes: names are taught, known again, forgotten; print is read on request."""

from collections.abc import Mapping
from pathlib import Path
from types import MappingProxyType
from typing import Any, ClassVar

import numpy as np
import pytest

from common import messages as m
from common import topics
from common.geometry import Mask
from common.household import Household, load_household
from services.perception.config import PerceptionConfig
from services.perception.detect import Detection
from services.perception.naming.naming import HALF_READ
from services.perception.naming.naming import RESEMBLES as LAST
from services.perception.naming.reader import installed
from services.perception.service import PerceptionService
from services.perception.views.view import View
from tests.node import Node
from tests.unit.painted import Box, label, view_of_boxes

VITAMINS = label("VITAL", "FORTE", ground=(240, 240, 235), ink=(200, 60, 20), band=(240, 140, 30))
TEA = label("GREEN", "TEA", ground=(240, 240, 235), ink=(20, 90, 40), band=(40, 120, 60))


class ShownBoxes:
    """A detector that is told where the boxes are, not what they look like."""

    boxes: ClassVar[list[Box]] = []

    def __init__(self, household: Household, max_range: float) -> None:
        pass

    def detect(self, view: View, robot: Mask | None = None) -> list[Detection]:
        return [
            Detection(
                label=f"white box {n}", kind="box", colour="white", position=(b.x, b.y, 1.0), yaw=0.0,
                size=(b.depth, b.width, b.height), confidence=0.9, on="", distance=b.x,
            )
            for n, b in enumerate(self.boxes)
        ]  # fmt: skip


class Shown(Node):
    """The service with a camera before which boxes stand."""

    def __init__(
        self, *boxes: Box, state_dir: Path | None = None, settings: Mapping[str, Any] = MappingProxyType({})
    ) -> None:
        ShownBoxes.boxes = list(boxes)
        config = PerceptionConfig(detector=f"{__name__}:ShownBoxes", fine_width=1280, fine_height=960, **settings)
        super().__init__(PerceptionService, config, load_household("minimal"), state_dir=state_dir)
        self._taken = 0
        self.sizes: list[tuple[int, int]] = []

    def feed(self) -> None:
        self.send(topics.POSE, m.PoseEstimate(t=self.now, x=0.0, y=0.0, theta=0.0))
        for request in self.sent(topics.CAMERA_REQUEST)[self._taken :]:
            self._taken += 1
            self.sizes.append((request.width, request.height))
            view = view_of_boxes(ShownBoxes.boxes, request.width, request.height)
            self.send(
                topics.HEAD_RGBD,
                m.Rgbd(
                    t=self.now, id=request.id, camera="head", width=request.width, height=request.height,
                    fx=view.focal[0], fy=view.focal[1], cx=view.middle[0], cy=view.middle[1], position=(0.0, 0.0, 1.0),
                    orientation=(0.5, -0.5, 0.5, -0.5), rgb=view.rgb.tobytes(),
                    depth=np.round(view.depth * 1000).astype("<u2").tobytes(),
                ),
            )  # fmt: skip

    def teach(self, name: str, forget: bool = False, **fields: object) -> m.TeachResult:
        request = m.TeachRequest(name=name, id=f"teach-{self.now}", forget=forget, **fields)  # type: ignore[arg-type]
        self.send(topics.TEACH, request)
        self.until(lambda: self.count(topics.TAUGHT) and self.last(topics.TAUGHT).goal_id == request.id, limit=20)
        return self.last(topics.TAUGHT)

    def names(self) -> dict[str, list[str]]:
        return {o.label: o.names for o in self.last(topics.WORLD_OBJECTS).objects}

    def ask(self, query: str) -> m.ObjectPose:
        asked = m.ObjectQuery(id=f"query-{self.now}", query=query)
        self.send(topics.OBJECT_QUERY, asked)
        self.until(lambda: self.count(topics.OBJECT_POSE) and self.last(topics.OBJECT_POSE).query_id == asked.id, 30)
        return self.last(topics.OBJECT_POSE)


def test_what_stands_before_the_robot_is_taught_and_found_by_its_name() -> None:
    node = Shown(Box(0.9, 0.0, VITAMINS))
    result = node.teach("my Vitamin Box")
    assert (result.ok, result.name, result.label) == (True, "vitamin box", "white box 0")
    assert [n.name for n in node.last(topics.HOUSEHOLD_NAMES).names] == ["vitamin box"]
    assert node.names() == {"white box 0": ["vitamin box"]}
    assert node.ask("my vitamin box").label == "white box 0"


def test_after_a_restart_it_is_known_again_elsewhere_and_beside_a_stranger(tmp_path: Path) -> None:
    assert Shown(Box(0.9, 0.0, VITAMINS), state_dir=tmp_path).teach("vitamin box").ok
    node = Shown(Box(1.2, 0.2, TEA), Box(1.3, -0.2, VITAMINS), state_dir=tmp_path)
    assert [n.name for n in node.last(topics.HOUSEHOLD_NAMES).names] == ["vitamin box"]
    assert node.ask("vitamin box").label == "white box 1"
    assert node.names() == {"white box 0": [], "white box 1": ["vitamin box"]}


def test_where_only_a_stranger_stands_the_taught_thing_is_not_found(tmp_path: Path) -> None:
    assert Shown(Box(0.9, 0.0, VITAMINS), state_dir=tmp_path).teach("vitamin box").ok
    answer = Shown(Box(1.1, 0.0, TEA), state_dir=tmp_path).ask("vitamin box")
    assert not answer.found and not answer.candidates


def test_two_that_look_the_same_are_both_candidates(tmp_path: Path) -> None:
    assert Shown(Box(0.9, 0.0, VITAMINS), state_dir=tmp_path).teach("vitamin box").ok
    answer = Shown(Box(1.1, 0.2, VITAMINS), Box(1.2, -0.2, VITAMINS), state_dir=tmp_path).ask("vitamin box")
    assert not answer.found and answer.candidates == ["white box 0", "white box 1"]


def test_this_is_refused_where_two_could_be_meant_and_taught_where_one_is_named_or_clicked() -> None:
    node = Shown(Box(1.0, 0.15, VITAMINS), Box(1.0, -0.15, TEA))
    result = node.teach("vitamin box")
    assert (result.ok, result.code, result.candidates) == (False, "AMBIGUOUS", ["white box 0", "white box 1"])
    assert node.teach("vitamin box", label="white box 0").label == "white box 0"
    assert node.teach("tea box", position=(1.02, -0.14, 0.9)).label == "white box 1"
    assert node.names() == {"white box 0": ["vitamin box"], "white box 1": ["tea box"]}


@pytest.mark.parametrize(
    ("name", "fields", "code"),
    [("mug", {}, "NAME_TAKEN"), ("", {}, "NO_NAME"), ("x" * 50, {}, "NO_NAME"),
     ("pills", {"label": "blue can"}, "NOT_SEEN"),
     ("pills", {"position": (3.0, 3.0, 0.0)}, "NOT_SEEN"), ("pills", {"forget": True}, "UNKNOWN_NAME")],
)  # fmt: skip
def test_what_cannot_be_taught_is_refused_with_the_reason(name: str, fields: dict[str, object], code: str) -> None:
    result = Shown(Box(0.9, 0.0, VITAMINS)).teach(name, **fields)  # type: ignore[arg-type]
    assert (result.ok, result.code) == (False, code) and result.detail


def test_a_forgotten_name_is_gone_at_once_and_after_a_restart(tmp_path: Path) -> None:
    node = Shown(Box(0.9, 0.0, VITAMINS), state_dir=tmp_path)
    assert node.teach("vitamin box").ok and node.teach("vitamin box", forget=True).ok
    node.step(1.0)
    assert node.names() == {"white box 0": []} and node.last(topics.HOUSEHOLD_NAMES).names == []
    assert Shown(Box(0.9, 0.0, VITAMINS), state_dir=tmp_path).last(topics.HOUSEHOLD_NAMES).names == []


def test_with_nothing_before_it_nothing_is_taught() -> None:
    assert Shown().teach("vitamin box").code == "NOT_SEEN"


@pytest.mark.skipif(not installed(), reason="the extra `ocr`")
def test_print_is_read_in_a_fine_picture_when_words_are_asked_for_that_name_nothing_else() -> None:
    node = Shown(Box(0.8, 0.12, VITAMINS), Box(0.8, -0.12, TEA))
    assert node.ask("white box").candidates and (1280, 960) not in node.sizes
    answer = node.ask("the green tea")
    assert answer.label == "white box 1" and (1280, 960) in node.sizes
    texts = {o.label: o.text.lower() for o in node.last(topics.WORLD_OBJECTS).objects}
    assert "tea" in texts["white box 1"] and "forte" in texts["white box 0"]
    assert not node.ask("coffee").found


@pytest.mark.skipif(not installed(), reason="the extra `ocr`")
def test_a_word_that_is_a_colour_as_well_tells_two_prints_apart() -> None:
    black = label("BLACK", "TEA", ground=(240, 240, 235), ink=(20, 20, 20), band=(90, 90, 90))
    node = Shown(Box(0.8, 0.12, TEA), Box(0.8, -0.12, black))
    assert node.ask("the black tea").label == "white box 1"
    assert node.ask("the green tea").label == "white box 0"
    assert node.ask("tea").candidates == ["white box 0", "white box 1"]


@pytest.mark.skipif(not installed(), reason="the extra `ocr`")
def test_print_that_is_too_far_away_leads_nearer() -> None:
    node = Shown(Box(2.4, 0.0, TEA))
    answer = node.ask("ginger biscuits")
    assert not answer.found and answer.unsure == ["white box 0"]


@pytest.mark.skipif(not installed(), reason="the extra `ocr`")
def test_what_reads_nearly_like_the_words_is_asked_about_and_nothing_else_is() -> None:
    node = Shown(Box(0.62, 0.1, label("CORM", ground=(240, 240, 235), ink=(20, 20, 20))), Box(0.62, -0.1, VITAMINS))
    answer = node.ask("the corn")
    assert not answer.found
    assert [(p.label, p.likeness) for p in answer.perhaps] == [("white box 0", HALF_READ)]


@pytest.mark.skipif(not installed(), reason="the extra `ocr`")
def test_a_fruit_that_was_asked_for_is_not_another_one_of_which_there_is_juice_too() -> None:
    carton = label("ORANGE", "JUICE", ground=(240, 240, 235), ink=(20, 20, 20))
    node = Shown(Box(0.62, 0.1, carton), Box(0.62, -0.1, VITAMINS))
    assert not node.ask("the apple juice").found
    assert node.ask("the orange juice").label == "white box 0"


@pytest.mark.skipif(not installed(), reason="the extra `ocr`")
def test_where_a_place_is_named_only_what_stands_there_is_worth_a_nearer_look() -> None:
    node = Shown(Box(2.4, 0.0, TEA))
    assert node.ask("ginger biscuits on the floor").unsure == ["white box 0"]
    assert not node.ask("ginger biscuits on the table").unsure


def test_what_has_but_the_colour_and_the_kind_of_a_taught_thing_is_asked_about_at_last(tmp_path: Path) -> None:
    assert Shown(Box(0.9, 0.0, VITAMINS), state_dir=tmp_path).teach("vitamin box").ok
    wide = Box(1.1, 0.0, VITAMINS, width=0.2, height=0.3, depth=0.2)
    answer = Shown(wide, state_dir=tmp_path).ask("vitamin box")
    assert not answer.found and not answer.candidates
    assert [(p.label, p.likeness <= LAST) for p in answer.perhaps] == [("white box 0", True)]
