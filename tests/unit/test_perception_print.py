"""What is printed on objects: read by the reader, compared with the words that somebody asked for."""

import sys

import pytest

from common.bus.memory import MemoryBus, MemoryIo
from common.household import load_household
from common.messages import WorldObject
from evaluation.site import eventually
from services.perception.naming.observer import Observer
from services.perception.naming.reader import Reader
from services.perception.naming.text import LIKELY, SURE, Line, likeness, merged, printed_words, traces
from services.perception.naming.vocabulary import common_words, taken, unlike_said
from tests.unit.painted import Box, label, view_of_boxes

pytest.importorskip("rapidfuzz", reason="the extra `ocr`")

COMMON = common_words(load_household("apartment"))


@pytest.mark.parametrize(
    ("asked", "read"),
    [
        ("tomato soup", "TOMATO SOUP"), ("tomato soup", "SOUP / TOMATO"), ("tomato soup", "TOMATOSOUP 400g"),
        ("corn flakes", "Crispy CORN / FLAKES"), ("corn flake", "CORN FLAKES"), ("parmesan cheese", "PARMESAN CHEESF"),
        ("milk", "fresh MILK 1.5 %"), ("earl grey", "EARL GREY TEA"),
    ],
)  # fmt: skip
def test_what_is_asked_for_is_known_by_its_print(asked: str, read: str) -> None:
    assert likeness(asked.split(), read) >= SURE


@pytest.mark.parametrize(
    ("asked", "read"),
    [
        ("tomato soup", "POTATO SOUP"), ("tomato soup", "TOMATO KETCHUP"), ("corn flakes", "BRAN FLAKES"),
        ("tea", "PEA SOUP"), ("tea", "TEN BISCUITS"), ("rice", "SALT"), ("milk", ""), ("", "MILK"),
        ("orange juice", "APPLE JUICE"), ("salt", "MALT"),
    ],
)  # fmt: skip
def test_what_reads_otherwise_is_not_it(asked: str, read: str) -> None:
    assert likeness(asked.split(), read) < LIKELY or (asked, read) == ("salt", "MALT")
    assert likeness(asked.split(), read) < SURE


def test_a_word_that_is_half_legible_is_worth_a_nearer_look() -> None:
    assert likeness(["mustard"], "MUSFARD") >= LIKELY and LIKELY <= likeness(["corn"], "CORM") < SURE


def test_letters_that_small_print_makes_look_alike_are_forgiven_and_no_others() -> None:
    assert likeness(["water"], "NATER") >= SURE and likeness(["water"], "WATEH") >= SURE
    assert likeness(["water"], "LATER") < SURE and likeness(["lemon"], "MELON") < LIKELY


def test_the_end_of_a_word_beyond_the_edge_of_a_can_is_a_trace_of_it() -> None:
    assert traces(["tomato", "soup"], "ATO / UP") == 1.0
    assert traces(["tomato", "soup"], "HONEY") < LIKELY and traces(["tomato"], "") == 0.0


def test_what_goes_around_a_can_is_put_together_of_what_each_side_shows() -> None:
    assert likeness(["honey"], "HON / NEY") >= SURE and likeness(["honey"], "HON / HO") < LIKELY
    assert likeness(["rice"], "ICE") < SURE and likeness(["popcorn"], "CORN") < LIKELY


def test_a_short_word_is_known_in_words_that_are_glued_to_it_and_in_no_others() -> None:
    assert likeness(["tea"], "GREENTEA", ("green", "tea")) >= SURE
    assert likeness(["tea"], "STEAM", ("green", "tea")) == 0.0 == likeness(["tea"], "GREENTEAM", ("green", "tea"))


def test_only_words_that_name_no_kind_colour_or_place_can_be_print() -> None:
    assert printed_words("the red box of corn flakes on the kitchen counter", COMMON) == ["corn", "flakes"]
    assert printed_words("my red mug", COMMON) == []
    assert printed_words("the small blue cup next to the bowl", COMMON) == []


def test_of_two_readings_of_a_line_the_surer_or_longer_one_stays() -> None:
    lines = merged([Line("T0MATO", 0.7), Line("400g", 0.9)], [Line("TOMATO", 0.98), Line("SOUP", 0.9)])
    assert {line.text for line in lines} == {"TOMATO", "SOUP", "400g"}
    assert [line.text for line in merged([Line("HO", 0.99)], [Line("HON", 0.97)])] == ["HON"]


@pytest.mark.parametrize(
    ("name", "means"), [("mug", "every mug"), ("kitchen counter", "a place"), ("cup", "every cup")]
)
def test_a_name_that_means_something_already_is_taken(name: str, means: str) -> None:
    assert taken(name, load_household("apartment")) == means
    assert taken("vitamin box", load_household("apartment")) == ""


def test_a_reader_whose_libraries_are_missing_is_told_of_once_and_nothing_is_read_any_more(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    # OpenCV without libGL is found and cannot be imported.
    monkeypatch.setitem(sys.modules, "rapidocr_onnxruntime", None)
    household = load_household("minimal")
    io = MemoryIo(MemoryBus(), "perception", (), (), household=household, lockstep=False)
    box = Box(0.8, 0.0, label("TEA"))
    reader = Reader()
    observer = Observer(io, reader, lambda key, look: None)
    observer.see(view_of_boxes([box]), [box.believed("a", "box")])
    observer.look(["a"], 0.0, read=True)
    observer.step(0.0)
    eventually(lambda: observer.step(0.1), "the worker has looked")
    sight = observer.sight("a")
    assert sight is not None and sight.looks and not sight.lines
    assert not observer.can_read and "libgl1" in reader.broken
    io.shutdown()


def seen(kind: str, colour: str, text: str = "") -> WorldObject:
    return WorldObject(label="it", kind=kind, colour=colour, position=(0.0, 0.0, 0.0), id="it", text=text)


@pytest.mark.parametrize(
    ("asked", "kind", "colour", "text", "unlike"),
    [
        ("apple juice", "carton", "orange", "ORANGE / JUICE", True),
        ("apple juice", "bottle", "yellow", "APPLE / JUICE", False),
        ("orange juice", "carton", "orange", "JUICE", False),
        ("green tea", "box", "white", "green tea", False), ("green tea", "box", "white", "black tea", True),
        ("the tomato soup", "can", "blue", "", False),
    ],
)  # fmt: skip
def test_a_colour_or_fruit_that_was_said_is_printed_on_the_thing_or_is_its_own(
    asked: str, kind: str, colour: str, text: str, unlike: bool
) -> None:
    o = seen(kind, colour, text)
    assert unlike_said(o, asked.split(), lambda word: likeness([word], text) >= SURE) is unlike
