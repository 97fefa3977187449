"""Commands offered to one of several robots: taken up once, by a free robot, and not after they were withdrawn."""

from common import messages as m
from common import topics
from services.brain.config import BrainConfig
from tests.unit.brain_bench import Bench
from tests.unit.test_brain_vla import PLAN, planned

MUG = "bring me the red mug"


def waiting() -> Bench:
    bench = Bench(BrainConfig(pipeline="vla"))
    bench.until(lambda: bench.state.state in ("WAITING", "LISTENING"))
    return bench


def offer(bench: Bench, name: str, text: str = MUG) -> None:
    command = m.VoiceCommand(text=text, id=name, confirmed=True, unless_busy=True)
    bench.send(topics.VOICE_COMMAND, command)
    bench.step()


def withdraw(bench: Bench, name: str) -> None:
    bench.command("", withdraws=name)


def test_a_free_robot_takes_it_and_says_which_it_was() -> None:
    bench = waiting()
    offer(bench, "fleet-1")
    bench.until(lambda: bench.state.command_id == "fleet-1")
    assert bench.state.command == MUG and bench.count(PLAN) == 1


def test_twice_offered_is_carried_out_once() -> None:
    bench = waiting()
    offer(bench, "fleet-1")
    bench.until(lambda: bench.state.command_id == "fleet-1")
    mission = bench.state.mission_id
    offer(bench, "fleet-1")
    withdraw(bench, "fleet-1")
    assert bench.state.last is not None and bench.state.last.command_id == "fleet-1"
    offer(bench, "fleet-1")
    bench.step(5.0)
    assert bench.state.last.id == mission and not bench.state.command_id


def test_a_busy_robot_neither_takes_nor_queues_it() -> None:
    bench = planned()
    before = bench.state.mission_id
    offer(bench, "fleet-1", "bring me the apple")
    offer(bench, "fleet-2", "no, bring me the apple instead")
    assert bench.state.mission_id == before and bench.state.command_id == ""
    assert not bench.brain.context.mission.queued


def test_a_withdrawal_ends_that_mission_and_no_other() -> None:
    bench = planned()
    before = bench.state.mission_id
    withdraw(bench, "fleet-1")
    assert bench.state.mission_id == before and bench.brain.context.mission.active
    bench = waiting()
    offer(bench, "fleet-1")
    bench.until(lambda: bench.state.command_id == "fleet-1")
    withdraw(bench, "fleet-1")
    last = bench.state.last
    assert last is not None and last.outcome == "cancelled" and "another robot" in last.reason


def test_what_was_withdrawn_before_it_came_is_not_heard() -> None:
    bench = waiting()
    withdraw(bench, "fleet-1")
    offer(bench, "fleet-1")
    bench.step(3.0)
    assert bench.count(PLAN) == 0 and not bench.state.command


def test_of_two_offers_at_once_the_first_counts() -> None:
    bench = waiting()
    for name, text in (("fleet-1", MUG), ("fleet-2", "bring me the apple")):
        bench.send(topics.VOICE_COMMAND, m.VoiceCommand(text=text, id=name, confirmed=True, unless_busy=True))
    bench.until(lambda: bench.state.command_id)
    assert bench.state.command_id == "fleet-1" and not bench.brain.context.mission.queued
