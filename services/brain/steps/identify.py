"""Leaves that ask the person whether an object that may be the one asked for is, or which of several."""

import math
from collections.abc import Callable
from itertools import groupby

from py_trees.behaviour import Behaviour
from py_trees.common import Status

from common import messages as m
from common.household import Household
from common.language.normalise import enumeration, indefinite, without_determiners
from common.language.noun_phrase import WHICH, related
from common.naming.likeness import LEAST, LIKELY, PLAIN, ROUGHLY, describes, likeness
from common.naming.names import ANYTHING, unnumbered
from common.naming.place_named import is_at
from services.brain.language.choosing import chosen
from services.brain.language.dialogue import Reply
from services.brain.mission.context import Context
from services.brain.mission.mission import Failure
from services.brain.mission.search import SAME_PLACE
from services.brain.steps.ask import AskQuestion, HearAnswer
from services.brain.steps.leaf import Leaf
from services.brain.tree.composites import Sequence

ANOTHER = "ANOTHER_ONE"
"""Code of a person's word that the object is not the one that they asked for."""

NOT_PLAIN = "NOT_PLAIN"
"""Failure code: the object before the robot does not plainly fit the words that were said."""

MOST_ASKED, IN_ALL, AT_FIRST = 5, 3, 2
"""Questions that a person is asked in one mission, of them while there is more to see, and before MANY looks, unless
the words fit an object HALF; beyond AT_FIRST it has to be LIKELY. Chosen: more is a nuisance, and a better one may
come; one is left for when all was looked at, one for when that was from near."""
MANY = 12
"""Poses looked from, each view as it is reached and left [count], from which on what fits ROUGHLY is asked about, and
not only what is LIKELY. Chosen: six views; the others of a home take minutes, a question seconds."""
MOST_NAMED, RIVAL = 5, 0.5
"""Objects that one question names, and their likeness, of that of the likeliest, from which they are named with it.
Chosen: more are not kept in mind; of two that are about as likely nobody wants to be asked one by one."""
HALF = 0.5
"""Likeness of an object of which half of the words are seen. Chosen: no other is likelier."""


class ChooseCandidate(Leaf):
    """Takes up those of the `candidates` that the person is asked about next."""

    def __init__(self, node_id: str, ctx: Context, of: Callable[[], list[m.PossibleObject]]) -> None:
        super().__init__(node_id, ctx)
        self._of = of

    def update(self) -> Status:
        search = self.ctx.mission.search
        search.about = self._of()
        search.questions += bool(search.about)
        return Status.SUCCESS if search.about else Status.FAILURE


class HearIdentity(HearAnswer):
    """Whether the object asked about is the one that is meant, or which of several; SUCCESS once the person has said
    so, or what it looks like instead."""

    def __init__(self, node_id: str, ctx: Context, item: Callable[[], str]) -> None:
        super().__init__(node_id, ctx)
        self._named = item

    @property
    def _item(self) -> str:
        return self._named()

    def step(self) -> str:
        return whether(self.ctx, self._item)

    def spoken(self) -> str:
        return f"I could not find the {self._item}."

    def heard(self, kind: Reply, rest: str, text: str) -> Status:
        search = self.ctx.mission.search
        about, search.about = search.about, []
        self.ctx.note(f"reply: {kind}", text, "heard")
        self.feedback_message = kind
        if kind == "cancel":
            return self.refuse("CANCELLED", "", "All right, I will do nothing.")
        if not about:
            return self.refuse("NOT_FOUND", "", self.spoken())
        if one := self._the_one(about, kind, text):
            search.confirmed[self._item] = one.id
            return Status.SUCCESS
        if kind == "yes":
            return self.refuse(ANOTHER, "it was not said which of them", self.spoken())
        # Whatever else is said, it is no yes.
        search.rejected = [*search.rejected, *(p.id for p in about)]
        search.refused = [*search.refused, *(p.position for p in about)]
        search.perhaps = [p for p in search.perhaps if p not in about]
        if meant := reworded(rest, self.ctx.io.household):
            search.chosen[self._item] = meant
            return Status.SUCCESS
        none = " or ".join(f"the {p.label}" for p in about)
        return self.refuse(ANOTHER, f"{none} is not the {self._item}", self.spoken())

    def _the_one(self, about: list[m.PossibleObject], kind: Reply, text: str) -> m.PossibleObject | None:
        if len(about) == 1 or kind != "correction":
            return about[0] if len(about) == 1 and kind == "yes" else None
        label = chosen(text, [p.label for p in about], self.ctx.objects, self.ctx.io.household)
        return next((p for p in about if p.label == label), None)

    def fail_with(self, failure: Failure) -> Status:
        """Nobody answers: nobody is asked again about what is looked for, and nothing is brought that may be wrong."""
        search = self.ctx.mission.search
        search.about, search.unanswered = [], True
        return super().fail_with(failure)


