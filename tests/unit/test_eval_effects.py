"""Effects of commands from samples of the world and sentences, and the page of commands against the suite."""

from pathlib import Path
from typing import Any

import msgspec
import pytest

from common.scene import load_scene
from evaluation.case import Case, Line, Observed
from evaluation.suites.commands import ALL, TALKS, TASKS, commands
from evaluation.verdict import judge
from judge.claims import Claim
from judge.effects import (
    AT_FURNITURE,
    AT_PLACE,
    BESIDE,
    DRIVEN,
    HAND_CLOSED,
    HAND_OPEN,
    STOOD,
    STOOD_FOR,
    Effect,
    Shown,
    Watcher,
    at,
    mentions,
)  # fmt: skip
from judge.evidence import Evidence, Sample, ThingEvidence, Want
from judge.track import MOVED, TOPPLED, ThingState

SCENE = load_scene("apartment")
APPLE = ThingState(position=(5.0, -0.7, 0.76), tilt=0.0, on="kitchen table", held=False, touched=False)
MUG = ThingState(position=(4.5, -3.1, 0.81), tilt=0.0, on="counter", held=False, touched=False)
HELD = ThingState(position=(0.5, 0.0, 0.9), tilt=0.0, on="", held=True, touched=True)
HOME, KITCHEN = (0.0, 0.0), (3.6, -1.2)


def sample(
    t: float, base: tuple[float, float] = HOME, mug: ThingState = MUG, apple: ThingState = APPLE, **more: Any
) -> Sample:
    return Sample(t, (*base, 0.0), {"red mug": mug, "apple": apple}, opening=more.get("opening", 0.085))


def still(base: tuple[float, float], start: float, **more: Any) -> list[Sample]:
    return [sample(start + 0.1 * n, base, **more) for n in range(8)]


def why(effect: Effect, *seen: Sample | str) -> str:
    watcher = Watcher(SCENE)
    for one in seen:
        if isinstance(one, str):
            watcher.hear(one)
        else:
            watcher.add(one)
    shown = watcher.conclude((effect,))[0]
    assert shown.shown == (not shown.why)
    return shown.why


def test_places() -> None:
    there_and_back = [*still(HOME, 0.0), *still(KITCHEN, 5.0), *still(HOME, 9.0)]
    assert why(Effect("visits", "kitchen"), *there_and_back) == why(Effect("ends", "home"), *there_and_back) == ""
    assert "not at the kitchen" in why(Effect("ends", "kitchen"), *there_and_back)
    through = [*still(HOME, 0.0), sample(2.0, KITCHEN), *still(HOME, 4.0)]
    assert "never stood" in why(Effect("visits", "kitchen"), *through)
    assert "not at the home" in why(Effect("ends", "home"), *still(KITCHEN, 0.0), sample(2.0, HOME))
    assert "drives" in why(Effect("stands"), *still(HOME, 0.0), sample(2.0, KITCHEN))
    assert why(Effect("stands"), sample(0.0, KITCHEN), *still(HOME, 4.0)) == ""


@pytest.mark.parametrize(
    ("name", "point", "there"),
    [
        ("counter", (4.4, -2.3), True), ("counter", (4.4, -1.7), False), ("lounge", (0.0, 1.0), True),
        ("sofa", (-1.4, 0.2), True), ("sofa", (-0.5, 0.2), False), ("dock", (0.1, 0.1), True),
    ],
)  # fmt: skip
def test_what_counts_as_at_a_place(name: str, point: tuple[float, float], there: bool) -> None:
    assert at(SCENE, name, *point) == there


def test_the_hand_and_what_it_holds() -> None:
    assert why(Effect("holds", "red mug"), sample(0.0), sample(1.0, mug=HELD)) == ""
    assert "holds apple" in why(Effect("holds", "red mug"), sample(0.0), sample(1.0, apple=HELD))
    assert "holds nothing" in why(Effect("holds", "red mug"), sample(0.0, mug=HELD), sample(1.0))
    assert why(Effect("hand", "open"), sample(0.0)) == why(Effect("hand", "closed"), sample(0.0, opening=0.0)) == ""
    assert "40 mm" in why(Effect("hand", "closed"), sample(0.0, opening=0.04))
    assert why(Effect("rests", "red mug"), sample(0.0, mug=HELD), sample(1.0)) == ""
    assert "not put down" in why(Effect("rests", "red mug"), sample(0.0), sample(1.0, mug=HELD))


