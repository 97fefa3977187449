"""Evidence from samples of the world: every rule with both outcomes, at its limit."""

import math
from typing import Any

import msgspec
import pytest

from common import messages as m
from judge.contacts import ContactBook, describe, is_hit
from judge.effects import Effect, Shown
from judge.evidence import CREEP, Evidence, EvidenceRecorder, Sample, ThingEvidence, Want, spl
from judge.goal import Goal, shortfall
from judge.track import DROP, LIFTED, ThingState, Track

WANT, MUG = Want("mug", ("tray", "desk")), frozenset({"mug"})
KINDS = {"mug": "mug", "can": "can", "ball": "ball"}
ON_TABLE = ThingState(position=(3.0, 0.0, 0.7), tilt=0.0, on="table", held=False, touched=False)
HELD = ThingState(position=(3.0, 0.0, 0.9), tilt=0.0, on="", held=True, touched=True)
FALLING = ThingState(position=(3.0, 0.0, 0.8), tilt=0.0, on="", held=False, touched=False)
LOWER = ThingState(position=(3.0, 0.0, 0.7), tilt=0.0, on="", held=False, touched=False)
ON_TRAY = ThingState(position=(0.7, 0.0, 0.5), tilt=0.0, on="tray", held=False, touched=False)
CAN = ThingState(position=(3.3, 0.0, 0.75), tilt=0.0, on="table", held=False, touched=False)
BALL = ThingState(position=(3.6, 0.0, 0.75), tilt=0.0, on="table", held=False, touched=False)


def changed(thing: ThingState, **fields: Any) -> ThingState:
    return msgspec.structs.replace(thing, **fields)


def sample(t: float, mug: ThingState, x: float = 0.0, can: ThingState = CAN, ball: ThingState = BALL) -> Sample:
    return Sample(t, (x, 0.0, 0.0), {"mug": mug, "can": can, "ball": ball})


GOOD = [
    sample(0.0, ON_TABLE), sample(1.0, ON_TABLE, 2.4), sample(2.0, HELD, 2.4), sample(3.0, HELD, 1.2),
    sample(4.0, HELD), sample(5.0, ON_TRAY), sample(5.5, ON_TRAY), sample(6.0, ON_TRAY),
]  # fmt: skip


def recorder(samples: list[Sample], bins: frozenset[str] = frozenset()) -> EvidenceRecorder:
    found = EvidenceRecorder(KINDS, bins)
    for one in samples:
        found.add(one)
    return found


def evidence(samples: list[Sample], bins: frozenset[str] = frozenset()) -> Evidence:
    return recorder(samples, bins).conclude((WANT,), MUG)


def mug(samples: list[Sample], bins: frozenset[str] = frozenset()) -> ThingEvidence:
    return evidence(samples, bins).things[0]


def test_lifted_carried_upright_and_at_rest_is_delivered() -> None:
    found = evidence(GOOD)
    assert found == Evidence(
        things=[
            ThingEvidence(
                "mug", "table", lifted=True, carried=2.4, on="tray", at_rest=True, released=True, delivered=True
            )
        ],
        driven=4.8, standing=True, moved=["mug"],
    )  # fmt: skip


@pytest.mark.parametrize(
    ("samples", "why"),
    [
        ([*GOOD[:2], *GOOD[5:]], "never lifted by the gripper"),
        (GOOD[:5], "still touched by the gripper; on nothing, not on tray or desk"),
        ([*GOOD[:-1], sample(6.0, changed(ON_TRAY, touched=True))], "still touched by the gripper"),
        ([*GOOD[:4], sample(3.5, FALLING, 1.0), *GOOD[5:]], "dropped on the way"),
        ([*GOOD[:4], sample(3.5, changed(ON_TABLE, on="floor"), 1.0), *GOOD[5:]], "dropped on the way"),
        (
            [*GOOD[:-1], sample(6.0, changed(ON_TRAY, on="floor"))],
            "dropped on the way; on floor, not on tray or desk",
        ),
        ([*GOOD[:-1], sample(6.0, changed(ON_TRAY, on="table"))], "on table, not on tray or desk"),
        ([*GOOD[:-1], sample(6.0, changed(ON_TRAY, position=(0.72, 0.0, 0.5)))], "not at rest"),
        ([], "the simulation showed nothing"),
    ],
)
def test_what_is_not_a_delivery(samples: list[Sample], why: str) -> None:
    found = mug(samples)
    assert not found.delivered and found.why == why