def candidates(ctx: Context, least: float, near: bool = False, place: str = "") -> list[m.PossibleObject]:
    """The likeliest object that may be meant and that the person can still be asked about, with others about as likely,
    surface by surface; [] if there is none.

    `least`: their likeness, at least; `near`: of those only that were looked at from nearer, `place`: that are there.
    """
    search = ctx.mission.search
    if search.unanswered or search.questions >= MOST_ASKED:
        return []
    if least > LEAST:
        much = len(search.visited) >= MANY
        if search.questions >= (IN_ALL if much else AT_FIRST):
            least = max(least, HALF)
        elif much:
            least = max(least, LIKELY) if search.questions >= AT_FIRST else min(least, ROUGHLY)
    left = [p for p in search.perhaps if p.likeness >= least and not _asked_about(ctx, p)]
    left = [p for p in left if not near or search.directions(p)]
    left = [p for p in left if not place or is_at(p, place, ctx.io.household)]
    rivals = [p for p in left if p.likeness >= RIVAL * left[0].likeness][:MOST_NAMED]
    places = [p.on for p in rivals]
    return sorted(rivals, key=lambda p: places.index(p.on))


def _asked_about(ctx: Context, possible: m.PossibleObject) -> bool:
    """Whether the person has said that it is not the one; one that was lost from sight has another id since."""
    search = ctx.mission.search
    stood = any(math.dist(possible.position, place) < SAME_PLACE for place in search.refused)
    return stood or possible.id in search.rejected


class StillMeant(Leaf):
    """FAILURE when what was found from afar does not, now that it is near, plainly fit what was asked for."""

    def __init__(self, node_id: str, ctx: Context, item: str) -> None:
        super().__init__(node_id, ctx)
        self._item = item

    def update(self) -> Status:
        ctx, item = self.ctx, self._item
        found = ctx.mission.search.found.get(item)
        if found is None or not found.id or item in ctx.mission.search.confirmed:
            return Status.SUCCESS
        now = next((o for o in ctx.objects if o.id == found.id and o.measured), None)
        # Words that are no looks, a taught name or a print, are not to be judged by looks.
        if now is None or item in ctx.mission.search.chosen or not 0.0 < likeness(item, now, ctx.io.household) < PLAIN:
            return Status.SUCCESS
        ctx.mission.search.perhaps = rated(ctx, item, now)
        detail = f"from near it is {indefinite(now.label)}, and that not plainly"
        return ctx.fail("GRABBING", NOT_PLAIN, detail, f"I am not sure that it is the {item}.")


def not_plain(ctx: Context) -> bool:
    """The grasp failed as NOT_PLAIN, and there is an object that the person was not asked about yet."""
    return ctx.mission.failed_with(NOT_PLAIN) and bool(candidates(ctx, LEAST))


def rated(ctx: Context, item: str, first: m.WorldObject | None = None) -> list[m.PossibleObject]:
    """The measured objects that the words `item` may mean, the likeliest first; `first` goes before all others."""
    fits = [(likeness(item, o, ctx.io.household), o) for o in ctx.objects if o.measured and not o.held]
    ordered = sorted(fits, key=lambda row: (row[1] is not first, -row[0], row[1].label))
    return [
        m.PossibleObject(id=o.id, label=o.label, likeness=fit, position=o.position, on=o.on)
        for fit, o in ordered
        if fit >= LEAST
    ]


def survey(ctx: Context, item: str) -> bool:
    """Whether what navigation has found by its words is none that is listed, and does not plainly fit them either."""
    search, known = ctx.mission.search, ctx.known_object(item)
    if (known is not None and not known.measured) or item in search.confirmed:
        return False
    search.perhaps = rated(ctx, item)
    return bool(search.perhaps) and search.perhaps[0].likeness < PLAIN


def reworded(text: str, household: Household) -> str:
    """What a person says instead of yes where it tells what a thing looks like: `green one on the counter`; else ""."""
    words, told = without_determiners(tuple(text.split())), household.words
    head = next((head for head, _, _ in related(words)), words)
    plain = {*ANYTHING, *WHICH, *told.qualities}
    known = all(word in plain or describes(word, household) for word in head)
    return " ".join(words) if known and describes(" ".join(head), household) else ""


def whether(ctx: Context, item: str) -> str:
    """The question about the objects that may be the one asked for."""
    about, seen = ctx.mission.search.about, []
    for on, group in groupby(about, key=lambda p: p.on):
        names = [unnumbered(p.label) for p in group]
        some = [f"another {n}" if n in names[:k] else indefinite(n) for k, n in enumerate(names)]
        seen.append(f"{enumeration(some)} on the {on or 'floor'}")
    asked = "one" if any(unnumbered(p.label) == item for p in about) else item
    question = (
        f"Is that the {asked} you mean?" if len(about) == 1 else f"Which of them is the {asked} you mean, if any?"
    )
    return f"I see {', and '.join(seen)}. {question}" if about else ""


def ask_identity(
    ctx: Context, item: Callable[[], str], of: Callable[[], list[m.PossibleObject]], *then: Behaviour
) -> Sequence:
    """Ask whether one `of` what was found is the `item` that is meant; FAILURE unless the person says so; `then`."""
    return Sequence(
        "ask_whether",
        ChooseCandidate("choose_candidate", ctx, of),
        AskQuestion("whether", ctx, lambda: whether(ctx, item())),
        HearIdentity("hear_identity", ctx, item),
        *then,
    )
