"""When a silent process counts as hung."""

from cli.watchdog import FROZEN, STUCK, Pulse


def heard() -> Pulse:
    pulse = Pulse()
    pulse.hear("brain", 10, 0.0)
    return pulse


def test_a_process_that_shows_its_token_and_speaks_is_left_alone() -> None:
    assert heard().hangs("brain", 10, True, False, FROZEN + 1) == ""


def test_one_without_token_is_frozen_when_it_is_silent_too() -> None:
    pulse = heard()
    assert pulse.hangs("brain", 10, False, False, FROZEN - 0.1) == ""
    assert "frozen" in pulse.hangs("brain", 10, False, False, FROZEN)
    pulse.hear("brain", 10, FROZEN)
    assert pulse.hangs("brain", 10, False, False, FROZEN + 1) == ""


def test_a_loop_that_never_returns_is_stuck() -> None:
    assert "stuck" in heard().hangs("brain", 10, True, False, STUCK)


def test_a_successor_that_has_not_spoken_yet_is_starting() -> None:
    assert heard().hangs("brain", 11, False, False, 100.0) == ""


def test_one_stopped_by_a_signal_needs_no_heartbeat() -> None:
    pulse = Pulse()
    assert pulse.hangs("router", 5, True, True, 0.0) == ""
    assert "signal" in pulse.hangs("router", 5, True, True, FROZEN)
    assert pulse.hangs("router", 5, True, False, FROZEN + 0.1) == ""
    assert pulse.hangs("router", 5, True, True, FROZEN + 0.2) == ""
