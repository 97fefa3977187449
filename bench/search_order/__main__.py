"""Where a search looks first: time to find, against chance and the optimal tour. `python -m bench.search_order`.

Homes of the generator, mapped exactly. Every thing has habits there: on most days it is on one of a few surfaces of its
own, on the others anywhere; on half of the days the robot comes by and sees it. After the days it is somewhere by the
same habits, the robot starts at home, knows nothing of today, and looks from viewpoint to viewpoint with the code of
navigation and of the estimate. Driving takes the path's cost at the usual speed, a look its time; the first view that
shows the thing's place finds it. No simulation and no perception: this is about the order alone.

chance      viewpoints that show something new, in random order
nearest     the most that is new for the way there; nothing known of the thing
by kind     with where things of the kind belong and how much room there is
by history  with what was seen on the days before
tour        the best order of the views that matter most, by dynamic programming, for one who knows the habits exactly
"""

import argparse
import math
import sys
from collections.abc import Callable, Sequence

import numpy as np
from numpy.typing import NDArray

from bench.search_order.homes import CONFIG, THINGS, Place, habits, homes, watched
from common.geometry import Array, Pose2
from common.viewpoints import LEAST_GAIN
from common.whereabouts import likelihood
from services.navigation.ended import Ended
from services.navigation.search.coverage import SearchCoverage
from services.navigation.search.search import Search

TOUR = 11
"""Views of the optimal tour that are put in order exactly: 2**11 subsets."""


# --- ways of searching
def searched(place: Place, home: Pose2, point: int, likely: Array | None) -> float:
    """Time [s] until the search of navigation shows a point; inf when it never does."""
    coverage = SearchCoverage(place.viewpoints)
    search, pose, now = Search("thing", coverage, CONFIG, 0.0, likely), home, 0.0
    shown = place.viewpoints.visible(home)
    while not shown[point]:
        coverage.look(pose, now, 0.0)
        try:
            view = search.next(pose, place.planner, place.costmap)
        except Ended:
            return math.inf
        now += float(place.seconds(pose, [view])[0])
        pose, shown = view, place.viewpoints.visible(view)
    return now


def by_chance(place: Place, home: Pose2, point: int, rng: np.random.Generator) -> float:
    """Search from one random viewpoint that shows something new to the next; returns as `searched`."""
    views, unseen = place.viewpoints, ~place.viewpoints.visible(home)
    pose, now = home, 0.0
    able = _free(place)
    while unseen[point]:
        news = views.shows @ unseen.astype(float)
        cost = place.seconds(pose, views.poses)
        able &= np.isfinite(cost)
        choice = np.flatnonzero((news >= LEAST_GAIN) & able)
        if not len(choice):
            return math.inf
        n = int(rng.choice(choice))
        now, pose = now + float(cost[n]), views.poses[n]
        unseen &= ~views.shows[n]
    return now


def _free(place: Place) -> NDArray[np.bool_]:
    radius = CONFIG.footprint_radius + CONFIG.clearance
    return np.array([place.costmap.clearance(p[0], p[1]) >= radius for p in place.viewpoints.poses])


def tour(place: Place, home: Pose2, mass: Array) -> Callable[[int], float]:
    """The tour of least expected time for a thing that is at each point with probability `mass` (p,), as the time at
    which it shows a point.

    The views are a greedy cover by mass; the order of the first TOUR of them is exact (Held and Karp's recursion with
    the mass that is still unseen as the weight of each leg), the others follow by mass.
    """
    views, able = place.viewpoints, _free(place)
    able &= np.isfinite(place.seconds(home, views.poses))
    unseen = ~views.visible(home)
    chosen: list[int] = []
    while True:
        gains = np.where(able, views.shows @ (mass * unseen), 0.0)
        n = int(np.argmax(gains))
        if gains[n] <= 1e-9:
            break
        chosen.append(n)
        unseen &= ~views.shows[n]
    first, rest = chosen[:TOUR], chosen[TOUR:]
    order = [*_ordered(place, home, mass, first), *rest]
    now, pose, at = 0.0, home, np.where(views.visible(home), 0.0, math.inf)
    for n in order:
        now += float(place.seconds(pose, [views.poses[n]])[0])
        pose = views.poses[n]
        at[views.shows[n] & np.isinf(at)] = now
    return lambda point: float(at[point])


