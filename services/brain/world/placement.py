"""Judges by what perception saw whether an object that was put down stands where it belongs. Pure."""

import math
from dataclasses import dataclass
from typing import Literal

import msgspec

from common.geometry import quat_matrix
from common.household import Household
from common.kinds import kind_of, laid_on_a_side
from common.messages import ObjectPose, ObjectRef
from common.messages.perception import End, ShapeFamily

Fault = Literal["", "NOT_SEEN", "MISPLACED", "TOPPLED", "UNTOLD"]
TIPPED = 0.35
"""Tilt [rad] from which an object does not stand; perception tells standing, lying (1.57) and upside down (3.14)."""
UPSIDE_DOWN = 2.4
"""Tilt [rad] from which an object is upside down rather than on its side: half-way between the two."""

FELL, FELL_SHARE = 0.025, 0.25
"""By how much [m], and by what share of its height, something that was asked for by no known kind is lower when it fell
over. Chosen: four times the error of a measured height."""
AS_HIGH = 0.85
"""Height by its length as it lay up to which what has no shape is not known to stand. Chosen: a tenth is the error."""
TURNED: tuple[ShapeFamily, ...] = ("round", "bowl")
"""Shapes that are the same from wherever one looks, as long as they stand."""
OBLONG = 1.5
"""Length by width of a box from which what was such a shape is taken for none that stands. Chosen: a can from near is
measured to 1.1."""
BESIDE = 0.4
"""Distance [m] between the middles of two objects up to which one is next to the other. Chosen: a hand's breadth or two
between them, with room for the fingers."""


@dataclass(frozen=True)
class Finding:
    """`fault` is "" when all is well; `words`: a clause for people; `measured`: the pose, "" when it was not seen.

    `unlike`: it has a shape that it has not where it stands.
    """

    fault: Fault
    words: str
    measured: str = ""
    unlike: bool = False

    @property
    def evidence(self) -> str:
        """Words and measurement, for the timeline."""
        return f"{self.words}, {self.measured}" if self.measured else self.words


class Rest(msgspec.Struct, frozen=True):
    """How an object rested before the hand came.

    `asked`: the kind that it was asked for as, `taken`: the one that it was taken for; "" for none. `stood`: its height
    [m] as it stood, 0 if it lay, `shape` how it was measured; `lay`: it has lain at some time, and may have been stood
    on its head since; `opening`: as it lay its opening was seen, so that the hand knew which end belongs above;
    `length`: its longest extent [m] as it lay.
    """

    asked: str = ""
    taken: str = ""
    stood: float = 0.0
    lay: bool = False
    shape: ShapeFamily = ""
    opening: bool = False
    length: float = 0.0


def rested(
    pose: ObjectPose,
    item: str,
    household: Household,
    before: Rest | None,
    shape: ShapeFamily = "",
    top: End = "",
) -> Rest:
    """What is known of the rest of an object that was asked for as `item` and is seen at `pose`, measured as `shape`
    with that upper end, before a grasp."""
    asked, taken = kind_meant(item, household), kind_meant(pose.label, household)
    lay = _over(asked or taken, pose)
    opening, length = lay and top == "open", max(pose.size) if lay else 0.0
    if before is not None:
        longest = max(length, before.length)
        return msgspec.structs.replace(before, lay=before.lay or lay, opening=opening, length=longest)
    return Rest(asked, taken, 0.0 if lay else pose.size[2], lay, shape, opening, length)


