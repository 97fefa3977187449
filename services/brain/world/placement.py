"""Judges by what perception saw whether an object that was put down stands where it belongs. Pure."""

import math
from dataclasses import dataclass
from typing import Literal

from common.geometry import quat_matrix
from common.household import Household
from common.kinds import kind_of, laid_on_a_side
from common.messages import ObjectPose, ObjectRef

Fault = Literal["", "NOT_SEEN", "MISPLACED", "TOPPLED"]
TIPPED = 0.35
"""Tilt [rad] from which an object does not stand; perception tells standing, lying (1.57) and upside down (3.14)."""
UPSIDE_DOWN = 2.4
"""Tilt [rad] from which an object is upside down rather than on its side: half-way between the two."""

FELL, FELL_SHARE = 0.025, 0.25
"""By how much [m], and by what share of its height, something that was asked for by no known kind is lower when it fell
over. Chosen: four times the error of a measured height."""
BESIDE = 0.4
"""Distance [m] between the middles of two objects up to which one is next to the other. Chosen: a hand's breadth or two
between them, with room for the fingers."""


@dataclass(frozen=True)
class Finding:
    """`fault` is "" when all is well; `words`: a clause for people; `measured`: the pose, "" when it was not seen."""

    fault: Fault
    words: str
    measured: str = ""

    @property
    def evidence(self) -> str:
        """Words and measurement, for the timeline."""
        return f"{self.words}, {self.measured}" if self.measured else self.words


def judge_placement(
    pose: ObjectPose,
    label: str,
    target: str,
    household: Household,
    beside: ObjectRef | None = None,
    kind: str = "",
    closed: bool = False,
    stood: float = 0.0,
) -> Finding:
    """Judge an object that was seen after it was put down on `target`; "": anywhere will do.

    `beside`: the object, with its place in frame map, next to which it belongs. `kind`: what it was asked for as, ""
    what the household or its label says; `closed`: it lay when it was found, and looks closed from above now; `stood`:
    its height [m] when it was found standing, 0 if it did not.
    """
    spec, wanted = household.thing(label), household.receptacle(target)
    stands = kind_of(kind or (spec.kind if spec else kind_meant(label, household)))
    on = household.receptacle(pose.on) or household.resting_place(pose.position)
    where = f"on the {on.name}" if on else "on the floor"
    if on and on.depth:
        where = f"in the {on.name}"
    tilt = tilt_of(pose)
    if spec is None and not tilt and laid_on_a_side(stands.name, pose.size):
        # A box on its side is seen as a book that lies as it should.
        tilt = math.pi / 2
    x, y, z = pose.position
    measured = f"at ({x:.2f}, {y:.2f}, {z:.2f}), tilt {math.degrees(tilt):.0f} deg"
    if wanted is not None and on is not wanted:
        return Finding("MISPLACED", f"the {label} is {where}, not on the {wanted.name}", measured)
    over = tilt > TIPPED or (closed and "upside down" in stands.rests)
    if stands.upright and over and not (on and on.depth):
        how = "lies on its side" if lies(tilt) else "stands upside down"
        return Finding("TOPPLED", f"the {label} {how} {where}", measured)
    unknown = not kind and spec is None and not stands.upright
    if unknown and stood - pose.size[2] > max(FELL, FELL_SHARE * stood) and not (on and on.depth):
        return Finding("TOPPLED", f"the {label} does not stand {where} as it did", measured)
    if beside is not None:
        apart = math.dist((x, y), beside.position[:2])
        if apart > BESIDE:
            return Finding("MISPLACED", f"the {label} is {apart:.1f} m from the {beside.label}", measured)
        where += f" next to the {beside.label}"
    return Finding("", f"the {label} is {where}", measured)


def lies(tilt: float) -> bool:
    """Does an object of that tilt [rad] lie on its side, and neither stand nor stand upside down?"""
    return TIPPED < tilt <= UPSIDE_DOWN


def kind_meant(phrase: str, household: Household) -> str:
    """The kind that a phrase like `the yellow bottle` names, "" when none of its words does."""
    named = (household.words.kind(word) for word in reversed(phrase.split()))
    return next((kind for kind in named if kind), "")


def judge_absence(label: str, target: str, household: Household) -> Finding:
    """Judge that an object is not to be seen. Into a bin the camera hardly looks: there the hand's word counts."""
    wanted = household.receptacle(target)
    if wanted is not None and wanted.depth:
        return Finding("", f"the {label} was let go over the {wanted.name} and is nowhere else to be seen")
    return Finding("NOT_SEEN", f"the {label} is not to be seen" + (f" on the {wanted.name}" if wanted else ""))


def tilt_of(pose: ObjectPose) -> float:
    """Angle [rad] of the object's own axis to the vertical, by whichever field its sender fills."""
    norm = math.hypot(*pose.orientation)
    upright = float(quat_matrix(pose.orientation)[2, 2]) if abs(norm - 1.0) < 0.01 else 1.0
    return max(pose.tilt, math.acos(max(-1.0, min(1.0, upright))))
