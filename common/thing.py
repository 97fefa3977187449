"""The description of an object by people: name, kind, colour and size."""

import math

from common.floor_plan import Rgba, Strict, Vec3
from common.kinds import KINDS


class Thing(Strict, frozen=True, kw_only=True):
    """An object by words and look: `kind` is one of `common.kinds`, `size` its full extent (x, y, z) upright."""

    name: str
    kind: str
    colour: str
    size: Vec3
    rgba: Rgba
    aliases: tuple[str, ...] = ()

    def fault(self) -> str:
        """What is wrong with kind or size, in words; "" when nothing is."""
        if self.kind not in KINDS:
            return f"{self.name!r} is a {self.kind!r}; known kinds: {', '.join(KINDS)}"
        if min(self.size) <= 0 or not all(map(math.isfinite, self.size)):
            return f"{self.name!r} needs a positive size"
        return ""
