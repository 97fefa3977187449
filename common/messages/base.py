"""What every payload is made of."""

import msgspec

Vec3 = tuple[float, float, float]
Quat = tuple[float, float, float, float]
IDENTITY: Quat = (1.0, 0.0, 0.0, 0.0)
"""No rotation, as (w, x, y, z)."""


class Message(msgspec.Struct, kw_only=True):
    """Base of all payloads."""
