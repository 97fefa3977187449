"""The VLA tree with hand-driven peers: dialogue, planning, search, and every kind of recovery."""

import math
from typing import Any

import msgspec
import pytest

from common import messages as m
from common import topics
from common.approach import ROOM, clearance
from common.geometry import wrap
from common.household import told
from common.scene import load_scene
from common.viewpoints import viewpoints_of
from common.whereabouts import points_at
from services.brain.config import BrainConfig
from services.brain.recoveries.step_back import BACK
from services.brain.world.standing_poses import place_pose, standing_pose
from services.sim.layout import place_objects
from tests.unit.brain_bench import Bench

SPEECH, NAV, MANIP, POSE = topics.SPEECH_GOAL, topics.NAVIGATION_GOAL, topics.MANIPULATION_GOAL, topics.NAV_GOAL
WORLD = load_scene("apartment")
SCENE = told(WORLD)
PLAN, QUERY = topics.PLAN_REQUEST, topics.OBJECT_QUERY
MUG = {"object": "red mug"}
MUG_AT = (-1.5, -2.3, 0.6)
FETCH = [
    m.PlanStep(action="find", **MUG),
    m.PlanStep(action="grasp", **MUG),
    m.PlanStep(action="return"),
    m.PlanStep(action="release"),
]


def bench_of(**changes: Any) -> Bench:
    bench = Bench(BrainConfig(pipeline="vla", **changes))
    bench.step()
    return bench


def asked(text: str = "bring me the red mug", **changes: Any) -> Bench:
    """A command is in, nothing confirmed."""
    bench = bench_of(**changes)
    bench.command(text, confidence=0.9)
    return bench


def planned(steps: list[m.PlanStep] = FETCH) -> Bench:
    """The plan is accepted, confirmation off."""
    bench = asked(enable_confirmation=False)
    answer_plan(bench, 1, steps)
    return bench


def answer_plan(bench: Bench, count: int, steps: list[m.PlanStep], detail: str = "") -> None:
    request = bench.next_goal(PLAN, count)
    bench.send(topics.ACTION_PLAN, m.ActionPlan(request_id=request.id, steps=steps, detail=detail))
    bench.step()


def see(bench: Bench, count: int, found: bool = True) -> None:
    query = bench.next_goal(QUERY, count)
    assert query.query == "red mug"
    at = (0.7, 0.0, 0.51) if query.since else MUG_AT
    pose = m.ObjectPose(
        query_id=query.id, found=found, label="red mug", position=at, seen_at=bench.now, id="object-1"
    )  # fmt: skip
    bench.send(topics.OBJECT_POSE, pose)
    bench.step()


def approach(
    bench: Bench, count: int, status: m.NavStatus = "arrived", code: str = "", recoveries: int = 0
) -> m.NavGoal:
    """Result the pose number `count`, which must be one before the mug, as a navigator that only knows `nav_goal`."""
    goal = bench.next_goal(POSE, count)
    assert goal.object is not None and (goal.object.label, goal.object.position) == ("red mug", MUG_AT)
    told = m.NavigationFeedback(goal_id=goal.id, status=status, code=code, recoveries=recoveries)
    bench.send(topics.NAVIGATION_FEEDBACK, told)
    bench.step()
    return goal


def reply(bench: Bench, text: str) -> None:
    """Result the newest question."""
    count = bench.texts(SPEECH).count("listen") + 1
    bench.until(lambda: bench.texts(SPEECH).count("listen") == count)
    listen = [g for g in bench.sent(SPEECH) if g.goal == "listen"][-1]
    bench.send(topics.SPEECH_RESULT, m.SpeechResult(text=text, goal_id=listen.id, attempt=1))
    bench.step()


