"""Readings of one command, the more literal first: as it stands, without slips, with unlisted things, guessed. Pure."""

from contextlib import suppress

from common.language.breaks import without_reason_behind
from common.language.clauses import cut_clauses
from common.language.contractions import expand
from common.language.discourse import commands
from common.language.lexicon import COMMANDING
from common.language.meaning import REFUSED, VERBS, WORDS
from common.language.normalise import Words, normalise
from common.messages import PlanStep
from services.planner.choice_points import ChoicePoints
from services.planner.config import PlannerConfig
from services.planner.grammar.accounting import as_command
from services.planner.grammar.asides import with_tales_apart, without_asides
from services.planner.grammar.chunks import chunks
from services.planner.grammar.guess import SURE, Guess, answer, guess
from services.planner.grammar.sentences import MAX_CHARACTERS, read_text
from services.planner.grammar.spelling import MARKS, corrected, renamed
from services.planner.grammar.vocabulary import Vocabulary
from services.planner.plan_builder import Lost, PlanBuilder, Refusal
from services.planner.reference.places import NoSuchPlace
from services.planner.semantic.forms import NONE, tokens
from services.planner.semantic.parse import parse
from services.planner.semantic.ranker import rank
from services.planner.world import World

LONGEST_SHORT = 4
"""Letters of the longest word that is told by its letters alone (chosen)."""
LONGEST_CRY = 5
"""Words of the longest exclamation that names something and asks for nothing, `a wasp!` (chosen)."""
IDLE = 0.7
"""Least probability that a part of a sentence asks for nothing, so that the rest is read by itself (chosen)."""


class Suggestion(Refusal):
    """`meant`: the command that comes nearest to what was said, to be asked about first."""

    def __init__(self, reason: str, meant: str) -> None:
        super().__init__(reason)
        self.meant = meant


class Attempts:
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
        self._text = command  # as it was read last

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
            taken, reason = self._choices.taken, refusal
            others = self._without_more() if isinstance(refusal, Lost) else []
            for text in others:
                with suppress(Refusal):
                    return self._read(text)
            if (read := self._without_slips(refusal, literally)) is not None:
                return read
            for text in (self._command, *others) if self._config.open_vocabulary and isinstance(refusal, Lost) else ():
                try:
                    return self._read(text, new_nouns=True)
                except NoSuchPlace as nowhere:  # a thing may be there that nobody has listed, a place may not
                    reason = nowhere
                except Refusal:
                    continue
            if not literally and (plainer := self._plainer(refusal)):
                raise Suggestion(str(reason), plainer) from None
            self._choices.taken, self._text = taken, self._command
            lost = isinstance(refusal, Lost)
            if (meant := self.guessed()) is None or (not lost and (meant.answers or meant.p < SURE)):
                raise reason from None
            if meant.answers:  # an answer moves nothing, so there is nothing to ask about first
                return meant.steps
            if literally:
                raise reason from None
            plainly = as_command(meant.steps, self._world) or ", then ".join(meant.texts)
            if self.is_said(plainly):
                return meant.steps
            raise Suggestion(str(reason), plainly) from None

    def _plainer(self, refusal: Refusal) -> str:
        """The plainer words that a refusal knows for all that was said, "" where they cannot be planned."""
        whole = len(commands(self._command[:MAX_CHARACTERS], self._is_place)) == 1
        if meant := refusal.meant if isinstance(refusal, Lost) and whole else "":
            with suppress(Refusal):
                self._read(meant, new_nouns=self._config.open_vocabulary)
                return meant
        return ""

    def _without_more(self) -> list[str]:
        """What was said without the reason behind it, and without the parts that ask for nothing, where it has such."""
        whole = self._command_words()
        shorter = (
            without_reason_behind(whole),
            without_asides(whole, self._is_idle),
            with_tales_apart(whole, lambda words: bool(chunks(words, self._vocabulary, unlisted=True))),
        )
        return [text for text in dict.fromkeys(shorter) if text != whole]

    def _is_idle(self, words: Words, exclaimed: bool) -> bool:
        """Do the words name nothing, or nothing known where they are exclaimed, and most likely ask for nothing?"""
        if exclaimed and len(words) <= LONGEST_CRY:
            return VERBS.isdisjoint(words) and not chunks(words, self._vocabulary, pronouns=True)
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
        return self.likeliest()

    def likeliest(self) -> Guess | None:
        """The plan of the likeliest parts of what was said; None where these ask for nothing that can be done."""
        with suppress(Refusal):
            return guess(parse(tokens(self._text[:MAX_CHARACTERS]), self._vocabulary), self._builder())
        return None

    def is_said(self, plainly: str) -> bool:
        """Is a plain command what was said, as after a yes to it? It is not asked about again."""
        return plainly == self._command_words()

    def _builder(self) -> PlanBuilder:
        return PlanBuilder(self._world.copy(), self._vocabulary, self._config, self._choices.fork())

    def _is_place(self, words: Words) -> bool:
        return bool(self._vocabulary.spot(words))

    def _read(self, text: str, new_nouns: bool = False) -> list[PlanStep]:
        self._text = text
        builder = PlanBuilder(self._world.copy(), self._vocabulary, self._config, self._choices.fork(), self._done)
        self._vocabulary.new_nouns = new_nouns
        try:
            return read_text(text, builder)
        finally:
            self._choices.taken = builder.choices.taken
            self._vocabulary.new_nouns = False

    def _without_slips(self, refusal: Refusal, literally: bool) -> list[PlanStep] | None:
        """Slips in verbs and small words are undone; a name is never exchanged for another unasked."""
        words = self._command_words().split()
        bare = [w.strip(MARKS) for w in words]
        colours, names = self._vocabulary.words()
        right, named = corrected(bare, colours | WORDS, names, REFUSED)
        # What is short is no slip of something longer, but for a colour: the bus is not busy.
        right = [
            b if len(b) < len(r) <= LONGEST_SHORT and r not in colours else r for b, r in zip(bare, right, strict=True)
        ]
        text = " ".join(w.replace(b, r) for w, b, r in zip(words, bare, right, strict=True))
        if right == bare:
            right, named = renamed(words, self._vocabulary.names(), colours, names), True
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
