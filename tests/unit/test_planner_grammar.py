"""What the embedded planner makes of sentences in a small believed world; every plan passes the brain's own checks."""

from pathlib import Path

import msgspec
import pytest

from common import config
from common.household import Household, load_household
from common.messages import ActionPlan, History, KnownWorld, PlanStep, RejectedPlan, WorldObject
from common.plan_rules import known_world, objection
from services.planner.config import PlannerConfig
from services.planner.grammar import grammar
from services.planner.world import believed

CONFIG = config.load("planner", PlannerConfig, config.DEFAULT_DIR, {})
CLOSED = msgspec.structs.replace(CONFIG, open_vocabulary=False)
SCENE = load_household("apartment")
NOW = 20.0


def seen(
    label: str, on: str, position: tuple[float, float, float], seen_at: float = NOW, scene: Household = SCENE
) -> WorldObject:
    spec = scene.thing(label)
    assert spec is not None
    return WorldObject(
        label=label, kind=spec.kind, colour=spec.colour, size=spec.size, on=on, position=position, seen_at=seen_at
    )


WORLD = [
    seen("red mug", "living table", (-1.5, -2.2, 0.55)),
    seen("green can", "living table", (-1.2, -2.3, 0.55)),
    seen("blue mug", "counter", (4.5, -3.1, 0.8)),
    seen("red can", "counter", (4.0, -3.1, 0.8)),
    seen("yellow block", "kitchen table", (5.3, -0.7, 0.75)),
    seen("apple", "kitchen table", (5.0, -0.7, 0.75)),
]


def ask(
    command: str,
    held: str = "",
    objects: list[WorldObject] = WORLD,
    rejected: tuple[RejectedPlan, ...] = (),
    done: list[PlanStep] | None = None,
    scene: Household = SCENE,
    config: PlannerConfig = CONFIG,
    history: History | None = None,
) -> ActionPlan:
    told = known_world(scene, [o.label for o in objects], held)
    plan = grammar.plan(
        command, believed(scene, told, objects, (0.0, 0.0, 0.0), NOW, history), config, rejected, done, "r"
    )
    assert plan.request_id == "r"
    if plan.steps:
        assert objection(plan.steps, told, scene) is None, f"{command}: {text(plan)}"
    else:
        assert plan.detail and not plan.detail.endswith(".")
    return plan


def text(plan: ActionPlan) -> str:
    """`find red mug; grasp red mug; ...`, or `no: <reason>`."""
    rows = [
        " ".join(p for p in (s.action, s.object, s.target, s.text, s.near and f"near {s.near}") if p)
        for s in plan.steps
    ]
    return "; ".join(rows) or f"no: {plan.detail}"


def bring(thing: str) -> str:
    return f"find {thing}; grasp {thing}; return; release"


def put(thing: str, where: str) -> str:
    return f"find {thing}; grasp {thing}; place {thing} {where}"


@pytest.mark.parametrize(
    "command",
    [
        "bring me the red mug", "Could you please bring me the red mug?", "fetch the red cup", "get me the red mug",
        "give me the red mug now", "hand me the red mug, please", "I want the red mug", "I'd like the red mug",
        "would you mind bringing me the red mug", "go and get the red mug", "red mug", "bring the red mug here",
        "take the red mug to me", "hey jarvis bring me my red mug", "bring me the mug on the table",
        "bring me the mug in the living room", "bring me the mug from the living table", "bring me the nearest mug",
        "no i said the red mug", "find the red mug and bring it to me", "get the mug that is on the coffee table",
        "bring me the red mug to the dock", "bring me the mug next to the green can", "Bring me THE RED MUG!",
    ],
)  # fmt: skip
def test_fetching(command: str) -> None:
    assert text(ask(command)) == bring("red mug")