def test_the_contracts_sequence() -> None:
    bench = asked()
    reply(bench, "yes")
    answer_plan(bench, 1, FETCH)
    see(bench, 1)
    stance = approach(bench, 1)
    grab = bench.manip(1)
    assert grab.object is not None and grab.object.position == MUG_AT
    bench.did(grab)
    bench.drove(bench.nav(1))
    bench.did(bench.manip(2))
    see(bench, 2)
    bench.until(lambda: bench.states()[-1] == "WAITING")
    assert bench.states() == [
        "IDLE", "WAITING", "CONFIRMING", "PLANNING", "GROUNDING", "NAVIGATING", "GRABBING", "RETURNING", "RELEASING",
        "COMPLETED", "WAITING",
    ]  # fmt: skip
    assert list(dict.fromkeys(s.state for s in bench.sent(topics.SYSTEM_STATUS))) == [
        "IDLE", "LISTENING", "PLANNING", "GROUNDING", "NAVIGATING", "EXECUTING", "SUCCESS",
    ]  # fmt: skip
    assert bench.texts(SPEECH) == ["say Did you say bring me the red mug?", "listen", "say Done."]
    assert [(g.x, g.y) for g in bench.sent(POSE)] == [(stance.x, stance.y)]
    assert bench.texts(NAV) == ["return_to_start"]
    assert bench.texts(MANIP) == ["grab", "release"]
    assert bench.outcome == "delivered"
    steps = dict.fromkeys((s.state, s.plan_step) for s in bench.sent(topics.BRAIN_STATE) if s.mission_id)
    assert list(steps)[1:] == [
        ("PLANNING", 0), ("GROUNDING", 1), ("NAVIGATING", 2), ("GRABBING", 2), ("RETURNING", 3), ("RELEASING", 4),
        ("COMPLETED", 0),
    ]  # fmt: skip


def test_it_goes_to_where_things_are_brought_when_that_is_not_its_home(monkeypatch: pytest.MonkeyPatch) -> None:
    """A home in which the robot does not start before a table; what it holds is not put on the floor there."""
    elsewhere = msgspec.structs.replace(SCENE, delivery="kitchen table")
    monkeypatch.setattr("tests.unit.brain_bench.HOME", elsewhere)
    bench = planned()
    see(bench, 1)
    approach(bench, 1)
    bench.did(bench.manip(1))
    assert bench.nav(1).goal == "goto kitchen table"
    bench.drove(bench.nav(1))
    assert bench.manip(2).goal == "release"
    pose = place_pose(elsewhere, "kitchen table", (0.0, 0.0, 0.0))
    table = elsewhere.receptacle("kitchen table")
    assert pose is not None and table is not None and table.outline.distance(*pose[:2]) < 0.5


def test_the_tree_is_the_contracts_sequence_of_steps() -> None:
    root = asked().last(topics.BRAIN_TREE).root
    question, do = root.children[-1].children[:2]
    assert question.name == "if question"
    assert (root.type, do.type) == ("Sequence", "Sequence")
    assert [child.name for child in root.children] == ["ready", "listen", "mission"]
    assert [child.name for child in do.children] == [
        "confirm", "plan and validate", "look first", "execute", "complete", "report success", "settle",
    ]  # fmt: skip


def test_a_correction_is_taken_and_confirmed_again() -> None:
    bench = asked()
    reply(bench, "no, the blue mug")
    reply(bench, "yes")
    assert bench.next_goal(PLAN, 1).command == "bring me the blue mug"
    assert "say Did you say bring me the blue mug?" in bench.texts(SPEECH)


def test_a_rejection_asks_for_the_command_again() -> None:
    bench = asked()
    reply(bench, "no")
    reply(bench, "bring me the apple")
    reply(bench, "yes")
    assert bench.next_goal(PLAN, 1).command == "bring me the apple"


def test_never_confirmed_is_never_done() -> None:
    bench = asked()
    while bench.state.state == "CONFIRMING":
        reply(bench, "no")
    assert bench.state.state == "ERROR"
    assert bench.texts(SPEECH).count("listen") == 6
    assert bench.sent(PLAN) == []


def test_confirmation_by_need() -> None:
    assert asked(enable_confirmation=False, confirm_below=0.8).state.state == "PLANNING"
    assert asked(enable_confirmation=False, confirm_below=0.95).state.state == "CONFIRMING"
    bench = bench_of()
    bench.command("bring me the red mug", confirmed=True)
    assert bench.state.state == "PLANNING"


OTHERS = [m.Transcription(text="bring me the red mug", score=0.4)]


