"""Names to places: rooms, surfaces and poses of the household, of places.toml, and objects that were seen."""

import msgspec

from common.floor_plan import Receptacle, Room
from common.furniture_tops import support_at
from common.geometry import Pose2
from common.household import Household
from common.messages import WorldObject
from common.naming.names import match_object, near_names, normalise


class Spot(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    x: float
    y: float
    theta: float = 0.0


class PlacesFile(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """Contents of config/places.toml: `places` are named poses, `items` where single items are looked for."""

    places: dict[str, Spot] = {}
    items: dict[str, Spot] = {}


class Places:
    """Looks names of places and objects up in the household, places.toml and perception's reports."""

    def __init__(self, household: Household, file: PlacesFile) -> None:
        self._household = household
        self._items = {normalise(k): v for k, v in file.items.items()}
        self._poses: dict[str, Pose2] = {}
        for place in (household.home, *household.places):
            for name in (place.name, *place.aliases):
                self._poses[normalise(name)] = (place.x, place.y, place.theta)
        self._poses |= {normalise(k): (v.x, v.y, v.theta) for k, v in file.places.items()}
        self._receptacles = {normalise(n): r for r in household.receptacles for n in (r.name, *r.aliases)}
        self._rooms = {normalise(n): r for r in reversed(household.rooms) for n in (r.name, *r.aliases)}

    @property
    def home(self) -> Pose2:
        return self._household.home.x, self._household.home.y, self._household.home.theta

    def place(self, name: str) -> Pose2 | Room | Receptacle | None:
        """The pose, room or receptacle of that name, None if there is none."""
        wanted = normalise(name)
        return self._poses.get(wanted) or self._rooms.get(wanted) or self._receptacles.get(wanted)

    def similar(self, name: str) -> str:
        """Names of places that are spelled like `name`, else all names, for error messages."""
        names = [*self._poses, *self._rooms, *self._receptacles]
        return ", ".join(near_names(name, names) or sorted(set(names)))

    def matching(self, name: str, objects: list[WorldObject]) -> list[WorldObject]:
        """The reported objects that the name can mean, without those in somebody's hand."""
        return [o for o in match_object(name, objects, self._household) if not o.held]

    def spot(self, name: str) -> Pose2 | None:
        """The pose that places.toml gives for an item, None where it has none."""
        spot = self._items.get(normalise(name))
        if spot is None:
            spec = self._household.thing(normalise(name))
            spot = self._items.get(normalise(spec.name)) if spec else None
        return (spot.x, spot.y, spot.theta) if spot else None

    def receptacle_of(self, o: WorldObject) -> Receptacle | None:
        """What an object stands on: as reported, else what is under it; None for the floor."""
        if o.on == "floor":
            return None
        return self._household.receptacle(o.on) or support_at(self._household, o.position[0], o.position[1])
