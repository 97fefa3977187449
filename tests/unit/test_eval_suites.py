"""Scenarios from seeds: repeatable one by one, and such that they can be run."""

from functools import cache

import msgspec
import pytest

from common import topics
from common.bus.codec import decode, encode
from common.config import config_dir, load, overrides
from common.files.plan_file import to_toml
from common.scene import load_scene
from evaluation.case import Case
from evaluation.faults.messages import Rule
from evaluation.homes.new import in_words_of
from evaluation.stack import replacement, service_class
from evaluation.suites import groceries
from evaluation.suites.blocks import destination
from evaluation.suites.chaos import CHAOS_SERVICES
from evaluation.suites.table import DIALOGUES, FAULTS, NAMED, SUITES, cases
from services.sim.layout import place_objects

SCENE = load_scene("apartment")


def things_missing() -> str:
    """Why the suite of scanned things cannot be drawn here, "" where it can."""
    try:
        groceries.directory()
    except groceries.AssetsMissing as missing:
        return str(missing)
    return ""


MISSING = things_missing()
LONG = ("homes", "aged", "lost", "new", "taught")
DRAWN = {s: 3 if s in LONG else 20 for s in SUITES if s != "things" or not MISSING}
"""Cases to look at, by suite: all that come in turn; homes differ by their furniture alone, and take long to draw."""


@cache
def drawn(suite: str) -> tuple[Case, ...]:
    return tuple(cases(suite, DRAWN[suite], 0))


@pytest.mark.parametrize(
    "suite", [pytest.param(s, marks=pytest.mark.skipif(s not in DRAWN, reason=MISSING or "-")) for s in SUITES]
)
def test_a_case_can_be_repeated_alone_and_sent_to_a_worker(suite: str) -> None:
    run = cases(suite, 3, 7)
    assert [c.seed for c in run] == [7, 8, 9]
    assert cases(suite, 1, 9)[0] == run[2]
    assert msgspec.msgpack.decode(msgspec.msgpack.encode(run[2]), type=Case) == run[2]
    assert msgspec.json.decode(msgspec.json.encode(run[2]), type=Case) == run[2]
    assert all(c.lines and c.command for c in run)


@pytest.mark.parametrize(("suite", "names"), [("seed", NAMED), ("dialogue", DIALOGUES), ("faults", FAULTS)])
def test_every_kind_comes_in_turn(suite: str, names: tuple[str, ...]) -> None:
    assert {c.name for c in cases(suite, len(names), 40)} == set(names)


def test_what_is_shown_is_asked_for_by_its_name_among_others_that_look_alike() -> None:
    run = cases("taught", 30, 0)
    assert {c.expect for c in run} == {"delivered", "reported"} and {not c.showing.sentence for c in run} == {
        True,
        False,
    }
    for case in run:
        assert case.showing is not None and case.scene is not None and case.showing.name in case.command
        (shown,) = [o for o in case.showing.scene.objects if o.position is not None]
        assert (shown.name in {o.name for o in case.scene.objects}) == (case.expect == "delivered")
        assert case.scene.lamps != case.showing.scene.lamps
        alike = [o for o in case.scene.objects if o.name.startswith("look-alike")]
        assert all(o.rgba == shown.rgba and (o.label, o.pattern) != (shown.label, shown.pattern) for o in alike)


def test_in_a_new_home_each_mission_has_a_goal_and_the_map_is_the_robots_own() -> None:
    for case in (*cases("new", 2, 0), *cases("new", 1, 31010)):
        assert case.explores and case.household is None and case.scene is not None
        assert [line.when for line in case.lines] == ["ready", *["ended"] * 4]
        assert all(line.goal is not None and (line.goal.wants or line.goal.effects) for line in case.lines)
        on = {p.spec.name: p.on for p in place_objects(case.scene, case.seed)}
        assert all(on[want.thing] not in want.goals for want in case.wants), "it would be there already"
        assert not any(effect.kind == "ends" for effect in case.effects), "it drives on after that"
        assert len({want.thing for want in case.wants}) == 3


def test_a_room_is_called_what_the_map_of_the_robot_calls_it() -> None:
    case = cases("new", 1, 31001)[0]
    assert case.scene is not None
    numbered = tuple(msgspec.structs.replace(r, name=f"room {n}", named=False) for n, r in enumerate(case.scene.rooms))
    lines = in_words_of(case, numbered)
    meant = next(n for n, r in enumerate(case.scene.rooms) if r.name in case.lines[2].text)
    assert lines[1].text == f"go to room {meant}" and lines[0] == case.lines[0]
    assert "{" not in in_words_of(case, ())[1].text


