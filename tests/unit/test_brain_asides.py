"""What people say to a robot at work, and what it asks before it acts on a guess; planner and peers by hand."""

import pytest

from common import messages as m
from common import topics
from tests.unit.brain_bench import Bench
from tests.unit.test_brain_vla import FETCH, PLAN, SPEECH, answer_plan, approach, asked, bench_of, planned, reply, see

SAYS = m.PlanStep(action="say", text="I am busy.")


def hear(bench: Bench, text: str) -> None:
    """Somebody says something, whatever the robot is doing."""
    bench.command(text, confidence=1.0)


def finish(bench: Bench) -> None:
    """Carry out the fetch that is under way."""
    see(bench, 1)
    approach(bench, 1)
    bench.did(bench.manip(1))
    bench.drove(bench.nav(1))
    bench.did(bench.manip(2))
    see(bench, 2)


def test_a_question_is_answered_beside_the_mission() -> None:
    bench = planned()
    hear(bench, "what are you doing")
    request = bench.next_goal(PLAN, 2)
    assert request.history.doing == "bring me the red mug" and request.history.step
    answer_plan(bench, 2, [SAYS])
    assert bench.texts(SPEECH)[-1] == "say I am busy."
    finish(bench)
    bench.until(lambda: bench.states()[-1] == "COMPLETED")
    assert bench.state.last is not None and bench.state.last.command == "bring me the red mug"


def test_a_question_that_takes_more_than_words_waits_for_its_turn() -> None:
    bench = planned()
    hear(bench, "where is the apple")
    answer_plan(bench, 2, [m.PlanStep(action="find", object="apple")])
    assert "I will do that next" in bench.texts(SPEECH)[-1]
    finish(bench)
    assert bench.next_goal(PLAN, 3).command == "where is the apple"


def test_an_answer_that_never_comes_is_given_up_aloud() -> None:
    bench = planned()
    hear(bench, "what are you doing")
    bench.until(lambda: any("I cannot answer that now" in text for text in bench.texts(SPEECH)))


def test_a_command_for_later_is_carried_out_later() -> None:
    bench = planned()
    hear(bench, "after that bring me the apple")
    assert bench.texts(SPEECH)[-1] == "say Next I will bring you the apple."
    finish(bench)
    request = bench.next_goal(PLAN, 2)
    assert request.command == "bring me the apple"
    assert request.history.objects == ["red mug"] and request.history.doing == ""
    assert request.history.last is not None and request.history.last.outcome == "delivered"


def test_the_queue_has_an_end_and_a_stop_empties_it() -> None:
    bench = planned()
    for n in range(6):
        hear(bench, f"then go to place {n}")
    assert "already" in bench.texts(SPEECH)[-1]
    hear(bench, "stop")
    bench.until(lambda: bench.states()[-1] == "WAITING")
    bench.step(5.0)
    assert len(bench.sent(PLAN)) == 1


def test_a_command_instead_takes_the_place_of_the_mission() -> None:
    bench = planned()
    hear(bench, "forget that, bring me the apple")
    assert bench.texts(SPEECH)[-1] == "say All right, I will bring you the apple instead."
    assert bench.next_goal(PLAN, 2).command == "bring me the apple"
    assert bench.outcome == "cancelled"


@pytest.mark.parametrize(
    ("said", "answer"),
    [
        ("wait, the blue one instead", "the blue one instead."),
        ("sorry, I meant the green can", "the green can instead."),
    ],
)
def test_a_thing_instead_is_named_as_a_thing(said: str, answer: str) -> None:
    bench = planned()
    hear(bench, said)
    assert bench.texts(SPEECH)[-1] == f"say All right, {answer}"


def test_what_was_called_off_says_by_which_words() -> None:
    bench = planned()
    hear(bench, "never mind")
    assert bench.state.last is not None
    assert (bench.state.last.outcome, bench.state.last.reason) == ("cancelled", "called off: never mind")


def test_yes_and_thanks_change_nothing() -> None:
    bench = planned()
    for text in ("yes", "thank you", "good job"):
        hear(bench, text)
    finish(bench)
    bench.until(lambda: bench.states()[-1] == "WAITING")
    assert len(bench.sent(PLAN)) == 1


def guessed() -> Bench:
    bench = asked("bring me the botle", enable_confirmation=False)
    request = bench.next_goal(PLAN, 1)
    plan = m.ActionPlan(request_id=request.id, steps=[], detail="I know no botle", suggestion="bring me the bottle")
    bench.send(topics.ACTION_PLAN, plan)
    bench.step()
    bench.until(lambda: "say Do you mean: bring me the bottle?" in bench.texts(SPEECH))
    return bench