@pytest.mark.parametrize(
    ("command", "expected"),
    [
        ("put the red mug on the counter", put("red mug", "counter")),
        ("put the red mug on the table in the kitchen", put("red mug", "kitchen table")),
        ("move the yellow block to the toy box", put("yellow block", "toy box")),
        ("place the red mug next to the apple", put("red mug", "kitchen table near apple")),
        ("take the red mug to the kitchen", put("red mug", "counter")),
        ("bring the apple to the sofa", "find apple; grasp apple; navigate sofa; release"),
        ("throw away the green can", put("green can", "recycling bin")),
        ("set the apple down on the desk", put("apple", "desk")),
        ("put down the apple on the desk", put("apple", "desk")),
        ("leave the apple in the bin", put("apple", "bin")),
        ("recycle the green can", put("green can", "recycling bin")),
        ("no, the apple", bring("apple")),
        ("throw the apple away", put("apple", "bin")),
        ("put the red can in the green bin", put("red can", "recycling bin")),
        ("put away the red mug", put("red mug", "counter")),
        ("put the red mug away", put("red mug", "counter")),
        ("pick up the red mug", "find red mug; grasp red mug"),
        ("pick the red mug up and put it down", "find red mug; grasp red mug; release"),
        ("find the apple", "find apple"),
        ("go to the kitchen", "navigate kitchen"),
        ("go to the office", "navigate study"),
        ("go back to the kitchen table", "navigate kitchen table"),
        ("go to the red mug", "find red mug; navigate red mug"),
        ("come back", "return"),
        ("go home", "return"),
        ("go home and charge", "return"),
        ("recharge", "return"),
        ("drive to the dock", "return"),
        ("wait here", "wait"),
        ("say hello, my friend", "say Hello, my friend."),
        ("open the gripper", "release gripper"),
        ("open your hand, please", "release gripper"),
        ("close your hand", "grasp gripper"),
        ("what are you holding", "say My hand is empty."),
        ("where are you", "say I am in the living room."),
        ("where is the red mug", "say The red mug is on the living table."),
        ("do you see an apple", "say The apple is on the kitchen table."),
        ("where is the blue bottle", "find blue bottle; say I have found the blue bottle."),
        ("where's the apple", "say The apple is on the kitchen table."),
        ("is the apple in the kitchen", "say The apple is on the kitchen table."),
        ("where is the counter", "say The counter is in the kitchen."),
        ("what is on the counter", "say A blue mug and a red can are on the counter."),
        ("how many mugs are there", "say I know of 2 mugs: the red mug and the blue mug."),
    ],
)
def test_one_command(command: str, expected: str) -> None:
    assert text(ask(command)) == expected


@pytest.mark.parametrize(
    ("command", "expected"),
    [
        ("go to the kitchen and then bring me the apple", f"navigate kitchen; {bring('apple')}"),
        ("bring me the red mug and the green can", f"{bring('red mug')}; {bring('green can')}"),
        ("bring me the red mug, then come back", bring("red mug")),
        (
            "put the red mug on the counter and the green can in the bin",
            f"{put('red mug', 'counter')}; {put('green can', 'bin')}",
        ),
        ("pick up the red mug and put it on the bookshelf", put("red mug", "bookshelf")),
        ("get the green can and throw it away", put("green can", "recycling bin")),
        ("fetch the red mug and put it on the desk", put("red mug", "desk")),
        ("get the apple and bring it to the bedroom", put("apple", "dresser")),
        (
            "pick up the cans and then put them in the bin",
            f"{put('green can', 'bin')}; {put('red can', 'bin')}",
        ),
        (
            "put the apple, the red mug, and the green can on the desk",
            f"{put('apple', 'desk')}; {put('red mug', 'desk')}; {put('green can', 'desk')}",
        ),
        ("hey jarvis, go to the kitchen, wait, and come back, please", "navigate kitchen; wait; return"),
        ("bring me the cans", f"{bring('green can')}; {bring('red can')}"),
        ("bring me all the cans in the kitchen", bring("red can")),
        ("bring me the red and the blue mug", f"{bring('red mug')}; {bring('blue mug')}"),
        ("bring me a red or a blue mug", bring("red mug")),
        ("throw the rubbish away", f"{put('green can', 'recycling bin')}; {put('red can', 'recycling bin')}"),
        ("bring me two mugs", f"{bring('red mug')}; {bring('blue mug')}"),
        ("put the toys in the toy box", put("yellow block", "toy box")),
        (
            "put everything on the kitchen table in the toy box",
            f"{put('apple', 'toy box')}; {put('yellow block', 'toy box')}",
        ),
        (
            "find the cans and put them in the bin",
            "find green can; find red can; grasp green can; place green can bin; grasp red can; place red can bin",
        ),
        ("go to the kitchen. Wait. Come back!", "navigate kitchen; wait; return"),
    ],
)  # fmt: skip
def test_several_commands(command: str, expected: str) -> None:
    assert text(ask(command)) == expected


