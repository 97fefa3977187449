"""Which of the things or places that the robot offered an answer most likely means: a model learnt from tests/data.

`python -m bench.offered` learns it. The weights are read at the first answer that no wording explains.
"""

import math
from collections.abc import Iterator, Sequence
from importlib.resources import files
from itertools import pairwise

import numpy as np

from common.floor_plan import Receptacle
from common.household import Household
from common.language.clauses import without_fillers
from common.language.contractions import expand
from common.language.embedding import beside_features, embedded
from common.language.log_linear import UNKNOWN, Floats, LogLinear, Option, hashed
from common.language.mood import forbids
from common.language.normalise import Words, normalise
from common.messages import WorldObject

WEIGHTS = "offered.npz"
"""Beside this module: what `LogLinear.save` wrote."""
NONE, ANY = "none", "any"
"""Forms of an answer that chooses nothing, and of one that every option suits."""
UNFIT = frozenset({
    "but", "dirty", "broken", "empty", "apart", "rather", "instead", "other", "difference", "nor", "not", "no",
    "except", "without", "never", "neither", "anything",
})  # fmt: skip
"""Words with which an option may be named in order to pass it over."""
_PRINTED = ("writing", "letters", "print", "printed", "label", "text", "words", "lettering")
"""Words for what is printed on something."""
TOLD_APART = 2
"""Options of a higher number are one form (more than three are hardly ever offered)."""
BESIDE = 0.6
"""Farthest that something is "next to" something else [m] (chosen: both within one reach)."""
_STEPS = 20.0
"""Steps a unit in which likenesses of texts are told apart (chosen)."""


def words_of(answer: str) -> Words:
    """The words and marks of an answer."""
    return tuple(without_fillers(expand(normalise(answer, ","))).replace(",", " ,").split())


def options(
    words: Words, offered: Sequence[str], known: Sequence[WorldObject], household: Household, vocabulary: frozenset[str]
) -> list[Option]:
    """Every option as the model sees it, and last that nothing is chosen, and that any will do."""
    marks = [set(marks_of(option, known, household)) for option in offered]
    text = " ".join(word for word in words if word != ",")
    likeness = [_likeness(text, option, known, household) for option in offered]
    sizes = [_size(option, known) for option in offered]
    found = []
    for n in range(len(offered)):
        others = set().union(*(marks[k] for k in range(len(offered)) if k != n))
        own = {name: kind for kind, name in marks[n] - others}
        foreign = {name: kind for kind, name in others - marks[n]}
        names = list(_names(words, own, foreign, vocabulary))
        best = likeness[n] - max((x for k, x in enumerate(likeness) if k != n), default=0.0)
        names += [f"likeness {math.floor(best * _STEPS)}", f"best {best > 0}"]
        names += [f"{word} {name}" for name in _ranks(n, sizes) for word in {"", *words} & ({""} | vocabulary)]
        names += [f"{word} number {n} of {len(offered)}" for word in set(words) & vocabulary]
        found.append(Option(f"option-{min(n, TOLD_APART)}", hashed(names)))
    whole = [word if word in vocabulary else UNKNOWN for word in words]
    return [
        *found,
        *(Option(form, hashed(f"{form} {name}" for name in (*whole, *pairwise(whole)))) for form in (NONE, ANY)),
    ]


def embedding(words: Words) -> Floats:
    """Of the answer: (embedding.SIZE,)."""
    return beside_features(" ".join(word for word in words if word != ","))


def likeliest(
    answer: str, offered: Sequence[str], known: Sequence[WorldObject], household: Household
) -> tuple[str, float]:
    """The option that most likely suits, "" for none of them; and with how much probability."""
    words, model = words_of(answer), _in_use()
    p = model.probabilities(options(words, offered, known, household, model.words), embedding(words))
    suits = p[: len(offered)] + p[-1]
    best = int(suits.argmax())
    return (offered[best], float(suits[best])) if suits[best] > p[-2] else ("", float(p[-2]))