def heard_alike(suggestion: str, steps: list[m.PlanStep] | None = None) -> Bench:
    """A sure command with an alternative, nothing to be asked, and the planner's answer to which of them it is."""
    bench = bench_of(enable_confirmation=False)
    bench.command("bring me the red mud", confidence=1.0, alternatives=OTHERS)
    request = bench.next_goal(PLAN, 1)
    assert (request.command, request.alternatives) == ("bring me the red mud", OTHERS)
    bench.send(topics.ACTION_PLAN, m.ActionPlan(request_id=request.id, steps=steps or [], suggestion=suggestion))
    bench.step()
    return bench


def test_what_may_have_been_said_instead_is_asked_about_and_never_done_unasked() -> None:
    bench = heard_alike("bring me the red mug")
    assert bench.texts(SPEECH) == ["say Did you say bring me the red mug?"] and bench.count(PLAN) == 1
    reply(bench, "yes")
    request = bench.next_goal(PLAN, 2)
    assert (request.command, request.alternatives) == ("bring me the red mug", [])


def test_what_was_heard_first_is_asked_about_where_the_planner_doubts_it() -> None:
    bench = heard_alike("bring me the red mud")
    assert bench.texts(SPEECH) == ["say Did you say bring me the red mud?"]


@pytest.mark.parametrize("suggestion", ["", "bring me the apple"])
def test_what_was_heard_first_stands_where_no_transcription_is_suggested(suggestion: str) -> None:
    """Nor is the plan that came with the choice carried out: the command is planned for itself."""
    bench = heard_alike(suggestion, [] if suggestion else FETCH)
    request = bench.next_goal(PLAN, 2)
    assert (request.command, request.alternatives) == ("bring me the red mud", [])
    assert bench.sent(QUERY) == [] and bench.texts(SPEECH) == []


def test_without_a_planner_to_choose_what_was_heard_first_is_asked_about() -> None:
    bench = bench_of()
    bench.command("bring me the red mud", alternatives=OTHERS)
    bench.until(lambda: bool(bench.texts(SPEECH)))
    assert bench.texts(SPEECH) == ["say Did you say bring me the red mud?"]


def test_who_vouches_for_the_words_has_no_alternatives() -> None:
    bench = bench_of()
    bench.command("bring me the red mud", confirmed=True, alternatives=OTHERS)
    assert bench.next_goal(PLAN, 1).alternatives == []


def test_cancel_as_an_answer_is_no_error() -> None:
    bench = asked()
    reply(bench, "never mind")
    bench.until(lambda: bench.states()[-1] == "WAITING")
    assert bench.outcome == "cancelled"
    assert "ERROR" not in bench.states()


def test_an_answer_during_the_question_counts_and_cuts_it_short() -> None:
    bench = asked()
    assert bench.texts(SPEECH) == ["say Did you say bring me the red mug?"]
    bench.command("no, the blue bottle", confidence=1.0)
    bench.until(lambda: len(bench.texts(SPEECH)) == 3)
    assert bench.texts(SPEECH)[1:] == ["cancel", "say Did you say bring me the blue bottle?"]
    bench.send(topics.VOICE_COMMAND, m.VoiceCommand(text="yes", confidence=1.0))
    assert bench.next_goal(PLAN, 1).command == "bring me the blue bottle"
    assert "listen" not in bench.texts(SPEECH)


def test_a_typed_yes_counts() -> None:
    bench = asked()
    bench.until(lambda: "listen" in bench.texts(SPEECH))
    bench.command("yes")
    bench.next_goal(PLAN, 1)


def lost_on_the_way() -> Bench:
    """Every release said that the hand is empty."""
    bench = planned()
    see(bench, 1)
    approach(bench, 1)
    bench.did(bench.manip(1))
    bench.drove(bench.nav(1))
    for attempt in range(BrainConfig().release_retries + 1):
        bench.did(bench.manip(2 + attempt), "failed", "NOT_HOLDING")
    return bench


def test_what_was_lost_on_the_way_is_fetched_again() -> None:
    bench = lost_on_the_way()
    see(bench, 2)
    approach(bench, 2)
    bench.did(bench.manip(3 + BrainConfig().release_retries))
    bench.drove(bench.nav(2))
    bench.did(bench.manip(4 + BrainConfig().release_retries))
    bench.until(lambda: bench.states()[-1] == "WAITING")
    assert bench.texts(NAV) == ["return_to_start"] * 2 and len(bench.sent(POSE)) == 2
    assert bench.texts(MANIP)[-2:] == ["grab", "release"]
    assert bench.outcome == "delivered"


