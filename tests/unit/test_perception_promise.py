"""Which objects are worth a nearer look when something is asked for by its print."""

import pytest

from common.config import config_dir
from common.household import Household, load_words, mapped
from common.messages import WorldObject
from common.scene import load_scene
from services.perception.naming.promise import PROMISING, promise
from services.perception.naming.sights import LEGIBLE, ROUGHLY, Sight
from services.perception.naming.text import Line

pytest.importorskip("rapidfuzz", reason="the extra `ocr`")

HOME: Household = mapped(load_scene("apartment"), load_words(config_dir()))
MET = Sight(legible=LEGIBLE, read_from=[0.0])


def seen(kind: str, colour: str = "white", text: str = "", **kinds: float) -> WorldObject:
    return WorldObject(
        label=f"{colour} {kind}", kind=kind, colour=colour, position=(1.0, 0.0, 0.8), id="object-1", measured=True,
        kinds=[kind, *kinds], colours=[colour], kind_shares={kind: 0.8, **kinds}, colour_shares={colour: 1.0},
        text=text,
    )  # fmt: skip


def told(text: str, legible: float = LEGIBLE) -> Sight:
    return Sight(legible=legible, lines=[Line(text, 0.95)], read_from=[0.0] if legible >= LEGIBLE else [])


@pytest.mark.parametrize(
    ("query", "words", "o", "sight", "promising"),
    [
        ("lemonade", ["lemonade"], seen("can"), None, True),
        ("lemonade", ["lemonade"], seen("bottle", can=0.2), MET, True),
        ("lemonade", ["lemonade"], seen("tool", bottle=0.1), None, False),
        ("lemonade", ["lemonade"], seen("thing"), None, False),
        ("lemonade", ["lemonade"], seen("can", text="BEANS"), told("BEANS"), False),
        ("lemonade", ["lemonade"], seen("can", text="BEANS"), told("BEANS", ROUGHLY), False),
        # From far away words are taken for others.
        ("lemonade", ["lemonade"], seen("can", text="BEANS"), told("BEANS", ROUGHLY - 1.0), True),
        ("lemonade", ["lemonade"], seen("can", text="LEMO"), told("LEMO"), True),
        ("lemonade", ["lemonade"], seen("can", text="LEMONABE"), told("LEMONABE"), True),
        # Nothing tells what it looks like: a pack first, then what has print now and then.
        ("zest", ["zest"], seen("box"), None, True),
        ("zest", ["zest"], seen("mug"), None, False),
        ("zest", ["zest"], seen("box"), MET, False),
        ("zest", ["zest"], seen("box"), Sight(legible=ROUGHLY), False),
        ("zest", ["zest"], seen("box"), Sight(legible=ROUGHLY - 1.0), True),
        ("zest", ["zest"], seen("box", text="NEW"), told("NEW"), True),
        ("zest mug", ["zest"], seen("mug"), None, True),
        ("ketchup", ["ketchup"], seen("bottle", "red"), None, True),
        ("ketchup", ["ketchup"], seen("bottle", "white"), None, True),
        ("tomato sauce", ["tomato", "sauce"], seen("can", "green"), None, True),
        ("apple juice", ["apple", "juice"], seen("bottle", "white"), None, True),
        ("corn flakes", ["corn", "flakes"], seen("box", "white"), None, True),
    ],
)  # fmt: skip
def test_what_promises_most_is_looked_at_first(
    query: str, words: list[str], o: WorldObject, sight: Sight | None, promising: bool
) -> None:
    found = promise(query, words, o, sight, HOME)
    assert found > 0.0 and (found >= PROMISING) is promising


def test_neither_another_kind_nor_what_was_read_from_all_sides_is_looked_at() -> None:
    everywhere = Sight(legible=LEGIBLE, read_from=[0.0, 2.0, 4.0])
    assert promise("water", ["water"], seen("book"), None, HOME) == 0.0
    assert promise("lemonade", ["lemonade"], seen("can"), everywhere, HOME) == 0.0


@pytest.mark.parametrize(("query", "usual", "other"), [("green tea", "green", "white"), ("ketchup", "red", "white")])
def test_the_colour_that_was_said_or_is_usual_comes_first(query: str, usual: str, other: str) -> None:
    kind = "bottle" if query == "ketchup" else "box"
    one, another = (promise(query, query.split(), seen(kind, c), None, HOME) for c in (usual, other))
    assert one > another > 0.0
