"""Everything that speech can hear, and noise, against the grammar: planned so that the brain accepts it, or refused."""

import random
import re

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from common import config
from common.household import load_household
from common.messages import ActionPlan, RejectedPlan, WorldObject
from common.plan_rules import known_world, objection
from services.planner.config import PlannerConfig
from services.planner.grammar import grammar
from services.planner.world import believed
from services.speech.config import SpeechConfig
from services.speech.recognise.grammar import vocabulary

CONFIG = config.load("planner", PlannerConfig, config.DEFAULT_DIR, {})
SPEECH = config.load("speech", SpeechConfig, config.DEFAULT_DIR, {})
SCENE = load_household("apartment")
_TOKEN = re.compile(r"<(\w+)>|([()\[\]|])|([a-z0-9']+)")
_NAMED = re.compile(r"^(\w+)\s*=\s*(.+)$")


class Speaker:
    """Says random sentences of the speech grammar."""

    def __init__(self, seed: int) -> None:
        self._rng = random.Random(seed)
        self._parts = dict(vocabulary(SCENE, SPEECH.objects, SPEECH.places, SPEECH.colours))
        self.sentences: list[str] = []
        for line in SPEECH.commands:
            if named := _NAMED.match(line):
                self._parts.setdefault(named[1], []).append(named[2])
            else:
                self.sentences.append(line)

    def say(self, pattern: str = "") -> str:
        self._tokens = _TOKEN.findall(pattern or self._rng.choice(self.sentences))
        words, at = self._alternatives(self._tokens, 0)
        assert at == len(self._tokens)
        return " ".join(words)

    def _alternatives(self, tokens: list[tuple[str, str, str]], at: int) -> tuple[list[str], int]:
        options = []
        while True:
            words, at = self._sequence(tokens, at)
            options.append(words)
            if at >= len(tokens) or tokens[at][1] != "|":
                return self._rng.choice(options), at
            at += 1

    def _sequence(self, tokens: list[tuple[str, str, str]], at: int) -> tuple[list[str], int]:
        words: list[str] = []
        while at < len(tokens) and tokens[at][1] not in ("|", ")", "]"):
            part, mark, word = tokens[at]
            if word:
                words.append(word)
            elif part:
                words += self._alternatives(_TOKEN.findall(self._rng.choice(self._parts[part])), 0)[0]
            else:
                inner, at = self._alternatives(tokens, at + 1)
                words += inner if mark == "(" or self._rng.random() < 0.5 else []
            at += 1
        return words, at


def world(rng: random.Random) -> list[WorldObject]:
    """Some objects on some surfaces."""
    shelves = [r for r in SCENE.receptacles if r.spawn]
    rows = []
    for spec in rng.sample(SCENE.things, rng.randint(0, len(SCENE.things))):
        r = rng.choice(shelves)
        x, y = r.center[0] + rng.uniform(-0.2, 0.2), r.center[1] + rng.uniform(-0.2, 0.2)
        position = (x, y, r.center[2] + 0.05)
        rows.append(WorldObject(label=spec.name, kind=spec.kind, colour=spec.colour, position=position, on=r.name))
    return rows


def plan_of(command: str, objects: list[WorldObject], held: str, rejected: tuple[RejectedPlan, ...] = ()) -> ActionPlan:
    told = known_world(SCENE, [o.label for o in objects], held)
    plan = grammar.plan(command, believed(SCENE, told, objects), CONFIG, rejected)
    if plan.steps:
        assert objection(plan.steps, told, SCENE) is None, f"{command!r} with {held!r} in hand: {plan.steps}"
    else:
        assert plan.detail, command
    return plan


@pytest.mark.parametrize("seed", [0, *(pytest.param(n, marks=pytest.mark.slow) for n in range(1, 6))])
def test_every_command_that_can_be_heard_is_planned_or_refused_with_its_reason(seed: int) -> None:
    rng, speaker = random.Random(seed), Speaker(seed)
    planned = 0
    for _ in range(60):
        command = speaker.say(rng.choice(["", "<command>", "<command>", "<command> and then <command>"]))
        objects = world(rng)
        held = rng.choice(["", "", rng.choice(objects).label if objects else "apple"])
        plan = plan_of(command, objects, held)
        planned += bool(plan.steps)
        # Words that fit nowhere are named.
        names = any(word in command for word in (*SPEECH.objects, *SPEECH.colours)) or "has to do with" in plan.detail
        assert names or "do not understand" not in plan.detail, f"{command!r}: {plan.detail}"
    assert planned > 10


@pytest.mark.parametrize("seed", range(4))
def test_a_rejected_plan_never_comes_twice(seed: int) -> None:
    rng, speaker = random.Random(seed), Speaker(seed)
    for _ in range(25):
        command, objects = speaker.say("<command>"), world(rng)
        rejected: list[RejectedPlan] = []
        for _ in range(5):
            plan = plan_of(command, objects, "", tuple(rejected))
            if not plan.steps:
                assert not rejected or plan.detail == "it cannot be done"
                break
            assert all(plan.steps != r.steps for r in rejected), command
            step = rng.randint(1, len(plan.steps))
            rejected.append(RejectedPlan(steps=plan.steps, reason="it cannot be done", step=step))


SALAD = (
    "bring me the all a and then put it them in on to of next left right red blue mug mugs can apple table kitchen bin "
    "tidy up away where is what other second two everything pick down go there not from one , please"
)
WORDS = st.sampled_from(SALAD.split())


@pytest.mark.slow
@settings(max_examples=150, deadline=None, suppress_health_check=[HealthCheck.too_slow], derandomize=True)
@given(st.lists(WORDS, max_size=14), st.sampled_from(["", "red mug"]))
def test_no_salad_of_words_makes_a_bad_plan(words: list[str], held: str) -> None:
    plan_of(" ".join(words), world(random.Random(1)), held)


@settings(max_examples=60, deadline=None, suppress_health_check=[HealthCheck.too_slow], derandomize=True)
@given(st.text(max_size=80))
def test_no_text_at_all_breaks_it(command: str) -> None:
    plan_of(command, [], "")
