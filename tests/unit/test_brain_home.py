"""The brain keeps names of places, rules and sightings: by speech, by clients, on disk."""

from pathlib import Path
from typing import Any

import msgspec
import pytest

from common import messages as m
from common import topics
from common.bus.memory import MemoryBus, MemoryIo
from common.household import load_household
from services.brain.config import BrainConfig
from services.brain.home.keeper import HouseholdKeeper
from services.brain.home.part_meant import room_around
from services.brain.home.sighting_log import MAX_ROWS, VISIT, SightingLog
from services.brain.home.told import edit_told
from services.brain.service import BrainService
from tests.unit.brain_bench import Bench
from tests.unit.test_brain_vla import answer_plan, asked

HOME = load_household("apartment")
COUNTER = HOME.receptacle("counter")


def brain_io(folder: Path | None = None, bus: MemoryBus | None = None) -> MemoryIo:
    io = MemoryIo(
        bus or MemoryBus(),
        "brain",
        topics.subscribed("brain"),
        topics.published("brain"),
        household=HOME,
        lockstep=False,
    )
    io.state_dir = folder
    return io


def before(name: str) -> tuple[float, float, float]:
    """A pose from which the robot looks at a surface."""
    r = HOME.receptacle(name)
    assert r is not None
    ax, ay = r.approach[0]
    dx, dy = r.outline.direction(ax, ay)
    reach = (r.size[0] if ax else r.size[1]) / 2 + 0.5
    import math

    return r.center[0] + dx * reach, r.center[1] + dy * reach, math.atan2(-dy, -dx)


def keeper(io: MemoryIo, pose: tuple[float, float, float] = (0.0, 0.0, 0.0)) -> HouseholdKeeper:
    kept = HouseholdKeeper(io)
    kept.pose = pose
    return kept


def test_this_is_what_the_robot_stands_before() -> None:
    io = brain_io()
    result = keeper(io, before("counter")).apply(m.HouseholdEdit(do="name", name="breakfast bar"))
    assert result == m.EditResult(goal_id="", ok=True, name="breakfast bar", part="counter", kind="surface")
    bar = io.household.receptacle("breakfast bar")
    assert bar is not None and COUNTER is not None and bar.center == COUNTER.center


def test_before_no_surface_nothing_is_named() -> None:
    io = brain_io()
    here = HOME.rooms[0]
    middle = (here.low[0] + 0.5, here.low[1] + 0.5, 0.0)
    result = keeper(io, middle).apply(m.HouseholdEdit(do="name", name="desk lamp stand", part="spaceship"))
    assert (result.ok, result.code) == (False, "NO_PART")


def test_a_name_that_means_something_else_is_refused_and_one_that_was_given_moves() -> None:
    io = brain_io()
    kept = keeper(io, before("counter"))
    assert kept.apply(m.HouseholdEdit(do="name", name="mug", kind="surface")).code == "NAME_TAKEN"
    assert kept.apply(m.HouseholdEdit(do="name", name="bookshelf")).code == "NAME_TAKEN"
    assert kept.apply(m.HouseholdEdit(do="name", name="workbench")).ok
    kept.pose = before("kitchen table")
    assert kept.apply(m.HouseholdEdit(do="name", name="workbench")).part == "kitchen table"
    assert io.household.receptacle("counter") is not io.household.receptacle("workbench")
    assert [n.part for n in kept.edits.names] == ["kitchen table"]


def test_a_part_has_one_given_name() -> None:
    kept = keeper(brain_io(), before("counter"))
    for name in ("worktop", "breakfast bar"):
        assert kept.apply(m.HouseholdEdit(do="name", name=name, kind="surface")).ok
    assert [n.name for n in kept.edits.names] == ["breakfast bar"]
    assert kept.apply(m.HouseholdEdit(do="name", name="island", part="breakfast bar")).part == "breakfast bar"
    assert [(n.name, n.part) for n in kept.edits.names] == [("island", "counter")]


def test_rooms_by_where_the_robot_stands_and_by_a_click() -> None:
    io = brain_io()
    kitchen = HOME.rooms[0]
    inside = (kitchen.low[0] + 1.0, kitchen.low[1] + 1.0, 0.0)
    assert keeper(io, inside).apply(m.HouseholdEdit(do="name", name="den")).part == kitchen.name
    clicked = m.HouseholdEdit(do="name", name="music room", position=(*HOME.rooms[1].low, 0.0))
    assert keeper(io).apply(clicked).kind in ("room", "surface")


def test_a_click_on_a_surface_names_it() -> None:
    io = brain_io()
    assert COUNTER is not None
    edit = m.HouseholdEdit(do="name", name="bar", position=COUNTER.center)
    assert keeper(io).apply(edit).part == "counter"