@pytest.mark.parametrize(("rise", "lifted"), [(0.0499, False), (0.0501, True)])
def test_lifted_is_five_centimetres_in_the_hand(rise: float, lifted: bool) -> None:
    low = changed(HELD, position=(3.0, 0.0, 0.7 + rise))
    assert mug([*GOOD[:2], sample(2.0, low), *GOOD[5:]]).lifted == lifted
    assert not mug([*GOOD[:2], sample(2.0, changed(low, held=False)), *GOOD[5:]]).lifted


def test_five_centimetres_sharp_are_not_lifted() -> None:
    floor = changed(ON_TABLE, position=(3.0, 0.0, 0.0))
    low = changed(HELD, position=(3.0, 0.0, LIFTED))
    assert not mug([sample(0.0, floor), sample(1.0, floor, 2.4), sample(2.0, low), *GOOD[5:]]).lifted


@pytest.mark.parametrize(("height", "lifted"), [(0.06, True), (0.04, False)])
def test_what_fell_is_lifted_from_where_it_came_to_lie(height: float, lifted: bool) -> None:
    fallen = changed(ON_TABLE, position=(3.0, 0.3, 0.0), on="floor")
    raised = sample(3.0, changed(HELD, position=(3.0, 0.3, height)), 1.2)
    found = mug([*GOOD[:2], sample(1.5, fallen, 2.4), sample(2.0, fallen, 2.4), raised, *GOOD[5:]])
    assert found.lifted == lifted and found.drops == 1


def test_what_has_been_lifted_stays_so_and_is_carried_only_in_the_hand() -> None:
    low = changed(HELD, position=(3.0, 0.0, 0.71))
    found = mug([*GOOD[:4], sample(4.0, low, 1.0), sample(5.0, changed(low, held=False), 0.5), sample(6.0, ON_TRAY)])
    assert found.lifted and found.carried == 1.4


@pytest.mark.parametrize(("drift", "at_rest"), [(0.0049, True), (0.0051, False)])
def test_at_rest_is_less_than_five_millimetres_in_half_a_second(drift: float, at_rest: bool) -> None:
    creeping = changed(ON_TRAY, position=(0.7 + drift, 0.0, 0.5))
    assert mug([*GOOD[:6], sample(5.5, creeping)]).at_rest == at_rest
    assert mug([*GOOD[:6], sample(5.51, creeping)]).at_rest, "half a second, not longer"


# --- standing
def test_a_mug_held_by_its_handle_and_let_go_lies_on_the_tray_and_is_not_delivered() -> None:
    """The hand held the mug, whose body is 74 mm wide, by 78 mm; let go, it lay at 90 degrees, and all said so."""
    askew = changed(HELD, tilt=math.radians(20))
    lying = changed(ON_TRAY, tilt=math.radians(90), position=(0.7, 0.03, 0.49))
    found = recorder([*GOOD[:2], sample(2.0, askew, 2.4), sample(4.0, askew), sample(5.0, lying), sample(6.0, lying)])
    judged = found.conclude((WANT,), MUG).things[0]
    assert judged.lifted and judged.at_rest and judged.released and judged.on == "tray"
    assert not judged.delivered and judged.toppled and judged.tilt == 90.0
    assert judged.why == "toppled, 90 degrees from upright"
    assert shortfall([judged], []) == "mug: toppled, 90 degrees from upright"


