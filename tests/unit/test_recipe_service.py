"""docs/EXTENDING.md, "A new service": done in a copy, the service is a part of the robot like the others."""

from pathlib import Path

import pytest

from tests.recipes import Recipe

ASK = """
from math import isclose

from cli.processes.services import SERVICES
from common import messages as m
from common import topics
from common.household import load_household
from common.security.access import Subject, grants
from services.odometer import OdometerConfig, OdometerService
from tests.node import Node

node = Node(OdometerService, OdometerConfig(), load_household("minimal"), lockstep=False)
for x in (0.0, 0.3, 0.6):
    node.send(topics.ODOMETRY, m.Odometry(t=0.0, x=x, y=0.0, theta=0.0))
    node.step()
assert isclose(node.last(topics.ODOMETER).metres, 0.6)
own = grants(Subject("odometer"))
assert own.puts == ("odometer/distance", "sim/ack", "service/odometer/health", "log/odometer")
assert "base/odom" in own.reads and "scan" not in own.reads
print([s.module for s in SERVICES if s.name == "odometer"])
"""


@pytest.mark.slow
def test_the_recipe_for_a_service(tmp_path: Path) -> None:
    recipe = Recipe("A new service", tmp_path)
    assert len(recipe.files) == len(set(recipe.files)) <= 5
    assert recipe.run("-c", ASK) == "['services.odometer']\n"
    assert "odometer.report_every = 0.1" in recipe.run("-m", "services.odometer", "--help")
    (recipe.folder / "docs" / "INTERFACES.md").write_text(recipe.run("-m", "common.interfaces"), encoding="utf-8")
    containers = "tests/integration/test_compose_file.py::test_each_"
    names = ("node_is_a_container_with_a_healthcheck_and_comes_back", "container_sees_its_own_certificate_only")
    recipe.run(
        "-m",
        "pytest",
        "-q",
        "-p",
        "no:cacheprovider",
        "tests/contract/test_topics.py",
        *(containers + n for n in names),
    )