def test_a_loss_that_cannot_be_mended_is_no_longer_held() -> None:
    bench = lost_on_the_way()
    count = 2
    while bench.state.state != "ERROR":
        if len(bench.sent(QUERY)) >= count:
            see(bench, count, found=False)
            count += 1
        views = bench.sent(POSE)
        if views and bench.state.step.startswith("search"):
            bench.send(
                topics.NAVIGATION_FEEDBACK, m.NavigationFeedback(status="failed", goal_id=views[-1].id, code="NO_PATH")
            )
        bench.step()
    assert "holding" not in bench.state.detail
    assert bench.texts(SPEECH)[-1].endswith("Please look whether it lies on my own base.")


def test_an_impossible_plan_is_rejected_with_the_reason_and_replanned() -> None:
    bench = planned([m.PlanStep(action="grasp", object="sofa")])
    request = bench.next_goal(PLAN, 2)
    assert request.rejected is not None
    assert "sofa" in request.rejected.reason and request.rejected.steps[0].object == "sofa"
    assert bench.sent(NAV) == []
    answer_plan(bench, 2, FETCH)
    see(bench, 1)
    bench.next_goal(POSE, 1)


def test_three_impossible_plans_are_explained_aloud() -> None:
    bench = asked(enable_confirmation=False)
    for count in (1, 2, 3):
        answer_plan(bench, count, [m.PlanStep(action="release")])
    assert bench.state.state == "ERROR"
    assert len(bench.sent(PLAN)) == 3
    assert "nothing in the hand" in bench.texts(SPEECH)[-1]


def test_a_planner_without_a_plan_is_quoted_at_once() -> None:
    bench = asked("sing", enable_confirmation=False)
    answer_plan(bench, 1, [], detail="I cannot sing")
    assert bench.state.state == "ERROR"
    assert bench.texts(SPEECH)[-1] == "say I cannot sing."


def test_a_reason_that_is_no_sentence_says_what_it_is_a_reason_for() -> None:
    bench = asked("put it down", enable_confirmation=False)
    answer_plan(bench, 1, [], detail="there is nothing in my hand")
    assert bench.texts(SPEECH)[-1] == "say I cannot do that: there is nothing in my hand."


def test_search_turns_then_looks_from_elsewhere() -> None:
    bench = planned()
    bench.send(topics.POSE, m.PoseEstimate(t=0.0, x=1.0, y=0.5, theta=0.0))
    see(bench, 1, found=False)
    turn = bench.next_goal(POSE, 1)
    assert (turn.x, turn.y) == (1.0, 0.5) and turn.theta > 1.0
    feedback = m.NavigationFeedback(goal_id=turn.id, status="arrived")
    bench.send(topics.NAVIGATION_FEEDBACK, feedback)
    see(bench, 2, found=False)
    looked = bench.now
    second = bench.next_goal(POSE, 2)
    assert bench.now - looked < BrainConfig().settle, "what was not there needs no rest"
    bench.drove(second, "failed", "BLOCKED")
    third = bench.next_goal(POSE, 3)
    assert (third.x, third.y) != (turn.x, turn.y)
    bench.drove(third)
    see(bench, 3)
    approach(bench, 4)
    bench.manip(1)


@pytest.mark.parametrize(
    ("steps", "place"),
    [
        ([m.PlanStep(action="find", text="red mug from the bed", **MUG), *FETCH[1:]], "bed"),
        ([m.PlanStep(action="find", text="red mug from the sofa", **MUG), *FETCH[1:]], "sofa seat"),
        ([m.PlanStep(action="navigate", target="study shelf"), *FETCH], "study shelf"),
    ],
)
def test_a_search_looks_first_where_the_thing_was_said_to_be(steps: list[m.PlanStep], place: str) -> None:
    def see_nothing(count: int) -> m.NavGoal:
        query = bench.next_goal(QUERY, count)
        bench.send(topics.OBJECT_POSE, m.ObjectPose(query_id=query.id, found=False))
        return bench.next_goal(POSE, count)

    bench = planned(steps)
    if steps[0].action == "navigate":
        bench.drove(bench.nav(1))
    views = viewpoints_of(SCENE, None)
    there, count = points_at(place, SCENE, views), 1
    while (goal := see_nothing(count)) and bench.state.step == "search: attempt 1":
        bench.drove(goal)
        count += 1
    assert views.visible((goal.x, goal.y, goal.theta))[there].any()


