"""One clause, or several joined by "and", on a plan under construction: as it stands, simplified, reworded."""

from common.language.exchange import noun_phrases, replaced
from common.language.lexicon import COMMANDING
from common.language.meaning import VERBS, is_question
from common.language.normalise import DETERMINERS, Words, infinitive
from common.language.noun_phrase import PLURAL_PRONOUNS, PRONOUNS
from common.language.politeness import without_politeness
from common.language.simplify import simplified
from common.language.word_order import reworded
from services.planner.grammar.phrases import Phrase, read
from services.planner.grammar.rules import NoWording, apply_first
from services.planner.plan_builder import Lost, PlanBuilder, Refusal

MAX_EFFORT = 120
"""Most clauses tried for one text (chosen: bounds the time for long lists)."""
_THING_STARTS = DETERMINERS | PRONOUNS | PLURAL_PRONOUNS | {"all", "every", "two", "three"}


_WHERETO = frozenset({"to", "onto", "into", "on", "in", "at", "next", "beside", "near"})
"""Words before a place where something is to be put."""
_POINTING = frozenset({"it", "this", "that", "one"})
"""Last words of what only points at the thing in the hand."""


class _Failure(Exception):
    """`at`: how many words were understood before it."""

    def __init__(self, at: int, reason: Refusal) -> None:
        super().__init__(str(reason))
        self.at, self.reason = at, reason


def read_clause(words: Words, builder: PlanBuilder, alone: bool, said: Words = ()) -> None:
    """One part of the sentence: one command, or several joined by "and"; `said` is the part before."""
    try:
        _joined(words, builder, said, 0, alone)
    except _Failure as failure:
        raise failure.reason from None


def _joined(words: Words, builder: PlanBuilder, said: Words, at: int, alone: bool) -> None:
    """Carry out `words` as the longest command that works, followed by the rest; changes `builder` only on success."""
    cuts = [len(words), *(i for i in range(len(words) - 1, 0, -1) if words[i] == "and")]
    worst: _Failure | None = None
    for cut in cuts:
        head, rest = words[:cut], words[cut + 1 :]
        trial = builder.fork()
        try:
            _command(head, trial, said, at, alone and not rest)
            if rest and not trial.unmet:
                _joined(rest, trial, head if head[0] in COMMANDING else ("put", *head), at + cut, False)
        except _Failure as failure:
            worst = failure if worst is None or failure.at >= worst.at else worst
            continue
        builder.adopt(trial)
        return
    assert worst is not None
    if not _run_on(words, builder, said, at):
        raise worst


def _run_on(words: Words, builder: PlanBuilder, said: Words, at: int) -> bool:
    """Carry out `go to the kitchen look around come back`: commands one after the other without a word between them."""
    for cut in range(2, 0 if is_question(" ".join(words)) else len(words)):
        if words[cut] not in _BEGINS or words[cut - 1] in _NO_END or words[0] not in VERBS:
            continue
        trial = builder.fork()
        try:
            _command(words[:cut], trial, said, at, False)
            if not trial.unmet:
                _joined(words[cut:], trial, words[:cut], at + cut, False)
        except _Failure:
            continue
        builder.adopt(trial)
        return True
    return False


_BEGINS = (COMMANDING | {"look"}) - {"place", "pass", "hand", "spot", "head", "set", "lay", "left", "clean", "clear"}
"""Verbs with which the next command may begin without a word before it."""
_NO_END = DETERMINERS | {"and", "to", "not", "you", "i", "we", "that", "please", "can", "or", "never"}
"""Words with which no command ends."""


def _command(words: Words, builder: PlanBuilder, before: Words, at: int, alone: bool) -> None:
    """The first form that fits the words and can be done; else the reason of the first that fits."""
    if not words:
        raise _Failure(at, Lost("I did not hear a command"))
    words = tuple(without_politeness(" ".join(words)).split()) or words
    builder.effort[0] += 1
    if builder.effort[0] > MAX_EFFORT:
        raise Refusal("that is too long a sentence for me")
    words = words if words[0] == "got" else (infinitive(words[0], VERBS), *words[1:])
    reason = _apply(words, builder, before, alone)
    if (
        reason is not None
        and (simple := simplified(words)) not in ((), words)
        and _apply(simple, builder, before, alone) is None
    ):
        return
    if reason is None or _apply_reworded(words, builder, before, alone):
        return
    if any(apply_first(other, builder, "told") is None for other in (words, *reworded(words, verbs_only=True))):
        return
    raise _Failure(at - isinstance(reason, NoWording), reason)


def _apply_reworded(words: Words, builder: PlanBuilder, before: Words, alone: bool) -> bool:
    """Carry out the first rewriting of a clause that can be done; was there one?"""
    for other in reworded(words, builder.vocabulary.new_nouns):
        builder.effort[0] += 1
        if builder.effort[0] > MAX_EFFORT:
            raise Refusal("that is too long a sentence for me")
        if _apply((infinitive(other[0], VERBS), *other[1:]), builder, before, alone) is None:
            return True
    return False


def _apply(words: Words, builder: PlanBuilder, before: Words, alone: bool) -> Refusal | None:
    """As `apply_first`, for a clause that may be a name alone or lack what was said in the one `before` it."""
    verb = before[0] if before else ""
    reason = apply_first(words, builder, "command", "reply")
    if not isinstance(reason, NoWording):
        return reason
    if where := _where_to_put(words, builder):
        return apply_first(where, builder, "name")
    if alone:
        return apply_first(words, builder, "name")
    if (verb in ("go", "drive", "come", "head", "visit") or before[1:2] == ("by",)) and builder.vocabulary.spot(words):
        return apply_first(("go", "to", *words), builder, "command")
    if verb and _is_thing(words, builder):
        # "put the mug on the table and the can on the counter": the verb is said once.
        return apply_first(_completed(words, before, builder), builder, "command", "reply")
    return reason


def _where_to_put(words: Words, builder: PlanBuilder) -> Words:
    """`to the dresser`, where no more is said than where the thing in the hand is to go; also of `dresser for that`."""
    if builder.world.held is None or builder.steps:
        return ()
    if words[0] in _WHERETO:
        return words
    place = words[: words.index("for")] if "for" in words and words[-1] in _POINTING else words
    spots = builder.vocabulary.spot(place) if place else []
    return ("on", *place) if spots and spots[0].receptacle else ()


def _completed(words: Words, said: Words, builder: PlanBuilder) -> Words:
    """`the green one` after `put the white can in the bin` is to be put there, too; else with the verb alone."""
    phrase = read(words, builder.vocabulary)
    known = isinstance(phrase, Phrase) and not phrase.sense.new and not phrase.relation
    spans = noun_phrases(list(said))
    places = range(spans[0][1], len(said)) if known and spans else range(0)
    if any(builder.vocabulary.spot(said[at:]) for at in places):
        return tuple((replaced(" ".join(said), " ".join(words)) or " ".join(words)).split())
    return said[0], *words


def _is_thing(words: Words, builder: PlanBuilder) -> bool:
    """Do the words begin like a thing's name?"""
    return words[0] in _THING_STARTS or any(builder.vocabulary.noun(w) for w in words[:3])
