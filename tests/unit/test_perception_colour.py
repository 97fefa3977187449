"""Colours in words: goods that are in no scene, in other light, of several colours."""

import numpy as np
import pytest

from services.perception.views.colour import light, main_words, name, shares

GOODS = {
    "cardboard": ((0.72, 0.55, 0.38), "brown"),
    "maroon": ((0.5, 0.05, 0.1), "red"),
    "navy": ((0.1, 0.12, 0.35), "blue"),
    "cream": ((0.95, 0.9, 0.75), "white"),
    "orange peel": ((0.9, 0.5, 0.1), "orange"),
    "tomato": ((0.85, 0.2, 0.12), "red"),
    "banana": ((0.95, 0.85, 0.3), "yellow"),
    "sky": ((0.5, 0.75, 0.95), "blue"),
    "rose": ((0.95, 0.65, 0.7), "pink"),
    "steel": ((0.5, 0.5, 0.52), "grey"),
    "paper": ((0.88, 0.87, 0.86), "white"),
    "chocolate": ((0.3, 0.18, 0.1), "brown"),
    "grass": ((0.25, 0.55, 0.2), "green"),
    "plum": ((0.4, 0.2, 0.5), "purple"),
    "beet": ((0.5, 0.05, 0.5), "purple"),
    "magenta": ((0.95, 0.2, 0.85), "pink"),
    "coal": ((0.1, 0.1, 0.11), "black"),
}


def pixels(rgb: tuple[float, float, float], count: int, seed: int = 0) -> np.ndarray:
    """Pixels in light and shade with a camera's noise."""
    rng = np.random.default_rng(seed)
    shade = rng.uniform(0.85, 1.05, (count, 1))
    return np.clip(np.array(rgb) * shade * 255 + rng.normal(0.0, 2.0, (count, 3)), 0, 255).astype(np.uint8)


@pytest.mark.parametrize(("rgb", "word"), GOODS.values(), ids=GOODS)
def test_goods_have_the_colour_that_people_call_them(rgb: tuple[float, float, float], word: str) -> None:
    assert name(np.array(rgb)) == word
    assert main_words(shares(pixels(rgb, 500), np.ones(3)))[0] == word


def test_what_has_two_colours_has_two_words_the_larger_first() -> None:
    both = np.concatenate([pixels((0.8, 0.1, 0.1), 300), pixels((0.9, 0.9, 0.9), 150)])
    assert main_words(shares(both, np.ones(3))) == ["red", "white"]


def test_a_highlight_is_no_colour() -> None:
    glossy = np.concatenate([pixels((0.1, 0.2, 0.6), 300), pixels((1.0, 1.0, 1.0), 20)])
    assert main_words(shares(glossy, np.ones(3))) == ["blue"]


def test_the_shade_of_a_yellow_thing_is_not_green() -> None:
    shaded = np.concatenate([pixels((0.9, 0.8, 0.1), 250), pixels((0.38, 0.35, 0.05), 150)])
    assert main_words(shares(shaded, np.ones(3))) == ["yellow"]


def test_what_is_dark_beside_a_white_label_is_no_shadow() -> None:
    bottle = np.concatenate([pixels((0.08, 0.22, 0.11), 300), pixels((0.88, 0.84, 0.75), 150)])
    assert main_words(shares(bottle, np.ones(3))) == ["green", "white"]


def test_at_the_limit_of_two_words_a_colour_has_both() -> None:
    vermilion = main_words(shares(pixels((0.9, 0.27, 0.1), 400), np.ones(3)))
    assert set(vermilion) == {"red", "orange"}


def test_warm_light_does_not_turn_white_things_yellow() -> None:
    warm = np.array([1.1, 1.0, 0.82])
    wall = np.clip(np.full((120, 160, 3), 0.7) * warm * 255, 0, 255).astype(np.uint8)
    gains = light(wall)
    thing = np.clip(np.array((0.9, 0.9, 0.9)) * warm * 255, 0, 255).astype(np.uint8)[None].repeat(200, 0)
    assert main_words(shares(thing, gains)) == ["white"]


