"""How well words fit an object by its looks, and what follows: brought, asked about, or passed over."""

import pytest

from common.config import config_dir
from common.household import Household, load_words, mapped
from common.messages import WorldObject
from common.naming.likeness import LEAST, LIKELY, PLAIN, ROUGHLY, describes, likeness, looks_like, other_goods, partly
from common.scene import load_scene
from services.perception.grounding import ground, parsed, possible

HOUSEHOLD: Household = mapped(load_scene("apartment"), load_words(config_dir()))


def measured(label: str, kinds: dict[str, float], colours: dict[str, float], name: str = "object-1") -> WorldObject:
    colour, kind = label.split()[:2]
    return WorldObject(
        label=label, kind=kind, colour=colour, position=(1.0, 0.0, 0.8), id=name, on="desk", measured=True,
        kinds=list(kinds), colours=list(colours), kind_shares=kinds, colour_shares=colours,
    )  # fmt: skip


APPLE = measured("yellow apple", {"apple": 0.5, "ball": 0.45}, {"yellow": 0.6, "green": 0.4})
BALL = measured("red ball", {"ball": 0.5, "apple": 0.5}, {"red": 1.0})
CAN = measured("grey can", {"can": 0.7, "jar": 0.3}, {"grey": 0.65, "white": 0.35})
DUCK = measured("yellow box", {"box": 0.8, "carton": 0.2}, {"yellow": 0.8, "orange": 0.2})
TIN = measured("white can", {"can": 1.0}, {"white": 0.6, "red": 0.4})

SPOUT = measured("white ball", {"ball": 0.3, "tool": 0.25, "toy": 0.2, "carton": 0.15, "box": 0.1}, {"white": 1.0})
ORANGE = measured("orange orange", {"orange": 0.6, "ball": 0.4}, {"orange": 1.0})
BRUSH = measured("orange tool", {"tool": 0.6, "box": 0.4}, {"orange": 1.0})


@pytest.mark.parametrize(
    ("words", "seen", "low", "high"),
    [
        ("yellow apple", APPLE, PLAIN, 1.0),
        ("yellow ball", APPLE, LIKELY, PLAIN),
        ("red ball", BALL, PLAIN, 1.0),
        ("red apple", BALL, LIKELY, 0.99 * PLAIN),
        ("green apple", APPLE, LIKELY, PLAIN),
        ("red apple", APPLE, 0.0, LEAST),
        ("yellow mug", APPLE, 0.0, LEAST),
        ("grey can", CAN, PLAIN, 1.0),
        ("white can", CAN, LIKELY, PLAIN),
        ("grey mug", CAN, LEAST, LIKELY),
        ("black can", CAN, LEAST, LIKELY),
        ("black mug", CAN, 0.0, LEAST),
        ("white can", TIN, PLAIN, 1.0),
        ("red can", TIN, LIKELY, PLAIN),
        ("something white", TIN, PLAIN, 1.0),
        ("vitamin can", TIN, 0.0, LEAST),
        ("orange", ORANGE, PLAIN, 1.0),
        ("orange ball", ORANGE, LIKELY, PLAIN),
        ("orange", BRUSH, 0.0, LEAST),
    ],
)
def test_likeness(words: str, seen: WorldObject, low: float, high: float) -> None:
    assert low <= likeness(words, seen, HOUSEHOLD) <= high


@pytest.mark.parametrize(("words", "fits"), [("orange brush", True), ("orange remote", True), ("blue brush", False)])
def test_a_word_for_a_fruit_and_a_colour_is_the_colour_before_another(words: str, fits: bool) -> None:
    assert (partly(words, BRUSH, HOUSEHOLD) >= LIKELY) is fits


def test_a_pack_is_read_from_near_whatever_colour_it_has_and_asked_about_in_its_own_alone() -> None:
    brown = measured("brown can", {"can": 0.5, "bottle": 0.15}, {"brown": 0.6, "grey": 0.4})
    assert looks_like("ketchup", brown, HOUSEHOLD, packed=True) >= LEAST > looks_like("ketchup", brown, HOUSEHOLD)
    assert looks_like("red ketchup", CAN, HOUSEHOLD, packed=True) < LEAST, "that colour was said"
    assert looks_like("ketchup", DUCK, HOUSEHOLD, packed=True) < LEAST, "that is no bottle"
    assert partly("ketchup", brown, HOUSEHOLD) == 0.0