def judge_placement(
    pose: ObjectPose,
    label: str,
    target: str,
    household: Household,
    beside: ObjectRef | None = None,
    rest: Rest = Rest(),  # noqa: B008 it is frozen
    alike: bool = False,
    top: End = "",
    shape: ShapeFamily = "",
    unlike: bool = False,
) -> Finding:
    """Judge an object that was seen after it was put down on `target`; "": anywhere will do.

    `beside`: the object, with its place in frame map, next to which it belongs. `rest`: how it rested before; `alike`:
    by its looks now its ends cannot be told apart, so that one that `lay` may stand on its head; `top`: what its upper
    end is, which tells of a vessel. `shape`: how it is measured now, "" if it was not; `unlike`: a look before, since
    it was put down, showed a shape that it has not where it stands; that the next one shows another does not tell which
    of them is right.
    """
    spec, wanted = household.thing(label), household.receptacle(target)
    seen = spec.kind if spec else kind_meant(label, household)
    # What fell may look like another kind since, and has to stand as both.
    kinds = {rest.asked} if rest.asked else {seen} if spec else {seen, rest.taken}
    on = household.receptacle(pose.on) or household.resting_place(pose.position)
    where = on.spoken if on else "on the floor"
    tilt = tilt_of(pose)
    if spec is None and not tilt and any(laid_on_a_side(kind, pose.size) for kind in kinds):
        # A box on its side is seen as a book that lies as it should.
        tilt = math.pi / 2
    x, y, z = pose.position
    measured = f"at ({x:.2f}, {y:.2f}, {z:.2f}), tilt {math.degrees(tilt):.0f} deg"
    if wanted is not None and on is not wanted:
        return Finding("MISPLACED", f"the {label} is {where}, not on the {wanted.name}", measured)
    stands = [kind_of(kind) for kind in kinds if kind_of(kind).upright]
    in_bin, lay = on is not None and bool(on.depth), rest.lay
    vessel = any("upside down" in kind.rests for kind in stands)
    over = tilt > TIPPED or (lay and vessel and (top == "closed" or (alike and not top)))
    if stands and over and not in_bin:
        how = "lies on its side" if lies(tilt) else "stands upside down"
        return Finding("TOPPLED", f"the {label} {how} {where}", measured)
    untold = not top and not rest.opening if vessel else alike and any(not kind.ends_alike for kind in stands)
    # What no shape explains tells of no tilt.
    untold |= shape == "irregular" and pose.size[2] < AS_HIGH * rest.length
    if stands and lay and untold and not in_bin:
        words = f"I cannot tell whether the {label} {where} stands as it should"
        return Finding("UNTOLD", words, measured)
    unknown = not rest.asked and spec is None and not stands
    lower = unknown and rest.stood - pose.size[2] > max(FELL, FELL_SHARE * rest.stood)
    turned = (unknown or stands) and rest.stood and rest.shape in TURNED
    other = bool(turned and (unlike or _turned_no_more(shape, pose)))
    if spec is None and (lower or other) and not in_bin:
        return Finding("TOPPLED", f"the {label} does not stand {where} as it did", measured, other)
    if beside is not None:
        apart = math.dist((x, y), beside.position[:2])
        if apart > BESIDE:
            return Finding("MISPLACED", f"the {label} is {apart:.1f} m from the {beside.label}", measured)
        where += f" next to the {beside.label}"
    return Finding("", f"the {label} is {where}", measured)


def _turned_no_more(shape: ShapeFamily, pose: ObjectPose) -> bool:
    """Nobody would measure so what is turned and stands: a flower pot as wide as high that lies shows no axis."""
    length, width = max(pose.size[:2]), min(pose.size[:2])
    return shape == "irregular" or (shape == "box" and length > OBLONG * width)


def _over(kind: str, pose: ObjectPose) -> bool:
    """Does something of that kind, seen so, lie or stand on its head?"""
    return tilt_of(pose) > TIPPED or laid_on_a_side(kind, pose.size)


def lies(tilt: float) -> bool:
    """Does an object of that tilt [rad] lie on its side, and neither stand nor stand upside down?"""
    return TIPPED < tilt <= UPSIDE_DOWN


def kind_meant(phrase: str, household: Household) -> str:
    """The kind that a phrase like `the yellow bottle` names, "" when none of its words does."""
    named = (household.words.kind(word) for word in reversed(phrase.split()))
    return next((kind for kind in named if kind), "")


def may_lie_flat(phrase: str, household: Household) -> bool:
    """A phrase names nothing that stands or is round: a comb, the scissors."""
    return kind_meant(phrase, household) in ("", "tool", "toy", "book")


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
