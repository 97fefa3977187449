"""What bench.restarts calls a leak."""

import msgspec

from bench.restarts import HANDLES, MEGABYTES, Count, leaks

BEFORE = Count(
    processes=12, listening=3, connections=18, tokens=["brain", "sim"],
    handles={"router": 20, "speech": 30}, memory={"router": 50.0, "speech": 200.0},
)  # fmt: skip


def after(**changes: object) -> Count:
    return msgspec.structs.replace(BEFORE, **changes)


def test_the_same_is_no_leak_nor_is_a_little() -> None:
    assert leaks(BEFORE, BEFORE, ("speech",)) == []
    assert leaks(BEFORE, after(handles={"router": 20 + HANDLES, "speech": 99}), ("speech",)) == []


def test_each_kind_of_leak_is_named() -> None:
    assert leaks(BEFORE, after(processes=13, strays=1), ("speech",)) == ["processes: 12 -> 13", "strays: 0 -> 1"]
    assert leaks(BEFORE, after(half_closed=2), ("speech",)) == ["half_closed: 0 -> 2"]
    assert "tokens" in leaks(BEFORE, after(tokens=["brain"]), ("speech",))[0]
    assert "router" in leaks(BEFORE, after(handles={"router": 21 + HANDLES}), ("speech",))[0]
    assert "MB" in leaks(BEFORE, after(memory={"router": 60.5 + MEGABYTES, "speech": 900.0}), ("speech",))[0]
