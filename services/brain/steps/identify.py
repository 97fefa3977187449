"""Leaves that ask the person whether an object that may be the one asked for is."""

import math
from collections.abc import Callable

from py_trees.behaviour import Behaviour
from py_trees.common import Status

from common import messages as m
from common.household import Household
from common.language.normalise import indefinite, without_determiners
from common.language.noun_phrase import WHICH, related
from common.naming.likeness import LEAST, PLAIN, describes, likeness
from common.naming.names import ANYTHING, unnumbered
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

MOST_ASKED, AT_FIRST = 4, 2
"""Objects that a person is asked about in one mission, and before everything was looked at unless the words fit them
HALF (chosen: more is a nuisance, and a better one may come)."""
HALF = 0.5
"""Likeness of an object of which half of the words are seen. Chosen: no other is likelier."""


class ChooseCandidate(Leaf):
    """Takes up the likeliest object that the person was not asked about; `least` and `near` as of `candidate`."""

    def __init__(self, node_id: str, ctx: Context, least: float, near: bool = False) -> None:
        super().__init__(node_id, ctx)
        self._least, self._near = least, near

    def update(self) -> Status:
        search = self.ctx.mission.search
        search.about = candidate(self.ctx, self._least, self._near)
        return Status.SUCCESS if search.about is not None else Status.FAILURE


class HearIdentity(HearAnswer):
    """Whether the object asked about is the one that is meant; SUCCESS once the person has said so, or what it looks
    like instead."""

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
        about, search.about = search.about, None
        self.ctx.note(f"reply: {kind}", text, "heard")
        self.feedback_message = kind
        if kind == "cancel":
            return self.refuse("CANCELLED", "", "All right, I will do nothing.")
        if about is None:
            return self.refuse("NOT_FOUND", "", self.spoken())
        if kind == "yes":
            search.confirmed[self._item] = about.id
            return Status.SUCCESS
        # Whatever else is said, it is no yes.
        search.rejected, search.refused = [*search.rejected, about.id], [*search.refused, about.position]
        search.perhaps = [p for p in search.perhaps if p.id != about.id]
        if meant := reworded(rest, self.ctx.io.household):
            search.chosen[self._item] = meant
            return Status.SUCCESS
        return self.refuse(ANOTHER, f"the {about.label} is not the {self._item}", self.spoken())

    def fail_with(self, failure: Failure) -> Status:
        """Nobody answers: nobody is asked again about what is looked for, and nothing is brought that may be wrong."""
        search = self.ctx.mission.search
        search.about, search.unanswered = None, True
        return super().fail_with(failure)


def candidate(ctx: Context, least: float, near: bool = False) -> m.PossibleObject | None:
    """The likeliest object that may be meant and that the person can still be asked about; None if there is none.

    `least`: its likeness, at least; `near`: of those only that were looked at from nearer.
    """
    search = ctx.mission.search
    if search.unanswered or len(search.rejected) >= MOST_ASKED:
        return None
    if least > LEAST and len(search.rejected) >= AT_FIRST:
        least = max(least, HALF)
    left = [p for p in search.perhaps if p.likeness >= least and not _asked_about(ctx, p)]
    return next((p for p in left if not near or search.directions(p.position)), None)


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
    failure = ctx.mission.failure
    return failure is not None and failure.code == NOT_PLAIN and candidate(ctx, LEAST) is not None


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
    """The question about an object that may be the one asked for."""
    about = ctx.mission.search.about
    if about is None:
        return ""
    label = unnumbered(about.label)
    where = f" on the {about.on}" if about.on else " on the floor"
    asked = "one" if label == item else item
    return f"I see {indefinite(label)}{where}. Is that the {asked} you mean?"


def ask_identity(ctx: Context, item: Callable[[], str], least: float, near: bool = False, *then: Behaviour) -> Sequence:
    """Ask whether what was found is the `item` that is meant; FAILURE unless the person says yes, else `then`.

    `least` and `near` as of `candidate`.
    """
    return Sequence(
        "ask_whether",
        ChooseCandidate("choose_candidate", ctx, least, near),
        AskQuestion("whether", ctx, lambda: whether(ctx, item())),
        HearIdentity("hear_identity", ctx, item),
        *then,
    )