@pytest.mark.parametrize(
    ("command", "held", "expected"),
    [
        ("put it in the bin", "red mug", "place red mug bin"),
        ("put it down", "red mug", "release"),
        ("put down the red mug", "red mug", "release"),
        ("open the gripper", "red mug", "release"),
        ("let go", "red mug", "release"),
        ("close your hand", "red mug", "say I am holding the red mug."),
        ("bring me the red mug", "red mug", "return; release"),
        ("bring it to me", "red mug", "return; release"),
        ("put the mug on the counter", "red mug", "place red mug counter"),
        ("what is in your hand", "red mug", "say I am holding the red mug."),
        ("pick up the red mug", "red mug", "say I am holding the red mug already."),
        ("put down the apple", "red mug", "no: I am not holding the apple"),
        ("bring me the apple", "red mug", f"place red mug bookshelf; {bring('apple')}"),
        ("put it down", "", "no: there is nothing in my hand"),
        ("throw it away", "", "no: I do not know what you mean by it"),
    ],
)
def test_with_something_in_the_hand(command: str, held: str, expected: str) -> None:
    assert text(ask(command, held)) == expected


def test_tidying_follows_the_rules_of_the_configuration() -> None:
    table = f"{put('green can', 'recycling bin')}; {put('red mug', 'counter')}"
    assert text(ask("tidy up the table")) == table
    assert text(ask("clean up the living room")) == table
    assert text(ask("tidy up the room")) == table, "the room that the robot is in"
    everywhere = f"{table}; {put('red can', 'recycling bin')}; {put('yellow block', 'toy box')}"
    assert text(ask("tidy up")) == everywhere, "the blue mug and the apple are where they belong"
    assert text(ask("clear the counter", objects=[WORLD[2]])) == "say The counter is tidy already."


def test_which_one_is_meant() -> None:
    assert text(ask("bring me the mug")) == bring("mug"), "perception sees several and the brain asks"
    assert text(ask("where is the mug")).count("mug is on the") == 2
    assert "the green can or the red can" in ask("bring me the drink").detail
    two = [seen("white mug", "counter", (4.4, -3.1, 0.8)), WORLD[2], WORLD[0]]
    counter = ask("bring me the mug on the counter", objects=two)
    assert counter.steps[0] == PlanStep(action="find", object="mug", text="mug on the counter")
    assert text(ask("bring me a mug")) == bring("red mug"), "any: the nearest"
    assert text(ask("bring me the other mug", held="red mug")).endswith(bring("blue mug"))
    assert text(ask("bring me the blue one")) == bring("blue mug")
    assert text(ask("bring me the mug", objects=WORLD[:2])) == bring("red mug"), "the only one seen"
    assert text(ask("bring me the big mug")).startswith("no: they are all of the same size")
    assert text(ask("bring me three mugs")) == "no: I know of only 2 of the 3 mugs"
    row = [seen("red mug", "counter", (4.0, -3.1, 0.8)), seen("blue mug", "counter", (4.4, -3.1, 0.8))]
    row.append(seen("white mug", "counter", (4.8, -3.1, 0.8)))
    assert text(ask("bring me the mug on the right", objects=row)) == bring("red mug")
    assert text(ask("bring me the mug on the left", objects=row)) == bring("white mug")
    assert text(ask("bring me the second mug on the counter", objects=row)) == bring("blue mug")
    assert text(ask("bring me the second mug from the right", objects=row)) == bring("blue mug")
    assert text(ask("bring me the first mug from the right", objects=row)) == bring("red mug")
    assert text(ask("bring me the last mug from the left", objects=row)) == bring("red mug")
    assert text(ask("bring me the mug left of the blue mug", objects=row)) == bring("white mug")


