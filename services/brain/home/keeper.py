"""Keeps what people tell of their home: names of its parts and where things belong."""

from typing import Literal

import msgspec

from common import messages as m
from common import topics
from common.bus.port import Io
from common.files.stored_file import StoredFile, home_file
from common.floor_plan import Receptacle, Room
from common.geometry import Pose2
from common.goal_inbox import GoalInbox
from common.household import Household
from common.naming.names import normalise
from services.brain.home.part_meant import Meant, meant, room_around

MAX_NAMES, MAX_RULES = 200, 100
"""Names and rules that are kept. Chosen: more than a home needs; each is spoken, drawn and compared."""
LONGEST = 40
"""Characters of a name."""


class Refused(Exception):
    """Why something is not kept: a code, and a clause for people."""

    def __init__(self, code: m.EditCode, detail: str) -> None:
        super().__init__(detail)
        self.code, self.detail = code, detail


class HouseholdKeeper:
    """Applies edits, keeps them on disk before it says so, and tells everybody. `pose` is where the robot stands."""

    def __init__(self, io: Io) -> None:
        self._io, self.pose = io, (0.0, 0.0, 0.0)
        path = home_file(io.state_dir, "household", io.loaded.name)
        self._file = StoredFile(
            path, m.HouseholdEdits, lambda why: io.log.warning("household", reason=why), folder=True
        )
        self.edits = self._file.load() or m.HouseholdEdits()
        self._inbox: GoalInbox[m.HouseholdEdit, m.EditResult] = GoalInbox(
            io, (topics.HOUSEHOLD_EDIT,), self._take, self._repeat
        )
        self._tell()

    def step(self, pose: Pose2) -> None:
        """Take what clients ask for; `pose` of the robot in the map."""
        self.pose = pose
        self._inbox.receive()

    def apply(self, edit: m.HouseholdEdit) -> m.EditResult:
        """Carry out an edit; when it says ok, it is on disk."""
        name = normalise(edit.name)
        try:
            edits, result = self._changed(msgspec.structs.replace(edit, name=name))
            if not self._file.save(edits):
                raise Refused("NOT_KEPT", "my disk does not take it")
        except Refused as refused:
            return m.EditResult(goal_id=edit.id, ok=False, name=name, code=refused.code, detail=refused.detail)
        self.edits = edits
        self._tell()
        self._io.log.info("household", do=edit.do, name=result.name, part=result.part)
        result.goal_id = edit.id
        return result

    # --- what changes
    def _changed(self, edit: m.HouseholdEdit) -> tuple[m.HouseholdEdits, m.EditResult]:
        match edit.do:
            case "name":
                return self._named(edit)
            case "forget":
                return self._forgotten(edit.name)
            case "rule":
                return self._ruled(edit.rule)
            case "forget rule":
                return self._unruled(edit.name)

    def _named(self, edit: m.HouseholdEdit) -> tuple[m.HouseholdEdits, m.EditResult]:
        name, home = edit.name, self._io.household
        if not name or len(name) > LONGEST:
            raise Refused("NO_NAME", "that is no name" if not name else "that name is too long")
        before = self._place_called(normalise(edit.part))
        found = Meant("place") if before is not None else meant(edit, home, self.pose)
        if found.kind is None:
            raise Refused(found.code or "NO_PART", found.detail)
        self._free(name, found)
        given = msgspec.structs.replace(before, name=name) if before is not None else self._name_of(found, name, edit)
        called = found.surface or found.room
        others = [n for n in self.edits.names if n.name != name and n is not before and not _same_part(n, given)]
        if len(others) >= MAX_NAMES:
            raise Refused("TOO_MANY", f"there are {MAX_NAMES} names already")
        edits = m.HouseholdEdits(names=[*others, given], rules=self.edits.rules)
        was = called.name if called else before.name if before else ""
        return edits, m.EditResult(goal_id="", ok=True, name=name, part=was, kind=given.kind)

    def _name_of(self, found: Meant, name: str, edit: m.HouseholdEdit) -> m.PlaceName:
        home, loaded = self._io.household, self._io.loaded
        x, y, theta = self.pose if edit.position is None else (edit.position[0], edit.position[1], 0.0)
        if found.surface is not None:
            part = loaded.receptacles[home.receptacles.index(found.surface)]
            return m.PlaceName(name=name, kind="surface", part=part.name, at=part.center)
        if found.room is not None:
            added = len(home.rooms) - len(loaded.rooms)
            number = home.rooms.index(found.room) - added
            if number >= 0:
                room = loaded.rooms[number]
                return m.PlaceName(name=name, kind="room", part=room.name, at=(*room.middle, 0.0))
            return m.PlaceName(name=name, kind="room", low=found.room.low, high=found.room.high)
        if found.kind == "room":
            low, high = room_around(home, x, y)
            return m.PlaceName(name=name, kind="room", low=low, high=high)
        return m.PlaceName(name=name, kind="place", pose=(round(x, 3), round(y, 3), round(theta, 3)))

    def _place_called(self, name: str) -> m.PlaceName | None:
        """The standing place that a person named so."""
        return next((n for n in self.edits.names if n.kind == "place" and n.name == name), None) if name else None

    def _free(self, name: str, found: Meant) -> None:
        """Raises `Refused` for a name that means something else, unless a person gave it: then it moves."""
        home, given = self._io.household, {n.name for n in self.edits.names}
        if what := _word_for_things(name, self._io):
            raise Refused("NAME_TAKEN", f"{name} means {what} already")
        owners: list[Receptacle | Room] = [*home.receptacles, *home.rooms]
        for owner in owners:
            if owner in (found.surface, found.room) or owner.name in given:
                continue
            if name in map(normalise, (owner.name, *owner.aliases)):
                raise Refused("NAME_TAKEN", f"the {owner.name} is called so already")

    def _forgotten(self, name: str) -> tuple[m.HouseholdEdits, m.EditResult]:
        gone = next((n for n in self.edits.names if n.name == name), None)
        if gone is None:
            raise Refused("UNKNOWN_NAME", f"nobody has told me of a place called {name}")
        edits = m.HouseholdEdits(names=[n for n in self.edits.names if n is not gone], rules=self.edits.rules)
        return edits, m.EditResult(goal_id="", ok=True, name=name, part=gone.part, kind=gone.kind)

    def _ruled(self, rule: m.TidyRule | None) -> tuple[m.HouseholdEdits, m.EditResult]:
        home, loaded = self._io.household, self._io.loaded
        surfaces = [r for name in rule.to if (r := home.receptacle(name))] if rule is not None else []
        if rule is None or not surfaces or not (rule.kinds or rule.colours or rule.names):
            raise Refused("NO_RULE", "I know no such thing or place")
        # Names change; the rule is about the surface.
        own = [loaded.receptacles[home.receptacles.index(r)] for r in surfaces]
        kept = msgspec.structs.replace(rule, to=[r.name for r in own], at=own[0].center)
        others = [r for r in self.edits.rules if _about(r) != _about(rule)]
        if len(others) >= MAX_RULES:
            raise Refused("TOO_MANY", f"there are {MAX_RULES} rules already")
        edits = m.HouseholdEdits(names=self.edits.names, rules=[*others, kept])
        return edits, m.EditResult(goal_id="", ok=True, name=rule.things, part=surfaces[0].name)

    def _unruled(self, things: str) -> tuple[m.HouseholdEdits, m.EditResult]:
        rules = [r for r in self.edits.rules if not things or normalise(r.things) == things]
        if not rules:
            raise Refused("NO_RULE", f"there is no rule about {things}" if things else "there is no rule")
        gone = rules[-1]
        edits = m.HouseholdEdits(names=self.edits.names, rules=[r for r in self.edits.rules if r is not gone])
        surface = self._io.household.receptacle(gone.to[0])
        part = surface.name if surface else gone.to[0]
        return edits, m.EditResult(goal_id="", ok=True, name=gone.things, part=part)

    # --- telling
    def _take(self, edit: m.HouseholdEdit) -> None:
        result = self.apply(edit)
        result.attempt = edit.attempt
        self._inbox.end(edit, result)
        self._io.publish(topics.HOUSEHOLD_EDITED, result)

    def _repeat(self, edit: m.HouseholdEdit, answer: m.EditResult | None) -> None:
        if answer is not None:
            self._io.publish(topics.HOUSEHOLD_EDITED, answer)

    def _tell(self) -> None:
        self._io.amend(self.edits)
        self._io.publish(topics.HOUSEHOLD_EDITS, self.edits)
        self._io.publish(topics.HOUSEHOLD_PARTS, m.HomeParts(parts=parts(self._io.household, self.edits)))


