"""Names of objects: how alike two looks are, which words a print has, what is kept on disk, who gets which name."""

import math
from pathlib import Path

import numpy as np
import pytest

from services.perception.naming.appearance import Look, difference, look_of
from services.perception.naming.crop import Crop, crop_of
from services.perception.naming.memory import FILE, MAX_LOOKS, NameMemory, Taught
from services.perception.naming.recognise import PERHAPS, SAME, Match, evidence, matches, unlikeness
from services.perception.naming.sights import Sight
from services.perception.naming.text import Line
from tests.unit.painted import Box, label, view_of_boxes

VITAMINS = label("VITA", ground=(240, 240, 235), ink=(200, 60, 20), band=(240, 140, 30))
TEA = label("TEA", ground=(240, 240, 235), ink=(20, 90, 40), band=(40, 120, 60))
PLAIN = label(ground=(240, 240, 235))


def crop(front: "np.ndarray", x: float = 0.9, y: float = 0.0, light: float = 1.0) -> Crop:
    box = Box(x, y, front)
    found = crop_of(view_of_boxes([box], light=light), box.believed("a", "box"))
    assert found is not None
    return found


def look(front: "np.ndarray", x: float = 0.9, y: float = 0.0, light: float = 1.0) -> Look:
    return look_of(crop(front, x, y, light))


# --- crops
def test_a_crop_has_the_pixels_of_its_object_and_no_others() -> None:
    box, beside = Box(0.9, 0.0, VITAMINS), Box(1.1, 0.12, TEA)
    found = crop_of(view_of_boxes([box, beside]), box.believed("a", "box"))
    assert found is not None
    focal, near = 480 * 0.96, 0.87
    expected = (focal * 0.08 / near) * (focal * 0.12 / near)
    assert np.count_nonzero(found.mask) == pytest.approx(expected, rel=0.08)
    assert found.along.min() < 0.1 < 0.9 < found.along.max()
    assert found.pixels_per_metre == pytest.approx(focal / near, rel=0.06)


def test_nothing_is_cut_out_behind_the_camera_or_behind_another_object() -> None:
    hidden, before = Box(1.4, 0.0, TEA), Box(0.7, 0.0, VITAMINS, width=0.2, height=0.3)
    view = view_of_boxes([hidden, before])
    assert crop_of(view, hidden.believed("a", "box")) is None
    assert crop_of(view, Box(-1.0, 0.0, TEA).believed("a", "box")) is None


# --- looks
@pytest.mark.parametrize(("x", "light"), [(0.9, 1.0), (0.9, 0.6), (0.6, 1.05), (1.4, 0.8)])
def test_an_object_is_more_like_itself_in_other_light_than_like_a_look_alike(x: float, light: float) -> None:
    taught, again = look(VITAMINS), look(VITAMINS, x, 0.05, light)
    assert difference(taught, again) < SAME
    assert difference(taught, again) < difference(taught, look(TEA, x, 0.05, light)) - 0.1


def test_another_size_is_another_object() -> None:
    small, large = Box(0.9, 0.0, VITAMINS), Box(0.9, 0.0, VITAMINS, width=0.14, height=0.21, depth=0.1)
    looks = [look_of(c) for b in (small, large) if (c := crop_of(view_of_boxes([b]), b.believed("a", "box")))]
    assert difference(*looks) > PERHAPS


# --- who has which name
def named(front: "np.ndarray", *lines: str) -> Taught:
    return Taught("vitamin box", "box", "white", (0.06, 0.08, 0.12), [look(front)], [(text, 0.95) for text in lines])


def sight(front: "np.ndarray", *lines: str, light: float = 0.8) -> Sight:
    return Sight(looks=[look(front, 1.1, -0.05, light)], lines=[Line(text, 0.9) for text in lines])


def test_the_taught_object_has_its_name_and_a_stranger_has_none() -> None:
    sights = {"it": sight(VITAMINS), "stranger": sight(TEA)}
    found = matches({"vitamin box": named(VITAMINS)}, sights, {})
    assert found == {"it": Match(("vitamin box",)), "stranger": Match()}
    assert matches({"vitamin box": named(VITAMINS)}, {"stranger": sight(TEA)}, {})["stranger"].names == ()


def test_of_two_that_look_the_same_both_have_the_name_so_that_it_is_asked_which() -> None:
    found = matches({"vitamin box": named(VITAMINS)}, {"a": sight(VITAMINS), "b": sight(VITAMINS, light=0.9)}, {})
    assert [m.names for m in found.values()] == [("vitamin box",)] * 2


def test_the_one_that_was_followed_since_it_was_taught_has_the_name_alone() -> None:
    sights = {"a": sight(VITAMINS), "b": sight(VITAMINS, light=0.9)}
    found = matches({"vitamin box": named(VITAMINS)}, sights, {"vitamin box": "b"})
    assert found == {"a": Match(), "b": Match(("vitamin box",))}


