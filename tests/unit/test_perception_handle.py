"""What is thin at the side of a body is its handle."""

import numpy as np
from numpy.typing import NDArray

from services.perception.shapes.handle import Parts, parted

PIXEL = 0.002
"""Size of a pixel [m]: about that at 0.8 m."""


def parts_of(mask: NDArray[np.bool_]) -> Parts:
    return parted(*np.nonzero(mask), PIXEL)


def mug() -> tuple[NDArray[np.bool_], NDArray[np.bool_]]:
    """A body of 80 x 100 mm in the picture, and a handle of 8 mm to its right."""
    body, ring = np.zeros((70, 90), bool), np.zeros((70, 90), bool)
    body[10:60, 10:50] = True
    ring[22:48, 50:64] = True
    ring[26:44, 50:60] = False
    return body, ring


def test_a_handle_is_told_from_the_body() -> None:
    body, ring = mug()
    parts = parts_of(body | ring)
    assert parts.of_handle(*np.nonzero(ring)).mean() > 0.8
    assert parts.of_body(*np.nonzero(body)).mean() > 0.98
    assert not parts.of_handle(*np.nonzero(body)).any()


def test_a_line_without_depth_parts_no_body() -> None:
    body, _ = mug()
    body[20] = False
    assert parts_of(body).of_body(*np.nonzero(body)).all()


def test_neither_a_neck_nor_something_thin_is_a_handle() -> None:
    bottle = np.zeros((110, 60), bool)
    bottle[40:100, 10:45] = True
    bottle[10:40, 25:31] = True
    pen = np.zeros((20, 90), bool)
    pen[8:12, 10:80] = True
    for mask in (bottle, pen):
        assert not parts_of(mask).handle.any()
    assert parts_of(pen).of_body(*np.nonzero(pen)).all()


def test_the_stem_and_the_foot_of_a_glass_are_of_it() -> None:
    glass = np.zeros((110, 60), bool)
    glass[10:50, 10:45] = True
    glass[50:95, 26:30] = True
    glass[95:98, 12:43] = True
    parts = parts_of(glass)
    assert parts.of_body(*np.nonzero(glass)).all() and not parts.handle.any()
