"""A model that sees, played by a chat endpoint on this machine that answers well, badly, late or not at all."""

import base64
import io
import json
import time
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray
from PIL import Image

from cli.processes.ports import free_port
from common import messages as m
from common import topics
from services.perception.config import PerceptionConfig
from services.perception.naming.grounders.grounder import Candidate, GrounderError, Question
from services.perception.naming.grounders.vision import Vision
from tests.integration.test_planner_llm import Answer, Endpoint, endpoint, says, send
from tests.unit.painted import Box
from tests.unit.test_perception_teaching import TEA, VITAMINS, Shown

__all__ = ["endpoint"]

TWO = (Candidate("object-1", "white box", (20, 30, 60, 90)), Candidate("object-2", "can", (100, 40, 130, 90)))
PICTURE = np.full((120, 160, 3), 200, np.uint8)


def number(n: int, confidence: float = 0.9) -> Answer:
    return says(json.dumps({"number": n, "confidence": confidence, "reason": "it reads so"}))


def picture(endpoint: Endpoint, n: int = 0) -> NDArray[np.uint8]:
    """What was shown with the n-th request."""
    url = endpoint.requests[n]["messages"][0]["content"][1]["image_url"]["url"]
    kind, _, data = url.partition(",")
    assert kind == "data:image/jpeg;base64"
    return np.asarray(Image.open(io.BytesIO(base64.b64decode(data))))


def ask(endpoint: Endpoint, *answers: Answer, timeout: float = 20.0) -> Any:
    endpoint.answers = list(answers)
    return Vision(endpoint.url, "eye", "", timeout).choose(Question("vitamin pills", PICTURE, TWO))


def test_the_model_is_shown_numbered_marks_and_its_number_is_the_object(endpoint: Endpoint) -> None:
    choice = ask(endpoint, number(2))
    assert (choice.key, choice.confidence) == ("object-2", 0.9) and "it reads so" in choice.detail
    text = endpoint.requests[0]["messages"][0]["content"][0]["text"]
    assert "vitamin pills" in text and endpoint.requests[0]["model"] == "eye"
    shown = picture(endpoint).astype(int)
    assert shown.shape == PICTURE.shape
    # A coloured frame around each object; the object itself is as it was.
    for one in TWO:
        left, top, right, bottom = one.box
        assert np.ptp(shown[(top + bottom) // 2, left - 2], axis=0) > 60
        assert np.abs(shown[top + 8 : bottom - 8, left + 8 : right - 8] - 200).max() < 25


def test_zero_means_none_of_them(endpoint: Endpoint) -> None:
    assert ask(endpoint, number(0)).key == ""


def test_json_in_a_fence_is_understood(endpoint: Endpoint) -> None:
    assert ask(endpoint, says('```json\n{"number": 1}\n```')).key == "object-1"


@pytest.mark.parametrize(
    "bad", [number(3), number(-1), number(1, 7.0), says("the second one"), says('{"number": "x"}')]
)
def test_an_answer_that_is_none_goes_back_with_the_reason_and_is_believed_when_mended(
    endpoint: Endpoint, bad: Answer
) -> None:
    assert ask(endpoint, bad, number(1)).key == "object-1"
    assert "That is wrong" in endpoint.requests[1]["messages"][-1]["content"]


def test_a_model_that_stays_wrong_is_not_believed(endpoint: Endpoint) -> None:
    with pytest.raises(GrounderError, match="there is no number 9"):
        ask(endpoint, number(9))
    assert len(endpoint.requests) == 2


def test_an_endpoint_that_does_not_answer_is_given_up_in_time(endpoint: Endpoint) -> None:
    began = time.monotonic()
    with pytest.raises(GrounderError, match="did not answer within"):
        ask(endpoint, endpoint.drips, timeout=0.5)
    assert time.monotonic() - began < 20


@pytest.mark.parametrize(
    ("answer", "message"),
    [(lambda h: send(h, {}, 500), "status 500"), (lambda h: send(h, b"<html>"), "no chat completion|no usable answer")],
)
def test_a_server_that_is_none_is_named(endpoint: Endpoint, answer: Answer, message: str) -> None:
    with pytest.raises(GrounderError, match=message):
        ask(endpoint, answer)


def test_where_nobody_listens_the_address_is_named() -> None:
    url = f"http://127.0.0.1:{free_port()}/v1"
    with pytest.raises(GrounderError, match=f"nothing from {url}: no connection"):
        Vision(url, "eye", "", 5.0).choose(Question("x", PICTURE, TWO))


# --- in the service
def service(endpoint: Endpoint, **settings: Any) -> Shown:
    config = {"grounder": "vision", "vision_url": endpoint.url, "vision_model": "eye", "read": False, **settings}
    return Shown(Box(0.9, 0.12, TEA), Box(0.9, -0.12, VITAMINS), settings=config)


def test_perception_asks_where_words_do_not_tell_and_once_for_a_query(endpoint: Endpoint) -> None:
    endpoint.answers = [number(2)]
    node = service(endpoint)
    answer = node.ask("something against a cold")
    assert answer.found and answer.label in ("white box 0", "white box 1") and len(endpoint.requests) == 1
    assert node.ask("white box 0").label == "white box 0" and len(endpoint.requests) == 1


def test_perception_goes_on_without_a_model_that_is_gone(endpoint: Endpoint) -> None:
    endpoint.answers = [lambda h: send(h, {}, 503)]
    node = service(endpoint)
    assert not node.ask("something against a cold").found
    before = node.count(topics.CAMERA_REQUEST)
    node.step(12.0)
    assert node.count(topics.CAMERA_REQUEST) > before
    assert isinstance(node.last(topics.WORLD_OBJECTS), m.WorldObjects) and PerceptionConfig().grounder == "words"
