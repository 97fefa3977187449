"""The support of an object by its exact pose and the floor plan, for the simulation and its judges."""

from common.floor_plan import FloorPlan

ON_TOP = 0.03
"""Height [m] of an underside above or below a surface that still counts as on it: a lying object's hull, a rim."""
MARGIN = 0.02
"""Distance [m] beyond the edge of a surface that still counts as over it: what stands partly over the edge."""


def support(floor_plan: FloorPlan, x: float, y: float, bottom: float) -> str:
    """What an object with its bottom at height `bottom` [m] rests on or in; "" for nothing.

    A receptacle, `floor`, or the piece of furniture whose top it stands on, as a bed or a washing machine.
    """
    found = floor_plan.surface_at(x, y, bottom, MARGIN, below=ON_TOP, above=ON_TOP)
    if found is not None:
        return found.name
    if bottom < ON_TOP:
        return "floor"
    tops = (f for f in floor_plan.furniture if abs(f.top - bottom) < ON_TOP and f.outline.contains(x, y, MARGIN))
    return next((f.name for f in tops), "")
