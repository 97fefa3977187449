"""What stands on every pack says nothing of one of them."""

import pytest

from common.naming.small_print import telling


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("Nutrition Facts / Serving Size 1 cup", []), ("NUTRITI0N FACTS", []), ("Ingredients:", []), ("", []),
        ("ALPHABET / SOUP", ["alphabet", "soup"]), ("tea 400 g 2024", []), ("VITAMINS", ["vitamins"]),
        ("calorles from fat", []), ("SWEET CORN / keep cool", ["sweet", "corn"]),
        ("CCCO / IIIIII", []), ("COCOA", ["cocoa"]),
    ],
)  # fmt: skip
def test_only_what_says_what_a_pack_is_is_telling(text: str, words: list[str]) -> None:
    assert telling(text) == words
