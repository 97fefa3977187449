"""Parts of a sentence that ask for nothing are left out; those that limit the rest are not."""

import pytest

from evaluation.everyday.understanding import planned
from services.planner.grammar.asides import without_asides

IDLE = frozenset({"they are empties", "ta", "yes you", "not that one", "if you can", "only now", "no rush"})


@pytest.mark.parametrize(
    ("said", "left"),
    [
        ("bin the cans, they are empties", "bin the cans"),
        ("ta, bring me the can; yes you", "bring me the can"),
        ("bring me the can, not that one", "bring me the can, not that one"),
        ("bring me the can, if you can, ta", "bring me the can, if you can"),
        ("bring me the can, only now", "bring me the can, only now"),
        ("no rush, bring me the can", "bring me the can"),
        ("bring me the can", "bring me the can"),
        ("ta", "ta"),
        ("", ""),
    ],
)
def test_idle_parts_go_unless_they_limit_the_rest(said: str, left: str) -> None:
    assert without_asides(said, lambda words, _: " ".join(words) in IDLE) == left


@pytest.mark.parametrize("said", ["bring me the red mug, er, not", "bring me the red mug, no don't"])
def test_what_takes_a_request_back_is_no_aside(said: str) -> None:
    assert not planned(said).steps
