"""Likeness: how well words for colours and kinds fit an object by its looks, from 0 to 1. Pure."""

from collections.abc import Sequence
from typing import NamedTuple

from common.household import Household
from common.kinds import KINDS
from common.messages import WorldObject
from common.naming.looks import OTHER
from common.naming.names import ALIKE, ANYTHING, is_ball, listed, normalise, own_words
from common.naming.small_print import telling

PLAIN = 0.55
"""Likeness from which words plainly fit: below it a person is asked. Chosen: the word is likelier than all others."""
LIKELY = 0.3
"""Likeness from which a person is asked before anything else is looked for. Chosen: one of two or three words that fit
about as well."""
LEAST = 0.06
"""Likeness below which words do not fit: both the colour and the kind would have to be mistaken."""
OWN = 0.3
"""Share of an object's surface from which a colour is its own whatever else it has. Chosen: a label on a can."""
SECOND = 0.5
"""Most likeness of a colour that is not the largest part: it may be a neighbour's that stands before or behind it."""
NOT_CALLED = 0.54
"""Most likeness of a kind that an object may be and is not called. Chosen: below PLAIN, since a red ball is brought for
a red apple only when the person says so."""
UNSEEN, UNTOLD = 0.4, 0.1
"""Most likeness of what fits but for words that are not seen (`words.qualities`, those before a kind, `words.looks`),
and but for words that may say anything. Chosen: a person is asked about the first at once, about the second at last."""
ROUGHLY = 0.15
"""Likeness of the words that are known from which the others are asked about. Chosen: more than one that is near."""
OFF_COLOUR = 0.7
"""What is left of the likeness of what has not the colour of what it is made of. Chosen: not asked about at once."""
SHAPELESS, ANY_SHAPE = frozenset({"toy", "tool"}), 0.35
"""Kinds that have no shape of their own, and the likeness of anything to them. Chosen: asked about when it is seen."""
SHAPED = 0.5
"""That likeness by how unlike an object is to kinds that have a shape. Chosen: what is a mug to four tenths and more is
asked about as a tool when all else was looked at."""
NEAR_COLOUR, NEAR_KIND, NO_KIND = 0.15, 0.12, 0.2
"""Likeness of a colour next to one that was seen, of a kind that is easily taken for one, and of any kind to what has
the shape of none. Chosen: rarely right."""
BLANK, BLANK_SPREAD = 0.06, 0.03
"""Likeness of anything to a name that says nothing of looks, and how much more it is of what has the shape of no kind:
who means a can says so. Chosen: asked about after all else."""
FLAVOURS = frozenset({"apple", "orange", "lemon", "banana"})
"""Kinds that say what is in a pack when they stand before another word, and that go by no other word than their own."""
MOSTLY, VAGUE = 0.5, 0.35
"""Share of the fruits among what an object may be from which it goes by no other word, and of the likeliest kind with a
shape below which it may have any. Chosen: as likely as not; as three that are about as likely have."""
HIDDEN = 0.5
"""Likeness of a ball that looks more like what stands on a foot, or the other way, by that of what it looks like."""
TAKEN_FOR = (
    frozenset({"mug", "cup", "can", "jar"}), frozenset({"can", "jar", "bottle"}), frozenset({"cup", "mug", "bowl"}),
    frozenset({"bowl", "plate"}), frozenset({"box", "block", "carton", "book"}), frozenset({"carton", "bottle"}),
    frozenset({"ball", "apple", "orange", "lemon"}),
)  # fmt: skip
"""Kinds that are taken for each other when a handle, a neck or the inside is hidden or dark."""
CALLED_ALIKE = {"mug", "cup"}
"""Kinds that go by each other's word: one is asked about at once as the other, an egg cup that was heard as a mug."""


def likeness(phrase: str, o: WorldObject, household: Household) -> float:
    """How well a noun with its colours fits an object, 0 to 1; 1 for a name or label that it has.

    0 also for what has other words in it than kinds, colours and those of the object's label.
    """
    wanted = normalise(phrase)
    if wanted in o.names or (wanted == normalise(o.label) and not o.kind_shares):
        return 1.0
    known = _known(wanted, o, household)
    return _fit(known, o) if known.any and not known.rest else 0.0


