"""Replies to questions and viewpoints: pure parts of the VLA pipeline."""

import math

import msgspec
import pytest

from common.scene import load_scene
from services.brain.dialogue import chosen, corrected, reply
from services.brain.search import Lookout

SCENE = load_scene("apartment")


@pytest.mark.parametrize(
    ("text", "kind", "rest"),
    [
        ("Yes!", "yes", ""),
        ("that's right", "yes", ""),
        ("no", "no", ""),
        ("never mind", "cancel", ""),
        ("no, the blue mug", "correction", "the blue mug"),
        ("no I said bring me the apple", "correction", "bring me the apple"),
        ("the blue mug", "correction", "the blue mug"),
    ],
)
def test_reply(text: str, kind: str, rest: str) -> None:
    assert reply(text) == (kind, rest)


def test_correction_changes_the_object_only() -> None:
    assert corrected("put the red mug in the bin", "the blue mug", SCENE) == "put the blue mug in the bin"
    assert corrected("Bring me the red cup", "blue cup", SCENE) == "bring me the blue cup"
    assert corrected("bring me the red mug", "bring me the apple", SCENE) == "bring me the apple"


LOOKOUT = Lookout(SCENE)
HOME = (0.0, 0.0, 0.0)


def test_the_tour_shows_every_surface_and_ends() -> None:
    visited: list[tuple[float, float, float]] = []
    at = HOME
    while (view := LOOKOUT.next(at, visited)) is not None:
        assert view not in visited
        visited.append(view)
        at = view
    assert len(visited) < 20
    assert LOOKOUT.covered(visited).mean() > 0.97


def test_every_view_shows_something_new() -> None:
    first = LOOKOUT.next(HOME, [])
    assert first is not None
    second = LOOKOUT.next(first, [first])
    assert second is not None
    assert LOOKOUT.covered([first, second]).sum() > LOOKOUT.covered([first]).sum() > 0


def test_turning_stays_on_the_spot_and_ends() -> None:
    pose, visited = (0.9, -1.4, 0.0), []
    while (view := LOOKOUT.turns(pose, visited)) is not None:
        assert view[:2] == pose[:2]
        visited.append(view)
    assert 1 <= len(visited) <= 12


def test_walls_hide_what_is_behind_them() -> None:
    alone = SCENE.receptacle("study shelf")
    assert alone is not None
    # From the living room the shelf is 2.4 m away, behind the wall between.
    hidden = Lookout(msgspec.structs.replace(SCENE, receptacles=(alone,)))
    assert not hidden.covered([(1.3, 1.9, math.pi / 2)]).any()
    assert hidden.covered([(1.3, 2.6, math.pi / 2)]).any()


def test_a_choice_is_the_one_that_the_words_single_out() -> None:
    options = ["blue mug", "red mug"]
    assert chosen("the red one", options) == "red mug"
    assert chosen("blue", options) == "blue mug"
    assert chosen("the second one please", options) == "red mug"
    assert chosen("the mug", options) is None
    assert chosen("the green one", options) is None