def test_what_does_not_plainly_fit_is_not_found_and_may_be_meant() -> None:
    for words, label in (("green apple", "yellow apple"), ("white can", "white can")):
        objects = [APPLE, CAN, TIN]
        found = ground(words, objects, HOUSEHOLD, (0.0, 0.0, 0.0), {}).found
        assert (found.label if found else "") == ("" if label == "yellow apple" else label)
        assert possible(parsed(words, HOUSEHOLD, {}), objects, HOUSEHOLD)[0].label == label


def test_two_that_look_alike_are_both_asked_about() -> None:
    other = measured("white can 2", {"can": 1.0}, {"white": 1.0}, "object-2")
    result = ground("white can", [TIN, other], HOUSEHOLD, (0.0, 0.0, 0.0), {})
    assert result.found is None and result.candidates == ["white can", "white can 2"]
    assert {p.id for p in result.perhaps} == {"object-1", "object-2"}


def test_a_label_is_enough_for_what_was_put_down() -> None:
    mug = measured("red mug", {"can": 0.8, "mug": 0.2}, {"red": 1.0})
    assert ground("red mug", [mug], HOUSEHOLD, (0.0, 0.0, 0.0), {}).found is None
    assert ground("red mug", [mug], HOUSEHOLD, (0.0, 0.0, 0.0), {}, least=0.0).found is mug


@pytest.mark.parametrize(
    ("words", "seen", "low", "high"),
    [
        ("striped grey can", CAN, LIKELY, PLAIN),
        ("my favourite can", TIN, LIKELY, PLAIN),
        ("striped mug", TIN, 0.0, LEAST),
        ("vitamin can", TIN, LIKELY, PLAIN),
        ("yellow toy car", DUCK, LEAST, LIKELY),
        ("duck", DUCK, LEAST, LIKELY),
        ("soup", TIN, LIKELY, PLAIN),
        ("soap", TIN, 0.0, LEAST),
        ("red tomato", TIN, 0.0, LEAST),
        ("vitamins", TIN, 0.0, LEAST),
        ("white can", TIN, 0.0, LEAST),
        ("teapot", SPOUT, ROUGHLY, LIKELY),
        ("magnifying glass", DUCK, LEAST, 0.1),
        ("orange watering can", BRUSH, LEAST, 0.1),
        ("green watering can", BRUSH, 0.0, 0.0),
        ("white teapot", SPOUT, ROUGHLY, LIKELY),
    ],
)
def test_words_that_say_nothing_of_looks_are_asked_about(
    words: str, seen: WorldObject, low: float, high: float
) -> None:
    assert low <= partly(words, seen, HOUSEHOLD) <= high


def test_what_has_other_words_on_it_is_not_asked_about() -> None:
    tin = measured("white can", {"can": 1.0}, {"white": 1.0})
    tin.text = "CORN"
    assert partly("vitamin can", tin, HOUSEHOLD) == 0.0 < partly("old can", tin, HOUSEHOLD)
    assert 0.0 < partly("soup", tin, HOUSEHOLD) < LIKELY < partly("old can", tin, HOUSEHOLD)


def test_a_name_that_says_nothing_of_looks_may_be_any_pack_but_one_of_other_goods() -> None:
    plain = measured("white can", {"can": 1.0}, {"white": 1.0})
    odd = measured("white thing", {"thing": 0.5, "bottle": 0.5}, {"white": 1.0})
    assert (
        LEAST
        <= partly("gizmo", plain, HOUSEHOLD)
        < partly("gizmo", odd, HOUSEHOLD)
        < partly("old can", plain, HOUSEHOLD)
    )
    assert partly("gizmo", APPLE, HOUSEHOLD) == 0.0, "an apple goes by its kind"
    plain.text = "BLUES C"
    assert partly("gizmo", plain, HOUSEHOLD) >= LEAST, "a brand says nothing of what it is"
    plain.text = "CORN"
    assert partly("gizmo", plain, HOUSEHOLD) == 0.0, "it says what it is"


@pytest.mark.parametrize("words", ["gizmo", "tape measure", "my old gizmo", "soap dish"])
def test_what_looks_like_no_kind_is_asked_about_first_under_an_unknown_name(words: str) -> None:
    mug, book = measured("white mug", {"mug": 0.9, "cup": 0.1}, {"white": 1.0}), measured("red book", {"book": 1.0}, {})
    odd = measured("orange banana", {"banana": 0.25, "tool": 0.25, "box": 0.2, "toy": 0.2}, {"orange": 1.0})
    assert partly(words, odd, HOUSEHOLD) > partly(words, mug, HOUSEHOLD) >= LEAST
    assert partly(words, odd, HOUSEHOLD) > partly(words, book, HOUSEHOLD) >= LEAST
    assert partly(words, APPLE, HOUSEHOLD) == 0.0


