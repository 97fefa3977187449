"""Names that people give to parts of the home, and names for parts that nobody has named."""

import msgspec

from common import messages as m
from common import topics
from common.bus.memory import MemoryBus, MemoryIo
from common.floor_plan import Place, Receptacle, Room
from common.household import Household, load_household
from common.household_edits import edited
from common.naming.part_names import kind_named, with_part_names
from common.naming.words import Words
from common.tidy_rule import rule_about
from services.speech.recognise.grammar import vocabulary
from tests.unit.navigation_flat import Flat

APARTMENT = load_household("apartment")
ISLAND = m.PlaceName(name="island", kind="surface", part="counter")


def table(name: str, x: float, named: bool = False, kind: str = "table", colour: str = "") -> Receptacle:
    return Receptacle(name=name, kind=kind, center=(x, 0.5, 0.7), size=(0.6, 0.6), named=named, colour=colour)  # type: ignore[arg-type]


HOME = Household(
    name="mapped",
    low=(0, 0),
    high=(9, 3),
    home=Place(name="home", x=0.5, y=0.5),
    rooms=(
        Room(name="r-1", low=(0, 0), high=(3, 3), named=False),
        Room(name="r-2", low=(3, 0), high=(6, 3), named=False),
    ),
    receptacles=(
        table("s-1", 1.0),
        table("s-2", 2.0),
        table("s-3", 4.0),
        table("s-4", 5.0, kind="shelf"),
        table("s-5", 8),
    ),
    delivery="s-1",
)


def test_a_room_in_the_corner_of_an_l_is_not_the_l() -> None:
    around, inside = Room(name="l", low=(0, 0), high=(6, 6)), Room(name="nook", low=(2, 4), high=(6, 5), yaw=1.5708)
    plan = msgspec.structs.replace(HOME, rooms=(around, inside))
    found = [plan.room_at(*point) for point in ((1, 1), (4, 6), (2.5, 4.5), (4, 2.5))]
    assert [room.name if room else "" for room in found] == ["l", "nook", "l", "nook"]


def test_what_nobody_named_is_called_by_kind_and_room() -> None:
    named = edited(HOME, m.HouseholdEdits())
    assert [r.name for r in named.rooms] == ["room 1", "room 2"]
    assert [r.name for r in named.receptacles] == [
        "table 1 in room 1", "table 2 in room 1", "table in room 2", "shelf in room 2", "table",
    ]  # fmt: skip
    assert named.delivery == "table 1 in room 1"
    assert named.fault() == ""


def test_colours_tell_tables_apart_before_numbers_do() -> None:
    two = (table("s-1", 1.0, colour="white"), table("s-2", 2.0, colour="brown"))
    named = with_part_names(msgspec.structs.replace(HOME, receptacles=two, delivery=""))
    assert [r.name for r in named.receptacles] == ["white table in room 1", "brown table in room 1"]


def test_an_identifier_that_is_a_word_for_a_surface_is_a_better_word_than_the_kind() -> None:
    found = (table("low table 2", 1.0), table("sofa", 2.0, kind="counter"), table("s-9", 4.0))
    named = with_part_names(msgspec.structs.replace(HOME, receptacles=found, delivery=""))
    assert [r.name for r in named.receptacles] == ["low table in room 1", "sofa in room 1", "table in room 2"]


def test_a_room_that_is_named_names_its_surfaces() -> None:
    edits = m.HouseholdEdits(names=[m.PlaceName(name="kitchen", kind="room", part="r-2")])
    named = edited(HOME, edits)
    assert [r.name for r in named.receptacles][2:4] == ["table in the kitchen", "shelf in the kitchen"]
    assert named.receptacle("s-3") is named.receptacles[2]
    room = named.room_at(4.0, 1.0)
    assert room is not None and room.name == "kitchen"


def test_a_named_part_keeps_what_it_was_called() -> None:
    edits = m.HouseholdEdits(names=[m.PlaceName(name="breakfast bar", kind="surface", part="counter")])
    named = edited(APARTMENT, edits)
    bar = named.receptacle("breakfast bar")
    assert bar is not None and named.receptacle("counter") is bar
    assert [r.center for r in named.receptacles] == [r.center for r in APARTMENT.receptacles]


def test_rooms_and_places_that_no_map_has() -> None:
    edits = m.HouseholdEdits(
        names=[
            m.PlaceName(name="den", kind="room", low=(6, 0), high=(9, 3)),
            m.PlaceName(name="charging spot", kind="place", pose=(7.0, 1.0, 0.5)),
        ]
    )
    named = edited(HOME, edits)
    room = named.room_at(8.0, 1.0)
    assert room is not None and room.name == "den"
    assert named.receptacles[4].name == "table in the den"
    assert [(p.name, p.x) for p in named.places] == [("charging spot", 7.0)]


