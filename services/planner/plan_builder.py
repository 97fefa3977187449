"""A plan in the making: the steps so far and the world as they will have left it. Pure."""

import math
from typing import Literal

import msgspec

from common.floor_plan import Receptacle
from common.language.normalise import enumeration
from common.messages import AROUND, GRIPPER, PlanStep
from common.naming.part_names import is_for_people
from common.naming.words import Destination
from services.planner.choice_points import ChoicePoints
from services.planner.config import PlannerConfig
from services.planner.grammar.senses import Spot
from services.planner.grammar.vocabulary import Vocabulary
from services.planner.world import BelievedObject, World


class Refusal(Exception):
    """Why there is no plan, as a clause: spoken after "I cannot do that:", or alone if it begins with "I"."""


class Lost(Refusal):
    """A refusal of words that may mean something else than what they were taken for; `meant`: in plainer words."""

    def __init__(self, reason: str, meant: str = "") -> None:
        super().__init__(reason)
        self.meant = meant


class LookFirst(Exception):
    """The command needs sight of something: carry out these steps and ask again."""

    def __init__(self, steps: list[PlanStep]) -> None:
        super().__init__("look first")
        self.steps = steps


class PlanBuilder:
    """`done`: the steps already carried out for this command by a sender who asks again, None for one who does not."""

    def __init__(
        self,
        world: World,
        vocabulary: Vocabulary,
        config: PlannerConfig,
        choices: ChoicePoints,
        done: list[PlanStep] | None = None,
    ) -> None:
        self.world, self.vocabulary, self.config, self.choices, self.done = world, vocabulary, config, choices, done
        self.steps: list[PlanStep] = []
        self.last: list[BelievedObject] = []
        self.told: dict[str, tuple[str, Spot | None]] = {}
        self.spot: Spot | None = None
        self.need = ""
        self.unmet = ""
        self.moved, self.leaving = False, False
        self.effort = [0]
        self.collecting, self.got = set[str](), set[str]()
        self._found: set[str] = set()

    def fork(self) -> "PlanBuilder":
        """A copy to try something on; its choices count only when it is adopted."""
        other = PlanBuilder(self.world.copy(), self.vocabulary, self.config, self.choices.fork(), self.done)
        other.steps, other.last, other.spot = list(self.steps), list(self.last), self.spot
        other.told = dict(self.told)
        other.need, other.unmet = self.need, self.unmet
        other.moved, other.leaving = self.moved, self.leaving
        other._found, other.effort = set(self._found), self.effort
        other.collecting, other.got = set(self.collecting), set(self.got)
        return other

    def adopt(self, other: "PlanBuilder") -> None:
        self.world, self.steps, self.last, self.spot = other.world, other.steps, other.last, other.spot
        self.told = other.told
        self.moved, self.leaving = other.moved, other.leaving
        self._found, self.collecting, self.got = other._found, other.collecting, other.got
        self.choices.taken, self.need, self.unmet = other.choices.taken, other.need, other.unmet

    # --- steps
    def say(self, text: str) -> None:
        self.steps.append(PlanStep(action="say", text=text))

    def wait(self, seconds: float = 0.0) -> None:
        self.steps.append(PlanStep(action="wait", seconds=seconds))

    def go(self, spot: Spot) -> None:
        if self.leaving and self.steps[-1:] == [PlanStep(action="return")]:
            self.steps.pop()  # "get out of the kitchen and go to the study"
        self.spot, self.leaving = spot, False
        self.moved = True
        step = PlanStep(action="return") if spot.home else PlanStep(action="navigate", target=spot.name)
        if self.steps[-1:] != [step]:  # "go to your corner, dock"
            self.steps.append(step)

    def approach(self, item: BelievedObject) -> None:
        """Find an object and drive up to it."""
        self.find(item)
        self.moved = True
        self.steps.append(PlanStep(action="navigate", object=item.label))

    def find(self, item: BelievedObject, words: str = "") -> None:
        """`words` are the whole phrase where the label alone does not tell which one is meant."""
        self.last = [item]
        if item.label not in self._found:
            self._found.add(item.label)
            self.steps.append(PlanStep(action="find", object=item.label, text=words))
            self.moved = True

    def collect(self, items: list[BelievedObject]) -> None:
        """Several objects at once, one after the other, once it is said where to; the hand holds one."""
        self.last, self.collecting = items, {t.label for t in items}

    def _not_over(self, label: str) -> None:
        """Take back the steps that would only hand a thing over: `get the mug, then the can, and put both there`."""
        self.got.discard(label)
        for at in reversed(range(len(self.steps))):
            part = self.steps[at : at + 4]
            if part[0].object == label and [s.action for s in part] == ["find", "grasp", "return", "release"]:
                self._found.discard(label)
                del self.steps[at : at + 4]

    def take(self, item: BelievedObject, words: str = "") -> None:
        """Have it in the hand; what else is there is put down first."""
        if item.label in self.got:
            self._not_over(item.label)
        self.collecting.discard(item.label)
        held = self.world.held
        if held is not None and held.label == item.label:
            self.last = [held]
            return
        if held is not None:
            self.place(self._set_down(held))
        if self.steps and self.steps[-1].action == "place" and self.steps[-1].object == item.label:
            self.steps.pop()  # "take it to the kitchen and leave it by the bowl": it need not be put down between
            self.world.grasp(item.label)
            return
        self.find(item, words)
        self.steps.append(PlanStep(action="grasp", object=item.label))
        self.world.grasp(item.label)
        self.last = [item]

    def place(self, receptacle: Receptacle, near: str = "") -> None:
        """Put what is held there, next to an object if one is named."""
        held = self._held()
        self.steps.append(PlanStep(action="place", object=held.label, target=receptacle.name, near=near))
        self.world.put(receptacle.name)
        self._found.discard(held.label)
        self.last, self.spot, self.moved = [held], Spot(receptacle.name, receptacle=receptacle), True

    def hand_over(self) -> None:
        """Bring what is held to where the person is."""
        self._held()
        self.steps.append(PlanStep(action="return"))
        self.release()
        self.moved = True

    def release(self) -> None:
        """Put what is held down within reach."""
        held = self._held()
        self.steps.append(PlanStep(action="release"))
        self.world.put("")
        self._found.discard(held.label)
        self.last = [held]

    def hand_alone(self, action: Literal["grasp", "release"]) -> None:
        """Close or open the empty hand."""
        self.steps.append(PlanStep(action=action, target=GRIPPER))

    def _held(self) -> BelievedObject:
        held = self.world.held
        if held is None:
            raise Refusal("there is nothing in my hand")
        return held

    # --- where things go
    def destination(self, item: BelievedObject, rules: tuple[Destination, ...]) -> Receptacle:
        """By the first rule that fits the thing and the household."""
        for rule in rules:
            if (rule.kinds and item.kind not in rule.kinds) or (rule.colours and item.colour not in rule.colours):
                continue
            if rule.names and not {item.label, *item.names} & set(rule.names):
                continue
            if options := self.named(rule.to):
                return self.choices.pick(options)
        raise Lost(f"I do not know where the {item.label} goes")

    def in_room(self, room: str) -> Receptacle:
        """A surface of a room to put something on, a bed or a sofa last."""
        found = self.vocabulary.surfaces(room)
        order = {kind: i for i, kind in enumerate(self.config.set_down)}
        options = sorted((r for r in found if r.kind in order), key=lambda r: (is_for_people(r.name), order[r.kind]))
        if not options:
            raise Refusal(f"there is nothing in the {room} to put things on")
        return self.choices.pick(options)

    def _set_down(self, held: BelievedObject) -> Receptacle:
        """Where something that is in the way was taken from, else the nearest surface."""
        here, origin = self.world.pose[:2], self.world.history.taken_from.get(held.label)
        found = sorted(self.vocabulary.surfaces(), key=lambda r: (r.name != origin, math.dist(r.center[:2], here)))
        if not found:
            raise Refusal(f"I am holding the {held.label} and see no place to put it down")
        return self.choices.pick(found)

    def named(self, wanted: tuple[str, ...]) -> list[Receptacle]:
        """The receptacles of these names, or of these kinds where no receptacle has the name."""
        household = self.world.household
        found: list[Receptacle] = []
        for name in wanted:
            exact = household.receptacle(name)
            found += [exact] if exact else [r for r in household.receptacles if r.kind == name and r.spawn]
        return list(dict.fromkeys(found))

    # --- looking first
    def look_at(self, spots: list[Receptacle]) -> None:
        """Have a look there before anything else, unless that was done or the sender would not ask again."""
        visited = {s.target for s in self.done or () if s.action == "navigate"}
        there = [PlanStep(action="navigate", target=r.name) for r in spots if r.name not in visited]
        if there and self.done is not None:
            raise LookFirst([step for going in there for step in (going, PlanStep(action="wait"))])

    def turn_around(self, way: list[PlanStep]) -> None:
        """Go there and look around before anything is said, unless that was done or the sender would not ask again."""
        if self.done is not None and not any(s.target == AROUND for s in self.done):
            raise LookFirst([*way, PlanStep(action="navigate", target=AROUND)])

    def search_first(self, searches: list[PlanStep]) -> None:
        """Find things before anything is said of them, unless that was done or the sender would not ask again."""
        if self.done is not None and not any(s.action == "find" for s in self.done):
            raise LookFirst(searches)

    def look_first(self, spots: list[Receptacle], reason: str) -> None:
        """As `look_at`, where nothing is known so far; `reason` is what is missing.

        Raises:
            Refusal: nobody would ask again, or a look has shown nothing.
        """
        if self.done is None:
            raise Refusal(reason)
        self.look_at(spots)
        seen = enumeration([f"the {r.name}" for r in spots])
        raise Refusal(f"I looked at {seen} and found nothing of the kind" if spots else reason)


def same(a: list[PlanStep], b: list[PlanStep]) -> bool:
    """Equal but for what is said."""
    one, other = ([s if s.action == "say" else msgspec.structs.replace(s, text="") for s in steps] for steps in (a, b))
    return one == other