def test_what_is_plainly_of_a_kind_is_asked_about_late_as_a_tool() -> None:
    mug = measured("white mug", {"mug": 0.9, "cup": 0.1}, {"white": 1.0})
    box = measured("white box", {"box": 0.3, "block": 0.3, "book": 0.3}, {"white": 1.0})
    odd = measured("white box", {"box": 0.3, "block": 0.3, "tool": 0.3}, {"white": 1.0})
    fits = [partly("spatula", o, HOUSEHOLD) for o in (mug, box, odd)]
    assert LEAST <= fits[0] < fits[1] < LIKELY <= fits[2]


def test_a_ball_of_wool_is_a_ball() -> None:
    ball = measured("pink ball", {"ball": 0.6, "can": 0.4}, {"pink": 1.0})
    can = measured("pink can", {"can": 1.0}, {"pink": 1.0})
    phrase = parsed("the ball of wool from the desk", HOUSEHOLD, {})
    assert (phrase.thing, phrase.place) == ("wool ball", "desk")
    (first,) = possible(phrase, [can, ball], HOUSEHOLD)
    assert first.label == "pink ball" and first.likeness >= LIKELY


def test_what_has_the_shape_of_no_kind_may_be_of_any() -> None:
    odd = measured("white thing", {"thing": 0.6, "bottle": 0.4}, {"white": 1.0})
    assert LEAST <= likeness("white mug", odd, HOUSEHOLD) < LIKELY
    assert likeness("red mug", odd, HOUSEHOLD) < LEAST
    assert LEAST <= partly("teapot", odd, HOUSEHOLD) < LIKELY


@pytest.mark.parametrize(
    ("phrase", "says"),
    [
        ("the red mug", True),
        ("teacup", True),
        ("something to drink", True),
        ("blue thing", True),
        ("the pear", True),
        ("the gizmo", False),
    ],
)
def test_which_words_say_what_a_thing_looks_like(phrase: str, says: bool) -> None:
    assert describes(phrase, HOUSEHOLD) is says


def test_a_colour_between_two_may_be_either_and_is_asked_about() -> None:
    tin = measured("white can", {"can": 1.0}, {"white": 0.8, "red": 0.2})
    for phrase in ("beige can", "the cream can", "something beige", "beige thing"):
        assert likeness(phrase, tin, HOUSEHOLD) == 0.0 and LIKELY < partly(phrase, tin, HOUSEHOLD) < PLAIN
    cheese = measured("blue box", {"box": 1.0}, {"blue": 1.0})
    assert looks_like("cream cheese", cheese, HOUSEHOLD) == looks_like("hand cream", tin, HOUSEHOLD) == 1.0
    assert partly("turquoise can", tin, HOUSEHOLD) == partly("beige mug", BALL, HOUSEHOLD) == 0.0
    assert ground("beige can", [tin], HOUSEHOLD, (0.0, 0.0, 0.0), {}).found is None


def test_what_has_one_of_two_colours_may_have_one_between_them() -> None:
    for shade, asked in (("orange", True), ("red", False), ("green", False)):
        baked = measured(f"{shade} toy", {"toy": 0.5, "tool": 0.4, "carton": 0.1}, {shade: 1.0})
        assert (partly("croissant", baked, HOUSEHOLD) >= LIKELY) == asked, shade


def test_one_is_a_word_for_anything() -> None:
    found = ground("the red one", [BALL, TIN], HOUSEHOLD, (0.0, 0.0, 0.0), {})
    assert found.found is not None and found.found.label == "red ball"
    assert likeness("white one", TIN, HOUSEHOLD) >= PLAIN


@pytest.mark.parametrize(
    ("phrase", "kind", "fits"),
    [
        ("tomato sauce", "can", True), ("tomato sauce", "apple", False), ("apple juice", "bottle", True),
        ("apple juice", "apple", False), ("pepper mill", "bottle", True), ("soup can", "can", True),
        ("can of soup", "can", True), ("chocolate milk", "carton", True), ("pickle", "jar", True),
        ("corn flakes", "box", True), ("lemon", "lemon", True), ("lemon tea", "box", True),
    ],
)  # fmt: skip
def test_the_last_word_says_what_it_is(phrase: str, kind: str, fits: bool) -> None:
    thing = measured(f"white {kind}", {kind: 1.0}, {"white": 1.0})
    assert (looks_like(phrase, thing, HOUSEHOLD, packed=True) >= LEAST) is fits


