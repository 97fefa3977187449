"""A text read clause by clause: what is told of a thing is noted, what is asked for goes into the plan. Pure."""

import re
from collections.abc import Sequence

from common.language.breaks import is_statement
from common.language.discourse import commands
from common.language.lexicon import A_WISH, COMMANDING
from common.language.meaning import asks_for
from common.language.normalise import Words
from common.language.wording import COURTESIES
from common.messages import SENSELESS, PlanStep
from services.planner.commands import answers
from services.planner.grammar.clause import read_clause
from services.planner.grammar.mention import expected, note
from services.planner.grammar.phrases import Phrase, read
from services.planner.grammar.repetition import repeated
from services.planner.grammar.rules import ACTIONS
from services.planner.plan_builder import Lost, PlanBuilder, Refusal
from services.planner.reference.fits import fitting

MAX_CHARACTERS = 2000
"""Longest text that is read (chosen: a minute of speech has a thousand characters)."""
MAX_WORDS = 60
"""Longest clause (chosen: the readings of a pattern grow with its square)."""
_VERBS = frozenset({"is", "are", "was", "were", "has", "have", "needs", "goes", "belongs"})
"""Words that make more than a name of a clause that begins with one."""

_WISHES = re.compile(rf"^{A_WISH} (?P<wanted>(?:some|something|an?) (?!.*\b(?:too|also|another|more|well)\b).+)$")
"""A wish for something of a kind, and not for one more."""


def _sentences(command: str, builder: PlanBuilder) -> list[str]:
    """The clauses of a command, what is to be repeated in full.

    Raises:
        Refusal: there is none, or it is too long.
    """

    def is_place(words: Words) -> bool:
        return bool(builder.vocabulary.spot(words))

    sentences = commands(command[:MAX_CHARACTERS], is_place)
    again = repeated(command, sentences, builder.world.history, is_place)
    if again is not command:
        sentences = commands(again, is_place)
    if not sentences:
        raise Lost("I did not hear a command")
    if len(command) > MAX_CHARACTERS or any(len(s.split()) > MAX_WORDS for s in sentences):
        raise Refusal("that is too long a sentence for me")
    return sentences


def _tells(words: Words, following: Sequence[str]) -> bool:
    """Is a clause only about a thing that the `following` one asks for? "I want the apple. Put it on the desk"."""
    wanted = words[0] in ("i", "we") and is_statement(" ".join(words)) and {"it", "them"} & set(following)
    return bool(wanted) or expected(words, following)


def _explains(words: Words, builder: PlanBuilder) -> bool:
    """Is a wish fulfilled by what was asked for just before, so that it only tells why that was?"""
    found = _WISHES.match(" ".join(words))
    phrase = read(tuple(found["wanted"].split()), builder.vocabulary) if found else None
    return isinstance(phrase, Phrase) and bool(builder.last) and any(map(fitting(builder, phrase), builder.last))


def _is_topic(words: Words, following: Sequence[str], builder: PlanBuilder, named_first: bool) -> bool:
    """Does a clause only say what the `following` one is about? It is noted; `named_first`: it is a name alone."""
    if _tells(words, following) or (named_first and {"it", "them"} & set(following) and _VERBS.isdisjoint(words)):
        note(words, builder)  # "the red can, bin it"
        return True
    if {"there", "it"} & set(following) and (topic := builder.vocabulary.spot(words)):
        builder.spot = topic[0]  # "the bookshelf. What is there?"
        return True
    return False


def read_text(command: str, builder: PlanBuilder) -> list[PlanStep]:
    """Everything that a text asks for, as steps.

    Raises:
        Refusal: a clause is not understood or cannot be done.
    """
    if courtesy := asks_for(command, *COURTESIES):
        ACTIONS[courtesy](builder, {})
        return builder.steps
    sentences = _sentences(command, builder)
    first = read(tuple(sentences[0].split()), builder.vocabulary)
    names = len(sentences) > 1 and isinstance(first, Phrase) and not first.sense.new
    said: Words = ("bring",) if names else ()
    for number, sentence in enumerate(sentences):
        words = tuple(sentence.split())
        following = sentences[number + 1].split() if number + 1 < len(sentences) else []
        if _is_topic(words, following, builder, named_first=number == 0 and names):
            continue
        if number and words[0] == "any" and sentences[number - 1].endswith(f" {' '.join(words[1:])}"):
            continue  # "get me a can. Any can"
        if number and _explains(words, builder):
            continue
        if words[0] == "otherwise":
            if not builder.unmet:
                break
            builder.unmet, words = "", words[1:]
        if builder.unmet or not words:
            continue
        try:
            read_clause(words, builder, alone=len(sentences) == 1, said=said)
        except Refusal:
            if number + 1 == len(sentences) or not is_statement(sentence):
                raise
            note(words, builder)
        if words[0] in COMMANDING:
            said = words
        else:  # a verb that nobody said is understood of what is known alone
            said = () if builder.vocabulary.new_nouns else ("bring", *words)
    return _steps(builder)


def _steps(builder: PlanBuilder) -> list[PlanStep]:
    """What the clauses came to.

    Raises:
        Refusal: that is nothing, or something is left open.
    """
    if builder.unmet:
        builder.say(builder.unmet)
    if builder.collecting:
        raise Refusal("I can hold only one thing at a time")
    if not builder.steps and builder.need:
        read_clause(("bring", "me", *builder.need.split()), builder, alone=True)
    if not builder.steps:
        raise Lost(f"{SENSELESS} what I should do")
    if all(step.action == "find" for step in builder.steps):
        answers.found(builder)
    return builder.steps
