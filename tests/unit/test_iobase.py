import threading

import pytest

from common import messages as m
from common import topics
from common.bus.mailbox import CAPACITY
from common.bus.memory import MemoryBus, MemoryIo
from tests.unit.test_lockstep import SCENE


def make(lockstep: bool = False) -> tuple[MemoryBus, MemoryIo]:
    bus = MemoryBus()
    reads = (topics.NAVIGATION_GOAL, topics.JOINT_STATES)
    io = MemoryIo(bus, "x", reads, (topics.NAVIGATION_STATUS,), household=SCENE, lockstep=lockstep)
    return bus, io


def joints(t: float) -> m.JointStates:
    return m.JointStates(t=t, name=["a"], position=[t], velocity=[0.0], effort=[0.0])


def test_take_all_returns_each_message_once_in_order() -> None:
    bus, io = make()
    for n in range(3):
        bus.send(topics.NAVIGATION_GOAL, m.NavigationGoal(goal=f"goto {n}"))
    assert io.take_all(topics.NAVIGATION_GOAL) == []
    io.begin(None, 1.0)
    assert [g.goal for g in io.take_all(topics.NAVIGATION_GOAL)] == ["goto 0", "goto 1", "goto 2"]
    assert io.take_all(topics.NAVIGATION_GOAL) == []


def test_streams_keep_only_the_newest_and_know_its_age() -> None:
    bus, io = make()
    assert io.age(topics.JOINT_STATES, 5.0) == float("inf")
    for t in (1.0, 2.0):
        bus.send(topics.JOINT_STATES, joints(t))
    io.begin(None, 5.0)
    newest = io.latest(topics.JOINT_STATES)
    assert newest is not None and newest.t == 2.0
    assert io.age(topics.JOINT_STATES, 5.5) == 0.5
    assert [j.t for j in io.take_all(topics.JOINT_STATES)] == [2.0]


def test_bad_payloads_are_counted_and_leave_the_last_good_value() -> None:
    bus, io = make()
    bus.send(topics.JOINT_STATES, joints(1.0))
    io.begin(None, 0.0)
    io.latest(topics.JOINT_STATES)
    bus.put(topics.JOINT_STATES, b"\xff\xff")
    bus.put(topics.NAVIGATION_GOAL, b"\xff")
    bus.put(topics.NAVIGATION_GOAL, b"stop")
    io.begin(None, 0.1)
    newest = io.latest(topics.JOINT_STATES)
    assert newest is not None and newest.t == 1.0
    assert [g.goal for g in io.take_all(topics.NAVIGATION_GOAL)] == ["stop"]
    assert io.drops == {"joint_states": 1, "brain/navigation_goal": 1}


def test_a_bad_payload_neither_repeats_the_last_good_one_nor_keeps_it_fresh() -> None:
    bus, io = make()
    bus.send(topics.JOINT_STATES, joints(1.0))
    io.begin(None, 1.0)
    assert len(io.take_all(topics.JOINT_STATES)) == 1
    for asked_first in (False, True):
        bus.put(topics.JOINT_STATES, b"\xff\xff")
        io.begin(None, 2.0)
        if asked_first:
            io.latest(topics.JOINT_STATES)
        assert io.take_all(topics.JOINT_STATES) == []
        assert io.age(topics.JOINT_STATES, 2.0) == 1.0
        newest = io.latest(topics.JOINT_STATES)
        assert newest is not None and newest.t == 1.0
    bus.send(topics.JOINT_STATES, joints(3.0))
    io.begin(None, 3.0)
    assert [j.t for j in io.take_all(topics.JOINT_STATES)] == [3.0]
    assert io.age(topics.JOINT_STATES, 3.0) == 0.0


def test_an_overfull_queue_drops_the_oldest_and_says_so() -> None:
    bus, io = make()
    for n in range(CAPACITY + 5):
        bus.send(topics.NAVIGATION_GOAL, m.NavigationGoal(goal=f"goto {n}"))
    io.begin(None, 0.0)
    goals = io.take_all(topics.NAVIGATION_GOAL)
    assert len(goals) == CAPACITY and goals[-1].goal == f"goto {CAPACITY + 4}"
    assert io.drops["brain/navigation_goal"] == 5


def test_publishing_what_is_not_declared_is_a_programming_error() -> None:
    _, io = make()
    with pytest.raises(ValueError, match="WRITES"):
        io.publish(topics.BRAIN_STATE, m.BrainState(state="IDLE"))


def test_work_becomes_visible_at_its_modelled_time_in_lockstep() -> None:
    _, io = make(lockstep=True)
    job = io.submit(lambda a, b: a + b, 2, 3, seconds=0.2)
    assert not job.poll(0.19)
    assert job.poll(0.2)
    assert job.result() == 5


def test_what_work_raises_is_raised_by_result() -> None:
    _, io = make(lockstep=True)
    job = io.submit(int, "x", seconds=0.0)
    assert job.poll(0.0)
    with pytest.raises(ValueError, match="invalid literal"):
        job.result()


def test_ids_repeat_for_a_seed_in_lockstep_and_never_otherwise() -> None:
    assert make(True)[1].new_id("g") == make(True)[1].new_id("g")
    assert make(False)[1].new_id("g") != make(False)[1].new_id("g")


def test_goal_ids_name_the_mission_in_the_log() -> None:
    bus, io = make()
    bus.send(topics.NAVIGATION_GOAL, m.NavigationGoal(goal="stop", id="m-7.3"))
    io.begin(None, 0.0)
    io.take_all(topics.NAVIGATION_GOAL)
    assert io.log.mission == "m-7"


def test_what_is_disposed_of_runs_behind_the_work_and_is_waited_for() -> None:
    _, io = make()
    done: list[str] = []
    gate = threading.Event()
    io.dispose(lambda: done.append("nothing was ever made"))
    assert done == []
    io.submit(lambda: (gate.wait(10), done.append("work")))
    threading.Timer(0.05, gate.set).start()
    io.dispose(lambda: done.append("freed"))
    io.shutdown()
    assert done == ["work", "freed"]
