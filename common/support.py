"""What an object rests on, by its exact pose and the floor plan's geometry: for the simulation and its judges."""

from common.floor_plan import FloorPlan

ON_TOP = 0.03
"""Height [m] of an underside above or below a surface that still counts as on it: a lying object's hull, a rim."""
MARGIN = 0.02
"""Distance [m] beyond the edge of a surface that still counts as over it: what stands partly over the edge."""


def support(floor_plan: FloorPlan, x: float, y: float, bottom: float) -> str:
    """The receptacle that an object with its bottom at height `bottom` [m] rests on or in, `floor`, or "" for none."""
    found = floor_plan.surface_at(x, y, bottom, MARGIN, below=ON_TOP, above=ON_TOP)
    if found is not None:
        return found.name
    return "floor" if bottom < ON_TOP else ""