def test_beside_is_on_the_same_surface_and_near() -> None:
    beside = Effect("beside", "red mug", "apple")
    near = msgspec.structs.replace(APPLE, position=(5.2, -0.7, 0.77))
    far = msgspec.structs.replace(APPLE, position=(5.7, -0.4, 0.77))
    assert why(beside, sample(0.0), sample(1.0, mug=near)) == ""
    assert "0.76 m" in why(beside, sample(0.0), sample(1.0, mug=far))
    assert "counter" in why(beside, sample(0.0), sample(1.0))


def test_nothing_moves() -> None:
    shoved = msgspec.structs.replace(MUG, position=(4.54, -3.1, 0.81))
    assert why(Effect("still"), *still(HOME, 0.0)) == ""
    assert why(Effect("still"), sample(0.0), sample(1.0, mug=shoved)) == "moved the red mug"
    assert "drove" in why(Effect("still"), sample(0.0), sample(1.0, KITCHEN), sample(2.0, HOME))
    assert why(Effect("left alone", "apple"), sample(0.0), sample(1.0, mug=shoved)) == ""
    assert "0.04 m" in why(Effect("left alone", "red mug"), sample(0.0), sample(1.0, mug=shoved))


@pytest.mark.parametrize(
    ("effect", "sentence", "reason"),
    [
        (Effect("tells where", "apple"), "The apple is on the kitchen table.", ""),
        (Effect("tells where", "apple"), "The apple is on the counter.", "it is on the kitchen table"),
        (Effect("tells where", "apple"), "I have found the apple.", "it is on the kitchen table"),
        (Effect("tells where", "apple"), "The red mug is on the counter.", "no answer"),
        (Effect("tells what is on", "counter"), "A red mug is on the counter.", ""),
        (Effect("tells what is on", "counter"), "An apple and a red mug are on the counter.", "there is red mug"),
        (Effect("tells what it sees"), "I see an apple on the kitchen table and a red mug on the counter.", ""),
        (Effect("tells what it sees"), "I see an apple and a red mug on the counter in the kitchen.", "the apple"),
        (Effect("tells what it sees"), "I have seen nothing that I know yet.", ""),
        (Effect("tells what it sees"), "Did you say what do you see?", "no answer"),
        (Effect("says", "I know no banana"), "I cannot do that: I know no banana.", ""),
        (Effect("says", "I know no banana"), "Done.", "never said"),
    ],
)
def test_answers_have_to_be_true_in_physics(effect: Effect, sentence: str, reason: str) -> None:
    found = why(effect, sample(0.0), sentence)
    assert (reason in found) if reason else not found, found


def verdict(shown: bool, claimed: str, **more: Any) -> Any:
    case = Case(
        suite="commands", seed=0, name="command", command="go to the kitchen", lines=(Line("go"),), expect="shown",
        effects=(Effect("ends", "kitchen"),), wants=more.get("wants", ()),
    )  # fmt: skip
    evidence = Evidence(things=[ThingEvidence("mug", "table", delivered=True)] if case.wants else [])
    seen = Observed(
        evidence=more.get("evidence", evidence), shown=[Shown("ends kitchen", shown, "" if shown else "ended at home")],
        claimed=claimed, ended=True, wrong=more.get("wrong", []), shortfall="" if shown else "ended at home",
        claims=[Claim(1.0, "speech", "Done.", "m", "go", "" if shown else "ended at home")] * (claimed == "delivered"),
    )  # fmt: skip
    return judge(case, seen, 1.0)


def test_the_verdict_counts_effects_and_no_claims() -> None:
    assert (verdict(True, "delivered").outcome, verdict(True, "none").met) == ("shown", True)
    assert verdict(False, "delivered").outcome == "false_success"
    silent = verdict(False, "none")
    assert (silent.outcome, silent.met, silent.cause) == ("failed", False, "effect: ended at home")
    assert verdict(False, "failed").outcome == "reported"
    assert verdict(True, "delivered", wants=(Want("mug", ("tray",)),)).delivered
    hit = verdict(True, "none", evidence=Evidence(hits=["arm on a wall, 9 mm"]))
    assert (hit.met, hit.cause) == (False, "contact")
    wrong = verdict(True, "none", wrong=["apple"])
    assert (wrong.met, wrong.cause) == (False, "wrong thing: apple")


# --- the suite
def page() -> dict[str, str]:
    text = (Path(__file__).parents[2] / "docs" / "COMMANDS.md").read_text(encoding="utf-8")
    table = text.partition("| said | planned |")[2].partition("\n\n")[0]
    rows = [[c.strip() for c in line.strip("|").split("|")] for line in table.splitlines() if line.startswith("| ")]
    return dict(map(tuple, rows))