def test_places_to_stand_are_renamed_and_forgotten() -> None:
    io = brain_io()
    kept = keeper(io, (1.0, 2.0, 0.5))
    assert kept.apply(m.HouseholdEdit(do="name", name="charging spot")).kind == "place"
    assert kept.apply(m.HouseholdEdit(do="name", name="dock", part="charging spot")).ok
    assert [(n.name, n.pose) for n in kept.edits.names] == [("dock", (1.0, 2.0, 0.5))]
    assert kept.apply(m.HouseholdEdit(do="forget", name="the dock")).ok
    assert kept.apply(m.HouseholdEdit(do="forget", name="dock")).code == "UNKNOWN_NAME"


def test_what_was_told_is_there_after_a_kill(tmp_path: Path) -> None:
    first = keeper(brain_io(tmp_path), before("counter"))
    first.apply(m.HouseholdEdit(do="name", name="breakfast bar", kind="surface"))
    rule = m.TidyRule(things="mugs", to=["breakfast bar"], kinds=["mug"])
    assert first.apply(m.HouseholdEdit(do="rule", rule=rule)).part == "breakfast bar"
    io = brain_io(tmp_path)  # nothing was closed
    again = keeper(io)
    assert again.edits == first.edits
    assert again.edits.rules[0].to == ["counter"]
    assert io.household.words.tidy[0].kinds == ("mug",)


def test_what_the_disk_refuses_is_not_acknowledged(tmp_path: Path) -> None:
    kept = keeper(brain_io(tmp_path / "state"), before("counter"))
    (tmp_path / "state").write_text("a file where the folder should be")
    result = kept.apply(m.HouseholdEdit(do="name", name="bar", kind="surface"))
    assert (result.ok, result.code) == (False, "NOT_KEPT")
    assert kept.edits.names == []


def test_a_file_that_cannot_be_read_is_kept_aside(tmp_path: Path) -> None:
    (tmp_path / "household-apartment.json").write_text('{"names": 3}')
    assert keeper(brain_io(tmp_path)).edits == m.HouseholdEdits()
    assert (tmp_path / "household-apartment.unreadable").exists()


def test_rules_replace_each_other_and_are_taken_back() -> None:
    kept = keeper(brain_io())
    for to in ("counter", "bookshelf"):
        assert kept.apply(m.HouseholdEdit(do="rule", rule=m.TidyRule(things="mugs", to=[to], kinds=["mug"]))).ok
    assert [r.to for r in kept.edits.rules] == [["bookshelf"]]
    assert kept.apply(m.HouseholdEdit(do="forget rule", name="cans")).code == "NO_RULE"
    assert kept.apply(m.HouseholdEdit(do="forget rule")).name == "mugs"
    assert kept.apply(m.HouseholdEdit(do="forget rule")).code == "NO_RULE"
    nowhere = m.TidyRule(things="mugs", to=["moon"], kinds=["mug"])
    assert kept.apply(m.HouseholdEdit(do="rule", rule=nowhere)).code == "NO_RULE"


@pytest.mark.parametrize("pipeline", ["fetch", "vla"])
def test_clients_name_places_in_both_pipelines(pipeline: Any) -> None:
    bench = Bench(BrainConfig(pipeline=pipeline))
    edit = m.HouseholdEdit(do="name", name="worktop", part="counter", id="cli-1")
    bench.send(topics.HOUSEHOLD_EDIT, edit)
    bench.send(topics.HOUSEHOLD_EDIT, edit)
    bench.step()
    assert [(r.goal_id, r.ok, r.part) for r in bench.sent(topics.HOUSEHOLD_EDITED)] == [("cli-1", True, "counter")] * 2
    assert bench.last(topics.HOUSEHOLD_EDITS).names[0].part == "counter"
    given = [p for p in bench.last(topics.HOUSEHOLD_PARTS).parts if p.given]
    assert [(p.name, p.kind) for p in given] == [("worktop", "surface")]


def test_said_names_are_kept_and_said_again() -> None:
    bench = asked("call the counter the worktop", enable_confirmation=False)
    answer_plan(bench, 1, [m.PlanStep(action="name", object="counter", text="worktop")])
    bench.until(lambda: any("worktop" in text for text in bench.texts(topics.SPEECH_GOAL)))
    assert bench.last(topics.HOUSEHOLD_EDITS).names[0].name == "worktop"


@pytest.mark.parametrize(
    ("text", "edit"),
    [
        ("this is the kitchen", m.HouseholdEdit(do="name", name="kitchen", kind="room")),
        ("Please call this table the workbench.", m.HouseholdEdit(do="name", name="workbench", kind="surface")),
        ("rename the counter to worktop", m.HouseholdEdit(do="name", name="worktop", part="counter")),
        ("forget that rule", m.HouseholdEdit(do="forget rule")),
        ("bring me the red mug", None),
        ("the mug goes on the counter", None),
        ("this is my vitamin box", None),
        ("come back", None),
    ],
)
def test_what_a_sentence_tells_of_the_home(text: str, edit: m.HouseholdEdit | None) -> None:
    assert edit_told(text, HOME) == edit


