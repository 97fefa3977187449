"""The clock over real Zenoh: each participant is woken for its own ticks, and by `sim/clock` where it is alone."""

from collections import Counter

import zenoh

from common import messages as m
from common import topics
from common.bus import codec
from common.time.clock_transport import AckCollector, ClockPublisher, ClockSubscriber
from common.topic import Topic
from evaluation.site import Site, eventually

OWN = topics.SLOWER_CLOCKS[10]


def say(session: zenoh.Session, clock: Topic[m.SimClockTick], tick: int) -> None:
    session.put(clock.key, codec.encode(clock, m.SimClockTick(t=tick / 100, tick=tick)))


def hear(listener: ClockSubscriber, newest: bool = False) -> int:
    found = eventually(lambda: listener.next(0.1, newest), "a tick")
    return int(found.tick)


def wait_for_a_reader(session: zenoh.Session, clock: Topic[m.SimClockTick]) -> None:
    publisher = session.declare_publisher(clock.key)
    eventually(lambda: publisher.matching_status.matching, f"{clock.key} is read")
    publisher.undeclare()


def test_every_participant_hears_the_ticks_it_is_due_at_and_no_others(here: Site) -> None:
    with here.session() as sim, here.session() as robot:
        listeners = {period: ClockSubscriber(robot, period, Counter()) for period in (1, 2, 4, 5, 10, 100)}
        for clock in topics.CLOCKS:
            wait_for_a_reader(sim, clock)
        speaker = ClockPublisher(sim)
        for tick in range(1, 201):
            speaker.publish(m.SimClockTick(t=tick / 100, tick=tick), at_once=tick % 7 == 0 or tick == 200)
        for period, listener in listeners.items():
            heard = [hear(listener)]
            while heard[-1] < 200:
                if (tick := hear(listener)) != heard[-1]:  # the first may come on both clocks
                    heard.append(tick)
            assert sorted(set(heard)) == list(range(period, 201, period)), period


def test_the_common_clock_is_followed_until_ones_own_comes_and_again_when_it_stays_away(here: Site) -> None:
    drops: Counter[str] = Counter()
    with here.session() as sim, here.session() as robot:
        listener = ClockSubscriber(robot, 10, drops)
        for clock in (topics.SIM_CLOCK, OWN):
            wait_for_a_reader(sim, clock)
        for tick in (9, 10, 11):
            say(sim, topics.SIM_CLOCK, tick)
        assert hear(listener) == 10
        say(sim, OWN, 20)
        assert hear(listener) == 20
        say(sim, topics.SIM_CLOCK, 30)
        say(sim, OWN, 40)
        assert hear(listener) == 40, "nobody is woken by a clock it does not need"
        # Its own has fallen silent.
        assert eventually(lambda: say(sim, topics.SIM_CLOCK, 50) or listener.next(0.1, True), "a tick").tick == 50
        sim.put(OWN.key, b"\xff\xffnoise")
        say(sim, OWN, 60)
        eventually(lambda: hear(listener, newest=True) == 60, "its own clock again")
    assert drops == {OWN.key: 1}


def test_acknowledgements_come_in_order_and_noise_is_counted(here: Site) -> None:
    drops: Counter[str] = Counter()
    with here.session() as sim, here.session() as robot:
        acks = AckCollector(sim, drops)
        publisher = robot.declare_publisher(topics.LOCKSTEP_ACK.key)
        eventually(lambda: publisher.matching_status.matching, "acknowledgements are read")
        publisher.put(b"noise")
        for tick in (-1, 10, 20):
            ack = m.LockstepAck(name="brain", tick=tick, period=10)
            publisher.put(codec.encode(topics.LOCKSTEP_ACK, ack))
        got = [eventually(lambda: acks.next(0.1), "an acknowledgement") for _ in range(3)]
    assert got == [("brain", -1, 10), ("brain", 10, 10), ("brain", 20, 10)]
    assert drops == {topics.LOCKSTEP_ACK.key: 1}
    assert acks.next(0.0) is None