def test_things_that_nobody_has_seen_are_looked_for() -> None:
    nothing: list[WorldObject] = []
    assert text(ask("bring me the white mug", objects=nothing)) == bring("white mug")
    assert text(ask("bring me the mug", objects=nothing)) == bring("mug")
    assert text(ask("bring me the can on the counter", objects=WORLD[:2])) == (
        "navigate counter; find can can on the counter; grasp can; return; release"
    )
    assert text(ask("bring me the blue block on the right", objects=nothing)) == bring("blue block")
    assert text(ask("bring me the toy next to the sofa", objects=nothing)).startswith("no: I do not know which one")
    assert text(ask("bring me the macaroni and cheese")) == bring("macaroni and cheese")
    assert text(ask("bring me the salt and pepper")) == f"{bring('salt')}; {bring('pepper')}"
    assert text(ask("bring me the strawberry jam")) == bring("strawberry jam"), "a verb elsewhere"
    left = ask("bring me the mug on the left", objects=nothing)
    assert left.steps[0] == PlanStep(action="find", object="mug", text="mug on the left")


REFUSED = {
    "bring me the sofa": "I cannot pick up the sofa",
    "my shoes": "I know no shoes",
    "the cat sat on the mat": "I know no cat sat",
    "put the apple in the bowl": "I cannot put things on or in the bowl",
    "put the red mug in the fridge": "the fridge is no place that I can use",
    "put the red mug on the floor": "I cannot put things on the floor",
    "put the red mug next to the table": "I cannot put things on the floor",
    "put the red mug on the sofa": "I cannot put things on the sofa, only",
    "take the plate to the sink": "I know no plate",
    "go to the garage": "I know no garage",
    "clean the bathroom": "I know no bathroom",
    "follow me": "I cannot follow people",
    "open the fridge": "I cannot open or close doors",
    "stop": "stopping needs no plan",
    "yes": "I did not ask anything",
    "dance with me": "I can fetch, carry and tidy things",
    "make me a sandwich": "I can bring things, but not make any",
    "could you wash the red mug": "neither wash, wipe nor sweep",
    "pour me some water from the blue bottle": "neither cook, pour nor feed",
    "call an ambulance": "I cannot call anybody",
    "carry me to bed": "I cannot carry people",
    "keep an eye on the kettle": "I cannot keep watch",
    "what time is it": "I know neither the time of day nor the date",
    "take a hike": "I know no hike",
    "anything but the red mug": "not what you want",
    "put the radio on": "I cannot switch things on or off",
    "pick up the red mug and the green can": "only one thing at a time",
    "put the apple on the desk and tell me what you see": "ask me again then",
    "bring me the red mug and dance": "I can fetch, carry and tidy things",
    "empty the bin": "I cannot empty the bin",
    "don't bring me the red mug": "you told me not to",
    "please do not touch the apple": "you told me not to",
    "when the bell rings bring me the mug": "I cannot wait for conditions",
    "take a picture": "I take no pictures",
    "what is on the bookshelf": "I have seen nothing there so far",
    "": "I did not hear a command",
    "?!": "I did not hear a command",
}


@pytest.mark.parametrize(("command", "reason"), REFUSED.items())
def test_what_cannot_be_planned_is_refused_in_plain_words(command: str, reason: str) -> None:
    plan = ask(command)
    assert not plan.steps and reason in plan.detail


CLOSED_LIST = {
    "bring me the purple mug": "I know no purple mug, only the red mug, the blue mug and the white mug",
    "bring me the banana": "I know no banana",
    "no i said keys": "I know no keys",
}


