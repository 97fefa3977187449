"""A physical fault as a case names it."""

from typing import Any, Literal

import msgspec
from msgspec.structs import replace

from common.geometry import IDENTITY_POSE, Pose2
from common.kinds import kind_of
from common.scene import Scene

Kind = Literal["shove", "slip", "heavy", "wide", "jam", "obstacle", "kidnap"]


class PhysicalFault(msgspec.Struct, frozen=True, kw_only=True):
    """A fault of the grasp of `thing`, or an obstacle `thing` in the robot's way.

    `shove`: pushed out of the hand as the fingers come. `slip`: after it was carried `after` metres the pads lose
    their friction for `seconds`. `jam`: a finger stays where it is for `seconds` when it should close. `heavy`: it has
    the mass `amount` [kg]. `wide`: it is `amount` [m] wide and deep, which nobody told the robot. `obstacle` changes
    nothing: it is watched whether it came in the way. `kidnap`: the robot, with nothing in its hand, is carried to
    `pose` (x, y, theta) [map] after it has driven `after` metres, at 0 before it is switched on.
    """

    kind: Kind
    thing: str = ""
    seconds: float = 0.0
    after: float = 0.0
    amount: float = 0.0
    pose: Pose2 = IDENTITY_POSE

    def world(self, scene: Scene) -> Scene:
        """The scene with the object changed as the fault wants it."""
        changes: dict[str, Any] = {}
        if self.kind == "heavy":
            changes["mass"] = self.amount
        objects = []
        for spec in scene.objects:
            if spec.name == self.thing and self.kind == "wide":
                height = self.amount if kind_of(spec.kind).shape == "sphere" else spec.size[2]
                changes["size"] = (self.amount, self.amount, height)
            objects.append(replace(spec, **changes) if spec.name == self.thing else spec)
        return replace(scene, objects=tuple(objects))