def partly(phrase: str, o: WorldObject, household: Household) -> float:
    """How well a noun fits an object of which some words say nothing that is seen: "the striped mug", "the spray
    bottle", "the soap", "the toy car", and least of all "the gizmo".

    0 where all its words are known, or those that are do not fit.
    """
    wanted, told = normalise(phrase), household.words
    known, fit = _known(wanted, o, household), looks_like(phrase, o, household)
    named, printed = known.rest & told.looks.keys(), other_goods(wanted, o.text, household)
    # The last word says what it is, those before it which one: a tape measure is no tape.
    before = named if _told_looks(wanted, household) else set()
    untold = known.rest - {*told.qualities, *told.looks, *told.shades}
    # And an untold one may make another thing of it: a magnifying glass is no glass, nor a watering can a can.
    coloured = _fit(known._replace(kinds=set()), o) >= ROUGHLY
    another = bool(untold and (before or known.kinds)) and fit < ROUGHLY and coloured
    if another or (not known.any and known.rest - set(told.qualities) and not before):
        return 0.0 if printed else _unnamed(o)
    headed = _known(wanted.split()[-1], o, household).any
    if not known.rest or not (known.any or named) or fit < ROUGHLY or (untold and printed and not named):
        return 0.0
    # What has other words printed on it is hardly the soap.
    if (untold and not headed and not named) or (printed and not known.rest <= {*told.qualities, *told.shades}):
        return UNTOLD
    return min(UNSEEN, fit) * (OFF_COLOUR if _of_another_flavour(wanted, o, household) else 1.0)


def other_goods(phrase: str, text: str, household: Household) -> list[str]:
    """The words of a text that say of a pack that something else is in it than a phrase says; no brands."""
    wanted, told = set(normalise(phrase).split()), household.words
    goods = {*told.looks, *FLAVOURS}
    forms = [(w, {w, w.removesuffix("s"), f"{w}s"}) for w in telling(text)]
    return [w for w, same in forms if same & goods and not same & wanted]


def _of_another_flavour(wanted: str, o: WorldObject, household: Household) -> bool:
    """Whether words before the last say of a colour that an object has nothing of: tomato sauce is red, or in red."""
    told = household.words.looks
    before = [told.get(w, ()) if w not in FLAVOURS else (w,) for w in wanted.split()[:-1]]
    shades = {w for looks in before for w in looks if w in ALIKE}
    return bool(shades) and max(_has_colour(shade, o) for shade in shades) < ROUGHLY


def _unnamed(o: WorldObject) -> float:
    """How well an object fits a name that says nothing of looks: 0 for what is a fruit."""
    fruit = sum(share for kind, share in _shares(o).items() if kind in FLAVOURS)
    return 0.0 if fruit >= MOSTLY else BLANK + BLANK_SPREAD * (1.0 - _shaped(o))


def _shaped(o: WorldObject) -> float:
    """How likely an object is of the likeliest kind that has a shape of its own."""
    return max((share for kind, share in _shares(o).items() if kind not in {*SHAPELESS, OTHER}), default=0.0)


def _shares(o: WorldObject) -> dict[str, float]:
    """How likely an object is of each kind that it may be."""
    return o.kind_shares or {o.kind: 1.0}


def looks_like(phrase: str, o: WorldObject, household: Household, packed: bool = False) -> float:
    """How well those words of a noun fit an object that say what it looks like, 0 to 1; 1 where none does.

    What is `packed` has any colour, and print that says what is inside: only a colour that was said counts.
    """
    known, told = _known(normalise(phrase), o, household), _told_looks(normalise(phrase), household)
    # "The blue duck" is not yellow.
    return min(_fit(known, o), _looks(told, o, packed or bool(known.shades), not packed) if told else 1.0)


def _told_looks(wanted: str, household: Household) -> tuple[str, ...]:
    """What the last word of a normalised phrase looks like: tomato sauce is a sauce, a soup can is no soup."""
    told, head = household.words.looks, (wanted.split() or [""])[-1]
    return told.get(head) or told.get(f"{head}s") or told.get(head.removesuffix("s")) or ()


def _looks(words: Sequence[str], o: WorldObject, any_colour: bool, vague: bool) -> float:
    """How well an object fits one of the kinds among words, and of their colours unless in `any_colour`; if `vague`,
    what may have any shape may be of them."""
    kinds, shades = [w for w in words if w in KINDS], [w for w in words if w in ALIKE and w not in KINDS]
    # What has any shape is told by its colour; without one, all but what may be of that kind is asked about at last.
    unlike = NO_KIND - (NO_KIND - ROUGHLY) * _shaped(o)
    seen = {*kinds} if shades else {k for k in kinds if k not in SHAPELESS or k in o.kinds}
    kind = max((_has_kind(k, o) if k in seen else unlike for k in kinds), default=0.0)
    if kinds and (o.kind in SHAPELESS or (vague and _shaped(o) < VAGUE)):
        # A teapot with its spout ahead is no mug, jar or can.
        kind = max(kind, unlike)
    if any_colour or not shades:
        return kind
    # What is yellow or brown may be orange: between the two.
    between = SECOND * (sum(o.colour in ALIKE[shade] for shade in shades) > 1)
    return kind * max(between, *(_has_colour(shade, o) for shade in shades))


