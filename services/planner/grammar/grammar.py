"""The embedded planner: a sentence and the believed world in, a plan or the reason against it out. Pure."""

from collections.abc import Callable, Sequence
from contextlib import suppress
from functools import cache

from common.language.addressee import addressee
from common.language.breaks import is_statement, without_reason_behind
from common.language.clauses import cut_clauses
from common.language.contractions import expand
from common.language.discourse import commands
from common.language.lexicon import COMMANDING
from common.language.meaning import WORDS
from common.language.normalise import Words, enumeration, normalise
from common.messages import ActionPlan, PlanStep, RejectedPlan
from services.planner.choice_points import ChoicePoints, every
from services.planner.commands import answers
from services.planner.config import PlannerConfig
from services.planner.grammar.accounting import CONDITIONS, as_command, unaccounted
from services.planner.grammar.asides import with_tales_apart, without_asides
from services.planner.grammar.chunks import chunks
from services.planner.grammar.clause import read_clause
from services.planner.grammar.guess import Guess, answer, guess
from services.planner.grammar.mention import expected, note
from services.planner.grammar.phrases import Phrase, read
from services.planner.grammar.repetition import repeated
from services.planner.grammar.spelling import corrected, renamed
from services.planner.grammar.vocabulary import Vocabulary
from services.planner.plan_builder import NOT_UNDERSTOOD, LookFirst, Lost, PlanBuilder, Refusal, same
from services.planner.semantic.deeds import contradicted
from services.planner.semantic.forms import NONE, tokens
from services.planner.semantic.parse import parse
from services.planner.semantic.ranker import Ranked, rank
from services.planner.world import World

SOURCE = "grammar"
MAX_CHARACTERS = 2000
"""Longest text that is read (chosen: a minute of speech has a thousand characters)."""
MAX_WORDS = 60
"""Longest clause (chosen: the readings of a pattern grow with its square)."""


_VERBS = frozenset({"is", "are", "was", "were", "has", "have", "needs", "goes", "belongs"})
"""Words that make more than a name of a clause that begins with one."""


IDLE = 0.7
"""Least probability that a part of a sentence asks for nothing, so that the rest is read by itself (chosen)."""
SURE = 0.5
"""Least probability of a guess at what was understood otherwise and refused (chosen on lists left out)."""


class Suggestion(Refusal):
    """`meant`: the command that comes nearest to what was said, to be asked about first."""

    def __init__(self, reason: str, meant: str) -> None:
        super().__init__(reason)
        self.meant = meant


def plan(
    command: str,
    world: World,
    config: PlannerConfig,
    rejected: Sequence[RejectedPlan] = (),
    done: list[PlanStep] | None = None,
    request_id: str = "",
) -> ActionPlan:
    """The preferred plan that differs from every rejected one; without steps when there is none, with the reason."""
    vocabulary = Vocabulary(world, config)
    literally = any(not r.steps for r in rejected)
    clauses = commands(command[:MAX_CHARACTERS], lambda words: bool(vocabulary.spot(words)))
    words = tokens(command[:MAX_CHARACTERS])
    ranked = cache(lambda: rank(words, vocabulary))
    other = addressee(command[:MAX_CHARACTERS], lambda name: not (vocabulary.noun(name) or vocabulary.spot((name,))))

    def run(choices: ChoicePoints) -> ActionPlan:
        attempts = _Attempts(command, world, vocabulary, config, choices, None if other else done)
        try:
            steps = attempts.steps(literally)
        except LookFirst as look:
            return ActionPlan(request_id=request_id, steps=look.steps, source=SOURCE, again=True)
        except Refusal as refusal:
            meant = refusal.meant if isinstance(refusal, Suggestion) else ""
            return ActionPlan(request_id=request_id, steps=[], source=SOURCE, detail=str(refusal), suggestion=meant)
        if len(steps) > config.max_steps:
            detail = f"that is too much at once: {len(steps)} steps"
            return ActionPlan(request_id=request_id, steps=[], source=SOURCE, detail=detail)
        if other and not literally and any(step.action != "say" for step in steps):
            detail, meant = f"you said that to {other}", as_command(steps, world)
            return ActionPlan(request_id=request_id, steps=[], source=SOURCE, detail=detail, suggestion=meant)
        detail = _ignored(clauses, steps, world, vocabulary)
        detail = detail or (_unlikely(clauses, words, steps, ranked) if config.guess else "")
        if detail:
            guessed = None if literally else attempts.guessed()
            if guessed and not guessed.answers and not unaccounted(clauses, guessed.steps, world, vocabulary):
                steps = guessed.steps
            meant = "" if literally else as_command(steps, world)
            return ActionPlan(request_id=request_id, steps=[], source=SOURCE, detail=detail, suggestion=meant)
        return ActionPlan(request_id=request_id, steps=steps, source=SOURCE)

    if not rejected:
        return run(ChoicePoints())
    culprits = [c for r in rejected if (c := _culprit(r)) is not None]
    second: ActionPlan | None = None
    for candidate in every(run):
        if not candidate.steps or any(same(candidate.steps, r.steps) for r in rejected):
            continue
        if not any(c in candidate.steps for c in culprits):
            return candidate
        second = second or candidate
    return second or _spent(run(ChoicePoints()), rejected[-1])


