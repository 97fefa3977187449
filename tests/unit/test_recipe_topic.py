"""docs/EXTENDING.md, "A new sensor topic": done in a copy, the sensor's samples reach the service that reads them."""

from pathlib import Path

from tests.recipes import Recipe

ASK = """
from common import interfaces, topics
from common.household import load_household
from common.security.access import Subject, grants
from services.navigation.config import NavigationConfig
from services.navigation.service import NavigationService
from tests.node import Node
from tests.simulation import Simulation

sim = Simulation()
navigation = Node(NavigationService, NavigationConfig(), load_household("minimal"), bus=sim.bus, lockstep=False)
for _ in range(20):
    sim.step()
navigation.step()
sample = sim.sent(topics.GYROSCOPE)[-1]
assert navigation.service.state.turning == sample.omega
assert "base/gyroscope" in grants(Subject("sim")).puts and "base/gyroscope" in grants(Subject("navigation")).reads
assert "base/gyroscope" not in grants(Subject("brain")).reads
assert "| `base/gyroscope` | Gyroscope | sim | navigation | 100 | latest |" in interfaces.render()
print(sample.t > 0.0)
"""


def test_the_recipe_for_a_sensor_topic(tmp_path: Path) -> None:
    recipe = Recipe("A new sensor topic", tmp_path)
    assert len(recipe.files) == len(set(recipe.files)) <= 4
    assert recipe.run("-c", ASK) == "True\n"
