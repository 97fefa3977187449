"""What people tell of their home and ask about it, as plans."""

import pytest

from common import messages as m
from common.household import load_household
from common.household_edits import edited
from common.plan_rules import known_world, objection
from services.planner.config import PlannerConfig
from services.planner.grammar.grammar import plan
from services.planner.world import World, believed

DAY = 86400.0
EDITS = m.HouseholdEdits(
    names=[m.PlaceName(name="breakfast bar", kind="surface", part="counter")],
    rules=[m.TidyRule(things="mugs", to=["study shelf"], kinds=["mug"])],
)
MUG = m.WorldObject(label="red mug", kind="mug", colour="red", position=(0, 0, 1), on="counter")
SEEN = [
    m.Sighting(thing="keys", kind="", colour="grey", part="counter", weight=5, last=99 * DAY),
    m.Sighting(thing="keys", kind="", colour="grey", part="kitchen table", weight=1, last=99.5 * DAY),
]


def world() -> World:
    household = edited(load_household("apartment"), EDITS)
    known = believed(household, known_world(household, ["red mug"], ""), [MUG])
    known.edits, known.sightings, known.seen_until = EDITS, SEEN, 100 * DAY
    return known


def planned(said: str) -> str:
    known = world()
    found = plan(said, known, PlannerConfig())
    told = known_world(known.household, ["red mug"], "")
    assert not found.steps or objection(found.steps, told, known.household) is None
    steps = [" ".join(filter(None, (s.action, s.object, s.target, s.text))) for s in found.steps]
    return "; ".join(steps) or f"no: {found.detail}"


@pytest.mark.parametrize(
    ("said", "steps"),
    [
        ("this is the kitchen", "name room kitchen"),
        ("call this the desk", "name surface desk"),
        ("call this table the workbench", "name surface workbench"),
        ("name this place the batcave", "name place batcave"),
        ("rename the breakfast bar to worktop", "name breakfast bar worktop"),
        ("forget the name breakfast bar", "forget place breakfast bar"),
        ("this is my vitamin box", "teach vitamin box"),
        ("mugs go on the study shelf", "rule mugs study shelf"),
        ("no, books belong in the study", "rule books study shelf"),
        ("my keys go on the counter", "rule keys breakfast bar"),
        ("from now on put the cans on the counter", "rule cans breakfast bar"),
        ("forget that rule", "forget rule mugs"),
        ("forget the rule about mugs", "forget rule mugs"),
        ("what are your rules", "say You have told me that mugs go on the study shelf."),
        ("where do mugs go", "say Mugs go on the study shelf."),
        ("put the mug away", "find red mug; grasp red mug; place red mug study shelf"),
        ("what is on the breakfast bar", "say A red mug is on the breakfast bar."),
        ("where is my wallet usually", "say I have not seen any wallet yet."),
    ],
)
def test_what_is_said_of_the_home(said: str, steps: str) -> None:
    assert planned(said) == steps


@pytest.mark.parametrize("said", ["the red mug belongs on the kitchen table", "all the mugs go on the kitchen table"])
def test_the_one_that_is_there_is_moved_and_no_rule_is_made(said: str) -> None:
    assert planned(said) == "find red mug; grasp red mug; place red mug kitchen table"


@pytest.mark.parametrize("said", ["this is dinner", "mugs do not go on the study shelf", "forget the rule about cans"])
def test_what_is_no_name_and_no_rule_changes_nothing(said: str) -> None:
    assert planned(said).startswith("no: ")


def test_where_things_usually_are_and_were_last() -> None:
    usual = planned("where are my keys usually")
    assert usual.startswith("say The keys are usually on the breakfast bar")
    assert "sometimes on the kitchen table" in usual
    last = planned("where did you last see my keys")
    assert last.startswith("say I last saw the keys on the kitchen table") and last.endswith("12 hours ago.")
    assert "breakfast bar" in planned("where did you last see the red mug")


@pytest.mark.parametrize("things", ["green ball", "blue mug", "books", "keys on the study shelf"])
def test_where_it_was_last_seen_is_answered_without_a_look(things: str) -> None:
    known = world()
    asked = f"where did you last see the {things}"
    found = plan(asked, known, PlannerConfig(), done=[])
    assert {s.action for s in found.steps} <= {"say"} and not found.again
    assert found.steps or found.detail
    assert plan("where is the green ball", world(), PlannerConfig(), done=[]).again


@pytest.mark.parametrize(
    ("said", "steps"),
    [
        ("the right place for cups is the dresser", "rule cups dresser"),
        ("new rule, keys on the counter", "rule keys breakfast bar"),
        ("in our house books stay on the bookshelf", "rule books bookshelf"),
        ("mugs no longer belong on the study shelf", "forget rule mugs"),
        ("there is no fixed place for mugs any more", "forget rule mugs"),
        ("are there any rules about mugs", "say You have told me that mugs go on the study shelf."),
        ("tell my son in the study to come down", "navigate study; say Come down."),
        ("say the words good morning out loud", "say Good morning."),
        ("can you carry three things at once", "say No, I can carry one thing at a time. Of several I bring one after "
         "the other."),
        ("did you understand me", "say Yes, I hear you, and I understand English."),
    ],
)  # fmt: skip
def test_a_rule_an_announcement_and_a_question_may_be_put_in_other_ways(said: str, steps: str) -> None:
    assert planned(said) == steps


@pytest.mark.parametrize("said", ["that is grandma's cup", "the mugs have to be on the dresser"])
def test_a_name_needs_a_thing_in_hand_and_a_rule_all_of_a_kind(said: str) -> None:
    assert "teach" not in planned(said) and "rule" not in planned(said)


def test_a_place_and_a_thing_may_be_learnt_by_a_name_without_my() -> None:
    assert planned("learn this place as the library") == "name place library"
    assert planned("this table shall be known as the workbench") == "name surface workbench"
    assert planned("remember this mug as bob") == "teach mug bob"


def test_what_calls_a_place_untidy_names_nothing() -> None:
    found = plan("this counter is a disgrace", world(), PlannerConfig())
    assert (found.steps, found.suggestion) == ([], "tidy up the counter")