def _ignored(clauses: Sequence[str], steps: list[PlanStep], world: World, vocabulary: Vocabulary) -> str:
    """What of the clauses a plan leaves aside, so that it is asked about first; "" where it is nothing."""
    ignored = unaccounted(clauses, steps, world, vocabulary)
    return f"{NOT_UNDERSTOOD} what {enumeration(list(map(repr, ignored)))} has to do with it" if ignored else ""


def _unlikely(clauses: Sequence[str], words: Words, steps: list[PlanStep], ranked: Callable[[], list[Ranked]]) -> str:
    """Why a plan may not be what is meant at all, so that it is asked about first; "" for no reason."""
    if any(clause.split()[0] in CONDITIONS for clause in clauses):  # what else is to be done need not be
        return ""
    return f"{NOT_UNDERSTOOD} for certain what I should do" if contradicted(words, steps, ranked()) else ""


def _spent(first: ActionPlan, rejected: RejectedPlan) -> ActionPlan:
    """No other plan: the reason against the last one, or why there never was one."""
    reason = rejected.reason.strip().rstrip(".") or "that plan was rejected and I know no other"
    detail = reason if first.steps or not first.detail else first.detail
    return ActionPlan(request_id=first.request_id, steps=[], source=SOURCE, detail=detail)


def _culprit(rejected: RejectedPlan) -> PlanStep | None:
    """The step that the reason is about."""
    return rejected.steps[rejected.step - 1] if 0 < rejected.step <= len(rejected.steps) else None