def parts(home: Household, edits: m.HouseholdEdits) -> list[m.HomePart]:
    """Rooms, surfaces and standing places as they are called now."""
    given = {n.name for n in edits.names}

    def part(name: str, kind: m.PartKind, x: float, y: float) -> m.HomePart:
        room = home.room_at(x, y) if kind != "room" else None
        where = room.name if room else ""
        return m.HomePart(name=name, kind=kind, room=where, given=name in given, x=round(x, 2), y=round(y, 2))

    rooms = [part(r.name, "room", *r.middle) for r in home.rooms]
    surfaces = [part(r.name, "surface", r.center[0], r.center[1]) for r in home.receptacles]
    return [*rooms, *surfaces, *(part(p.name, "place", p.x, p.y) for p in (home.home, *home.places))]


def _same_part(a: m.PlaceName, b: m.PlaceName) -> bool:
    """Names of one part; of a room that no map has, the newer one replaces the older."""
    if a.kind != b.kind or a.part != b.part or a.kind == "place":
        return False
    return bool(a.part) or (a.low, a.high) == (b.low, b.high)


def _about(rule: m.TidyRule) -> tuple[list[str], list[str], list[str]]:
    return sorted(rule.kinds), sorted(rule.colours), sorted(rule.names)


def _word_for_things(name: str, io: Io) -> Literal["", "a kind of thing", "a colour", "a thing"]:
    words, taught = io.household.words, io.latest(topics.HOUSEHOLD_NAMES)
    if words.kind(name) or name in words.groups:
        return "a kind of thing"
    if words.colour(name):
        return "a colour"
    if io.household.thing(name) or (taught is not None and any(one.name == name for one in taught.names)):
        return "a thing"
    return ""
