"""What a sentence could mean that no construction of the grammar fits, to be asked about first. Pure.

Each clause is tried from every verb on that may begin a request, so that any words may stand before it; then by its
parts alone (roles.py). Of several readings the one counts that leaves the fewest of the named things and places aside.
"""

from collections.abc import Iterator, Sequence
from contextlib import suppress
from typing import NamedTuple

from common.language.breaks import is_statement
from common.language.frame import SMALL_TALK
from common.language.itself import about_itself
from common.language.mood import SUBJECTS, forbids, is_of_others, is_told
from common.language.normalise import DETERMINERS, Words, infinitive
from common.language.verb_classes import VERBS, classes
from common.messages import PlanStep
from services.planner.grammar.accounting import unaccounted
from services.planner.grammar.chunks import POINTING, chunks
from services.planner.grammar.clause import read_clause
from services.planner.grammar.mention import note
from services.planner.grammar.roles import by_roles, is_asked
from services.planner.grammar.rules import ACTIONS
from services.planner.plan_builder import PlanBuilder, Refusal

_CONJUNCTIONS = frozenset({"and", "then", "so", "but", "because", "while", "since", "also", "plus", "though"})
_ARTICLES = DETERMINERS - {"that"}
"""Words that a noun follows."""
LONGEST = 40
"""Words of the longest clause of which anything is guessed (chosen: bounds the time)."""
MOST = 8
"""Most readings of one clause that are tried (chosen: bounds the time)."""


class Guess(NamedTuple):
    """`texts`: the plain commands or questions that the sentence comes to; `steps`: what they are planned as.

    `answers`: it was a question, and is answered in words alone.
    """

    texts: list[str]
    steps: list[PlanStep]
    answers: bool


def guess(clauses: Sequence[str], builder: PlanBuilder) -> Guess:
    """What the clauses could mean.

    Raises:
        Refusal: nothing suggests a command, or something forbids to guess.
    """
    for clause in clauses:
        if forbids(clause) or len(clause.split()) > LONGEST:
            raise Refusal("there is nothing to guess")
    texts: list[str] = []
    for number, clause in enumerate(clauses, 1):
        words = tuple(clause.split())
        if number < len(clauses) and is_statement(clause) and not is_asked(words):
            note(words, builder)
            continue
        texts += _clause(words, builder) or _pieces(words, builder)
    if not texts or not builder.steps:
        raise Refusal("there is nothing to guess")
    asked = all(is_asked(tuple(clause.split())) for clause in clauses)
    return Guess(texts, builder.steps, asked and all(s.action == "say" for s in builder.steps))


def _clause(words: Words, builder: PlanBuilder) -> list[str]:
    """Plan the best reading of a clause as one, and say which; [] when there is none."""
    readings = [(len(ignored), at, text, trial) for at, (ignored, text, trial) in enumerate(_readings(words, builder))]
    if not readings:
        return []
    _, _, text, trial = min(readings, key=lambda r: r[:2])
    builder.adopt(trial)
    return [text]


def _readings(words: Words, builder: PlanBuilder) -> Iterator[tuple[list[str], str, PlanBuilder]]:
    """Plans of a clause with the names in it that have nothing to do with them, and the words planned."""
    asks = is_asked(words)
    inside = {at for c in chunks(words, builder.vocabulary) for at in range(c.begin, c.end)}
    verbs_only = tuple("_" if at in inside or word in POINTING else word for at, word in enumerate(words))
    tries: list[tuple[Words, Words]] = [((), words)]
    if not asks:
        tries += [(words[:at], (infinitive(words[at], VERBS), *words[at + 1 :])) for at in _beginnings(words)]
    if ((asks and words[0] not in SUBJECTS.split("|")) or not is_told(verbs_only)) and (
        asks or not _is_strange(words, inside)
    ):
        tries += [((), tuple(text.split())) for text in by_roles(words, builder.vocabulary)]
    itself = about_itself(words, wholly=False) if asks and not inside else None
    if itself is not None:
        trial = builder.fork()
        ACTIONS[itself](trial, {})
        yield [], " ".join(words), trial
    for told, asked in tries[: MOST + 1]:
        trial = builder.fork()
        trial.effort = [0]
        if told:
            note(told, trial)
        with suppress(Refusal):
            read_clause(asked, trial, alone=False)
            steps = trial.steps[len(builder.steps) :]
            if steps and (asks or (asked[0] == "say" and not told) or any(s.action != "say" for s in steps)):
                ignored = unaccounted([" ".join(words)], steps, builder.world, builder.vocabulary)
                yield ignored, " ".join(asked), trial


def _beginnings(words: Words) -> list[int]:
    """Where a request may begin: at verbs that the robot is to act by."""
    return [
        at
        for at, word in enumerate(words[:-1])
        if at and classes(word) and (word in VERBS or word.endswith("ing")) and not is_of_others(words, at)
    ]


def _is_strange(words: Words, known: set[int]) -> bool:
    """Is something named behind the first verb that nobody knows, as `the wall` in `throw the mug at the wall`?"""
    first = next((at for at, word in enumerate(words) if classes(word)), len(words))
    unknown = (at for at in range(first, len(words) - 1) if words[at] in _ARTICLES and at not in known)
    return any(at + 1 not in known and words[at + 1] not in SMALL_TALK for at in unknown)


def _pieces(words: Words, builder: PlanBuilder) -> list[str]:
    """Plan the parts of a clause between its conjunctions one after the other; what is no request is noted."""
    parts: list[list[str]] = [[]]
    for word in words:
        if word in _CONJUNCTIONS:
            parts.append([])
        else:
            parts[-1].append(word)
    texts: list[str] = []
    for part in map(tuple, filter(None, parts)):
        found = _clause(part, builder) if len(part) < len(words) else []
        if not found:
            note(part, builder)
        texts += found
    return texts
