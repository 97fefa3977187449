"""What an object is called when its views contradict each other."""

from dataclasses import replace

import numpy as np

from services.perception.detection import Detection
from services.perception.tracking.descriptor import Descriptor


def called(*views: tuple[dict[str, float], float]) -> str:
    """The kind after views with shares of kinds and how much each says."""
    looks = Descriptor((0.04, 0.04, 0.12))
    kind = ""
    for kinds, weight in views:
        first = max(kinds, key=lambda k: kinds[k])
        seen = Detection(
            label="", kind=first, colour="black", position=(1.0, 0.0, 0.7), yaw=0.0, size=(0.04, 0.04, 0.12),
            confidence=0.9, on="desk", distance=1.0, known=False, kinds=kinds, colours={"black": 1.0}, shape="round",
        )  # fmt: skip
        looks.add(seen, weight, False, seen.position, seen.position)
        kind, _ = looks.name()
    return kind


BOTTLE, BACK = {"bottle": 1.0}, {"book": 0.5, "box": 0.4, "bottle": 0.1}


def test_a_nearer_view_says_better_what_it_is() -> None:
    assert called((BACK, 0.2), (BOTTLE, 4.0)) == "bottle"
    assert called(({"can": 0.6, "mug": 0.4}, 0.2), ({"box": 0.6, "book": 0.4}, 4.0)) == "box", "the first was a guess"


def test_what_counted_as_seen_takes_as_much_to_be_something_else() -> None:
    assert called((BOTTLE, 0.2), (BACK, 4.0), (BACK, 4.0)) == "bottle"
    assert called((BOTTLE, 0.2), ({"book": 0.97, "box": 0.03}, 4.0)) == "book"


def test_what_it_is_easily_taken_for_takes_no_more() -> None:
    assert called((BOTTLE, 0.2), ({"can": 0.6, "book": 0.4}, 4.0)) == "can"


def test_what_was_seen_from_far_does_not_blur_what_was_seen_from_near() -> None:
    def view(distance: float, at: float, whole: bool = True) -> Detection:
        return Detection(
            label="", kind="can", colour="red", position=(1.0, 0.0, 0.7), yaw=0.0, size=(0.06, 0.06, 0.1),
            confidence=0.9, on="desk", distance=distance, known=False, whole=whole, kinds={"can": 1.0},
            colours={"red": 1.0}, shape="round", points=np.array([[at, 0.0, 0.7]]),
        )  # fmt: skip

    def seen(*views: Detection) -> set[float]:
        looks = Descriptor((0.06, 0.06, 0.1))
        for one in views:
            looks.add(one, 1.0, False, one.position, one.position)
        return {round(float(x), 6) for x in looks.points[:, 0]}

    assert seen(view(2.0, 0.9), view(0.8, 1.0)) == seen(view(0.8, 1.0), view(2.0, 0.9)) == {0.0}
    assert seen(view(0.9, 0.9), view(0.8, 1.0)) == {-0.1, 0.0}
    assert seen(view(2.0, 0.9), view(0.8, 1.0, whole=False)) == {-0.1, 0.0}, "a part replaces nothing"


def test_what_was_put_down_has_the_shape_that_is_seen_since() -> None:
    seen = Detection(
        label="", kind="cup", colour="brown", position=(1.0, 0.0, 0.7), yaw=0.0, size=(0.1, 0.1, 0.096), confidence=0.9,
        on="desk", distance=0.6, known=False, kinds={"cup": 1.0}, colours={"brown": 1.0}, shape="bowl",
    )  # fmt: skip
    looks, lies = Descriptor(seen.size), replace(seen, size=(0.098, 0.097, 0.105), shape="irregular", confidence=0.68)
    for _ in range(4):
        looks.add(seen, 2.0, False, seen.position, seen.position)
    looks.set_down()
    looks.add(lies, 1.0, False, lies.position, lies.position)
    assert (looks.shape, looks.size) == ("irregular", lies.size)
    assert looks.name()[0] == "cup", "it is still the same"


def test_views_taken_for_other_shapes_are_laid_over_one_another_where_they_are() -> None:
    """A frame of 20 mm bars, whose middle is 20 mm off where it is taken for a box."""
    x, y = (axis.ravel() for axis in np.meshgrid(np.arange(-0.07, 0.071, 0.007), np.arange(-0.05, 0.051, 0.007)))
    bars = (np.abs(x) > 0.05) | (np.abs(y) > 0.03)
    frame = np.stack([1.0 + x[bars], y[bars], np.full(bars.sum(), 0.7)], axis=1)
    seen = Detection(
        label="", kind="tool", colour="red", position=(1.0, 0.0, 0.7), yaw=0.0, size=(0.14, 0.1, 0.02), confidence=0.9,
        on="desk", distance=0.8, known=False, kinds={"tool": 1.0}, colours={"red": 1.0}, shape="irregular",
        points=frame,
    )  # fmt: skip
    looks, boxed = Descriptor(seen.size), replace(seen, shape="box", position=(1.014, 0.014, 0.7))
    elsewhere = replace(seen, position=(1.01, 0.0, 0.7), points=np.add(frame, (0.01, 0.0, 0.0)))
    between = (1.007, 0.007, 0.7)
    looks.add(seen, 1.0, False, seen.position, seen.position)
    looks.add(elsewhere, 1.0, False, seen.position, seen.position)
    assert len(looks.points) == len(frame), "the robot, and not the object, was elsewhere than believed"
    looks.add(boxed, 1.0, False, seen.position, between)
    assert np.abs(np.sort(looks.points, axis=0) - np.sort(frame - between, axis=0)).max() < 1e-6