@pytest.mark.parametrize(("degrees", "toppled"), [(0, False), (14.9, False), (15.1, True), (90, True), (180, True)])
def test_what_has_an_upright_must_stand(degrees: float, toppled: bool) -> None:
    found = mug([*GOOD[:5], sample(5.0, changed(ON_TRAY, tilt=math.radians(degrees)))])
    assert (found.toppled, found.delivered) == (toppled, not toppled)
    assert found.tilt == degrees


@pytest.mark.parametrize(("degrees", "toppled"), [(180, False), (166, False), (90, True), (160, True)])
def test_what_has_two_ends_alike_may_stand_on_either(degrees: float, toppled: bool) -> None:
    track = Track("can", frozenset(), CAN, changed(CAN, tilt=math.radians(degrees)))
    assert track.toppled is toppled


def test_in_a_bin_it_may_lie_as_it_fell() -> None:
    lying = [*GOOD[:5], sample(5.0, changed(ON_TRAY, tilt=math.radians(90)))]
    assert mug(lying, frozenset({"tray"})).delivered
    assert not mug(lying, frozenset({"desk"})).delivered


def test_what_rolls_has_no_upright() -> None:
    rolled = changed(ON_TRAY, tilt=2.0)
    ball_home = [sample(one.t, ON_TABLE, one.base[0], CAN, one.things["mug"]) for one in GOOD]
    ball_home[-1] = sample(6.0, ON_TABLE, 0.0, CAN, rolled)
    found = recorder(ball_home).things((Want("ball", ("tray",)),))[0]
    assert found.delivered and found.tilt == pytest.approx(114.6)


# --- dropping
@pytest.mark.parametrize(
    ("bins", "later", "drops"), [({"tray"}, 0.9, 0), (set(), 0.9, 1), ({"desk"}, 0.9, 1), ({"tray"}, 1.0, 1)]
)
def test_a_thing_may_fall_into_a_bin(bins: set[str], later: float, drops: int) -> None:
    found = mug([*GOOD[:5], sample(4.5, FALLING), sample(4.5 + later, ON_TRAY), sample(9.0, ON_TRAY)], frozenset(bins))
    assert (found.drops, found.dropped, found.delivered) == (drops, bool(drops), not drops)


def test_what_slipped_is_judged_by_the_carry_that_followed() -> None:
    slipped = [*GOOD[:3], sample(2.5, FALLING, 2.4), sample(2.7, ON_TABLE, 2.4), *GOOD[3:]]
    found = mug(slipped)
    assert (found.drops, found.dropped, found.delivered) == (1, False, True)
    twice = [
        *GOOD[:3],
        *(sample(2.5, FALLING), sample(2.6, LOWER), sample(2.8, HELD)),
        *(sample(2.9, FALLING), sample(3.0, LOWER), sample(3.1, HELD)),
    ]
    assert mug([*twice, *GOOD[5:]]).drops == 2


def test_set_down_is_not_dropped() -> None:
    touched = changed(FALLING, touched=True)
    assert mug([*GOOD[:5], sample(4.5, touched), *GOOD[5:]]).drops == 0
    assert mug([*GOOD[:5], sample(4.5, changed(ON_TABLE, touched=False)), *GOOD[5:]]).drops == 0


@pytest.mark.parametrize(("fall", "drops"), [(0.009, 0), (0.011, 1)])
def test_what_the_hand_loses_is_dropped_when_it_falls(fall: float, drops: int) -> None:
    above, below = changed(FALLING, position=(3.0, 0, 0.9)), changed(FALLING, position=(3.0, 0, 0.9 - fall))
    still = [sample(t, changed(above, held=True, touched=True)) for t in (4.7, 4.8)]
    assert mug([*GOOD[:5], sample(4.5, above), sample(4.6, below), *still]).drops == drops
    assert mug([*GOOD[:5], sample(4.5, above), sample(4.6, changed(below, on="tray")), *GOOD[5:]]).drops == drops
    again = changed(below, touched=True)
    assert mug([*GOOD[:5], sample(4.5, above), sample(4.6, again), sample(4.7, ON_TRAY), *GOOD[5:]]).drops == 0