def test_names_of_another_home_change_nothing() -> None:
    edits = m.HouseholdEdits(names=[m.PlaceName(name="desk", kind="surface", part="s-77")])
    assert edited(HOME, edits).receptacles == edited(HOME, m.HouseholdEdits()).receptacles


def test_a_home_that_is_mapped_again_keeps_the_names_of_its_places() -> None:
    edits = m.HouseholdEdits(
        names=[
            m.PlaceName(name="desk", kind="surface", part="s-3", at=(4.0, 0.5, 0.7)),
            m.PlaceName(name="kitchen", kind="room", part="r-2", at=(4.5, 1.5, 0.0)),
        ],
        rules=[m.TidyRule(things="mugs", to=["s-3"], kinds=["mug"], at=(4.0, 0.5, 0.7))],
    )
    anew = (table("s-1", 4.1), table("s-2", 1.1), table("s-3", 8.0))
    right, left = (
        Room(name="r-1", low=(3, 0), high=(6, 3), named=False),
        Room(name="r-2", low=(0, 0), high=(3, 3), named=False),
    )
    named = edited(msgspec.structs.replace(HOME, receptacles=anew, rooms=(right, left), delivery=""), edits)
    assert [r.name for r in named.receptacles] == ["desk", "table in room 2", "table"]
    assert [r.name for r in named.rooms] == ["kitchen", "room 2"]
    to = named.receptacle(named.words.tidy[0].to[0])
    assert to is not None and to.name == "desk"


def test_the_newest_rule_comes_first() -> None:
    rules = [
        m.TidyRule(things="mugs", to=["shelf"], kinds=["mug"]),
        m.TidyRule(things="cups", to=["s-1"], kinds=["cup"]),
    ]
    tidy = edited(HOME, m.HouseholdEdits(rules=rules)).words.tidy
    assert [rule.kinds for rule in tidy] == [("cup",), ("mug",)]


def test_a_delivery_place_goes_by_its_new_name() -> None:
    edits = m.HouseholdEdits(names=[m.PlaceName(name="desk", kind="surface", part="s-1")])
    assert edited(HOME, edits).delivery == "desk"


def test_last_words_tell_rooms_from_surfaces() -> None:
    assert kind_named("kids room") == "room"
    assert kind_named("standing desk") == "surface"
    assert kind_named("my corner") == "place"
    assert kind_named("vitamin box") is None
    assert kind_named("") is None


def test_what_a_rule_is_about() -> None:
    words = APARTMENT.words
    assert rule_about("red mugs", "shelf", words) == m.TidyRule(
        things="red mugs", to=["shelf"], kinds=["mug"], colours=["red"]
    )
    assert set(rule_about("toys", "box", words).kinds) == set(words.groups["toy"])
    assert rule_about("my keys", "tray", words).names == ["keys", "key"]
    assert rule_about("", "tray", Words()).names == []


# --- who follows
def test_a_service_that_reads_the_edits_follows_them_and_another_does_not() -> None:
    bus = MemoryBus()
    follows = MemoryIo(bus, "a", (topics.HOUSEHOLD_EDITS,), (), household=APARTMENT)
    other = MemoryIo(bus, "b", (), (), household=APARTMENT)
    first = follows.household
    assert follows.household is first
    bus.send(topics.HOUSEHOLD_EDITS, m.HouseholdEdits(names=[ISLAND]))
    assert follows.household is first  # not before the next step
    for io in (follows, other):
        io.begin(5, 1.0)
    island = follows.household.receptacle("island")
    assert island is not None and follows.household.receptacle("counter") is island
    assert other.household.receptacle("island") is None and follows.loaded == APARTMENT


def test_navigation_knows_a_place_by_its_new_name() -> None:
    flat = Flat()
    flat.ask("goto island", "a.1")
    assert flat.status().code == "UNKNOWN_PLACE"
    flat.bus.send(topics.HOUSEHOLD_EDITS, m.HouseholdEdits(names=[ISLAND]))
    flat.ask("goto island", "a.2")
    assert flat.status().status == "navigating"


def test_speech_listens_for_the_new_name() -> None:
    named = edited(APARTMENT, m.HouseholdEdits(names=[ISLAND]))
    assert "island" in vocabulary(named, (), (), ())["surface"]
    assert "island" not in vocabulary(APARTMENT, (), (), ())["surface"]