@pytest.mark.parametrize(
    ("command", "place"),
    [
        ("There is my mug on the study floor. Please put it on the desk.", "study floor"),
        ("Put my mug on the desk. I saw the mug in the kitchen.", "kitchen"), ("Put the mug on the desk.", ""),
        ("Put the bowl on the desk and bring me the mug.", ""),
    ],
)  # fmt: skip
def test_where_a_thing_is_may_be_said_in_a_sentence_of_its_own(command: str, place: str) -> None:
    bench = asked(command, enable_confirmation=False)
    one = {"object": "mug"}
    there = m.PlanStep(action="place", target="desk", **one)
    answer_plan(bench, 1, [m.PlanStep(action="find", **one), m.PlanStep(action="grasp", **one), there])
    assert bench.brain.context.told_place("mug") == place


def test_a_question_about_a_shorter_command_forgets_no_place() -> None:
    bench = asked("Bring me the mug, it's on the desk in the study.", enable_confirmation=False)
    bench.brain.context.mission.command = "bring me the mug"
    assert bench.brain.context.told_place("mug") == "desk"


def test_a_search_that_is_held_up_on_its_way_looks_elsewhere_first() -> None:
    bench = planned()
    see(bench, 1, found=False)
    for count in (1, 2):
        bench.drove(bench.next_goal(POSE, count))
        see(bench, count + 1, found=False)
    first, patience = bench.next_goal(POSE, 3), BrainConfig().view_patience
    began = bench.now

    def hold_up(code: str, seconds: float) -> None:
        until = bench.now + seconds
        while bench.now < until and len(bench.sent(POSE)) == 3:
            told = m.NavigationFeedback(goal_id=first.id, status="navigating", code=code)
            bench.send(topics.NAVIGATION_FEEDBACK, told)
            bench.step()

    hold_up("PERSON_IN_WAY", patience / 2)
    hold_up("DETOUR", patience)
    assert len(bench.sent(POSE)) == 3, "it is getting on"
    hold_up("GIVING_WAY", patience)
    second = bench.next_goal(POSE, 4)
    assert bench.now - began > 2 * patience
    assert (second.x, second.y, second.theta) != (first.x, first.y, first.theta)
    assert bench.texts(NAV) == ["stop"]


def test_views_that_people_keep_it_from_are_no_looks_for_as_long_as_people_are_waited_for() -> None:
    bench = planned()
    see(bench, 1, found=False)
    config, kept, count, looked = BrainConfig(), 0, 0, 0
    while True:
        bench.until(lambda n=count: bench.state.state == "ERROR" or len(bench.sent(POSE)) > n)  # type: ignore[misc]
        if bench.state.state == "ERROR":
            break
        count += 1
        if count > 2 and kept < 8:
            kept += 1
            bench.drove(bench.sent(POSE)[-1], "failed", "PERSON_IN_WAY")
            continue
        looked += 1
        bench.drove(bench.sent(POSE)[-1])
        see(bench, looked + 1, found=False)
    assert kept * config.view_patience <= config.people_patience
    assert looked == looks_of_an_absent_object(), "as many as with nobody around"


def test_an_absent_object_is_reported_after_three_attempts() -> None:
    assert 4 <= looks_of_an_absent_object() <= 16


def looks_of_an_absent_object() -> int:
    bench = planned()
    see(bench, 1, found=False)
    count = 0
    while True:
        bench.until(lambda n=count: bench.state.state == "ERROR" or len(bench.sent(POSE)) > n)  # type: ignore[misc]
        if bench.state.state == "ERROR":
            break
        count += 1
        bench.drove(bench.sent(POSE)[-1])
        see(bench, count + 1, found=False)
    # Turning on the spot twice, then two tours of what can be seen from elsewhere.
    assert len({(g.x, g.y, g.theta) for g in bench.sent(POSE)}) == count
    assert "NOT_FOUND" in bench.state.detail
    assert bench.texts(SPEECH)[-1] == "say I could not find the red mug."
    return count