def _names(words: Words, own: dict[str, str], foreign: dict[str, str], known: frozenset[str]) -> Iterator[str]:
    """The words around those that only this option, or only another one, has: `not #own`, `#other , #own`."""
    marks = ["<begin>"]
    for word in words:
        singular = word.removesuffix("'s").removesuffix("s")
        if kind := own.get(word) or own.get(singular):
            marks.append(f"#own {kind}")
        elif kind := foreign.get(word) or foreign.get(singular):
            marks.append(f"#other {kind}")
        else:
            marks.append(word if word in known else UNKNOWN)
    marks.append("<end>")
    hits = [mark for mark in marks if mark[0] == "#"]
    yield f"hits {' '.join(hits[:4])}"
    yield f"last {hits[-1] if hits else ''}"
    yield f"unfit {not UNFIT.isdisjoint(words)} {hits[0] if hits else ''} {len(hits)}"
    yield f"forbids {forbids(' '.join(words))} {hits[-1] if hits else ''}"
    for at, mark in enumerate(marks):
        if mark[0] == "#":
            yield mark
            yield f"before {marks[at - 1]} {mark}"
            yield f"two before {marks[max(at - 2, 0)]} {marks[at - 1]} {mark}"
            yield f"behind {mark} {marks[at + 1]}"
            for other in set(marks[:at]):
                yield f"somewhere before {other} {mark}"


def marks_of(option: str, known: Sequence[WorldObject], household: Household) -> Iterator[tuple[str, str]]:
    """Words by which an option is told, each with what kind of word it is."""
    items = [o for o in known if o.label == option]
    for word in normalise(option).split():
        yield "name", word
    for item in items:
        for text in (item.text, *item.names):
            for word in normalise(text).split():
                yield "print", word
        for other in beside(item, known):
            for word in normalise(f"{other.label} {other.text}").split():
                yield "beside", word
    groups = household.words.groups
    for group in (group for group, kinds in groups.items() if any(o.kind in kinds for o in items)):
        yield "use", group.split()[-1]
    if any(o.text for o in items):
        yield from (("print", word) for word in _PRINTED)
    receptacle = household.receptacle(option)
    for other in (o for o in known if receptacle and o.on == receptacle.name):
        for word in normalise(f"{other.label} {other.text}").split():
            yield "contents", word
    for part in [receptacle] if receptacle else [r for o in items if (r := household.receptacle(o.on or ""))]:
        for name in _where(part, household):
            for word in name.split():
                yield "place", word


def _where(part: Receptacle, household: Household) -> Iterator[str]:
    """The names of a surface and of its room."""
    yield from (part.name, *part.aliases)
    if (room := household.room_at(*part.center[:2])) is not None:
        yield from (room.name, *room.aliases)


def beside(item: WorldObject, known: Sequence[WorldObject]) -> Iterator[WorldObject]:
    """What stands within a reach of it, on the same surface."""
    for other in known:
        apart = math.dist(other.position[:2], item.position[:2])
        if other.label != item.label and other.on == item.on and apart < BESIDE:
            yield other


def _likeness(text: str, option: str, known: Sequence[WorldObject], household: Household) -> float:
    """Of the answer to what the option is and where it stands: the cosine of their embeddings."""
    item = next((o for o in known if o.label == option), None)
    part = household.receptacle(item.on or "") if item else household.receptacle(option)
    where = " ".join(list(dict.fromkeys(_where(part, household)))[:2]) if part else ""
    return float(np.dot(embedded(text), embedded(f"the {option} {where}".strip())))


def _size(option: str, known: Sequence[WorldObject]) -> tuple[float, float] | None:
    """Height [m] and volume [m3]."""
    item = next((o for o in known if o.label == option), None)
    return (item.size[2], math.prod(item.size)) if item else None


def _ranks(n: int, sizes: Sequence[tuple[float, float] | None]) -> Iterator[str]:
    if all(sizes):
        for axis, name in enumerate(("tall", "big")):
            values = [size[axis] for size in sizes if size]
            if values[n] == max(values) and values.count(values[n]) == 1:
                yield f"most {name}"
            if values[n] == min(values) and values.count(values[n]) == 1:
                yield f"least {name}"


_MODELS: list[LogLinear] = []
"""The model in use, once there is one."""


def use(model: LogLinear) -> None:
    """Choose by another model than the shipped one."""
    _MODELS[:] = [model]


def _in_use() -> LogLinear:
    if not _MODELS:
        use(LogLinear.load(files(__package__) / WEIGHTS))
    return _MODELS[0]
