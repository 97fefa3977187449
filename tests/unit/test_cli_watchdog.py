"""When a silent process counts as hung."""

import os

from cli.processes.watchdog import FROZEN, IDLE, STUCK, Pulse, look
from common.time.lockstep import HUNG


def heard() -> Pulse:
    """One that was heard at 0 s, at work for 3 s by then."""
    pulse = Pulse()
    pulse.hear("brain", 10, 0.0)
    assert pulse.hangs("brain", 10, True, False, 3.0, 0.0) == ""
    return pulse


def test_a_process_that_shows_its_token_and_speaks_is_left_alone() -> None:
    assert heard().hangs("brain", 10, True, False, 3.0, FROZEN + 1) == ""


def test_one_without_token_is_frozen_when_it_is_silent_and_idle_too() -> None:
    pulse = heard()
    assert pulse.hangs("brain", 10, False, False, 3.0, FROZEN - 0.1) == ""
    assert "frozen" in pulse.hangs("brain", 10, False, False, 3.0, FROZEN)
    pulse.hear("brain", 10, FROZEN)
    assert pulse.hangs("brain", 10, False, False, 3.0, FROZEN + 1) == ""


def test_one_that_hardly_gets_at_the_processor_is_not_frozen() -> None:
    pulse = heard()
    assert pulse.hangs("brain", 10, False, False, 3.01, FROZEN) == ""
    assert pulse.hangs("brain", 10, False, False, 3.01, FROZEN + IDLE - 0.1) == ""
    assert "frozen" in pulse.hangs("brain", 10, False, False, 3.01, FROZEN + IDLE)


def test_a_loop_that_never_returns_is_stuck() -> None:
    assert "stuck" in heard().hangs("brain", 10, True, False, STUCK, STUCK)


def test_a_successor_that_has_not_spoken_yet_is_starting() -> None:
    assert heard().hangs("brain", 11, False, False, 0.0, 100.0) == ""


def test_one_stopped_by_a_signal_needs_no_heartbeat() -> None:
    pulse = Pulse()
    assert pulse.hangs("router", 5, True, True, 1.0, 0.0) == ""
    assert "signal" in pulse.hangs("router", 5, True, True, 1.0, FROZEN)
    assert pulse.hangs("router", 5, True, False, 1.0, FROZEN + 0.1) == ""
    assert pulse.hangs("router", 5, True, True, 1.0, FROZEN + 0.2) == ""


def test_what_the_system_tells_of_a_process() -> None:
    stopped, worked = look(os.getpid())
    assert not stopped and worked > 0
    assert look(2**30) == (False, 0.0)


def test_lockstep_waits_for_who_is_slow_until_the_watchdog_has_ended_who_is_stuck() -> None:
    assert HUNG > STUCK + FROZEN
