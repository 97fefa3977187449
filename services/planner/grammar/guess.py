"""What a sentence could mean that no construction fits: questions are answered, requests are asked about. Pure."""

from collections.abc import Collection, Sequence
from contextlib import suppress
from typing import NamedTuple

from common.language.itself import about_itself
from common.language.lexicon import HANDLING
from common.language.mood import forbids, is_asked
from common.language.normalise import Words
from common.messages import PlanStep
from services.planner.grammar.accounting import unaccounted
from services.planner.grammar.chunks import chunks
from services.planner.grammar.clause import read_clause
from services.planner.grammar.mention import note
from services.planner.grammar.rules import ACTIONS
from services.planner.plan_builder import PlanBuilder, Refusal
from services.planner.semantic.parse import LEAST, Part
from services.planner.semantic.ranker import rank

LONGEST = 40
"""Words of the longest question that is read (chosen: bounds the time)."""
MOST = 4
"""Most plain questions that one may come to (chosen)."""
SURE = 0.5
"""Least probability of a guess at what was understood otherwise (chosen on lists left out)."""
FIRM = 0.8
"""Least probability of a guess that a plan for things all known has to agree with (chosen on lists left out)."""
CERTAIN = 0.9
"""Least probability of a guess that does something, where the plan only answers in words (chosen likewise)."""
_DEEDS = frozenset({"grasp", "place", "release", "return", "rule"})
"""Actions by which plans differ that do something else, beside waiting; others go before these, or move nothing."""
_EXCEPT = frozenset({"but", "except", "excluding", "without"})
"""Words behind which stands what no guess takes account of."""
_NOTHING = "there is nothing to guess"


class Guess(NamedTuple):
    """`texts`: the plain commands or questions that the sentence comes to; `steps`: what they are planned as.

    `answers`: it was a question, and is answered in words alone; `p`: with how much probability it is meant.
    """

    texts: list[str]
    steps: list[PlanStep]
    answers: bool
    p: float


def answer(clauses: Sequence[str], builder: PlanBuilder) -> Guess:
    """The answers to clauses that are all questions.

    Raises:
        Refusal: one of them is none, or has no answer in words alone.
    """
    texts: list[str] = []
    for words in (tuple(clause.split()) for clause in clauses):
        if not words or len(words) > LONGEST or forbids(" ".join(words)) or not is_asked(words):
            raise Refusal(_NOTHING)
        texts.append(_answer(words, builder))
    if not texts or any(step.action != "say" for step in builder.steps):
        raise Refusal(_NOTHING)
    return Guess(texts, builder.steps, answers=True, p=1.0)


def _answer(words: Words, builder: PlanBuilder) -> str:
    """Plan the reading of a question that leaves the fewest names aside, and say which."""
    found: list[tuple[int, str, PlanBuilder]] = []
    about = about_itself(words, wholly=False) if not chunks(words, builder.vocabulary, pronouns=True) else None
    for text in (" ".join(words), *_likely(words, builder)):
        trial = builder.fork()
        trial.effort = [0]
        with suppress(Refusal):
            read_clause(tuple(text.split()), trial, alone=False)
            steps = trial.steps[len(builder.steps) :]
            ignored = unaccounted([" ".join(words)], steps, builder.world, builder.vocabulary)
            found += [(len(ignored), text, trial)] if steps else []
    if about is not None:
        trial = builder.fork()
        ACTIONS[about](trial, {})
        found.insert(0, (0, " ".join(words), trial))
    if not found:
        raise Refusal(_NOTHING)
    _, text, best = min(found, key=lambda reading: reading[0])
    builder.adopt(best)
    return text


def _likely(words: Words, builder: PlanBuilder) -> list[str]:
    """The likeliest plain questions that the words may come to, those first that leave the fewest names aside.

    One that names nothing has to be as likely as any guess, and the words name nothing either.
    """
    names = bool(chunks(words, builder.vocabulary, pronouns=True))
    ranked = [
        r
        for r in rank(words, builder.vocabulary)
        if r.candidate.kind == "ask" and (r.candidate.roles or (r.p > LEAST and not names))
    ]
    return [r.candidate.text for r in sorted(ranked, key=lambda r: -len(r.candidate.roles))[:MOST]]


def guess(parts: Sequence[Part], builder: PlanBuilder) -> Guess:
    """The plan of the likeliest parts of a sentence; what is told in it is noted.

    Raises:
        Refusal: it asks for nothing, cannot be planned, is a question beside a request, or is too uncertain.
    """
    asked = [part for part in parts if part.meant.text]
    p = min((part.p for part in asked), default=0.0)
    if p < LEAST:
        raise Refusal(_NOTHING)
    builder.vocabulary.new_nouns = builder.config.open_vocabulary
    try:
        for part in parts:
            if part.meant.text:
                read_clause(tuple(part.meant.text.split()), builder, alone=False)
            else:
                note(part.words, builder)
    finally:
        builder.vocabulary.new_nouns = False
    if not builder.steps:
        raise Refusal(_NOTHING)
    answers = all(part.meant.kind == "ask" for part in asked) and all(s.action == "say" for s in builder.steps)
    if answers and any(not part.meant.text and part.words[0] in HANDLING for part in parts):
        raise Refusal(_NOTHING)  # "what is on the desk? bring it to me"
    return Guess([part.meant.text for part in asked], builder.steps, answers, p)


def contradicted(words: Words, steps: Sequence[PlanStep], likely: Guess, known: Collection[str]) -> bool:
    """Does the likeliest reading do something else than a plan, and no more, so that it is asked about first?

    A thing among the words that is not `known` by its name is doubted sooner, for any words may look like one. On lists
    left out 11 of 13 such plans are wrong, and 7 of 17 of the others.
    """
    if all(step.action == "say" for step in steps):
        says = any(text.startswith("say ") for text in likely.texts)  # "say hello and then go to the kitchen"
        acts = any(step.action != "say" and (says or step.action != "find") for step in likely.steps)
        return acts and not likely.answers and likely.p >= (FIRM if says else CERTAIN)
    done, others = _acts(steps), _acts(likely.steps)
    if likely.answers or not done or done == others or set(others) >= set(done):
        return False
    left_out = {step.action for step in steps} - {step.action for step in likely.steps}
    if "return" in left_out and len(others) > 1 and not {"me", "us"}.isdisjoint(words):
        return False  # the guess leaves aside for whom it is
    unlisted, guessed = _unlisted(steps, known), _unlisted(likely.steps, known)
    new = {word for label in unlisted for word in label.split()}.intersection(words)
    part = any(f" {name} " in f" {label} " for label in unlisted for name in known)  # "wee yellow block"
    handles = any(step.object for step in likely.steps)
    if not part and handles and new & {word for text in likely.texts for word in text.split()}:
        return False  # the guess only knows a part of the name, "can" of "can of paint"
    if not new and (guessed or set(others) < set(done) or not _EXCEPT.isdisjoint(words)):
        return False  # the guess knows less, or leaves a part aside
    return likely.p >= (SURE if new else FIRM)


def _unlisted(steps: Sequence[PlanStep], known: Collection[str]) -> set[str]:
    return {step.object for step in steps if step.action in ("find", "grasp") and step.object not in known}


def _acts(steps: Sequence[PlanStep]) -> list[tuple[str, str, str, str, float]]:
    return [(s.action, s.object, s.target, s.near, s.seconds) for s in steps if s.action in _DEEDS or s.seconds]