class _Attempts:
    """Readings of one command, the more literal first, each with a plan builder of its own."""

    def __init__(
        self,
        command: str,
        world: World,
        vocabulary: Vocabulary,
        config: PlannerConfig,
        choices: ChoicePoints,
        done: list[PlanStep] | None,
    ) -> None:
        self._command, self._world, self._vocabulary, self._config = command, world, vocabulary, config
        self._choices, self._done = choices, done

    def steps(self, literally: bool) -> list[PlanStep]:
        """By what is known, as it stands; without slips of typing; with things that nobody has listed or seen.

        `literally`: a slip in a name was asked about and is none.

        Raises:
            Suggestion: the words are one slip in a name away from a command.
            Refusal: none of it helps, with the reason against the words as they stand.
        """
        try:
            return self._read(self._command)
        except Refusal as refusal:
            taken = self._choices.taken
            others = self._without_more() if isinstance(refusal, Lost) else []
            for text in others:
                with suppress(Refusal):
                    return self._read(text)
            if (read := self._without_slips(refusal, literally)) is not None:
                return read
            for text in (self._command, *others) if self._config.open_vocabulary and isinstance(refusal, Lost) else ():
                with suppress(Refusal):
                    return self._read(text, new_nouns=True)
            self._choices.taken = taken
            lost = isinstance(refusal, Lost)
            if (meant := self.guessed()) is None or (not lost and (meant.answers or meant.p < SURE)):
                raise
            if meant.answers:  # an answer moves nothing, so there is nothing to ask about first
                return meant.steps
            if literally:
                raise
            plainly = as_command(meant.steps, self._world) or ", then ".join(meant.texts)
            raise Suggestion(str(refusal), plainly) from None

    def _without_more(self) -> list[str]:
        """What was said without the reason behind it, and without the parts that ask for nothing, where it has such."""
        whole = self._command_words()
        shorter = (
            without_reason_behind(whole),
            without_asides(whole, self._is_idle),
            with_tales_apart(whole, lambda words: bool(chunks(words, self._vocabulary, unlisted=True))),
        )
        return [text for text in dict.fromkeys(shorter) if text != whole]

    def _is_idle(self, words: Words) -> bool:
        """Do the words name nothing and most likely ask for nothing?"""
        if (
            not self._config.guess
            or words[0] in COMMANDING
            or chunks(words, self._vocabulary, pronouns=True, unlisted=True)
        ):
            return False
        return sum(p for candidate, p in rank(words, self._vocabulary) if candidate.form == NONE) > IDLE

    def _command_words(self) -> str:
        """What was said with its marks, in the spelling of the grammar."""
        return expand(normalise(self._command[:MAX_CHARACTERS], ",;.!?"))

    def guessed(self) -> Guess | None:
        """What the words may mean that no construction fits, as it can be done."""
        if not self._config.guess:
            return None
        whole = [clause for part in self._command_words().split(".") for clause in cut_clauses(part)]
        for clauses in (commands(self._command[:MAX_CHARACTERS], self._is_place), whole):
            with suppress(Refusal):
                return answer(clauses, self._builder())
        with suppress(Refusal):
            return guess(parse(tokens(self._command[:MAX_CHARACTERS]), self._vocabulary), self._builder())
        return None

    def _builder(self) -> PlanBuilder:
        return PlanBuilder(self._world.copy(), self._vocabulary, self._config, self._choices.fork())

    def _is_place(self, words: Words) -> bool:
        return bool(self._vocabulary.spot(words))

    def _read(self, text: str, new_nouns: bool = False) -> list[PlanStep]:
        builder = PlanBuilder(self._world.copy(), self._vocabulary, self._config, self._choices.fork(), self._done)
        self._vocabulary.new_nouns = new_nouns
        try:
            return _steps(text, builder)
        finally:
            self._choices.taken = builder.choices.taken
            self._vocabulary.new_nouns = False

    def _without_slips(self, refusal: Refusal, literally: bool) -> list[PlanStep] | None:
        """Slips in verbs and small words are undone; a name is never exchanged for another unasked."""
        words = self._command_words().split()
        bare = [w.strip(",;.!?") for w in words]
        colours, names = self._vocabulary.words()
        right, named = corrected(bare, colours | WORDS, names)
        text = " ".join(w.replace(b, r) for w, b, r in zip(words, bare, right, strict=True))
        if right == bare:
            right, named = renamed(bare, self._vocabulary.names()), True
            text = " ".join(right)
        if right == bare or (named and literally):
            return None
        try:
            steps = self._read(text)
        except Refusal:
            return None
        if named:
            raise Suggestion(str(refusal), text)
        return steps


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


def _steps(command: str, builder: PlanBuilder) -> list[PlanStep]:
    sentences = _sentences(command, builder)
    first = read(tuple(sentences[0].split()), builder.vocabulary)
    names = len(sentences) > 1 and isinstance(first, Phrase) and not first.sense.new
    said: Words = ("bring",) if names else ()
    for number, sentence in enumerate(sentences):
        words = tuple(sentence.split())
        following = sentences[number + 1].split() if number + 1 < len(sentences) else []
        if _tells(words, following) or (number == 0 and names and "it" in following and _VERBS.isdisjoint(words)):
            note(words, builder)  # "the red can, bin it"
            continue
        if {"there", "it"} & set(following) and (topic := builder.vocabulary.spot(words)):
            builder.spot = topic[0]  # "the bookshelf. What is there?"
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
    if builder.unmet:
        builder.say(builder.unmet)
    if builder.collecting:
        raise Refusal("I can hold only one thing at a time")
    if not builder.steps and builder.need:
        read_clause(("bring", "me", *builder.need.split()), builder, alone=True)
    if not builder.steps:
        raise Lost(f"{NOT_UNDERSTOOD} what I should do")
    if all(step.action == "find" for step in builder.steps):
        answers.found(builder)
    return builder.steps