def test_a_colour_that_is_said_goes_before_the_usual_one() -> None:
    blue = measured("blue toy", {"toy": 1.0}, {"blue": 1.0})
    assert looks_like("blue duck", blue, HOUSEHOLD) > LIKELY > looks_like("duck", blue, HOUSEHOLD)


def test_for_a_name_that_tells_nothing_what_has_no_shape_is_asked_about_first() -> None:
    tin, tool = measured("white can", {"can": 1.0}, {"white": 1.0}), measured("grey tool", {"tool": 1.0}, {"grey": 1.0})
    assert partly("tongs", tool, HOUSEHOLD) > partly("tongs", tin, HOUSEHOLD) >= LEAST


def test_a_brand_says_nothing_against_a_pack_and_other_goods_do() -> None:
    tin = measured("red can", {"can": 1.0}, {"red": 1.0})
    plain = partly("tomato sauce", tin, HOUSEHOLD)
    tin.text = "MELISSA"
    assert other_goods("tomato sauce", "MELISSA / Sauce / Nutrition", HOUSEHOLD) == []
    assert partly("tomato sauce", tin, HOUSEHOLD) == plain > LIKELY
    tin.text = "BAKED BEANS"
    assert other_goods("bean soup", tin.text, HOUSEHOLD) == [] != other_goods("tomato sauce", tin.text, HOUSEHOLD)
    assert 0.0 < partly("tomato sauce", tin, HOUSEHOLD) < LIKELY


def test_what_has_nothing_of_the_colour_of_what_it_is_made_of_is_asked_about_later() -> None:
    red, black = (measured(f"{c} bottle", {"bottle": 1.0}, {c: 1.0}) for c in ("red", "black"))
    assert partly("tomato sauce", red, HOUSEHOLD) > LIKELY > partly("tomato sauce", black, HOUSEHOLD) > LEAST
    assert partly("bbq sauce", black, HOUSEHOLD) == partly("tomato sauce", red, HOUSEHOLD)


@pytest.mark.parametrize("phrase", ["magnifying glass", "bottle opener", "can opener", "mug tree", "coffee maker"])
def test_a_word_before_the_last_may_make_it_another_thing(phrase: str) -> None:
    odd = measured("yellow banana", {"banana": 0.4, "tool": 0.32, "toy": 0.28}, {"yellow": 1.0})
    named = [k for k in ("can", "bottle", "mug") if k in phrase]
    for_it = [measured(f"white {kind}", {kind: 1.0}, {"white": 1.0}) for kind in named]
    assert partly(phrase, odd, HOUSEHOLD) >= LEAST
    assert all(likeness(phrase, o, HOUSEHOLD) == 0.0 for o in for_it)
    assert all(partly(phrase, o, HOUSEHOLD) < partly(phrase, odd, HOUSEHOLD) for o in for_it)


def test_a_thing_of_no_shape_may_be_what_is_told_to_look_like_a_mug() -> None:
    teapot = measured("blue toy", {"toy": 0.56, "tool": 0.31, "carton": 0.13}, {"blue": 1.0})
    assert LEAST < partly("teapot", teapot, HOUSEHOLD) < LIKELY
    assert partly("teapot", measured("blue box", {"box": 1.0}, {"blue": 1.0}), HOUSEHOLD) == 0.0


def test_a_cup_goes_by_the_word_for_a_mug() -> None:
    cup = measured("yellow cup", {"cup": 0.6, "jar": 0.4}, {"yellow": 1.0})
    assert partly("egg mug", cup, HOUSEHOLD) > LIKELY and LIKELY < likeness("mug", cup, HOUSEHOLD) < PLAIN


@pytest.mark.parametrize(
    ("phrase", "like", "unlike"),
    [
        ("elephant", "toy", "book"),
        ("hair dryer", "tool", "book"),
        ("snow globe", "ball", "book"),
        ("lunchbox", "box", "ball"),
    ],
)
def test_household_words_say_what_a_thing_may_look_like(phrase: str, like: str, unlike: str) -> None:
    fits, other = (
        measured(f"blue {like}", {like: 1.0}, {"blue": 1.0}),
        measured("blue one", {unlike: 1.0}, {"blue": 1.0}),
    )
    assert looks_like(phrase, fits, HOUSEHOLD) > looks_like(phrase, other, HOUSEHOLD)
