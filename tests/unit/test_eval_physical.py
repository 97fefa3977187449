"""Physical faults in the simulation: each takes effect on a grasp, says so, and is over when it should be."""

import math
import re
from pathlib import Path

import pytest

from bench.grasp.hand import Bench
from common import messages as m
from common import topics
from common.scene import Obstacle, load_scene
from evaluation.faults.physical.fault import PhysicalFault
from evaluation.faults.physical.faults import targets, with_faults, with_physical_faults
from evaluation.faults.physical.unfit import InTheWay
from evaluation.faults.reports import FaultReport, FaultReportFile, ignore
from evaluation.suites.table import AMOUNT, FAULTS, GRASPED, faults
from judge.contacts import is_hit
from services.manipulation.config import ManipulationConfig
from services.sim.physics import Physics
from services.sim.service import SimService

SCENE = load_scene("apartment")


def bench_of(fault: PhysicalFault, told: list[FaultReport]) -> Bench:
    """The robot before the fault's object, one grasp to try."""
    spec = SCENE.object(fault.thing)
    assert spec is not None
    simulation = with_physical_faults(SimService, (fault,), told.append)
    bench = Bench(SCENE, spec, 0.6, 1, ManipulationConfig(max_candidates=1), simulation)
    placed = bench.sim.physics.placements[0]
    x, y, _ = placed.position
    surface = next(r for r in SCENE.receptacles if r.name == placed.on)
    ax, ay = max(surface.approach, key=lambda a: a[0] * (x - surface.center[0]) + a[1] * (y - surface.center[1]))
    half = surface.size[0] / 2 if ax else surface.size[1] / 2
    inset = half - (ax * (x - surface.center[0]) + ay * (y - surface.center[1]))
    far = max(0.6, inset + 0.36)
    bench.stand((x + far * ax, y + far * ay, math.atan2(-ay, -ax)))
    return bench


def drive_back(bench: Bench) -> None:
    """For a metre."""
    now = bench.world.clock.now
    for _ in range(200):
        bench.bus.send(topics.CMD_VEL, m.CmdVel(vx=-0.3, vy=0.0, omega=0.0))
        bench.world.advance()
    assert now() > 0


def test_a_shoved_object_is_not_between_the_fingers() -> None:
    told: list[FaultReport] = []
    bench = bench_of(PhysicalFault(kind="shove", thing="blue block"), told)
    before = bench.truth()["objects"]["blue block"]["position"]
    status = bench.run("grab", "b.1")
    assert (status.status, status.code, bench.truth()["holding"]) == ("failed", "EMPTY_GRASP", None)
    assert [s.fault for s in told] == ["shove"]
    thing = bench.truth()["objects"]["blue block"]
    assert math.dist(before[:2], thing["position"][:2]) > 0.03 and thing["on"]


@pytest.mark.parametrize(("seconds", "kept"), [(0.06, True), (1.5, False)])
def test_friction_that_goes_lets_it_slide_or_fall(seconds: float, kept: bool) -> None:
    told: list[FaultReport] = []
    bench = bench_of(PhysicalFault(kind="slip", thing="green bottle", after=0.1, seconds=seconds), told)
    assert bench.run("grab", "b.1").status == "done"
    pads = sorted(g for side in bench.sim.physics.pads for g in side)
    friction = bench.sim.physics.model.geom_friction[pads].copy()
    drive_back(bench)
    assert [s.fault for s in told] == ["slip"]
    assert (bench.truth()["holding"] == "green bottle") is kept
    assert (bench.sim.physics.model.geom_friction[pads] == friction).all(), "the pads are dry again"


@pytest.mark.slow
def test_a_jammed_finger_stays_and_comes_free() -> None:
    told: list[FaultReport] = []
    bench = bench_of(PhysicalFault(kind="jam", thing="blue block", seconds=3.0), told)
    status = bench.run("grab", "b.1")
    assert (status.status, status.code) == ("failed", "EMPTY_GRASP")
    assert [s.fault for s in told] == ["jam"]
    # The fingers go in nearly as wide open as they go.
    assert re.search(r"a finger stays: 8[0-5] mm open", told[0].what)
    assert bench.run("grab", "b.2").status == "done", "one more try, without the jam"


