"""Where an object is by the part of it that the wrist camera shows, whatever its shape."""

import math

import mujoco
import numpy as np
import pytest

from common.geometry import Array
from common.household import load_household
from common.messages import ShapeFamily
from services.perception.detection import Detection
from services.perception.tracking.object_tracker import ObjectTracker
from services.perception.tracking.registration import laid_over, shift
from services.perception.unlisted import thinned
from services.perception.views.view import View

STAPLER = '<geom type="box" size=".063 .011 .025" pos="0 0 .025"/>'
BOOK = '<geom type="box" size=".075 .05 .01" pos="0 0 .01"/>'
SCISSORS = '<geom type="box" size=".06 .008 .005" pos="0 0 .005" euler="0 0 12"/>' + STAPLER.replace(".063", ".05")
OFF = np.array([0.006, -0.005, 0.003])
"""By how much [m] the head camera sees everything beside where it is."""


def looking(shape: str, eye: Array, at: Array, camera: str, focal: float) -> tuple[View, Array]:
    """A view of a shape on the floor, and its points there; the fingers hide the lower part of the wrist's picture."""
    world = f'<geom type="plane" size="3 3 .1"/><body euler="0 0 25">{shape}</body>'
    model = mujoco.MjModel.from_xml_string(f"<mujoco><worldbody>{world}</worldbody></mujoco>")
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    ahead = (at - eye) / np.linalg.norm(at - eye)
    right = np.cross(ahead, (0.0, 0.0, 1.0)) / np.linalg.norm(np.cross(ahead, (0.0, 0.0, 1.0)))
    rotation = np.stack([right, np.cross(ahead, right), ahead], axis=1)
    h, w = 120, 160
    v, u = np.mgrid[:h, :w] + 0.5
    rays = np.stack([(u - w / 2) / focal, (v - h / 2) / focal, np.ones((h, w))], axis=-1).reshape(-1, 3)
    far = np.linalg.norm(rays, axis=1)
    met, apart = np.full(h * w, -1, np.int32), np.zeros(h * w)
    directions = (rays / far[:, None] @ rotation.T).reshape(-1)
    mujoco.mj_multiRay(model, data, eye, directions, None, 1, -1, met, apart, None, h * w, 5.0)
    depth = (apart / far).reshape(h, w)
    if camera == "wrist":
        depth[90:], met[90 * w :] = 0.08, -1
    image = np.zeros((h, w, 3), np.uint8)
    view = View(image, depth.astype(np.float32), (focal, focal), (w / 2, h / 2), eye, rotation, camera=camera)
    return view, thinned(view.points[met.reshape(h, w) > 0].astype(np.float64))


def both(shape: str) -> tuple[Array, View, Array]:
    """What the head camera tells of a shape's points, and what the wrist camera shows of it."""
    middle = np.array([0.0, 0.0, 0.02])
    _, believed = looking(shape, np.array([-0.7, 0.1, 0.75]), middle, "head", 250.0)
    view, seen = looking(shape, np.array([-0.12, 0.03, 0.22]), np.add(middle, (0.03, 0.0, 0.0)), "wrist", 110.0)
    return believed + OFF, view, seen


def detection(points: Array, distance: float, shape: ShapeFamily = "box") -> Detection:
    x, y, z = (float(v) for v in points.mean(axis=0))
    return Detection(
        label="", kind="box", colour="red", position=(x, y, z), yaw=0.0, size=(0.03, 0.03, 0.03), confidence=0.9,
        on="counter", distance=distance, known=False, whole=False, shape=shape, kinds={"box": 1.0}, points=points,
    )  # fmt: skip


@pytest.mark.parametrize("shape", [STAPLER, BOOK, SCISSORS], ids=["stapler", "book", "scissors"])
def test_a_part_that_the_wrist_camera_shows_tells_where_the_whole_is(shape: str) -> None:
    believed, view, seen = both(shape)
    found = shift(believed, seen, view)
    assert found is not None and math.dist(found[:2], -OFF[:2]) < 0.0015


def test_what_has_another_shape_or_is_elsewhere_is_another_object() -> None:
    believed, view, seen = both(STAPLER)
    assert shift(believed, np.add(seen, (0.06, 0.0, 0.0)), view) is None
    assert shift(believed, np.empty((0, 3)), view) is None


def test_the_wrist_camera_moves_what_nobody_listed_and_changes_nothing_else_of_it() -> None:
    believed, view, seen = both(STAPLER)
    tracker, middle = ObjectTracker(load_household("apartment"), 3, 0.3), believed.mean(axis=0)
    whole = detection(believed, 1.05)
    for n in range(2):
        tracker.update(looking(STAPLER, np.array([0.0, 0.0, 0.9]), middle, "head", 250.0)[0], [whole], float(n))
    [before] = tracker.objects()
    assert tracker.update(view, [detection(seen, 0.25)], 2.0) == {before.id}
    [after] = tracker.objects()
    moved = np.subtract(after.position, before.position)
    # What the farther camera says counts a little: the nearer one is not mounted better.
    share = float(moved[:2] @ -OFF[:2]) / float(OFF[:2] @ OFF[:2])
    assert 0.6 < share < 0.9 and math.dist(moved[:2], share * -OFF[:2]) < 0.0015 and moved[2] == 0.0
    assert (after.size, after.kinds, after.shape, after.seen_at) == (before.size, before.kinds, before.shape, 2.0)


@pytest.mark.parametrize(("taken_for", "things"), [("irregular", 2), ("box", 1)])
def test_what_was_taken_for_one_without_a_shape_is_the_things_that_the_wrist_camera_shows(
    taken_for: ShapeFamily, things: int
) -> None:
    block, can = (f'<geom type="{kind}" pos="0 {y} .03"' for kind, y in (("box", 0.035), ("cylinder", -0.035)))
    believed, view, seen = both(f'{block} size=".03 .03 .03"/>{can} size=".03 .03"/>')
    aside = seen @ (-math.sin(math.radians(25)), math.cos(math.radians(25)), 0.0)
    parts = [detection(seen[aside > 0.004], 0.25), detection(seen[aside < -0.004], 0.25, "round")]
    tracker = ObjectTracker(load_household("apartment"), 3, 0.3)
    whole = detection(believed, 1.05, taken_for)
    for n in range(2):
        tracker.update(looking(STAPLER, np.array([0.0, 0.0, 0.9]), np.zeros(3) + 0.01, "head", 250.0)[0], [whole], n)
    for n in range(2):
        tracker.update(view, parts, 2.0 + n)
    found = tracker.objects()
    assert len(found) == things
    assert things == 1 or {o.shape for o in found} == {"box", "round"}


def test_a_view_is_laid_where_it_shows_the_same_sides_and_the_far_side_stays_where_it_is() -> None:
    rng = np.random.default_rng(0)

    def arc(middle: tuple[float, float, float]) -> Array:
        turn, up = rng.uniform(-1.2, 1.2, 600), rng.uniform(0.0, 0.1, 600)
        return np.add(np.stack([-0.04 * np.cos(turn), 0.04 * np.sin(turn), up], axis=1), middle)

    front = arc((0.0, 0.0, 0.0))
    moved = laid_over(front, arc((0.005, 0.004, 0.0)))
    assert abs(float(np.hypot(moved[:, 0], moved[:, 1]).mean()) - 0.04) < 0.001
    behind = arc((0.015, 0.0, 0.0))
    assert laid_over(front, behind) is behind, "what is so thin stays so"
