"""What the planner believes of the world: the objects it was told of, where they are, what is in the hand. Pure."""

from collections.abc import Sequence

import msgspec

from common.messages import KnownWorld, Vec3, WorldObject
from common.scene import Receptacle, Scene

Pose2 = tuple[float, float, float]


class Thing(msgspec.Struct, frozen=True):
    """An object by the name that plans use. `seen` is False for one that the scene names and nobody has seen."""

    label: str
    kind: str
    colour: str = ""
    position: Vec3 | None = None
    on: str = ""
    size: Vec3 = (0.0, 0.0, 0.0)
    seen: bool = True
    seen_at: float = 0.0
    held: bool = False


class World(msgspec.Struct):
    """`things` are what has been seen or is held, `specs` what the scene names; `pose` is the robot's in the map."""

    scene: Scene
    things: list[Thing] = []
    specs: list[Thing] = []
    places: list[str] = []
    pose: Pose2 = (0.0, 0.0, 0.0)
    now: float = 0.0

    @property
    def held(self) -> Thing | None:
        return next((t for t in self.things if t.held), None)

    def receptacle_of(self, thing: Thing) -> Receptacle | None:
        """What a thing stands on or in."""
        return self.scene.receptacle(thing.on) if thing.on else None

    def room_of(self, thing: Thing) -> str:
        """The room a thing is in, "" when unknown."""
        where = thing.position
        if where is None and (r := self.receptacle_of(thing)):
            where = r.center
        room = self.scene.room_at(where[0], where[1]) if where else None
        return room.name if room else ""

    def distance(self, thing: Thing) -> float:
        """From the robot [m]; inf when its position is unknown."""
        where = thing.position
        if where is None and (r := self.receptacle_of(thing)):
            where = r.center
        if where is None:
            return float("inf")
        return float(((where[0] - self.pose[0]) ** 2 + (where[1] - self.pose[1]) ** 2) ** 0.5)

    def current(self, thing: Thing) -> Thing:
        """What is believed now of a thing mentioned before."""
        return next((t for t in self.things if t.label == thing.label), thing)

    def copy(self) -> "World":
        return msgspec.structs.replace(self, things=list(self.things))

    # --- what steps do to it
    def grasp(self, label: str) -> None:
        self._change(label, held=True, on="", position=None)

    def put(self, where: str) -> None:
        """What is held is now on `where`, "" for an unknown spot."""
        if held := self.held:
            self._change(held.label, held=False, on=where, position=None)

    def _change(self, label: str, **fields: object) -> None:
        for i, thing in enumerate(self.things):
            if thing.label == label and (fields["held"] != thing.held):
                self.things[i] = msgspec.structs.replace(thing, **fields)
                return
        spec = next((t for t in self.specs if t.label == label), Thing(label, label))
        self.things.append(msgspec.structs.replace(spec, seen=True, **fields))


def believed(
    scene: Scene, told: KnownWorld, objects: Sequence[WorldObject], pose: Pose2 = (0.0, 0.0, 0.0), now: float = 0.0
) -> World:
    """The world from a request's own list and the latest `world/objects`; the request says what is held."""
    specs = [Thing(label=o.name, kind=o.kind, colour=o.colour, size=o.size, seen=False) for o in scene.objects]
    named = {t.label: t for t in specs}
    held = _canonical(told.held, scene)
    things: list[Thing] = []
    for o in objects:
        if not o.label:
            continue
        spec = named.get(_canonical(o.label, scene))
        in_hand = bool(held) and _canonical(o.label, scene) == held and not any(t.held for t in things)
        things.append(
            Thing(
                label=spec.label if spec else o.label,
                kind=o.kind or (spec.kind if spec else ""),
                colour=o.colour or (spec.colour if spec else ""),
                position=None if in_hand else o.position,
                on="" if in_hand else o.on or _resting_on(o.position, scene),
                size=o.size if any(o.size) else (spec.size if spec else o.size),
                seen_at=o.seen_at,
                held=in_hand,
            )
        )
    labels = {t.label for t in things}
    for label in (*told.objects, told.held):
        name = _canonical(label, scene)
        if name and name not in labels:
            labels.add(name)
            spec = named.get(name, Thing(name, name))
            things.append(msgspec.structs.replace(spec, seen=True, held=name == held))
    return World(scene=scene, things=things, specs=specs, places=list(told.places), pose=pose, now=now)


def _canonical(label: str, scene: Scene) -> str:
    spec = scene.object(label)
    return spec.name if spec else label


def _resting_on(position: Vec3, scene: Scene) -> str:
    """Name of the surface that an object rests on; "" when there is none."""
    surface = scene.resting_place(position)
    return surface.name if surface else ""