def test_what_is_too_heavy_is_left_where_it_stood() -> None:
    told: list[FaultReport] = []
    bench = bench_of(PhysicalFault(kind="heavy", thing="blue block", amount=8.0), told)
    before = bench.truth()["objects"]["blue block"]["position"]
    status = bench.run("grab", "b.1")
    assert (status.status, status.code, bench.truth()["holding"]) == ("failed", "TOO_HEAVY", None)
    assert math.dist(before, bench.truth()["objects"]["blue block"]["position"]) < 0.01
    assert not any(is_hit(touch) for touch in bench.sim.physics.contacts.touches)
    assert [s.fault for s in told] == ["heavy"] and told[0].what.startswith("8.0 kg")


def test_without_a_grasp_nothing_strikes() -> None:
    told: list[FaultReport] = []
    for kind in ("shove", "slip", "jam", "heavy", "wide"):
        bench = bench_of(PhysicalFault(kind=kind, thing="blue block", amount=0.1), told)
        bench.run("home", "b.1")
    assert not told
    assert bench.sim.physics.placements[0].spec.size[0] == 0.1, "wider than anybody was told"
    assert SCENE.object("blue block").size[0] == 0.05  # type: ignore[union-attr]


def test_only_services_with_faults_are_replaced() -> None:
    assert with_physical_faults(SimService, (), ignore) is SimService
    case = faults(FAULTS.index("jam"))
    assert targets(case) == {"sim"} and issubclass(with_faults(SimService, case, ignore), SimService)


def test_every_kind_of_fault_comes_with_the_seeds() -> None:
    for seed in range(50):
        case = faults(seed)
        assert case.fault == FAULTS[seed % len(FAULTS)] and case.faults >= 1
        assert (case.expect == "reported") == (case.fault in AMOUNT)
        spec = SCENE.object(case.thing)
        assert spec is not None and spec.kind in GRASPED.get(case.fault, (spec.kind,))


def test_reports_of_other_processes_are_read_as_they_come(tmp_path: Path) -> None:
    path = tmp_path / "strikes"
    reader, writer = FaultReportFile(path), FaultReportFile(path)
    assert reader.news() == []
    first, second = FaultReport(1.0, "drop", "scan"), FaultReport(2.5, "jam", "a finger stays")
    writer.report(first)
    assert reader.news() == [first]
    with path.open("ab") as file:
        file.write(b'{"t":2.5,"fault"')
    assert reader.news() == [], "half a record is none yet"
    with path.open("ab") as file:
        file.write(b':"jam","what":"a finger stays"}\n')
    assert (reader.news(), reader.news()) == ([second], [])


@pytest.mark.parametrize(("around", "struck"), [((2.5, -0.75), True), ((0.0, 2.0), False)])
def test_an_obstacle_on_the_shortest_path_was_in_the_way_of_who_went_round_it(
    around: tuple[float, float], struck: bool
) -> None:
    crate = Obstacle(name="crate", kind="box", size=(0.5, 0.9, 0.9), position=around)
    physics = Physics(SCENE, 0, (crate,))
    injector = InTheWay(PhysicalFault(kind="obstacle", thing="crate"), physics)
    told = []
    for x, y, speed in [(0.6, -0.75, 0.3), (4.6, -0.75, 0.3), *[(4.6, -0.75, 0.0)] * 40]:
        physics.data.qpos[:2], physics.data.qvel[:2] = (x, y), (speed, 0.0)
        told.append(injector.step(0.0, "NAVIGATING"))
    assert any("shortest path" in t for t in told) is struck


def test_a_robot_that_is_carried_stands_elsewhere_and_its_wheels_did_not_turn() -> None:
    told: list[FaultReport] = []
    fault = PhysicalFault(kind="kidnap", pose=(3.6, -1.2, 0.8))
    spec = SCENE.object("blue block")
    assert spec is not None
    bench = Bench(SCENE, spec, 0.6, 1, ManipulationConfig(), with_physical_faults(SimService, (fault,), told.append))
    for _ in range(20):
        bench.world.advance()
    assert bench.truth()["base"] == pytest.approx(fault.pose, abs=0.005)
    believed = bench.sim.sensors.odometry.believed
    home = SCENE.home
    assert believed == pytest.approx((home.x, home.y, home.theta), abs=0.01)
    assert [s.fault for s in told] == ["kidnap"] and "carried 3.8 m" in told[0].what