def test_every_command_of_the_page_has_an_effect() -> None:
    told = {task.said: commands(seed) for seed, task in enumerate(TASKS)}
    planned = page()
    assert len(planned) > 20
    assert not [said for said in planned if said not in told], "evaluation/suites/commands.py has no effect for them"
    assert not [said for said in told if said not in planned], "docs/COMMANDS.md does not have them"
    assert not [said for said, task in told.items() if not task.wants and not task.effects]
    for said, plan in planned.items():
        carries = "place" in plan or plan.endswith("release")
        assert bool(told[said].wants) == carries, f"{said}: {plan}"
        if plan.startswith("no: "):
            assert Effect("says", plan.removeprefix("no: ")) in told[said].effects


def test_effects_name_what_is_in_their_scene() -> None:
    for seed, task in enumerate(ALL):
        case = commands(seed)
        assert case.scene is not None and case.command == task.said
        things, surfaces = {o.name for o in case.scene.objects}, {r.name for r in case.scene.receptacles}
        assert {w.thing for w in case.wants} <= things
        assert {g for w in case.wants for g in w.goals} <= surfaces
        for effect in case.effects:
            if effect.kind in ("holds", "beside", "rests", "left alone", "tells where"):
                assert {effect.what, effect.other} - {""} <= things
            if effect.kind in ("visits", "ends"):
                assert at(case.scene, effect.what, *HOME) or at(case.scene, effect.what, *KITCHEN)
    assert {line.text for task in TALKS for line in task.then} >= {"stop", "cancel", "come here"}


def test_what_has_an_upright_goes_over_and_an_apple_only_turns() -> None:
    turned = {"tilt": 0.6}
    apple, mug = (msgspec.structs.replace(thing, **turned) for thing in (APPLE, MUG))
    assert why(Effect("remains", "apple", "kitchen table"), sample(0.0), sample(1.0, apple=apple)) == ""
    assert "went over" in why(Effect("remains", "red mug", "counter"), sample(0.0), sample(1.0, mug=mug))


# --- what is said of an effect that was not shown, and where the limits lie
STAYS, RESTS = Effect("remains", "red mug", "counter"), Effect("rests", "red mug")
BESIDE_APPLE, SEES = Effect("beside", "red mug", "apple"), Effect("tells what it sees")
WHERE, ON_COUNTER = Effect("tells where", "apple"), Effect("tells what is on", "counter")


def thing(x: float, on: str = "counter", **more: Any) -> ThingState:
    return ThingState((x, 0.0, 0.0), more.get("tilt", 0.0), on, more.get("held", False), more.get("touched", False))


@pytest.mark.parametrize(
    ("effect", "now", "reason"),
    [
        (Effect("holds", "red mug"), {"mug": HELD, "apple": HELD}, "holds red mug and apple, not the red mug"),
        (RESTS, {"mug": thing(0.0, "")}, "the red mug is not put down"),
        (RESTS, {"mug": thing(0.0, "floor")}, "the red mug is not put down"),
        (RESTS, {"mug": thing(0.0, touched=True)}, "the red mug is not put down"),
        (RESTS, {"mug": thing(0.0, "", touched=True)}, "the red mug is not put down"),
        (STAYS, {"mug": HELD}, "the red mug is in the hand"),
        (STAYS, {"mug": thing(0.0, "")}, "the red mug is on nothing, not on the counter"),
        (STAYS, {"mug": thing(0.0, "sofa")}, "the red mug is on sofa, not on the counter"),
        (STAYS, {"mug": thing(0.0, tilt=TOPPLED)}, ""),
        (Effect("hand", "open"), {"opening": HAND_OPEN}, ""),
        (Effect("hand", "closed"), {"opening": HAND_CLOSED}, ""),
        (Effect("hand", "closed"), {"opening": 0.6}, "the hand is 600 mm open, not closed"),
        (BESIDE_APPLE, {"mug": thing(0.0), "apple": thing(BESIDE)}, ""),
        (
            BESIDE_APPLE, {"mug": thing(0.0, "")},
            "the red mug is on nothing, the apple on kitchen table",
        ),
        (
            BESIDE_APPLE, {"apple": thing(0.0, "")},
            "the red mug is on counter, the apple on nothing",
        ),
    ],
)  # fmt: skip
def test_what_physics_shows_instead_is_told(effect: Effect, now: dict[str, Any], reason: str) -> None:
    assert why(effect, sample(0.0), sample(1.0, **now)) == reason


