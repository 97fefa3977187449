"""Where a thing usually is, by what was seen over the days, and what a search makes of it."""

import numpy as np
import pytest

from common import messages as m
from common.household import load_household
from common.viewpoints import viewpoints_of
from common.whereabouts import HALF_LIFE, LEAST, STAYS, ago, decayed, likelihood, of_thing, shares

HOME = load_household("apartment")
DAY = 86400.0


def seen(thing: str, part: str, weight: float, last: float = 0.0, kind: str = "") -> m.Sighting:
    return m.Sighting(thing=thing, kind=kind, colour="", part=part, weight=weight, last=last)


def test_shares_of_all_surfaces_add_up_to_one() -> None:
    for sightings in ([], [seen("keys", "counter", 5.0)], [seen("keys", "gone table", 2.0)]):
        found = shares("keys", HOME, sightings, 0.0)
        assert sum(found.values()) == pytest.approx(1.0)
        assert set(found) == {r.name for r in HOME.receptacles if r.kind != "bin"}


def test_where_it_was_seen_often_is_likeliest() -> None:
    sightings = [seen("keys", "bookshelf", 6.0), seen("keys", "counter", 1.0)]
    found = shares("my keys", HOME, sightings, 3 * DAY)
    assert max(found, key=lambda name: found[name]) == "bookshelf"
    assert found["counter"] > shares("my keys", HOME, sightings[:1], 3 * DAY)["counter"]


def test_others_of_the_kind_tell_of_one_that_was_never_seen() -> None:
    without = shares("blue mug", HOME, [], 0.0)
    kin = shares("blue mug", HOME, [seen("red mug", "bookshelf", 8.0, kind="mug")], 0.0)
    assert kin["bookshelf"] > 2 * without["bookshelf"]
    can = shares("blue can", HOME, [seen("red mug", "bookshelf", 8.0, kind="mug")], 0.0)
    assert can["bookshelf"] == pytest.approx(shares("blue can", HOME, [], 0.0)["bookshelf"])


def test_rules_of_people_move_the_estimate_of_what_was_never_seen() -> None:
    rule = HOME.words.tidy[0]
    assert "mug" in rule.kinds
    assert shares("mug", HOME, [], 0.0)["counter"] > shares("thing", HOME, [], 0.0)["counter"]


def test_a_small_surface_is_likelier_than_by_its_area() -> None:
    large, small = (next(r for r in HOME.receptacles if r.name == name) for name in ("counter", "bedside table"))
    areas = [r.size[0] * r.size[1] for r in (large, small)]
    found = shares("thing", HOME, [], 0.0)
    assert found[large.name] / found[small.name] == pytest.approx((areas[0] / areas[1]) ** 0.5)


def test_old_visits_count_less_and_the_last_one_fades() -> None:
    assert decayed(seen("keys", "counter", 4.0), HALF_LIFE) == pytest.approx(2.0)
    sightings = [seen("keys", "bookshelf", 4.0, last=0.0), seen("keys", "counter", 1.0, last=DAY)]
    fresh, later = (shares("keys", HOME, sightings, DAY + wait)["counter"] for wait in (0.0, 5 * STAYS))
    assert fresh > later


def test_words_name_things_as_they_were_seen() -> None:
    sightings = [seen("red mug", "counter", 1.0, kind="mug"), seen("keys", "counter", 1.0)]
    assert [s.thing for s in of_thing("the mugs", sightings)] == ["red mug"]
    assert [s.thing for s in of_thing("my keys", sightings)] == ["keys"]
    assert of_thing("", sightings) == [] and of_thing("blue mug", sightings) == []


def test_a_search_goes_where_it_is_likely_and_leaves_nothing_out() -> None:
    views = viewpoints_of(HOME, None)
    likely = likelihood("keys", HOME, [seen("keys", "bookshelf", 9.0)], 0.0, views)
    surfaces = [r.name for r in HOME.receptacles if r.kind != "bin"]
    shelf = views.surface == surfaces.index("bookshelf")
    assert likely[shelf].min() > likely[~shelf].max() and likely.min() >= LEAST
    worth, at_once = np.ones(len(views.points)), lambda pose: 0.0
    best = views.best(worth, set(), at_once, lambda pose: True, likely)
    assert best is not None and views.visible(best)[shelf].any()
    # The last of what is new is looked at, however unlikely it is.
    rest = np.where(shelf, 0.0, 1.0)
    assert views.best(rest, set(), at_once, lambda pose: True, likely) is not None


@pytest.mark.parametrize(
    ("seconds", "said"),
    [(5, "just now"), (120, "2 minutes ago"), (3600, "1 hour ago"), (3 * DAY, "3 days ago"), (21 * DAY, "3 weeks ago")],
)
def test_ago(seconds: float, said: str) -> None:
    assert ago(seconds) == said