class _Words(NamedTuple):
    """Those of a phrase that name kinds, that name colours, others of the object's `label`, and the `rest`, among them
    words for colours `between`, here by the colours that they may look like."""

    kinds: set[str]
    shades: set[str]
    label: set[str]
    rest: set[str]
    between: tuple[tuple[str, ...], ...] = ()

    @property
    def any(self) -> bool:
        """One of them says what the object is."""
        return bool(self.kinds or self.shades or self.label or self.between)


def _known(wanted: str, o: WorldObject, household: Household) -> _Words:
    words = own_words(wanted, household)
    kinds, shades, called = words & set(KINDS), words & set(ALIKE), {*normalise(o.label).split()}
    # "The orange can": what may be a colour is one before another word; alone it is what is meant.
    head = own_words(wanted.split()[-1] if wanted else "", household)
    both = kinds & shades
    # And a fruit before another word is what that is made of, or smells of.
    kinds -= (both | FLAVOURS) - head
    shades -= both & head
    made_for = _made_for(wanted, household) if not head & called else set()
    kinds -= made_for
    others = words - kinds - shades
    label = others & called - made_for
    rest, told = others - label, household.words
    # Hand cream is no colour, nor is that of cream cheese.
    edible = set() if head & {*KINDS, *ANYTHING} or not head else told.looks.keys()
    between = tuple(told.shades[w] for w in sorted(rest - edible) if w in told.shades)
    return _Words(kinds, shades, label, rest, between)


def _made_for(wanted: str, household: Household) -> set[str]:
    """The kind right before a last word that is none, which says what that is for: a can opener is no can."""
    *_, kind, head = ["", "", *wanted.split()]
    plain = not head.isalpha() or own_words(head, household) <= {*KINDS, *ALIKE, *household.words.shades}
    return set() if plain else own_words(kind, household) & (KINDS.keys() - SHAPELESS)


def _fit(words: _Words, o: WorldObject) -> float:
    found = min((_has_kind(kind, o) for kind in words.kinds), default=1.0)
    for shade in words.shades:
        found *= _has_colour(shade, o)
    for several in words.between:
        found *= max(_has_colour(shade, o) for shade in several)
    return found


def describes(phrase: str, household: Household) -> bool:
    """One of the words says what the thing looks like, or the household lists it: not so "the pear"."""
    wanted, told = normalise(phrase), household.words
    plain = {*KINDS, *ALIKE, *told.groups, *told.looks, *told.shades}
    return listed(wanted, household) is not None or any(
        w in plain or told.kind(w) or told.colour(w) for w in (*wanted.split(), wanted)
    )


def _has_kind(kind: str, o: WorldObject) -> float:
    shares = o.kind_shares or ({o.kind: 1.0} | dict.fromkeys(o.kinds, 1.0))
    best = max(shares.values())
    if is_ball(kind) != is_ball(max(shares, key=lambda k: shares[k])):
        # Balls and what stands on a foot are taken for each other only where most is hidden.
        return HIDDEN * shares.get(kind, 0.0) / best if o.kind_shares else 0.0
    near = NEAR_KIND * any(kind in group and o.kind in group for group in TAKEN_FOR)
    if {kind, o.kind} == CALLED_ALIKE:
        near = UNSEEN
    has = shares.get(kind, 0.0) / best
    if o.kind_shares and kind != o.kind:
        has = min(has, NOT_CALLED)
    shapeless = max(NO_KIND, min(ANY_SHAPE, SHAPED * (1.0 - _shaped(o)))) if kind in SHAPELESS else 0.0
    return max(has, near, NO_KIND * (o.kind == OTHER), shapeless)


def _has_colour(shade: str, o: WorldObject) -> float:
    """The largest colour counts in full, and less as more of the object has a colour next to it."""
    shares = o.colour_shares or ({o.colour: 1.0} | dict.fromkeys(o.colours, 1.0))
    own = shares.get(shade, 0.0)
    if o.colour_shares:
        # Light and shade turn a colour into one next to it, not into several.
        beside = max((shares.get(other, 0.0) for other in ALIKE[shade]), default=0.0)
        own = min(1.0, own / OWN) * own / max(own + beside, 1e-9)
        if shade != max(shares, key=lambda c: shares[c]):
            own = min(own, SECOND)
    return max(own, NEAR_COLOUR * (o.colour in ALIKE[shade]))
