"""Kinds by their looks: measures of real goods that are in no scene, and what they may be called."""

import pytest

from common.kinds import KINDS, LOOKS, laid_on_a_side
from common.naming.looks import LEAST, Measures, likely

GOODS = [
    ("bottle", Measures("round", 0.065, 0.235, neck=True), "green"),
    ("bottle", Measures("round", 0.031, 0.32, neck=True), "green"),
    ("mug", Measures("round", 0.082, 0.096, hollow=True, handle=True), "white"),
    ("can", Measures("round", 0.066, 0.122), "red"),
    ("can", Measures("round", 0.085, 0.058), "blue"),
    ("bowl", Measures("bowl", 0.15, 0.065, hollow=True), "white"),
    ("plate", Measures("bowl", 0.21, 0.022, hollow=True), "white"),
    ("ball", Measures("ball", 0.066, 0.066), "blue"),
    ("apple", Measures("ball", 0.078, 0.072), "red"),
    ("orange", Measures("ball", 0.08, 0.08), "orange"),
    ("book", Measures("box", 0.024, 0.198, 5.4), "blue"),
    ("carton", Measures("box", 0.07, 0.2, 1.0), "white"),
    ("block", Measures("box", 0.04, 0.04, 1.0), "green"),
    ("banana", Measures("irregular", 0.036, 0.18, 1.2), "yellow"),
    ("tool", Measures("long", 0.028, 0.2, 1.0), "red"),
]


@pytest.mark.parametrize(("kind", "measures", "colour"), GOODS, ids=[f"{g[0]}-{i}" for i, g in enumerate(GOODS)])
def test_what_a_thing_is_called_is_among_its_likely_kinds(kind: str, measures: Measures, colour: str) -> None:
    found = likely(LOOKS, measures, [colour])
    assert kind in found, f"taken for {found}"
    assert sum(found.values()) == pytest.approx(1.0)


def test_a_mug_whose_handle_and_inside_are_hidden_may_be_a_can_and_the_other_way_round_less() -> None:
    hidden = likely(LOOKS, Measures("round", 0.08, 0.095), ["red"])
    assert {"mug", "can"} <= set(hidden)
    shown = likely(LOOKS, Measures("round", 0.08, 0.095, hollow=True, handle=True), ["red"])
    assert next(iter(shown)) == "mug"
    assert "can" not in shown


def test_what_has_no_measures_of_any_kind_is_none() -> None:
    assert likely(LOOKS, Measures("box", 0.9, 1.8, 1.5), ["grey"]) == {}


def test_a_little_outside_its_range_a_kind_is_still_likely_and_far_outside_not() -> None:
    near, far = (KINDS["can"].look.likelihood(Measures("round", d, 0.12), ["red"]) for d in (0.11, 0.19))  # type: ignore[union-attr]
    assert near > LEAST
    assert far < LEAST / 5


@pytest.mark.parametrize(
    ("size", "lies"),
    [
        ((0.28, 0.19, 0.06), True),  # corn flakes on their back
        ((0.19, 0.07, 0.07), True),  # a milk carton
        ((0.12, 0.065, 0.085), False),  # tea bags
        ((0.10, 0.06, 0.15), False),
        ((0.085, 0.05, 0.03), False),  # a dessert to be mixed
        ((0.08, 0.04, 0.02), False),  # butter
    ],
)
def test_a_box_lies_on_its_largest_side_and_is_not_stood_on_its_narrow_end(
    size: tuple[float, float, float], lies: bool
) -> None:
    assert laid_on_a_side("box", size) is lies
