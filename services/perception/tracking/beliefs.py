"""What perception believes to be where, under the names that people use, and its publication."""

import math

from common import messages as m
from common import topics
from common.bus.port import Io
from services.perception.config import PerceptionConfig
from services.perception.naming.naming import Naming
from services.perception.tracking.object_tracker import ObjectTracker


class Beliefs:
    """The tracked objects on surfaces as people call them, with their taught names and their print."""

    def __init__(self, config: PerceptionConfig, io: Io, naming: Naming) -> None:
        self._config, self._io, self._naming = config, io, naming
        self.forget()

    def forget(self) -> None:
        """Another world: nothing is believed, and everybody is told."""
        self.tracker = ObjectTracker(self._io.loaded, self._config.gone_after, self._config.min_confidence)
        self.published: list[m.WorldObject] = []
        self._naming.reset()
        self._io.publish(topics.WORLD_OBJECTS, m.WorldObjects(t=0.0, objects=[], source="perception"))

    @property
    def laden(self) -> bool:
        """The robot holds one of the objects."""
        return any(o.held for o in self.published)

    def objects(self, since: float = -math.inf) -> list[m.WorldObject]:
        """What is believed, of what was seen `since` then."""
        objects, home = self.tracker.objects(since), self._io.household
        for o in objects:
            surface = home.receptacle(o.on)
            o.on = surface.name if surface else o.on
        return self._naming.annotated(objects)

    def publish(self, now: float, seen: bool = False) -> None:
        """Publish what is believed when it has changed or was `seen` again."""
        objects = self.objects()
        if seen or [_outline(o) for o in objects] != [_outline(o) for o in self.published]:
            self.published = objects
            self._io.publish(topics.WORLD_OBJECTS, m.WorldObjects(t=now, objects=objects, source="perception"))


def _outline(o: m.WorldObject) -> tuple[object, ...]:
    """What others care about: a change below 2 mm is none."""
    x, y, z = (round(v / 0.002) for v in o.position)
    return o.id, o.label, o.on, o.held, round(o.tilt, 1), x, y, z, *o.names, o.text