def test_without_a_planner_names_and_rules_are_kept_as_well() -> None:
    bench = Bench(BrainConfig(pipeline="fetch"))
    bench.hear("mugs go on the counter")
    bench.until(lambda: bench.state.last is not None)
    assert bench.outcome == "delivered"
    assert [r.things for r in bench.last(topics.HOUSEHOLD_EDITS).rules] == ["mugs"]
    assert any("mugs go on the counter from now on" in text for text in bench.texts(topics.SPEECH_GOAL))
    assert not bench.count(topics.NAVIGATION_GOAL)


def test_without_a_planner_a_refusal_is_an_error_that_is_spoken() -> None:
    bench = Bench(BrainConfig(pipeline="fetch"))
    bench.hear("call the counter the mug")
    bench.until(lambda: bench.state.last is not None)
    assert bench.state.last is not None and bench.state.last.code == "NAME_TAKEN"


def test_a_room_without_a_map_ends_at_its_walls() -> None:
    low, high = room_around(HOME, *((HOME.rooms[0].low[i] + HOME.rooms[0].high[i]) / 2 for i in (0, 1)))
    room = HOME.rooms[0]
    assert all(abs(a - b) < 0.35 for a, b in zip((*low, *high), (*room.low, *room.high), strict=True))


# --- what was seen where
def seen(label: str, on: str, t: float, number: int = 1, **more: Any) -> m.WorldObjects:
    one = m.WorldObject(
        label=label, kind="mug", colour="red", position=(1, 1, 1), on=on, seen_at=t, id=f"o{number}", **more
    )
    return m.WorldObjects(t=t, objects=[one])


def watch(io: MemoryIo, log: SightingLog, report: m.WorldObjects) -> None:
    io.bus.send(topics.WORLD_OBJECTS, report)
    io.begin(None, report.t)
    log.step(report.t)


def test_a_thing_counts_once_a_visit() -> None:
    io = brain_io()
    log = SightingLog(io)
    for t in (1.0, 2.0, 3.0, VISIT + 5.0):
        watch(io, log, seen("red mug 2", "counter", t, names=["sunrise"]))
    rows = {(s.thing, s.part): round(s.weight, 1) for s in log.rows}
    assert rows == {("red mug", "counter"): 2.0, ("sunrise", "counter"): 2.0}


def test_held_and_doubtful_things_are_nowhere() -> None:
    io = brain_io()
    log = SightingLog(io)
    watch(io, log, seen("red mug", "counter", 1.0, held=True))
    watch(io, log, seen("red mug", "counter", 2.0, confidence=0.3))
    assert not log.rows


def test_sightings_outlive_the_process_and_stay_few(tmp_path: Path) -> None:
    io = brain_io(tmp_path)
    log = SightingLog(io)
    for n in range(MAX_ROWS + 30):
        watch(io, log, seen(f"thing-{n}", "counter", float(n), number=n))
    log.save(1e6)
    assert len(log.rows) == MAX_ROWS
    assert len(SightingLog(brain_io(tmp_path)).rows) == MAX_ROWS


def test_what_was_seen_is_found_again_in_a_home_that_was_mapped_anew(tmp_path: Path) -> None:
    assert COUNTER is not None
    x, y, z = COUNTER.center
    row = m.Sighting(
        thing="red mug", kind="mug", colour="red", part="table 9", weight=3.0, last=1.0, position=(x, y, z)
    )
    (tmp_path / "sightings-apartment.json").write_bytes(msgspec.json.encode(m.Sightings(t=1.0, sightings=[row])))
    assert [(s.part, s.weight) for s in SightingLog(brain_io(tmp_path)).rows] == [("counter", 3.0)]


def test_a_renamed_surface_is_the_same_surface() -> None:
    io = brain_io()
    kept, log = keeper(io), SightingLog(io)
    kept.apply(m.HouseholdEdit(do="name", name="worktop", part="counter"))
    watch(io, log, seen("red mug", "worktop", 1.0))
    assert [s.part for s in log.rows] == ["counter"]


def test_the_service_closes_with_its_sightings_saved(tmp_path: Path) -> None:
    io = brain_io(tmp_path)
    brain = BrainService(BrainConfig(journal=""), io)
    io.bus.send(topics.WORLD_OBJECTS, seen("red mug", "counter", 1.0))
    io.begin(None, 1.0)
    brain.context.sightings.step(1.0)
    brain.close()
    assert [s.thing for s in SightingLog(brain_io(tmp_path)).rows] == ["red mug"]
