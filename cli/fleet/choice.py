"""Choice of the robot for a command: the one expected to be done first, with reasons. Pure."""

import math
from collections.abc import Iterable, Mapping

import msgspec

from cli.fleet.robots import RobotNow
from common.language.normalise import normalise

SPEED = 0.35
"""How fast a robot gets along [m/s]; chosen: navigation's 0.5 with turns and stops."""
SEARCH = 60.0
"""What not knowing where the thing is costs [s]; chosen: a look from some viewpoints."""
FULL_HAND = 40.0
"""What something in the hand costs [s]; chosen: putting it down first."""
LOW, EMPTY = 0.3, 0.1
"""Charge from which on a robot is spared, and below which it gets nothing to do; chosen."""
SPARED = 240.0
"""What a nearly empty battery costs, in proportion to what is missing to `LOW` [s]; chosen: a robot with a full one
may be a flat's length further away."""


class Candidate(msgspec.Struct, frozen=True):
    """A robot with its expected time [s] for a command, infinite if it cannot take it, and `why` in words."""

    name: str
    cost: float
    why: str

    @property
    def able(self) -> bool:
        return math.isfinite(self.cost)


def things(text: str, labels: Iterable[str]) -> list[str]:
    """The known objects that a command may be about: those named in full, else those of a kind that is named."""
    words = f" {normalise(text)} "
    named = sorted({label for label in labels if f" {label.lower()} " in words}, key=len, reverse=True)
    if named:
        # "mug" within "red mug" is no second thing.
        return [n for n in named if not any(n != other and f" {n} " in f" {other} " for other in named)]
    return sorted({label for label in labels if f" {label.lower().split()[-1]} " in words})


def goals(text: str, robots: Iterable[RobotNow]) -> dict[str, dict[str, tuple[float, float]]]:
    """Positions of the objects of a command, as each robot knows them, by robot."""
    robots = list(robots)
    wanted = set(things(text, {label for r in robots for label in r.knows}))
    return {r.name: {label: at for label, at in r.knows.items() if label in wanted} for r in robots}


def rank(
    robots: Iterable[RobotNow],
    wanted: Mapping[str, Mapping[str, tuple[float, float]]],
    metres: Mapping[str, float | None],
) -> list[Candidate]:
    """The robots, the best first.

    `wanted`: as of `goals`. `metres`: by robot, the way to the nearest of them, by its own knowledge or, where it has
    none, by that of the others; None where no way leads there; absent where nobody knows.
    """
    asked_for = any(wanted.values())
    found = [_candidate(r, wanted.get(r.name, {}), metres, asked_for) for r in robots]
    return sorted(found, key=lambda c: (c.cost, c.name))


def _candidate(
    r: RobotNow, known: Mapping[str, object], metres: Mapping[str, float | None], asked_for: bool
) -> Candidate:
    if why := refusal(r):
        return Candidate(r.name, math.inf, why)
    cost, parts = 0.0, []
    if r.name in metres:
        way = metres[r.name]
        if way is None:
            return Candidate(r.name, math.inf, "no way leads there")
        cost += way / SPEED
        parts.append(f"{way:.1f} m away")
    if known:
        parts.append(f"knows the {' and the '.join(sorted(known)[:3])}")
    elif asked_for:
        cost += SEARCH
        parts.append("has to look for it")
    if r.holding:
        cost += FULL_HAND
        parts.append(f"holds the {r.holding}")
    if r.battery is not None:
        cost += SPARED * max(0.0, LOW - r.battery) / LOW
        parts.append(f"battery {100 * r.battery:.0f} %")
    return Candidate(r.name, cost, ", ".join(parts) or "free")


def refusal(r: RobotNow) -> str:
    """Why a robot cannot take any command now, "" when it can."""
    if not r.state:
        return "does not answer"
    if r.braked:
        return "is stopped"
    if r.battery is not None and r.battery < EMPTY:
        return f"battery {100 * r.battery:.0f} %"
    if r.free:
        return ""
    return f"is busy: {r.command}" if r.command else f"is not ready: {r.detail or r.state}"