def test_beige_tiles_before_a_pale_wall_are_not_taken_for_the_light() -> None:
    wall, floor = pixels((0.68, 0.68, 0.66), 60 * 160), pixels((0.57, 0.51, 0.44), 60 * 160)
    room = light(np.concatenate([wall, floor]).reshape(120, 160, 3))
    assert main_words(shares(pixels((0.66, 0.68, 0.7), 300), room)) == ["white"]


def test_a_painted_wall_is_not_taken_for_the_light() -> None:
    wall = np.full((120, 160, 3), (180, 60, 50), np.uint8)
    assert np.allclose(light(wall), 1.0)


def test_what_is_as_bright_as_the_walls_of_a_dim_room_is_white_and_half_as_bright_is_grey() -> None:
    room = light(np.broadcast_to(pixels((0.5, 0.49, 0.47), 60 * 60).reshape(60, 60, 3), (60, 60, 3)))
    assert main_words(shares(pixels((0.48, 0.48, 0.46), 300), room)) == ["white"]
    assert main_words(shares(pixels((0.27, 0.27, 0.27), 300), room)) == ["grey"]
    assert main_words(shares(pixels((0.48, 0.48, 0.46), 300), np.ones(3)))[0] == "grey"


def test_a_yellow_thing_in_a_dim_room_is_not_green() -> None:
    room = light(np.broadcast_to(pixels((0.5, 0.49, 0.47), 60 * 60).reshape(60, 60, 3), (60, 60, 3)))
    assert main_words(shares(pixels((0.38, 0.34, 0.09), 300), room))[0] == "yellow"
    assert main_words(shares(pixels((0.38, 0.34, 0.09), 300), np.ones(3)))[0] == "green"


def test_a_white_bowl_is_white_also_where_most_of_it_is_turned_from_the_lamp() -> None:
    lit, turned = pixels((0.75, 0.75, 0.73), 60), pixels((0.48, 0.48, 0.47), 240)
    assert main_words(shares(np.concatenate([lit, turned]), np.ones(3))) == ["white"]
    assert main_words(shares(pixels((0.48, 0.48, 0.47), 300), np.ones(3)))[0] == "grey"


def test_black_print_on_white_and_a_dark_lid_stay_what_they_are() -> None:
    parts = pixels((0.8, 0.8, 0.8), 150), pixels((0.08, 0.08, 0.08), 80), pixels((0.35, 0.35, 0.36), 80)
    assert set(main_words(shares(np.concatenate(parts), np.ones(3)))) == {"white", "black", "grey"}


def test_what_may_as_well_be_white_in_less_light_has_both_words() -> None:
    found = shares(pixels((0.51, 0.51, 0.5), 300), np.ones(3))
    assert main_words(found) == ["grey", "white"] and found["white"] > 0.2
    assert main_words(shares(pixels((0.62, 0.62, 0.6), 300), np.ones(3))) == ["white"]
    assert main_words(shares(pixels((0.4, 0.4, 0.4), 300), np.ones(3))) == ["grey"]


def test_grey_is_called_so_in_a_home_whose_surfaces_are_warm() -> None:
    warm = np.array([1.29, 1.31, 1.46])
    steel = np.broadcast_to(np.array([94, 100, 106], np.uint8), (300, 3))
    assert {"grey", "white"} & set(main_words(shares(steel, warm)))
    assert "blue" in main_words(shares(np.broadcast_to(np.array([90, 110, 150], np.uint8), (300, 3)), np.ones(3)))


def test_slate_is_grey_to_some_and_a_blue_sky_to_nobody() -> None:
    assert shares(pixels((0.42, 0.44, 0.53), 400), np.ones(3)).get("grey", 0.0) > 0.08
    assert "grey" not in shares(pixels((0.5, 0.75, 0.95), 400), np.ones(3))
