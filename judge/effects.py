"""What a command should bring about beside objects delivered: places reached, answers that are true, a thing in hand.

Pure: samples of the world and sentences of the robot in, effects shown or not out. No claim of the robot enters.
"""

import math
import re
from typing import Literal

import msgspec

from common.kinds import kind_of
from common.scene import Scene
from judge.evidence import Sample
from judge.track import MOVED, TOPPLED, ThingState
from judge.words import plain

Kind = Literal[
    "visits", "ends", "says", "tells where", "tells what is on", "tells what it sees", "holds", "beside", "rests",
    "hand", "still", "stands", "left alone", "remains",
]  # fmt: skip
AT_PLACE = 0.5
"""Distance [m] from a named standing pose that counts as there: half the diagonal of the base, 0.57 x 0.53 m, more."""
AT_FURNITURE = 1.0
"""Distance [m] from the edge of a surface that counts as at it: the reach of the arm."""
STOOD, STOOD_FOR = 0.02, 0.5
"""Drift [m] over a time [s] that counts as standing; a base that drives through covers 0.1 m and more."""
BESIDE = 0.40
"""Distance [m] between the middles of two things that people call next to each other on a table of 1.2 m."""
DRIVEN = 0.3
"""Path [m] of the base in a command that should not move it; a turn on the spot to look around is allowed."""
HAND_OPEN, HAND_CLOSED = 0.075, 0.015
"""Gap between the pads [m]: the hand's full opening is 0.085, closed on nothing 0."""


class Effect(msgspec.Struct, frozen=True):
    """One thing to be seen in physics or heard. `what` is a place, a thing, a surface or words; `other` an anchor."""

    kind: Kind
    what: str = ""
    other: str = ""

    def __str__(self) -> str:
        return " ".join(w for w in (self.kind, self.what, self.other) if w)


class Shown(msgspec.Struct):
    """Whether an effect was shown; `why` it was not."""

    effect: str
    shown: bool
    why: str = ""


