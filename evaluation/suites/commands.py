"""The suite `commands`: each line of docs/COMMANDS.md, with what it has to bring about in a flat with six objects.

A contract test holds the page against `TASKS`: a command that is planned there has effects here.
"""

from cmath import phase

import msgspec

from common.scene import Scene
from evaluation.case import Case, Line
from evaluation.suites.blocks import VLA, flat
from judge.effects import Effect
from judge.evidence import Want
from judge.goal import Goal
from services.sim.layout import place_objects

LAID = {
    "red mug": "living table", "green can": "living table", "blue mug": "counter", "red can": "counter",
    "yellow block": "kitchen table", "apple": "kitchen table",
}  # fmt: skip
"""The world of docs/COMMANDS.md: what stands on what."""
SECONDS = 900.0
"""Robot time [s] for one command: twice that of the longest mission, four things from a table, at 1.5 m/s."""


class Task(msgspec.Struct, frozen=True):
    """A command and what it has to bring about.

    `first` is what the command itself must bring about, where what follows undoes it; None: all of it. `then` are
    further lines (text, when, seconds after) as in `evaluation.case.Line`; `thing` is what the person names
    when the robot asks which; `laid` lays some of the things elsewhere.
    """

    said: str
    wants: tuple[Want, ...] = ()
    effects: tuple[Effect, ...] = ()
    first: Goal | None = None
    then: tuple[Line, ...] = ()
    thing: str = ""
    laid: dict[str, str] = {}


def _on(thing: str, *goals: str) -> Want:
    return Want(thing, goals)


TRAY = "delivery tray"
STILL = Effect("still")
HOME = Effect("ends", "home")
LEFT_OFF = (Effect("stands"), Effect("left alone", "red mug"))
LEFT = "bring me the can on the left"
TASKS: tuple[Task, ...] = (
    Task("bring me the red mug", (_on("red mug", TRAY),)),
    Task("could you please get the apple and bring it to the bedroom", (_on("apple", "dresser", "bedside table"),)),
    Task("bring me the mug", (_on("red mug", TRAY),), thing="red mug"),
    Task("bring me the mug on the counter", (_on("blue mug", TRAY),)),
    Task(LEFT, laid={"red can": "living table"}),
    Task("bring me all the cans", (_on("green can", TRAY), _on("red can", TRAY))),
    Task("put the red mug on the counter", (_on("red mug", "counter"),)),
    Task(
        "put the red mug next to the apple", (_on("red mug", "kitchen table"),), (Effect("beside", "red mug", "apple"),)
    ),
    Task("throw away the green can", (_on("green can", "recycling bin"),)),
    Task("pick up the cans and put them in the bin", (_on("green can", "bin"), _on("red can", "bin"))),
    Task("take the red mug to the kitchen", (_on("red mug", "counter", "kitchen table"),)),
    Task("put the toys away", (_on("yellow block", "toy box"),)),
    Task("tidy up the table", (_on("green can", "recycling bin"), _on("red mug", "counter"))),
    Task("go to the kitchen", effects=(Effect("ends", "kitchen"),)),
    Task("go to the kitchen and then come back", effects=(Effect("visits", "kitchen"), HOME)),
    Task("come here", effects=(HOME,)),
    Task("find the apple", effects=(Effect("tells where", "apple"),)),
    Task("find the banana", effects=(Effect("says", "I could not find the banana"),)),
    Task("where is the apple", effects=(Effect("tells where", "apple"),)),
    Task("what is on the counter", effects=(Effect("tells what is on", "counter"),)),
    Task("what do you see", effects=(Effect("tells what it sees"), STILL)),
    Task("pick up the red mug", effects=(Effect("holds", "red mug"),)),
    Task("open your hand", effects=(Effect("hand", "open"), STILL)),
    Task("close the gripper", effects=(Effect("hand", "closed"), STILL)),
    Task("wait", effects=(STILL,)),
    Task("say dinner is ready", effects=(Effect("says", "dinner is ready"), STILL)),
    Task(
        "put the apple in the bowl",
        effects=(Effect("says", "I cannot put things on or in the bowl"), STILL),
        laid={"yellow bowl": "kitchen table"},
    ),
    Task("open the fridge", effects=(Effect("says", "I cannot open or close doors, drawers or lids"), STILL)),
    Task("don't touch the red mug", effects=(Effect("says", "you told me not to, so I leave it"), STILL)),
    Task("swap the red mug and the blue mug", (_on("red mug", "counter"), _on("blue mug", "living table"))),
)
"""The lines of docs/COMMANDS.md, in its order where it has them."""

IN_HAND = Goal(effects=(Effect("holds", "red mug"),))
TALKS: tuple[Task, ...] = (
    Task(
        "pick up the red mug", (_on("red mug", "counter"),), first=IN_HAND,
        then=(Line("put it on the counter", "ended"),),
    ),
    Task(
        "pick up the red mug", effects=(Effect("rests", "red mug"),), first=IN_HAND,
        then=(Line("put it down", "ended"),),
    ),
    Task(
        "go to the kitchen", effects=(Effect("visits", "kitchen"), HOME),
        first=Goal(effects=(Effect("ends", "kitchen"),)), then=(Line("come here", "ended"),),
    ),
    Task(
        "close the gripper", effects=(Effect("hand", "open"),), first=Goal(effects=(Effect("hand", "closed"),)),
        then=(Line("open your hand", "ended"),),
    ),
    Task("bring me the red mug", effects=LEFT_OFF, then=(Line("stop", "NAVIGATING", 2.0),)),
    Task("bring me the red mug", effects=LEFT_OFF, then=(Line("cancel", "NAVIGATING", 2.0),)),
)  # fmt: skip
"""Follow-ups, stop and cancel."""
ALL = TASKS + TALKS


def commands(seed: int) -> Case:
    """Line after line of the page, then the conversations; the seed also places things on their surfaces."""
    return case_of(ALL[seed % len(ALL)], seed)


def case_of(task: Task, seed: int) -> Case:
    scene = scene_of({**LAID, **task.laid})
    wants = task.wants if task.said != LEFT else (_on(_left(scene, seed, "green can", "red can"), TRAY),)
    return Case(
        suite="commands", seed=seed, name="command", command=task.said,
        lines=(Line(task.said, goal=task.first), *task.then),
        thing=task.thing or (wants[0].thing if len(wants) == 1 else ""), wants=wants, effects=task.effects,
        expect="shown", settings=(VLA,), scene=scene, limit=SECONDS,
    )  # fmt: skip


def _left(scene: Scene, seed: int, *names: str) -> str:
    """The one of these things that is on the left as seen from home, where the person is."""
    x, y = scene.home.x, scene.home.y
    places = {p.spec.name: p.position for p in place_objects(scene, seed)}
    middle = sum(complex(places[n][0] - x, places[n][1] - y) for n in names)
    return max(names, key=lambda n: phase(complex(places[n][0] - x, places[n][1] - y) / middle))


def scene_of(laid: dict[str, str]) -> Scene:
    """The flat with these things alone, each on its surface."""
    scene = flat()
    placed = [msgspec.structs.replace(o, on=laid[o.name]) for o in scene.objects if o.name in laid]
    return msgspec.structs.replace(scene, objects=tuple(placed))
