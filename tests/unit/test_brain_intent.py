"""Sentences to intents of the fetch pipeline."""

import pytest

from common.household import load_household
from services.brain.language.intent import parse

SCENE = load_household("apartment")


@pytest.mark.parametrize(
    ("text", "item"),
    [
        ("bring me the red mug", "red mug"),
        ("Bring me the red mug.", "red mug"),
        ("red mug", "red mug"),
        ("fetch the apple please", "apple"),
        ("get me a green can", "green can"),
        ("hey jarvis, could you please bring me the blue bottle from the kitchen?", "blue bottle"),
        ("I would like the yellow bowl", "yellow bowl"),
        ("pick up the white box", "white box"),
        ("go and get the red cup", "red cup"),
        ("give me the bottle of water", "bottle of water"),
        ("can you get me the can", "can"),
        ("bring me the big red mug", "red mug"),
        ("find_the_red_mug", "red mug"),
        ("bring the red mug to me", "red mug"),
        ("bring the blue block here please", "blue block"),
        ("i need the red mug on the counter", "red mug"),
        ("yellow cubes", "yellow block"),
        ("bring me a mug", "red mug"),
        ("get me some blue bottle", "blue bottle"),
    ],
)
def test_fetch(text: str, item: str) -> None:
    intent = parse(text, SCENE)
    assert (intent.kind, intent.item) == ("fetch", item)
    assert SCENE.thing(intent.label) is not None


@pytest.mark.parametrize(
    ("text", "kind"),
    [
        ("stop", "stop"),
        ("Stop!", "stop"),
        ("please cancel", "cancel"),
        ("never mind", "cancel"),
        ("come back", "return"),
    ],
)
def test_control(text: str, kind: str) -> None:
    assert parse(text, SCENE).kind == kind


@pytest.mark.parametrize(
    ("text", "reason"),
    [
        ("bring me the stapler", "stapler"),
        ("bring me the mug", "red mug, blue mug or white mug"),
        ("bring me the purple mug", "no purple mug"),
        ("what a lovely day", "do not know"),
        ("bring me", "do not know"),
        ("?", "did not hear"),
        ("not the red mug", "do not know"),
    ],
)
def test_no_intent_says_why(text: str, reason: str) -> None:
    intent = parse(text, SCENE)
    assert intent.kind == "none"
    assert reason in intent.reason


def test_alias_keeps_the_spoken_word_and_names_the_object() -> None:
    intent = parse("bring me the water bottle", SCENE)
    assert (intent.item, intent.label) == ("water bottle", "blue bottle")