def test_what_is_as_far_as_allowed_is_not_moved() -> None:
    before, after = sample(0.0, mug=thing(0.0)), sample(1.0, mug=thing(MOVED))
    assert why(Effect("left alone", "red mug"), before, after) == why(Effect("still"), before, after) == ""
    assert why(Effect("still"), sample(0.0), sample(1.0, (DRIVEN, 0.0))) == ""
    there_and_back = [sample(float(n), (0.2 * (n % 2), 0.0)) for n in range(3)]
    assert why(Effect("still"), *there_and_back) == "drove 0.4 m", "every way counts"


def test_who_stands_has_drifted_no_farther_than_that_for_that_long() -> None:
    stood = [sample(5.0, KITCHEN), sample(5.0 + STOOD_FOR, KITCHEN)]
    for kind in ("visits", "ends", "stands"):
        assert why(Effect(kind, "kitchen"), *stood) == ""  # type: ignore[arg-type]
    assert why(Effect("stands"), sample(0.0), sample(STOOD_FOR, (STOOD, 0.0))) == ""
    passing = [sample(5.0, KITCHEN), sample(5.1, KITCHEN)]
    assert why(Effect("visits", "kitchen"), *passing) == "never stood at the kitchen"
    assert why(Effect("ends", "kitchen"), *passing) == "ended at (3.6, -1.2), not at the kitchen"
    assert why(Effect("stands"), *passing) == "the base still drives"


def test_an_effect_is_told_in_words_and_of_nothing_seen_nothing_is_shown() -> None:
    (shown,) = Watcher(SCENE).conclude((BESIDE_APPLE,))
    assert shown == Shown("beside red mug apple", False, "the simulation showed nothing")
    watcher = Watcher(SCENE)
    for seen in (sample(0.0), sample(1.0, mug=HELD), sample(2.0, apple=HELD), sample(3.0)):
        watcher.add(seen)
    assert watcher.lifted == {"red mug", "apple"}


def test_a_thing_that_no_scene_lists_has_no_upright() -> None:
    seen = Sample(0.0, (0.0, 0.0, 0.0), {"parcel": thing(0.0, tilt=1.0)})
    assert why(Effect("remains", "parcel", "counter"), seen) == ""


@pytest.mark.parametrize(
    ("effect", "seen", "sentences", "reason"),
    [
        (WHERE, {}, ("Did you say the apple is on the kitchen table?",), "no answer: tells where apple"),
        (WHERE, {}, ("Do you mean the apple on the kitchen table?",), "no answer: tells where apple"),
        (WHERE, {}, ("It is an apple on the kitchen table.", "The apple is on the sofa."), ""),
        (WHERE, {"apple": HELD}, ("The apple is on the sofa.",), "it is on the hand"),
        (ON_COUNTER, {"apple": MUG}, ("A red mug is on the counter.",), "there is apple, red mug"),
        (ON_COUNTER, {"mug": HELD}, ("A red mug is on the counter.",), "there is nothing"),
        (SEES, {}, ("I see an apple.",), "no answer: tells what it sees"),
        (SEES, {}, ("I see nothing.",), ""),
        (SEES, {}, ("On the counter is a red mug.",), "the red mug is on the , it is on the counter"),
        (Effect("says", "Hello"), {}, ("Done.",), "never said Hello"),
        (Effect("says"), {}, (), "never said what it sees"),
    ],
)  # fmt: skip
def test_answers_are_held_against_physics_as_they_are_given(
    effect: Effect, seen: dict[str, Any], sentences: tuple[str, ...], reason: str
) -> None:
    found = why(effect, sample(0.0, **seen), *sentences)
    assert found.endswith(reason) and bool(found) == bool(reason), found


def test_what_is_said_before_anything_was_seen_answers_nothing() -> None:
    assert why(WHERE, "The apple is on the kitchen table.", sample(0.0)) == "no answer: tells where apple"


def test_at_a_place_is_as_near_as_its_limit() -> None:
    home = SCENE.home
    assert at(SCENE, home.name, home.x + AT_PLACE, home.y) and not at(SCENE, home.name, home.x, home.y + 3.0)
    block = msgspec.structs.replace(
        SCENE.receptacles[0], name="block", center=(0.0, 0.0, 0.5), size=(2.0, 2.0), yaw=0.0
    )
    assert at(msgspec.structs.replace(SCENE, receptacles=(block,)), "block", 1.0 + AT_FURNITURE, 0.0)


def test_of_two_names_the_longer_is_meant() -> None:
    first, second, *_ = SCENE.objects
    named = (msgspec.structs.replace(first, name="mug"), msgspec.structs.replace(second, name="mug two"))
    assert mentions("mug two and mug", msgspec.structs.replace(SCENE, objects=named)) == [
        ("thing", "mug two"), ("thing", "mug"),
    ]  # fmt: skip