def test_a_failed_grab_looks_again_and_drives_up_again() -> None:
    bench = planned()
    for count, code in ((1, "EMPTY_GRASP"), (2, "SLIPPED")):
        see(bench, count)
        approach(bench, count)
        bench.did(bench.manip(count), "failed", code)
    see(bench, 3)
    approach(bench, 3)
    bench.did(bench.manip(3))
    assert bench.nav(1).goal == "return_to_start"


def test_the_next_grab_is_tried_from_the_stance_that_manipulation_told_and_only_that_one() -> None:
    bench = planned()
    see(bench, 1)
    approach(bench, 1)
    stance = (-1.0, -1.7, 0.4)
    unreachable(bench, bench.manip(1), stance)
    see(bench, 2)
    told = bench.next_goal(POSE, 2)
    assert (told.x, told.y, told.theta) == stance and told.object is None
    bench.send(topics.NAVIGATION_FEEDBACK, m.NavigationFeedback(goal_id=told.id, status="arrived"))
    bench.did(bench.manip(2), "failed", "SLIPPED")
    see(bench, 3)
    approach(bench, 3)
    bench.did(bench.manip(3))
    assert bench.nav(1).goal == "return_to_start"


def test_what_slipped_away_is_looked_for_on_the_floor_from_farther_back() -> None:
    bench = planned()
    see(bench, 1)
    approach(bench, 1)
    bench.did(bench.manip(1), "failed", "SLIPPED")
    see(bench, 2, found=False)
    goal = bench.next_goal(POSE, 2)
    x, y, theta = goal.x, goal.y, goal.theta
    assert goal.object is None and min(BACK) <= math.dist((x, y), MUG_AT[:2]) <= max(BACK)
    assert abs(wrap(math.atan2(MUG_AT[1] - y, MUG_AT[0] - x) - theta)) < 0.01
    bench.send(topics.NAVIGATION_FEEDBACK, m.NavigationFeedback(goal_id=goal.id, status="arrived"))
    see(bench, 3)
    assert bench.next_goal(POSE, 3).object is not None


def test_what_manipulation_sends_elsewhere_for_is_no_try_as_long_as_it_has_other_stances() -> None:
    bench = planned()
    see(bench, 1)
    approach(bench, 1)
    for count in (1, 2, 3):
        unreachable(bench, bench.manip(count), (-1.0, -1.0 - 0.2 * count, 0.4))
        see(bench, count + 1)
        told = bench.next_goal(POSE, count + 1)
        assert told.y == -1.0 - 0.2 * count
        bench.send(topics.NAVIGATION_FEEDBACK, m.NavigationFeedback(goal_id=told.id, status="arrived"))
    bench.did(bench.manip(4))
    assert bench.nav(1).goal == "return_to_start"


def test_a_told_stance_that_cannot_be_driven_to_is_left_for_another_try() -> None:
    bench = planned()
    see(bench, 1)
    approach(bench, 1)
    unreachable(bench, bench.manip(1), (-1.0, -1.7, 0.4))
    see(bench, 2)
    for count in (2, 3, 4):
        told = bench.next_goal(POSE, count)
        failed = m.NavigationFeedback(goal_id=told.id, attempt=told.attempt, status="failed", code="UNREACHABLE")
        bench.send(topics.NAVIGATION_FEEDBACK, failed)
    see(bench, 3)
    assert bench.next_goal(POSE, 5).object is not None, "wherever navigation finds a place"


def unreachable(bench: Bench, goal: m.ManipulationGoal, stance: tuple[float, float, float]) -> None:
    """Manipulation finds no grasp from here, and says from where."""
    told = m.ManipulationStatus(
        status="failed", goal_id=goal.id, attempt=goal.attempt, code="UNREACHABLE", stance=stance
    )
    bench.send(topics.MANIPULATION_STATUS, told)
    bench.step()


def test_three_failed_grabs_are_an_error() -> None:
    bench = planned()
    for count in (1, 2, 3):
        see(bench, count)
        approach(bench, count)
        bench.did(bench.manip(count), "failed", "SLIPPED")
    assert bench.state.state == "ERROR"
    assert "COMPLETED" not in bench.states()


