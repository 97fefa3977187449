"""Questions about the robot itself: by which words they are known, and what is none."""

import pytest

from common.language.itself import about_itself
from common.language.wording import Action
from common.messages import BatteryState
from evaluation.everyday.flat import CONFIG, HOME
from evaluation.everyday.sentences import Sentence
from evaluation.everyday.understanding import planned, understand
from services.planner.grammar import grammar
from services.planner.world import World


@pytest.mark.parametrize(
    ("said", "action"),
    [
        ("what is keeping you", "doing"),
        ("how much longer", "doing"),
        ("what is it that you are up to", "doing"),
        ("why is that", "why"),
        ("what seems to be the problem", None),  # two words that are none of its own: only where nothing else fits
        ("where in the world are you", None),
        ("which room are you in", "whereabouts"),
        ("what jobs can i give you", "abilities"),
        ("what have you got in your claw", "holding"),
        ("are you low on power", "battery"),
        ("how did it go", "done"),
        ("what are you looking at", None),
        ("are you the one who moved the mug", None),
        ("bring me your battery", None),
        ("what time is it", None),
    ],
)
def test_a_question_is_known_by_its_words(said: str, action: Action | None) -> None:
    assert about_itself(tuple(said.split())) == action


def test_other_words_do_not_hide_a_question_that_nothing_else_fits() -> None:
    found = planned("who on this planet am i talking to")
    assert [s.text for s in found.steps] == ["I am TidyBot, a household robot. I fetch things and tidy up."]
    assert not [s for s in planned("where is the mug that you are talking about").steps if "TidyBot" in s.text]


@pytest.mark.parametrize(
    ("state", "text"),
    [
        (None, "I cannot tell how full my battery is."),
        (BatteryState(t=0.0, charge=0.625), "My battery is at 62%."),
        (BatteryState(t=0.0, charge=0.2, charging=True), "My battery is at 20% and charging."),
    ],
)
def test_the_battery_is_told_as_it_is_measured(state: BatteryState | None, text: str) -> None:
    plan = grammar.plan("how full is your battery", World(household=HOME, battery=state), CONFIG)
    assert [s.text for s in plan.steps] == [text]


@pytest.mark.parametrize(
    ("context", "said", "kind"),
    [
        ("busy:bring me the red mug", "stop right there, young man", "stop"),
        ("busy:bring me the red mug", "that's the wrong way, stop", "stop"),
        ("busy:bring me the red mug", "you can stop looking, i found it", "stop"),
        ("busy:bring me the red mug", "stop by the kitchen", "queue"),
        ("heard:bring me the green can", "that's the one, go", "yes"),
        ("heard:bring me the green can", "goodness no", "no"),
    ],
)
def test_what_is_said_to_a_robot_at_work_or_in_answer_to_it(context: str, said: str, kind: str) -> None:
    assert understand(Sentence(context, said, "none()")).kind == kind


def test_a_robot_sent_away_asks_where_to() -> None:
    assert planned("get out of here").reason == "you did not say where to go"
    assert [s.action for s in planned("get out of the kitchen").steps] == ["return"]
    assert not planned("leave it").steps


@pytest.mark.parametrize(
    ("said", "stays"),
    [
        ("clear the desk, hands off my vitamin box though", {"orange box"}),
        ("tidy everything on the living table apart from the box", {"white box"}),
        ("tidy the kitchen except the counter", {"blue mug", "red can", "yellow bowl", "blue bottle", "apple"}),
    ],
)
def test_what_is_spared_stays_when_the_rest_is_tidied(said: str, stays: set[str]) -> None:
    found = planned(said)
    taken = {s.object for s in found.steps if s.action == "grasp"}
    assert taken and not taken & stays


@pytest.mark.parametrize(
    "said",
    [
        "is it wise to put the mug in the bin",
        "would it have been better to throw the can away",
        "why would anyone throw away the apple",
        "stay away from the kitchen",
        "it would be bad if you threw away the white box",
    ],
)
def test_what_asks_for_no_deed_leads_to_none(said: str) -> None:
    found = planned(said)
    assert not [s for s in (*found.looks, *found.steps) if s.action != "say"]
    assert not found.asks