def test_fetch_varies() -> None:
    run = cases("fetch", 60, 0)
    assert len({c.thing for c in run}) == len(SCENE.objects)
    assert len({c.command.replace(c.thing, "X") for c in run}) > 5
    assert 10 < sum(c.spoken for c in run) < 50


def test_a_misheard_command_is_another_one() -> None:
    for case in (c for c in cases("seed", 20, 0) if c.name == "misheard"):
        assert case.rules[0].fields["text"] != case.command


@pytest.mark.slow
def test_rules_speak_of_what_their_service_publishes() -> None:
    rules = [r for suite in DRAWN for c in drawn(suite) for r in c.rules]
    rules += [r for c in cases("chaos", 150, 98) for r in c.rules]
    assert {r.service for r in rules} == {*CHAOS_SERVICES}
    for rule in rules:
        topic = topics.BY_KEY[rule.key]
        assert rule.service in topic.writers or "*" in topic.writers, rule
        assert set(rule.match) | set(rule.fields) <= set(topic.type.__struct_fields__), rule


def test_edits_make_messages() -> None:
    rules: list[Rule] = [r for s in ("seed", "faults", "dialogue") for c in cases(s, 20, 0) for r in c.rules]
    for rule in (r for r in rules if r.kind == "edit"):
        topic = topics.BY_KEY[rule.key]
        required = {"request_id": "r", "steps": [], "query_id": "q", "found": True, "text": "x"}
        fields = {k: v for k, v in required.items() if k in topic.type.__struct_fields__}
        message = msgspec.convert({**fields, **rule.fields}, topic.type)
        assert decode(topic, encode(topic, message)) == message


def test_tidy_lays_four_things_on_the_table_that_belong_elsewhere() -> None:
    for case in cases("tidy", 10, 0):
        assert case.scene is not None
        placed = {p.spec.name: p.on for p in place_objects(case.scene, case.seed)}
        assert len(case.wants) == 4
        for want in case.wants:
            assert placed[want.thing] == "living table"
            assert want.goals[0] not in ("", "living table")
        assert sum(on == "living table" for on in placed.values()) == 4


def test_where_things_go() -> None:
    by_kind = {o.kind: destination(o, SCENE) for o in SCENE.objects}
    assert by_kind["can"] == "recycling bin"
    assert by_kind["block"] == "toy box"
    assert all(by_kind.values())


def test_a_scene_survives_its_file(tmp_path) -> None:  # type: ignore[no-untyped-def]
    scene = cases("tidy", 1, 3)[0].scene
    assert scene is not None
    path = tmp_path / "scene.toml"
    path.write_text(to_toml(scene))
    assert load_scene(str(path)) == scene


def test_a_setting_of_the_user_comes_last_and_the_pipeline_of_a_suite_stands() -> None:
    assert cases("seed", 1, 0, ("brain.settle=0.5",), "fetch")[0].settings[-1] == "brain.settle=0.5"
    assert "brain.pipeline=fetch" not in cases("seed", 1, 0, (), "fetch")[0].settings
    case = cases("fetch", 1, 0, (), "vla")[0]
    assert case.settings == ("brain.pipeline=vla",) and case.wake
    assert not cases("fetch", 1, 0, (), "fetch")[0].wake


def test_services_are_found_by_the_table() -> None:
    assert service_class("navigation").NAME == "navigation"
    with pytest.raises(ImportError):
        service_class("nonsense")


def test_a_class_of_ones_own_takes_the_place_of_a_service() -> None:
    entry = "services.planner.service:PlannerService"
    assert replacement(entry) == ("planner", service_class("planner"))
    assert cases("fetch", 1, 0, replaced=(entry,))[0].replaced == (entry,)
    for wrong, reason in (
        ("nowhere.at_all:Planner", "No module named"),
        ("services.planner.service:Nonsense", "no attribute"),
        ("services.planner.service", "expected package.module:Class"),
        ("common.scene:Scene", "has no NAME"),
        ("services.sim.service:SimService", "no service 'sim'"),
    ):
        with pytest.raises(LookupError, match=reason):
            replacement(wrong)


def test_settings_are_such_that_services_start_with_them() -> None:
    everything = {s for suite in DRAWN for c in drawn(suite) for s in c.settings}
    for setting in everything:
        section = setting.partition(".")[0]
        kind = service_class(section)
        load(section, kind.CONFIG, config_dir(), overrides({}, [setting]))
