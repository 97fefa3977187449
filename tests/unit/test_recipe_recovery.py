"""docs/EXTENDING.md, "A new recovery": done in a copy, it is tried in its turn, and what it finds is fetched."""

from pathlib import Path

from tests.recipes import Recipe

ASK = """
from common import topics
from tests.unit.test_brain_vla import POSE, QUERY, SPEECH, approach, planned, see

PLEASE = "say I do not see the red mug. Please put it where I can see it."
bench = planned()
see(bench, 1, found=False)
query = bench.next_goal(QUERY, 2)
print(bench.texts(SPEECH)[-1] == PLEASE, bench.count(POSE))
see(bench, 2)
goal = approach(bench, 1)
print(bench.manip(1).goal)

bench = planned()
see(bench, 1, found=False)
see(bench, 2, found=False)
turn = bench.next_goal(POSE, 1)
print(turn.object is None, bench.texts(SPEECH).count(PLEASE))
"""


def test_the_recipe_for_a_recovery(tmp_path: Path) -> None:
    recipe = Recipe("A new recovery", tmp_path)
    assert len(recipe.files) == len(set(recipe.files)) <= 2
    assert recipe.run("-c", ASK).splitlines() == ["True 0", "grab", "True 1"]