@pytest.mark.parametrize(("command", "reason"), CLOSED_LIST.items())
def test_with_a_closed_vocabulary_only_what_is_listed_is_known(command: str, reason: str) -> None:
    plan = ask(command, config=CLOSED)
    assert not plan.steps and reason in plan.detail
    assert text(ask(command)) == bring(reason.split(",")[0].removeprefix("I know no ")), "else it is looked for"


def test_another_scene_has_another_vocabulary() -> None:
    scene = load_household("minimal")
    assert text(ask("bring me the mug", objects=[], scene=scene)) == bring("red mug")
    assert "I know no apple" in ask("bring me the apple", objects=[], scene=scene, config=CLOSED).detail
    assert "I know no kitchen" in ask("go to the kitchen", objects=[], scene=scene).detail
    can = [seen("green can", "delivery tray", (0.7, 0.0, 0.5), scene=scene)]
    assert text(ask("put away the green can", objects=can, scene=scene)) == put("green can", "table")
    assert "where the green can goes" in ask("throw away the green can", objects=can, scene=scene).detail


def test_a_bed_is_where_things_are_put_only_where_there_is_nothing_else() -> None:
    home = load_household("apartment")
    scene = msgspec.structs.replace(
        home,
        receptacles=tuple(
            msgspec.structs.replace(r, name="bed 2 in the kitchen") if r.name == "counter" else r
            for r in home.receptacles
        ),
    )
    assert ask("take the red mug to the kitchen", scene=scene).steps[-1].target == "kitchen table"
    rest = tuple(r for r in scene.receptacles if r.name != "kitchen table")
    only = msgspec.structs.replace(scene, receptacles=rest)
    assert ask("take the red mug to the kitchen", scene=only).steps[-1].target == "bed 2 in the kitchen"


def reject(plan: ActionPlan, step: int, reason: str) -> RejectedPlan:
    return RejectedPlan(steps=plan.steps, reason=reason, step=step)


def test_a_rejected_plan_is_followed_by_another_and_in_the_end_by_the_reason() -> None:
    rejected: list[RejectedPlan] = []
    places = []
    for _ in range(2):
        plan = ask("take the red mug to the kitchen", rejected=tuple(rejected))
        places.append(plan.steps[-1].target)
        rejected.append(reject(plan, 3, f"there is no {places[-1]} to put things on"))
    assert places == ["counter", "kitchen table"]
    last = ask("take the red mug to the kitchen", rejected=tuple(rejected))
    assert not last.steps and last.detail == "there is no kitchen table to put things on"
    first = ask("bring me a mug")
    assert text(ask("bring me a mug", rejected=(reject(first, 2, "the red mug is broken"),))) == bring("blue mug")
    plan = ask("bring me the red mug")
    spent = ask("bring me the red mug", rejected=(reject(plan, 2, "the red mug does not fit into the gripper"),))
    assert (spent.steps, spent.detail) == ([], "the red mug does not fit into the gripper")


def test_a_plan_of_somebody_else_that_was_rejected_is_replaced() -> None:
    sofa = RejectedPlan(steps=[PlanStep(action="grasp", object="sofa")], reason="I know no sofa", step=1)
    assert text(ask("bring me the red mug", rejected=(sofa,))) == bring("red mug")


def test_a_sender_that_asks_again_gets_a_look_first() -> None:
    command, far = "tidy up the living room", WORLD[2:]
    assert "I have not seen what lies" in ask(command, objects=far).detail
    look = ask(command, objects=far, done=[])
    assert look.again and text(look) == "navigate living table; wait; navigate bookshelf; wait"
    after = ask(command, done=look.steps)
    assert not after.again and text(after).startswith("find green can")
    empty = ask(command, objects=far, done=look.steps)
    assert not empty.steps and "found nothing" in empty.detail
    known = ask("tidy up the living room", done=[])
    assert known.again, "what is known may not be all that is there"
    assert ask("put everything on the living table in the bin", done=[]).again
    assert ask("what is on the living table", done=[]).again
    assert not ask("bring me the red mug", done=[]).again
    both = ask("bring me the apple and then tidy up the bookshelf", done=[])
    assert both.again and text(both) == "navigate bookshelf; wait", "it looks before it moves anything"


