"""Worlds from outside: which files belong together, what is asked in them, and what is wrong with a broken one."""

from pathlib import Path

import pytest

from common.config import ConfigError, RuntimeConfig
from common.household import load_household, mapped, told
from common.plan_tables import SCENES
from common.scene import SceneError, load_scene
from evaluation.suites.worlds import WorldsError, cases, worlds

EXAMPLES = Path(__file__).resolve().parents[2] / "examples" / "worlds"
PLAN = 'name = "x"\nplan = "apartment"\n'
MUG = '{ name = "a cup", kind = "mug", colour = "red", size = [0.07, 0.07, 0.09], mass = 0.2, rgba = [1, 0, 0, 1] }'


def world(directory: Path, objects: str = MUG, **files: str) -> Path:
    directory.mkdir(parents=True, exist_ok=True)
    (directory / "world.toml").write_text(f"{PLAN}objects = [{objects}]\n")
    for name, text in files.items():
        (directory / f"{name}.toml").write_text(text)
    return directory


def test_the_example_is_sound() -> None:
    first, second, third = cases(EXAMPLES, None, 50)
    assert (first.seed, second.seed, third.seed) == (3, 51, 52)
    assert first.household is not None and first.household.things == ()
    assert first.household.words.kind("beaker") == "mug"
    assert second.thing == second.wants[0].thing == "blue mug" and third.expect == "reported" and not third.wants
    again = cases(EXAMPLES, 4, 50)[3]
    assert again.command == first.command and again.seed == 53


def test_both_layouts_are_found_and_a_household_may_be_missing(tmp_path: Path) -> None:
    world(tmp_path / "b")
    household = f"{PLAN}things = [{MUG.replace('mass = 0.2, ', '').replace('a cup', 'other')}]\n"
    world(tmp_path / "a", household=household)
    (tmp_path / "a" / "world.toml").rename(tmp_path / "flat.world.toml")
    (tmp_path / "a" / "household.toml").rename(tmp_path / "flat.household.toml")
    one, two = worlds(tmp_path)
    assert (one.name, two.name) == ("b", "flat")
    assert one.household.things == () and one.household.words.kinds
    assert [t.name for t in two.household.things] == ["other"]


def test_without_cases_something_is_asked_for_in_the_household_words(tmp_path: Path) -> None:
    world(tmp_path / "a")
    (case,) = cases(tmp_path, None, 7)
    assert "red mug" in case.command and case.wants[0].thing == "a cup"
    world(tmp_path / "a", f"{MUG}, {MUG.replace('a cup', 'b cup')}")
    with pytest.raises(WorldsError, match=r"no words that mean one object.*cases\.toml"):
        cases(tmp_path, None, 7)


@pytest.mark.parametrize(
    ("rows", "expected"),
    [
        ('[[case]]\ncommand = "bring it"\nthing = "a pot"\n', "no object 'a pot'; it has a cup"),
        ('[[case]]\ncommand = "bring it"\nthing = "a cup"\nto = ["attic"]\n', "no receptacle 'attic'"),
        ('[[case]]\ncommand = "bring it"\nthing = "a cup"\nto = "attic"\n', "no receptacle 'attic'"),
        ('[[case]]\ncommand = "bring it"\n', "nothing is wanted"),
        ('[[case]]\ncommand = "go"\nexpect = "shown"\n', "`effects` are missing"),
        ('[[case]]\ncommand = "bring it"\nthnig = "a cup"\n', "unknown field `thnig`"),
        ("[[case]\n", "not valid TOML"),
    ],
)
def test_a_broken_case_file_is_named(tmp_path: Path, rows: str, expected: str) -> None:
    world(tmp_path / "a", cases=rows)
    with pytest.raises(WorldsError, match=r"cases\.toml") as error:
        cases(tmp_path, None, 0)
    assert expected in str(error.value)


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        (PLAN.replace("apartment", "castle"), "plan: .*castle.toml; shipped floor plans: apartment$"),
        (PLAN.replace('"apartment"', "3"), "plan: expected the name"),
        (f"{PLAN}objects = [{MUG.replace('mug', 'teapot', 1)}]", "is a 'teapot'; known kinds"),
        (f'{PLAN}objects = [{MUG[:-1]}, on = "attic" }}]', "on 'attic', which is no receptacle or furniture"),
        (f"{PLAN}objects = [{MUG[:-1]}, position = [0, 0] }}]", "needs `on`"),
        (f'{PLAN}objects = [{MUG[:-1]}, on = "floor" }}]', "needs a position"),
        (f'{PLAN}objects = [{MUG[:-1]}, on = "desk", position = [0, 0] }}]', "beside 'desk'"),
    ],
)
def test_a_broken_world_is_named(tmp_path: Path, text: str, expected: str) -> None:
    world(tmp_path / "a")
    (tmp_path / "a" / "world.toml").write_text(text)
    with pytest.raises(WorldsError, match=expected):
        cases(tmp_path, None, 0)


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        (f'{PLAN}[words.kinds]\nteapot = ["pot"]\n', "no kind is called 'teapot'"),
        (f'{PLAN}[words]\nplants = ["fern"]\n', "unknown field `plants`"),
        (f'{PLAN}things = [{{ name = "cup", kind = "mug" }}]\n', "missing required field `colour`"),
    ],
)
def test_a_broken_household_is_named(tmp_path: Path, text: str, expected: str) -> None:
    file = tmp_path / "household.toml"
    file.write_text(text)
    with pytest.raises(SceneError, match=r"household\.toml") as error:
        load_household(str(file))
    assert expected in str(error.value)


def test_a_directory_without_worlds_says_what_it_should_hold(tmp_path: Path) -> None:
    with pytest.raises(WorldsError, match=r"NAME\.world\.toml"):
        cases(tmp_path, None, 0)
    with pytest.raises(WorldsError, match="no such directory"):
        cases(tmp_path / "none", None, 0)


def test_the_shipped_flat_is_told_as_it_is() -> None:
    """Its figures are those of a home whose owner told the robot everything."""
    told_all, world = load_household("apartment"), load_scene("apartment")
    assert told_all == told(world, told_all.words)
    assert mapped(world).things == () and mapped(world).receptacles == told_all.receptacles


def test_one_scene_file_is_both(tmp_path: Path) -> None:
    text = (SCENES / "minimal.toml").read_text()
    (tmp_path / "mine.toml").write_text(text)
    household = load_household(str(tmp_path / "mine.toml"))
    assert [t.name for t in household.things] == [o.name for o in load_scene(str(tmp_path / "mine.toml")).objects]


def test_a_world_of_its_own_needs_its_household() -> None:
    assert RuntimeConfig(scene="a").world_file == RuntimeConfig(scene="a").household_file == "a"
    apart = RuntimeConfig(world="w.toml", household="h.toml")
    assert (apart.world_file, apart.household_file) == ("w.toml", "h.toml")
    with pytest.raises(ConfigError, match=r"needs runtime\.household"):
        RuntimeConfig(world="w.toml").household_file  # noqa: B018