def test_a_guess_is_asked_about_first() -> None:
    bench = guessed()
    reply(bench, "yes")
    assert bench.next_goal(PLAN, 2).command == "bring me the bottle"
    answer_plan(bench, 2, FETCH)
    finish(bench)
    bench.until(lambda: bench.states()[-1] == "COMPLETED")


def test_a_guess_that_is_wrong_is_not_made_again() -> None:
    bench = guessed()
    reply(bench, "no")
    request = bench.next_goal(PLAN, 2)
    assert request.command == "bring me the botle"
    assert request.rejected is not None and not request.rejected.steps


def test_a_correction_of_a_guess_is_the_command() -> None:
    bench = guessed()
    reply(bench, "no, bring me the apple")
    assert bench.next_goal(PLAN, 2).command == "bring me the apple"


def test_nobody_answers_a_guess() -> None:
    bench = guessed()
    bench.until(lambda: bench.state.last is not None)
    assert len(bench.sent(PLAN)) == 1
    assert bench.outcome == "failed"


def unclear(bench: Bench, count: int, steps: list[m.PlanStep], suggestion: str = "", detail: str = "") -> None:
    """Words that speech took for no command, and what the planner makes of them."""
    others = [m.Transcription(text="i am angry", score=0.2)]
    bench.send(topics.SPEECH_UNCLEAR, m.VoiceCommand(text="i am hungry", confidence=0.0, alternatives=others))
    request = bench.next_goal(PLAN, count)
    assert (request.command, request.alternatives) == ("i am hungry", others)
    plan = m.ActionPlan(request_id=request.id, steps=steps, suggestion=suggestion, detail=detail)
    bench.send(topics.ACTION_PLAN, plan)
    bench.step(0.5)


@pytest.mark.parametrize("suggestion", ["", "i am angry", "bring me the apple"])
def test_what_speech_takes_for_no_command_is_asked_about_where_there_is_a_plan(suggestion: str) -> None:
    bench = bench_of(enable_confirmation=False)
    unclear(bench, 1, [] if suggestion else FETCH, suggestion)
    text = suggestion or "i am hungry"
    assert bench.texts(SPEECH) == [f"say Did you say {text}?"] and bench.count(PLAN) == 1
    reply(bench, "yes")
    assert bench.next_goal(PLAN, 2).command == text


@pytest.mark.parametrize(
    ("detail", "said"),
    [
        ("", m.NOT_UNDERSTOOD),
        (f"{m.SENSELESS} 'i am hungry'", m.NOT_UNDERSTOOD),
        ("I know no windowsill", "I know no windowsill."),
        ("the shelf is too high", "I cannot do that: the shelf is too high."),
    ],
)
def test_what_has_no_plan_either_was_not_understood_or_cannot_be_done(detail: str, said: str) -> None:
    bench = bench_of()
    unclear(bench, 1, [], detail=detail)
    assert bench.texts(SPEECH) == [f"say {said}"]
    assert bench.states()[-1] == "WAITING" and bench.outcome == ""


def test_at_work_nobody_weighs_what_is_no_command() -> None:
    bench = planned()
    bench.send(topics.SPEECH_UNCLEAR, m.VoiceCommand(text="i am hungry", confidence=0.0))
    bench.step()
    assert bench.texts(SPEECH)[-1] == f"say {m.NOT_UNDERSTOOD}" and bench.count(PLAN) == 1


def test_a_planner_that_does_not_answer_is_not_waited_for_for_ever() -> None:
    bench = bench_of()
    bench.send(topics.SPEECH_UNCLEAR, m.VoiceCommand(text="i am hungry", confidence=0.0))
    bench.until(lambda: bench.texts(SPEECH) == [f"say {m.NOT_UNDERSTOOD}"])


def test_it_remembers_where_a_thing_stood() -> None:
    bench = planned()
    query = bench.next_goal(topics.OBJECT_QUERY, 1)
    pose = m.ObjectPose(query_id=query.id, found=True, label="red mug", position=(-1.5, -2.3, 0.6), on="living table")
    bench.send(topics.OBJECT_POSE, pose)
    bench.step()
    approach(bench, 1)
    bench.did(bench.manip(1))
    bench.drove(bench.nav(1))
    bench.did(bench.manip(2))
    see(bench, 2)
    bench.until(lambda: bench.states()[-1] == "WAITING")
    hear(bench, "put it back where it was")
    assert bench.next_goal(PLAN, 2).history.taken_from == {"red mug": "living table"}


def test_what_was_said_last_is_said_again() -> None:
    bench = planned()
    hear(bench, "after that bring me the apple")
    hear(bench, "say that again")
    assert bench.next_goal(PLAN, 2).history.said == "Next I will bring you the apple."