def test_a_centimetre_sharp_is_no_fall() -> None:
    above, below = ((3.0, 0.0, z) for z in (DROP, 0.0))
    held = sample(4.4, changed(HELD, position=above))
    lost = [sample(4.5, changed(FALLING, position=above)), sample(4.6, changed(FALLING, position=below))]
    assert mug([*GOOD[:5], held, *lost, *GOOD[5:]]).drops == 0


def test_what_a_sinking_hand_loses_for_one_sample_is_not_dropped() -> None:
    held = sample(3.6, changed(HELD, position=FALLING.position))
    assert mug([*GOOD[:4], sample(3.4, FALLING), held, *GOOD[4:]]).drops == 0
    assert mug([*GOOD[:4], sample(3.4, FALLING), sample(3.5, LOWER), held, *GOOD[4:]]).drops == 1


def test_what_stands_on_the_floor_has_not_fallen() -> None:
    below = changed(ON_TABLE, on="floor")
    assert mug([sample(0.0, below), sample(1.0, below), *GOOD[2:]]).delivered
    assert mug([sample(0.0, below), sample(1.0, changed(below, position=(3.01, 0, 0.7))), *GOOD[2:]]).drops == 0


# --- others
@pytest.mark.parametrize(("shift", "moved"), [(0.029, False), (0.031, True)])
def test_dominoes_count_whoever_touched_them(shift: float, moved: bool) -> None:
    """For a moment is enough: what was put back had been taken away."""
    shoved = sample(2.0, HELD, 2.4, changed(CAN, position=(3.3 + shift, 0.0, 0.75)))
    found = evidence([*GOOD[:2], shoved, *GOOD[3:]])
    assert found.disturbed == (["can"] if moved else [])
    assert found.moved == (["can", "mug"] if moved else ["mug"])


@pytest.mark.parametrize(("degrees", "tipped"), [(14.9, False), (15.1, True), (90, True)])
def test_what_went_over_is_disturbed(degrees: float, tipped: bool) -> None:
    leaning = changed(CAN, tilt=math.radians(degrees))
    turned = [sample(one.t, one.things["mug"], one.base[0], leaning if one.t > 1 else CAN) for one in GOOD]
    assert evidence(turned).disturbed == (["can"] if tipped else [])


def test_what_leaned_before_is_disturbed_by_what_it_leans_more() -> None:
    leaning = [changed(CAN, tilt=math.radians(degrees)) for degrees in (10, 20)]
    turned = [sample(one.t, one.things["mug"], one.base[0], leaning[one.t > 1]) for one in GOOD]
    assert evidence(turned).disturbed == []


def test_a_ball_may_turn_on_the_spot() -> None:
    turned = [*GOOD[:-1], sample(6.0, ON_TRAY, ball=changed(BALL, tilt=1.5))]
    assert evidence(turned).disturbed == []
    assert evidence([*GOOD[:-1], sample(6.0, ON_TRAY, ball=changed(BALL, position=(3.6, 0.04, 0.75)))]).disturbed


def test_the_world_may_settle_until_the_robot_is_asked() -> None:
    away, over = changed(BALL, position=(3.7, 0.0, 0.75)), changed(CAN, tilt=1.5)
    found = recorder([sample(0.0, ON_TABLE, can=CAN), sample(0.5, ON_TABLE, 0.0, over, away)])
    assert found.conclude((WANT,), MUG).disturbed == ["ball", "can"]
    found.restart()
    found.add(sample(1.0, ON_TABLE, 0.0, over, away))
    assert found.conclude((WANT,), MUG).disturbed == []
    found.add(sample(1.5, ON_TABLE, 0.0, CAN, BALL))
    assert found.conclude((WANT,), MUG).disturbed == ["ball", "can"]