@pytest.mark.parametrize("command", ["where is the apple", "find the apple"])
def test_what_nobody_has_seen_is_looked_for_and_then_told(command: str) -> None:
    first = ask(command, objects=WORLD[:2], done=[])
    assert first.again and text(first) == "find apple"
    after = ask(command, done=first.steps)
    assert not after.again and text(after) == "say The apple is on the kitchen table."


def test_what_something_is_put_beside_is_looked_for_first() -> None:
    command = "put the red mug next to the apple"
    first = ask(command, objects=WORLD[:1], done=[])
    assert first.again and text(first) == "find apple"
    assert text(ask(command, done=first.steps)) == put("red mug", "kitchen table near apple")
    assert "I have not seen where the apple stands" in text(ask(command, objects=WORLD[:1], done=first.steps))


def test_next_to_what_lies_in_a_bin_is_into_the_bin() -> None:
    binned = [*WORLD[:-1], seen("apple", "bin", (6.6, -2.3, 0.1))]
    assert text(ask("put the red mug next to the apple", objects=binned)) == put("red mug", "bin")


def test_where_one_of_several_is_told_of_the_one_that_was_found() -> None:
    first = ask("find a mug", objects=[], done=[])
    assert first.again and text(first) == "find mug"
    after = ask("find a mug", objects=WORLD[2:3], done=first.steps)
    assert text(after) == "say The blue mug is on the counter in the kitchen."


def test_a_long_plan_is_refused() -> None:
    command = ", then ".join(["bring me the red mug", "bring me the green can"] * 10)
    assert "too much at once" in ask(command).detail


def test_sentences_without_end_are_refused() -> None:
    for command in (
        "bring me " * 1000,
        "the red mug and " * 30 + "the unicorn",
        "bring me " + "the red mug and " * 12 + "x",
    ):
        assert "too long" in ask(command).detail
    chain = "bring me the red mug" + " and the apple" * 8 + " and the unicorn"
    assert not ask(chain, config=CLOSED).steps


def test_what_it_sees_and_what_it_remembers() -> None:
    assert text(ask("what do you see", objects=WORLD[:1])) == "say I see a red mug on the living table."
    old = [seen("apple", "counter", (4.0, -3.1, 0.8), seen_at=1.0)]
    assert text(ask("what do you see", objects=old)) == (
        "say From here I see nothing that I know. I remember an apple on the counter in the kitchen."
    )
    assert text(ask("what do you see", objects=[])) == "say I have seen nothing that I know yet."


def test_objects_without_a_survey_are_known_by_name() -> None:
    told = KnownWorld(objects=["red cup", "strange thing"], held="")
    plan = grammar.plan("bring me the mug", believed(SCENE, told, []), CONFIG)
    assert text(plan) == bring("red mug")
    assert text(grammar.plan("bring me the strange thing", believed(SCENE, told, []), CONFIG)) == bring("strange thing")


def test_the_page_of_commands_is_true() -> None:
    page = (Path(__file__).parents[2] / "docs" / "COMMANDS.md").read_text(encoding="utf-8")
    table = page.partition("| said | planned |")[2].partition("\n\n")[0]
    rows = [
        [cell.strip() for cell in line.strip("|").split("|")] for line in table.splitlines() if line.startswith("| ")
    ]
    assert len(rows) > 20
    for command, expected in rows:
        assert text(ask(command)) == expected


def test_a_thing_may_look_like_what_things_are_put_into() -> None:
    scene = msgspec.structs.replace(SCENE, things=())
    assert text(ask("get me the yellow box", scene=scene, objects=[])) == bring("yellow box")
    assert text(ask("get me the toy box", scene=scene, objects=[])) == "no: I cannot pick up the toy box"
    assert ask("put the red mug in the yellow box").steps[-1].target == "toy box"
