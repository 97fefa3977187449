"""A client's question to the person: said, answered, and never taken for a command, a stop or an answer."""

from common import messages as m
from common import topics
from services.brain.config import BrainConfig
from tests.unit.brain_bench import Bench

SPEECH, PLAN = topics.SPEECH_GOAL, topics.PLAN_REQUEST


def asked(text: str = "Shall I bring you the red mug?", pipeline: str = "vla") -> Bench:
    bench = Bench(BrainConfig(pipeline=pipeline))
    bench.step()
    bench.command(text, confirmed=True, question=True)
    return bench


def answered(bench: Bench, text: str) -> None:
    bench.until(lambda: "listen" in bench.texts(SPEECH))
    listen = bench.sent(SPEECH)[-1]
    bench.send(topics.SPEECH_RESULT, m.SpeechResult(text=text, goal_id=listen.id, attempt=1))
    bench.step()


def outcome(bench: Bench) -> m.MissionOutcome:
    bench.until(lambda: bench.state.last is not None)
    assert bench.state.last is not None
    return bench.state.last


def test_the_answer_is_the_outcome_and_nothing_is_planned() -> None:
    bench = asked()
    assert bench.texts(SPEECH) == ["say Shall I bring you the red mug?"]
    answered(bench, "the blue one please")
    last = outcome(bench)
    assert (last.outcome, last.reason) == ("delivered", "the blue one please")
    bench.until(lambda: bench.state.state == "WAITING")
    assert not bench.sent(PLAN) and not bench.sent(topics.NAVIGATION_GOAL)


def test_an_answer_in_writing_counts_while_the_question_is_said() -> None:
    bench = asked()
    bench.command("yes", confirmed=True)
    assert outcome(bench).reason == "yes"


def test_silence_fails_with_a_reason_and_no_plan() -> None:
    bench = asked()
    bench.until(lambda: "listen" in bench.texts(SPEECH))
    bench.until(lambda: bench.state.last is not None, limit=900)
    last = outcome(bench)
    assert last.outcome == "failed" and last.stage == "CONFIRMING"
    assert not bench.sent(PLAN)


def test_who_calls_the_question_off_cancels() -> None:
    bench = asked()
    answered(bench, "cancel")
    assert outcome(bench).outcome == "cancelled"


def test_a_question_with_the_words_of_a_stop_stops_nothing() -> None:
    bench = Bench(BrainConfig(pipeline="vla", enable_confirmation=False))
    bench.step()
    bench.command("bring me the red mug")
    for text in ("stop", "cancel", "yes"):
        bench.send(topics.VOICE_COMMAND, m.VoiceCommand(text=text, question=True))
    bench.step()
    assert bench.state.state == "PLANNING" and bench.state.last is None


def test_the_fetch_pipeline_takes_no_question_for_a_command() -> None:
    bench = asked("bring me the red mug", pipeline="fetch")
    bench.step(5)
    assert not bench.sent(topics.NAVIGATION_GOAL) and bench.state.command == ""