def test_place_drives_to_the_receptacle_once() -> None:
    bin_steps = [*FETCH[:2], m.PlanStep(action="navigate", target="bin"), m.PlanStep(action="place", target="bin")]
    bench = planned(bin_steps)
    see(bench, 1)
    approach(bench, 1)
    grab = bench.manip(1)
    assert grab.to == "bin", "so that it is taken as it can be put down there"
    bench.did(grab)
    bench.drove(bench.nav(1))
    bench.did(bench.manip(2))
    assert bench.texts(NAV) == ["goto bin"]
    assert bench.texts(MANIP) == ["grab", "place bin"]
    bench.until(lambda: bench.state.state == "COMPLETED")


@pytest.mark.parametrize(("recoveries", "attempts"), [(0, 3), (1, 2), (2, 1), (5, 1)])
def test_a_blocked_way_is_tried_twice_more_in_all_whoever_tries(recoveries: int, attempts: int) -> None:
    """What the navigator has tried itself counts; the sender makes up for the rest."""
    bench = planned()
    see(bench, 1)
    sent = [approach(bench, n, "failed", "BLOCKED", recoveries if n == 1 else 0) for n in range(1, attempts + 1)]
    bench.until(lambda: bench.state.state == "ERROR")
    assert [g.attempt for g in bench.sent(POSE)] == list(range(1, attempts + 1)) == [g.attempt for g in sent]
    assert len({g.id for g in sent}) == 1
    bench.until(lambda: bench.texts(SPEECH)[-1] == "say I could not reach the red mug.")


def test_retries_of_several_attempts_add_up_and_other_failures_are_counted_alone() -> None:
    bench = planned()
    see(bench, 1)
    approach(bench, 1, "failed", "NO_SCAN", recoveries=2)
    approach(bench, 2, "failed", "BLOCKED", recoveries=1)
    bench.until(lambda: bench.state.state == "ERROR")
    assert "BLOCKED" in bench.state.detail and len(bench.sent(POSE)) == 2


def test_people_in_the_way_are_waited_for_longer_than_things_and_not_for_ever() -> None:
    bench = planned()
    see(bench, 1)
    patience = BrainConfig().people_patience
    began, count = bench.now, 0
    while bench.now - began < patience:
        count += 1
        approach(bench, count, "failed", "PERSON_IN_WAY", recoveries=2)
        until = bench.now + patience / 6
        while bench.now < until:
            bench.step()
    assert count == len(bench.sent(POSE)) - 1 == 6 and bench.state.state == "NAVIGATING"
    approach(bench, count + 1, "failed", "PERSON_IN_WAY", recoveries=2)
    bench.until(lambda: bench.state.state == "ERROR")
    assert "PERSON_IN_WAY" in bench.state.detail


def test_the_standing_pose_is_free_and_faces_the_thing() -> None:
    """Any navigator could drive there: no part of the base is in furniture, a surface or a wall."""
    for placed in (p for seed in range(20) for p in place_objects(WORLD, seed)):
        x, y, _ = placed.position
        pose = standing_pose(SCENE, (x, y), (0.0, 0.0, 0.0))
        assert clearance(SCENE, pose[0], pose[1]) >= ROOM, f"{placed.spec.name} on {placed.on}"
        assert math.dist(pose[:2], (x, y)) < 0.75
        assert SCENE.room_at(pose[0], pose[1]) is SCENE.room_at(x, y)
        assert abs(math.remainder(math.atan2(y - pose[1], x - pose[0]) - pose[2], math.tau)) < 0.01


def test_every_destination_has_a_pose_to_drive_to() -> None:
    places = [p.name for p in SCENE.places] + [r.name for r in SCENE.rooms] + [r.name for r in SCENE.receptacles]
    for name in places:
        pose = place_pose(SCENE, name, (0.0, 0.0, 0.0))
        assert pose is not None and clearance(SCENE, pose[0], pose[1]) > 0.0, name
    assert place_pose(SCENE, SCENE.delivery, (3.0, 3.0, 0.0)) == (SCENE.home.x, SCENE.home.y, SCENE.home.theta)
    assert place_pose(SCENE, "the moon", (0.0, 0.0, 0.0)) is None


def test_the_robot_stands_on_its_own_side_of_what_lies_free() -> None:
    for here in ((1.2, 0.0, 0.0), (-1.2, 0.0, 0.0)):
        assert standing_pose(SCENE, (0.0, 0.0), here)[0] * here[0] > 0.0