def test_what_still_topples_as_the_robot_is_asked_counts_from_where_it_comes_to_rest() -> None:
    falls = [
        sample(0.1 * n, ON_TABLE, can=changed(CAN, position=(3.3 + 0.02 * min(n, 8), 0.0, 0.75))) for n in range(20)
    ]
    found = recorder(falls[:4])
    found.restart()
    for one in falls[4:]:
        found.add(one)
    assert found.conclude((WANT,), MUG).disturbed == []
    found.add(sample(2.0, ON_TABLE))
    assert found.conclude((WANT,), MUG).disturbed == ["can"]


@pytest.mark.parametrize(
    ("positions", "creeps"),
    [((0, 0, 0), False), ((0, 0, CREEP), False), ((0, 0, 1.1 * CREEP), True), ((0, 1.1 * CREEP, 1.1 * CREEP), True)],
)
def test_creeping_is_what_half_a_second_shows(positions: tuple[float, ...], creeps: bool) -> None:
    found = recorder(
        [sample(0.2 * n, ON_TABLE, can=changed(CAN, position=(x, 0.0, 0.0))) for n, x in enumerate(positions)]
    )
    found.restart()
    found.add(sample(0.5, ON_TABLE, can=changed(CAN, position=(0.1, 0.0, 0.0))))
    assert found.conclude((WANT,), MUG).disturbed == ([] if creeps else ["can"])


def test_what_the_hand_holds_does_not_move_of_itself() -> None:
    taken = [
        sample(0.1 * n, ON_TABLE, 0.0, changed(CAN, position=(3.3 + 0.02 * n, 0.0, 0.8), held=True)) for n in range(6)
    ]
    found = recorder(taken[:3])
    found.restart()
    for one in taken[3:]:
        found.add(one)
    assert found.conclude((WANT,), MUG).disturbed == ["can"]


def test_what_another_command_wanted_moved_is_not_disturbed() -> None:
    moved = recorder([*GOOD[:-1], sample(6.0, ON_TRAY, 0.0, changed(CAN, position=(1.0, 0.0, 0.75)))])
    assert moved.conclude((WANT,), MUG).disturbed == ["can"]
    assert moved.conclude((WANT,), frozenset({"mug", "can"})).disturbed == []


def test_touches_are_in_the_evidence_and_hits_too() -> None:
    found = recorder(GOOD)
    touches = [touch(0, force=20.0), touch(1, "desk_leg", force=70.0, impulse=1.24), touch(2, force=0.9)]
    found.note_contacts(m.SimContacts(t=3.0, epoch="e", touches=touches))
    seen = found.conclude((WANT,), MUG)
    assert seen.hits == ["base on desk leg: 70 N, 1.2 Ns in 0.05 s at 2.5 s"]
    assert seen.touches == ["base on desk: 20 N, 0.0 Ns in 0.05 s at 2.5 s", *seen.hits]


def touch(number: int, thing: str = "desk", kind: m.TouchKind = "furniture", **more: float) -> m.Touch:
    return m.Touch(id=number, part="base", thing=thing, kind=kind, first=2.5, last=2.55, seconds=0.05, **more)


@pytest.mark.parametrize(
    ("kind", "force", "impulse", "hit"),
    [
        ("furniture", 65.0, 32.5, False), ("furniture", 65.1, 0.1, True), ("furniture", 1.0, 32.6, True),
        ("obstacle", 65.1, 0.1, True), ("floor", 65.1, 0.1, True), ("held", 65.0, 32.5, False),
        ("held", 65.1, 0.1, True), ("held", 5.0, 32.6, True), ("self", 10.0, 5.0, False), ("self", 10.1, 0.1, True),
        ("self", 1.0, 5.1, True),
    ],
)  # fmt: skip
def test_a_touch_is_a_hit_by_its_force_or_its_impulse(
    kind: m.TouchKind, force: float, impulse: float, hit: bool
) -> None:
    assert is_hit(touch(0, kind=kind, force=force, impulse=impulse)) == hit