def _ordered(place: Place, home: Pose2, mass: Array, chosen: list[int]) -> list[int]:
    """The order of views in which the expected time to find is least."""
    count = len(chosen)
    poses = [place.viewpoints.poses[n] for n in chosen]
    start = place.seconds(home, poses)
    between = np.array([place.seconds(p, poses) for p in poses]).reshape(count, count)
    shows = place.viewpoints.shows[chosen]
    at_home = place.viewpoints.visible(home)
    left = np.empty(1 << count)
    for s in range(1 << count):
        shown = shows[[v for v in range(count) if s >> v & 1]].any(axis=0)
        left[s] = mass[~(at_home | shown)].sum()
    best = np.full((1 << count, count), math.inf)
    before = np.full((1 << count, count), -1)
    for v in range(count):
        best[1 << v, v] = left[0] * start[v]
    for s in range(1, 1 << count):
        for v in range(count):
            if not s >> v & 1 or not math.isfinite(best[s, v]):
                continue
            for w in range(count):
                if s >> w & 1:
                    continue
                cost = best[s, v] + left[s] * between[v, w]
                if cost < best[s | 1 << w, w]:
                    best[s | 1 << w, w], before[s | 1 << w, w] = cost, v
    s, order = (1 << count) - 1, list[int]()
    v = int(np.argmin(best[s])) if count else -1
    while v >= 0:
        order.append(v)
        s, v = s & ~(1 << v), int(before[s, v])
    return [chosen[v] for v in reversed(order)]


# --- the table
def times(place: Place, days: int, rng: np.random.Generator) -> dict[str, list[float]]:
    """Times [s] by way of searching, one for each thing."""
    home = place.household.home
    start = (home.x, home.y, home.theta)
    views = place.viewpoints
    things = {name: (kind, habits(place, kind, rng)) for name, kind in THINGS}
    seen = watched(place, things, days, rng)
    found: dict[str, list[float]] = {}
    for name, (_, shares) in things.items():
        sizes = np.bincount(views.surface, minlength=len(shares))
        mass = shares[views.surface] / sizes[views.surface]
        reach = views.shows[_free(place) & np.isfinite(place.seconds(start, views.poses))].any(axis=0)
        mass = mass * (reach | views.visible(start))
        if mass.sum() <= 0:
            continue
        mass /= mass.sum()
        point = int(rng.choice(len(mass), p=mass))
        by_kind = likelihood(name, place.household, [], seen.t, views)
        by_history = likelihood(name, place.household, seen.sightings, seen.t, views)
        row = {
            "chance": by_chance(place, start, point, rng),
            "nearest": searched(place, start, point, None),
            "by kind": searched(place, start, point, by_kind),
            "by history": searched(place, start, point, by_history),
            "tour": tour(place, start, mass)(point),
        }
        if all(map(math.isfinite, row.values())):
            for way, seconds in row.items():
                found.setdefault(way, []).append(seconds)
        else:
            found.setdefault("never", []).append(float(math.isinf(row["by history"])))
    return found


def interval(per_home: Sequence[Sequence[float]], rng: np.random.Generator) -> tuple[float, float, float]:
    """Mean of all, and its 95 % interval by a bootstrap over homes (Efron and Tibshirani, 1993)."""
    sums, counts = np.array([sum(h) for h in per_home]), np.array([len(h) for h in per_home])
    drawn = rng.integers(len(sums), size=(2000, len(sums)))
    means = sums[drawn].sum(axis=1) / np.maximum(1, counts[drawn].sum(axis=1))
    low, high = np.percentile(means, (2.5, 97.5))
    return float(sums.sum() / counts.sum()), float(low), float(high)


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--homes", type=int, default=20)
    parser.add_argument("--days", type=int, default=14, help="days on which the robot has come by before")
    parser.add_argument("--seed", type=int, default=12600)
    args = parser.parse_args()
    rows = [times(place, args.days, np.random.default_rng([seed, 4])) for seed, place in homes(args.homes, args.seed)]
    rng = np.random.default_rng(0)
    ways = [way for way in rows[0] if way != "never"]
    count = sum(len(row.get("tour", ())) for row in rows)
    print(f"{count} searches in {len(rows)} homes after {args.days} days; time to find [s]")
    print(f"{'':12} {'mean':>6}  {'95 %':>14}  {'median':>6}  {'of chance':>9}")
    chance = interval([row.get("chance", []) for row in rows], rng)[0]
    for way in ways:
        mean, low, high = interval([row.get(way, []) for row in rows], rng)
        median = float(np.median([t for row in rows for t in row.get(way, [])]))
        print(f"{way:12} {mean:6.1f}  {low:6.1f} to {high:5.1f}  {median:6.1f}  {mean / chance:9.0%}")
    for way, other in (("by history", "nearest"), ("by history", "tour"), ("by kind", "nearest")):
        less = [[b - a for a, b in zip(row.get(way, []), row.get(other, []), strict=True)] for row in rows]
        mean, low, high = interval(less, rng)
        print(f"{way} finds {mean:.1f} s ({low:.1f} to {high:.1f}) sooner than {other}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