def test_what_was_followed_loses_the_name_when_it_comes_to_look_otherwise() -> None:
    assert matches({"vitamin box": named(VITAMINS)}, {"b": sight(TEA)}, {"vitamin box": "b"})["b"].names == ()


def test_other_print_tells_two_of_the_same_colours_apart_and_the_same_print_joins_them() -> None:
    pytest.importorskip("rapidfuzz", reason="the extra `ocr`")
    taught = named(VITAMINS, "TOMATO", "SOUP")
    alone, same = unlikeness(taught, sight(VITAMINS)), unlikeness(taught, sight(VITAMINS, "TOMATO"))
    other, unsure = unlikeness(taught, sight(VITAMINS, "POTATO", "SOUP")), unlikeness(taught, sight(VITAMINS, "400 g"))
    assert same < alone == unsure < other


# --- what is kept
def test_names_outlive_the_process(tmp_path: Path) -> None:
    warnings: list[str] = []
    memory = NameMemory(tmp_path, warnings.append)
    assert memory.teach(named(VITAMINS, "VITA"))
    again = NameMemory(tmp_path, warnings.append)
    assert again.names == memory.names
    assert again.forget("vitamin box") and not again.forget("vitamin box")
    assert NameMemory(tmp_path, warnings.append).names == {} and not warnings


@pytest.mark.parametrize("broken", [b"", b"[{", b'{"names": 1}', b'[{"name": "a"}]'])
def test_a_broken_file_is_set_aside_and_told_of(tmp_path: Path, broken: bytes) -> None:
    (tmp_path / FILE).write_bytes(broken)
    warnings: list[str] = []
    memory = NameMemory(tmp_path, warnings.append)
    assert memory.names == {} and len(warnings) == 1 and FILE in warnings[0]
    assert (tmp_path / FILE).with_suffix(".unreadable").read_bytes() == broken
    assert memory.teach(named(VITAMINS))


def test_a_disk_that_takes_nothing_is_told_of_and_the_name_is_not_believed_in(tmp_path: Path) -> None:
    warnings: list[str] = []
    memory = NameMemory(tmp_path / "missing", warnings.append)
    assert not memory.teach(named(VITAMINS)) and memory.names == {} and warnings


def test_looks_from_other_sides_are_learnt_and_bounded(tmp_path: Path) -> None:
    memory = NameMemory(tmp_path, print)
    memory.teach(named(PLAIN))
    one = look(PLAIN)
    for n in range(3 * MAX_LOOKS):
        angle = 2 * np.pi * n / (3 * MAX_LOOKS)
        memory.learn("vitamin box", Look(one.histogram, one.size, (math.cos(angle), math.sin(angle), 0.0), 0.9), [])
    assert 6 <= len(memory.names["vitamin box"].looks) <= MAX_LOOKS
    assert NameMemory(tmp_path, print).names == memory.names


def test_a_part_of_a_word_tells_as_much_as_the_word() -> None:
    pytest.importorskip("rapidfuzz", reason="the extra `ocr`")
    taught = named(VITAMINS, "ADE")
    assert evidence(taught, sight(VITAMINS, "LEMONADE")) == "same"
    assert evidence(named(VITAMINS, "LEMONADE"), sight(VITAMINS, "LEM")) == "same"
    assert evidence(taught, sight(VITAMINS, "COLA")) == "other"
    assert evidence(taught, sight(VITAMINS)) == evidence(named(VITAMINS), sight(VITAMINS, "COLA")) == "silent"


def test_what_has_print_is_known_by_its_print_alone_and_asked_about_else() -> None:
    pytest.importorskip("rapidfuzz", reason="the extra `ocr`")
    taught = {"vitamin box": named(VITAMINS, "FORTE")}
    turned, same, other = sight(VITAMINS), sight(VITAMINS, "FORTE"), sight(VITAMINS, "COLA")
    assert matches(taught, {"a": turned, "b": other}, {}, reads=True)["a"] == Match((), ("vitamin box",))
    assert matches(taught, {"a": turned, "b": same}, {}, reads=True) == {"a": Match(), "b": Match(("vitamin box",))}


@pytest.mark.parametrize(
    ("kind", "read_from", "words", "sure"),
    [("mug", [], (), 0), ("mug", [0.0], (), 1), ("mug", [0.0], ("COLA",), 0), ("ball", [], (), 1),
     ("box", [0.0, 1.0, 2.0], (), 0)],
)  # fmt: skip
def test_what_has_no_print_is_known_by_its_looks_once_it_was_seen_to_have_none_and_a_pack_is_asked_about(
    kind: str, read_from: list[float], words: tuple[str, ...], sure: int
) -> None:
    pytest.importorskip("rapidfuzz", reason="the extra `ocr`")
    seen, taught = sight(VITAMINS, *words), named(VITAMINS)
    seen.read_from, taught.kind = read_from, kind
    found = matches({"vitamin box": taught}, {"a": seen}, {}, reads=True)["a"]
    assert (len(found.names), len(found.perhaps)) == (sure, 1 - sure)