def test_saying_waiting_and_going_need_no_hand() -> None:
    steps = [
        m.PlanStep(action="say", text="On my way."),
        m.PlanStep(action="wait"),
        m.PlanStep(action="navigate", target="kitchen"),
    ]
    bench = planned(steps)
    bench.drove(bench.nav(1))
    bench.until(lambda: bench.state.state == "COMPLETED")
    assert bench.texts(NAV) == ["goto kitchen"]
    assert "say On my way." in bench.texts(SPEECH)


def test_a_plan_that_only_looks_is_followed_by_another_with_what_was_seen() -> None:
    bench = asked("tidy up the table", enable_confirmation=False)
    request = bench.next_goal(PLAN, 1)
    assert request.done == []
    look = [m.PlanStep(action="navigate", target="living table")]
    bench.send(topics.ACTION_PLAN, m.ActionPlan(request_id=request.id, steps=look, again=True))
    bench.step()
    there = bench.nav(1)
    assert there.goal == "goto living table"
    bench.drove(there)
    apple = m.WorldObject(label="apple", kind="apple", colour="red", position=(-1.5, -2.3, 0.55), on="living table")
    bench.send(topics.WORLD_OBJECTS, m.WorldObjects(t=1.0, objects=[apple]))
    request = bench.next_goal(PLAN, 2)
    assert request.done == look and request.world.objects == ["apple"]
    answer_plan(bench, 2, [m.PlanStep(action="say", text="The table is tidy already.")])
    bench.until(lambda: "say The table is tidy already." in bench.texts(SPEECH))
    bench.until(lambda: bench.state.last is not None)
    assert bench.outcome == "delivered"


def test_a_planner_that_only_ever_wants_to_look_is_not_followed_for_ever() -> None:
    bench = asked("tidy up the table", enable_confirmation=False)
    for count in range(1, 6):
        request = bench.next_goal(PLAN, count)
        look = [m.PlanStep(action="wait")]
        bench.send(topics.ACTION_PLAN, m.ActionPlan(request_id=request.id, steps=look, again=True))
        bench.step()
    bench.until(lambda: bench.state.last is not None)
    assert bench.outcome == "failed"


def test_the_words_of_a_step_are_what_perception_is_asked_for() -> None:
    bench = planned([m.PlanStep(action="find", object="mug", text="mug on the left")])
    assert bench.next_goal(QUERY, 1).query == "mug on the left"


def test_listening_is_shown_while_speech_takes_in_an_utterance() -> None:
    bench = bench_of()
    bench.send(topics.SPEECH_STATUS, m.SpeechStatus(state="transcribing"))
    bench.step()
    bench.send(topics.SPEECH_STATUS, m.SpeechStatus(state="idle"))
    bench.step()
    assert bench.states() == ["IDLE", "WAITING", "LISTENING", "WAITING"]


def test_stop_cuts_any_step_short() -> None:
    bench = planned()
    see(bench, 1)
    bench.next_goal(POSE, 1)
    bench.send(topics.VOICE_COMMAND, m.VoiceCommand(text="stop"))
    bench.step(1.0)
    assert bench.outcome == "cancelled"
    assert bench.texts(NAV) == ["stop"]
    assert bench.state.state == "WAITING"


@pytest.mark.parametrize(("height", "reached"), [(0.74, True), (1.0, False)])
def test_what_stands_higher_than_its_kind_is_taken_from_is_refused_before_anything_moves(
    height: float, reached: bool
) -> None:
    bench = planned([m.PlanStep(action="find", object="white bowl"), m.PlanStep(action="grasp", object="white bowl")])
    query = bench.next_goal(QUERY, 1)
    at, size = (-1.5, -6.0, height + 0.03), (0.14, 0.14, 0.06)
    bench.send(
        topics.OBJECT_POSE,
        m.ObjectPose(query_id=query.id, found=True, label="white bowl", position=at, size=size, seen_at=bench.now),
    )
    if reached:
        assert bench.next_goal(POSE, 1).object is not None
        return
    bench.until(lambda: bench.state.state == "ERROR")
    assert bench.count(POSE) == bench.count(MANIP) == 0
    assert "OUT_OF_REACH" in bench.state.detail and "1.00 m" in bench.state.detail
    assert bench.texts(SPEECH)[-1] == "say The white bowl stands too high for me."