def test_a_book_keeps_the_last_word_on_each_touch_and_what_a_killed_simulation_saw() -> None:
    book = ContactBook()
    book.note(m.SimContacts(t=1.0, epoch="a", touches=[touch(0, force=1.0), touch(1, kind="held", force=0.99)]))
    book.note(m.SimContacts(t=2.0, epoch="a", touches=[touch(0, force=66.0)]))
    book.note(m.SimContacts(t=3.0, epoch="b", touches=[touch(0, "wall_3", force=1.0, impulse=40.0)]))
    assert book.felt() == [
        "base on desk: 66 N, 0.0 Ns in 0.05 s at 2.5 s", "base on wall 3: 1 N, 40.0 Ns in 0.05 s at 2.5 s",
    ]  # fmt: skip
    assert book.hits() == book.felt()
    assert describe(touch(1, kind="held")) == "base in the hand on desk: 0 N, 0.0 Ns in 0.05 s at 2.5 s"


@pytest.mark.parametrize(("drift", "standing"), [(0.0049, True), (0.0051, False)])
def test_a_base_stands_that_is_at_rest(drift: float, standing: bool) -> None:
    assert evidence([*GOOD, sample(6.4, ON_TRAY, drift)]).standing == standing


def test_without_a_sample_nothing_is_shown() -> None:
    found = EvidenceRecorder(KINDS)
    assert not found.ready and not found.conclude((WANT,), MUG).standing
    found.add(GOOD[0])
    assert found.ready and found.conclude((WANT,), MUG).standing


# --- goals
def test_a_goal_is_held_against_physics() -> None:
    things = recorder(GOOD).things((WANT, Want("can", ("desk",))))
    assert shortfall(things[:1], []) == shortfall([], [Shown("still", True)]) == ""
    assert shortfall([], []) == "nothing was wanted that could be done"
    assert (
        shortfall(things, [Shown("still", True), Shown("holds can", False, "holds nothing")])
        == "can: never lifted by the gripper; on table, not on desk; holds nothing"
    )


def test_what_a_goal_speaks_of_may_be_moved() -> None:
    assert Goal().things == frozenset()
    goal = Goal((WANT,), (Effect("beside", "can", "ball"), Effect("still")))
    assert goal.things == {"mug", "can", "ball"}


def test_success_is_weighted_by_the_way() -> None:
    assert spl(True, 2.0, 4.0) == 0.5
    assert spl(True, 4.0, 2.0) == 1.0
    assert spl(True, 0.0, 2.0) == spl(False, 2.0, 2.0) == 0.0


# --- numbers as they are told
def test_of_a_world_that_nobody_showed_nothing_is_known() -> None:
    unseen = ThingEvidence("mug", "", why="the simulation showed nothing")
    assert EvidenceRecorder(KINDS).things((WANT,)) == [unseen]


def test_ways_are_told_to_the_millimetre() -> None:
    third = 1 / 3
    carrying = [
        sample(0.0, ON_TABLE),
        sample(1.0, HELD, third),
        sample(2.0, HELD, 2 * third),
        sample(3.0, ON_TRAY, 2 * third),
    ]
    found = evidence(carrying)
    assert (found.driven, found.things[0].carried) == (0.667, 0.667)


def test_five_millimetres_are_no_rest() -> None:
    here, there = (changed(ON_TRAY, position=(x, 0.0, 0.0)) for x in (0.0, 0.005))
    assert not mug([*GOOD[:5], sample(5.0, here), sample(5.5, there)]).at_rest


def test_the_weight_of_short_ways_and_of_none() -> None:
    assert spl(True, 0.5, 1.0) == 0.5
    assert spl(True, 0.0, 0.0) == 0.0