class Watcher:
    """Decides which effects were shown, from samples of the world and sentences of the robot in the order of time."""

    def __init__(self, scene: Scene) -> None:
        self._scene = scene
        self._first: Sample | None = None
        self._last: Sample | None = None
        self._rest: Sample | None = None
        self._stood: list[tuple[float, float]] = []
        self._driven = 0.0
        self._said: list[tuple[str, Sample | None]] = []
        self.lifted: set[str] = set()

    def add(self, sample: Sample) -> None:
        """Take the next sample of the world."""
        self._first = self._first or sample
        self._driven += math.dist(sample.base[:2], self._last.base[:2]) if self._last else 0.0
        if self._rest is None or math.dist(sample.base[:2], self._rest.base[:2]) > STOOD:
            self._rest = sample
        elif sample.t - self._rest.t >= STOOD_FOR:
            here = self._rest.base[:2]
            if not self._stood or math.dist(here, self._stood[-1]) > STOOD:
                self._stood.append(here)
        self.lifted |= {name for name, thing in sample.things.items() if thing.held}
        self._last = sample

    def hear(self, sentence: str) -> None:
        """Take a sentence that the robot says now; what it says of the world is held against the newest sample."""
        self._said.append((plain(sentence), self._last))

    def conclude(self, effects: tuple[Effect, ...]) -> list[Shown]:
        """For each effect whether it has been shown until now."""
        return [Shown(str(e), not (why := self._objection(e)), why) for e in effects]

    def _objection(self, effect: Effect) -> str:
        first, last = self._first, self._last
        if first is None or last is None:
            return "the simulation showed nothing"
        match effect.kind:
            case "visits":
                there = any(at(self._scene, effect.what, *spot) for spot in self._stood)
                return "" if there else f"never stood at the {effect.what}"
            case "ends":
                standing = self._rest is not None and last.t - self._rest.t >= STOOD_FOR
                if standing and at(self._scene, effect.what, *last.base[:2]):
                    return ""
                return f"ended at ({last.base[0]:.1f}, {last.base[1]:.1f}), not at the {effect.what}"
            case "holds":
                held = [n for n, thing in last.things.items() if thing.held]
                return (
                    "" if held == [effect.what] else f"holds {' and '.join(held) or 'nothing'}, not the {effect.what}"
                )
            case "rests":
                now = last.things[effect.what]
                return "" if now.on not in ("", "floor") and not now.touched else f"the {effect.what} is not put down"
            case "remains":
                spec = self._scene.object(effect.what)
                return _away(last.things[effect.what], spec.kind if spec else "", effect.what, effect.other)
            case "beside":
                return self._apart(last, effect.what, effect.other)
            case "hand":
                wide = last.opening
                good = wide >= HAND_OPEN if effect.what == "open" else wide <= HAND_CLOSED
                return "" if good else f"the hand is {1000 * wide:.0f} mm open, not {effect.what}"
            case "stands":
                standing = self._rest is not None and last.t - self._rest.t >= STOOD_FOR
                return "" if standing else "the base still drives"
            case "left alone":
                moved = math.dist(last.things[effect.what].position, first.things[effect.what].position)
                return "" if moved <= MOVED else f"moved the {effect.what} by {moved:.2f} m"
            case "still":
                return self._motion(first, last)
            case _:
                return self._spoken(effect)

    def _apart(self, last: Sample, name: str, anchor: str) -> str:
        one, two = last.things[name], last.things[anchor]
        apart = math.dist(one.position[:2], two.position[:2])
        if one.on != two.on:
            return f"the {name} is on {one.on or 'nothing'}, the {anchor} on {two.on or 'nothing'}"
        return "" if apart <= BESIDE else f"the {name} stands {apart:.2f} m from the {anchor}"

    def _motion(self, first: Sample, last: Sample) -> str:
        for name, now in last.things.items():
            if math.dist(now.position, first.things[name].position) > MOVED:
                return f"moved the {name}"
        return "" if self._driven <= DRIVEN else f"drove {self._driven:.1f} m"

    # --- words
    def _spoken(self, effect: Effect) -> str:
        reasons = [self._untrue(effect, words, sample) for words, sample in self._said]
        if "" in reasons:
            return ""
        told = [r for r in reasons if r is not None]
        return (
            told[-1]
            if told
            else f"never said {effect.what or 'what it sees'}"
            if effect.kind == "says"
            else (f"no answer: {effect}")
        )

    def _untrue(self, effect: Effect, words: str, sample: Sample | None) -> str | None:
        """Why the sentence is untrue, "" when it answers truly, None when it is about other things."""
        if effect.kind == "says":
            return "" if plain(effect.what) in words else None
        # A question of the robot's and its report at the end are no answers.
        if sample is None or words.startswith(("did you say", "do you mean")):
            return None
        found = mentions(words, self._scene)
        things = [n for what, n in found if what == "thing"]
        surfaces = [n for what, n in found if what == "surface"]
        match effect.kind:
            case "tells where":
                if effect.what not in things:
                    return None
                really = sample.things[effect.what].on
                good = set(surfaces) == {really}
                return "" if good else f"said {words!r}, it is on the {really or 'hand'}"
            case "tells what is on":
                if effect.what not in surfaces:
                    return None
                there = {n for n, thing in sample.things.items() if thing.on == effect.what}
                return (
                    "" if set(things) == there else f"said {words!r}, there is {', '.join(sorted(there)) or 'nothing'}"
                )
            case _:
                if not things or not surfaces:
                    return "" if "seen nothing" in words or "see nothing" in words else None
                for number, (what, name) in enumerate(found):
                    where = next((n for w, n in found[number:] if w == "surface"), "")
                    if what == "thing" and sample.things[name].on != where:
                        return f"said the {name} is on the {where}, it is on the {sample.things[name].on}"
                return ""


def _away(now: ThingState, kind: str, name: str, surface: str) -> str:
    """Why an object is not on its surface, let go and, if its kind has an upright, standing; "" if it is."""
    if now.held:
        return f"the {name} is in the hand"
    if now.on != surface:
        return f"the {name} is on {now.on or 'nothing'}, not on the {surface}"
    return f"the {name} went over" if kind_of(kind).upright and now.tilt > TOPPLED else ""


def at(scene: Scene, name: str, x: float, y: float) -> bool:
    """True when the point is at the place, in the room or before the surface of that name or alias."""
    places = [p for p in (scene.home, *scene.places) if name == p.name or name in p.aliases]
    if any(math.hypot(p.x - x, p.y - y) <= AT_PLACE for p in places):
        return True
    room = scene.room_at(x, y)
    if room is not None and (name == room.name or name in room.aliases):
        return True
    receptacle = scene.receptacle(name)
    return receptacle is not None and receptacle.outline.distance(x, y) <= AT_FURNITURE


def mentions(words: str, scene: Scene) -> list[tuple[str, str]]:
    """(`thing` or `surface`, name) in the order in which a plain sentence names them."""
    names = {plain(o.name): ("thing", o.name) for o in scene.objects}
    names |= {plain(r.name): ("surface", r.name) for r in scene.receptacles}
    alternatives = "|".join(re.escape(n) for n in sorted(names, reverse=True))
    return [names[found[0]] for found in re.finditer(rf"\b(?:{alternatives})\b", words)]
