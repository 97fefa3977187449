"""The plain commands and questions that any words could mean: every form with the things and places they name. Pure."""

import re
from collections.abc import Iterator, Mapping, Sequence
from itertools import pairwise, product
from typing import Literal, NamedTuple

from common.language.clauses import without_fillers
from common.language.contractions import expand
from common.language.normalise import Words, normalise
from services.planner.grammar.chunks import Chunk

Role = Literal["object", "goal", "source", "beside"]
Kind = Literal["act", "ask", "none", "other"]
NONE, OTHER = "none", "other"
"""Forms of a sentence that asks for nothing, and of one that asks for something that no single form says."""
MARK = ","
"""The word that stands for every mark."""
MOST = 200
"""Most candidates of one sentence (chosen: bounds the time; a sentence with two things and a place has 90)."""
_FORMS = {
    "bring": "bring me {object}", "find": "find {object}", "where": "where is {object}",
    "discard": "throw away {object}", "away": "put {object} away", "take": "pick up {object}",
    "exists": "is there {bare}", "number": "how many {bare} are there", "colour": "what colour is {object}",
    "belongs": "where does {object} belong",
    "put": "put {object} on {goal}", "on": "is {object} on {goal}", "number_on": "how many {bare} are there on {goal}",
    "rule": "{bare} always belong on {goal}", "bring_from": "bring me {object} on {goal}",
    "discard_from": "throw away {object} on {goal}", "find_on": "find {object} on {goal}",
    "put_from": "put {object} on {source} on {goal}", "near": "put {object} next to {beside}",
    "go": "go to {goal}", "wait_at": "go to {goal} and wait", "tidy": "tidy up {goal}", "contents": "what is on {goal}",
    "look_at": "look at {goal}",
    "tidy_up": "tidy up", "back": "come back", "look": "look around", "abilities": "what can you do",
    "doing": "what are you doing", "did": "what did you just do", "why": "why did you fail", "see": "what do you see",
    "down": "put it down", "wait": "wait", "drink": "bring me something to drink",
    "eat": "bring me something to eat", "where_you": "where are you", "open": "open your hand",
    "close": "close your hand", "put_back": "put it back where it was", "again": "try again",
    "battery": "how full is your battery", "who": "who are you", "holding": "what are you holding",
    "rules": "what are your rules",
}  # fmt: skip
"""Each form as the plain words that the grammar plans; `bare` is the object without its article."""
_ASKS = frozenset({
    "where", "exists", "number", "colour", "belongs", "on", "number_on", "contents", "abilities", "doing", "did", "why",
    "see", "where_you", "battery", "who", "holding", "rules",
})  # fmt: skip
_ROLES: tuple[Role, ...] = ("object", "goal", "source", "beside")
_TAKES = {
    name: tuple(role for role in _ROLES if f"{{{role}}}" in form.replace("bare", "object"))
    for name, form in _FORMS.items()
}
"""What each form says of the things and places."""
_ARTICLE = re.compile(r"^(?:the|my|all|any|a|an|some|another)(?: the| my)? ")


class Candidate(NamedTuple):
    """`text`: the plain command, "" where nothing is planned; `roles`: what each chunk is in it, by its number."""

    form: str
    text: str
    roles: Mapping[int, Role]

    @property
    def kind(self) -> Kind:
        """Whether it acts or asks; "none" and "other" for the forms of that name."""
        if self.form in _FORMS:
            return "ask" if self.form in _ASKS else "act"
        return "other" if self.form == OTHER else "none"


def tokens(text: str) -> Words:
    """The words of a text in the spelling of the grammar; every mark is a word `,`."""
    return tuple(re.sub(r"[,;.!?]", f" {MARK} ", without_fillers(expand(normalise(text, ",;.!?")))).split())


def candidates(found: Sequence[Chunk]) -> list[Candidate]:
    """What could be meant where these things and places are named; the two forms without words are always among it."""
    seen = {c.text: c for c in _candidates(found) if c.text}
    return [Candidate(NONE, "", {}), Candidate(OTHER, "", {}), *list(seen.values())[:MOST]]


def _candidates(found: Sequence[Chunk]) -> Iterator[Candidate]:
    things: list[tuple[int, ...]] = [(at,) for at, chunk in enumerate(found) if chunk.kind == "thing"]
    spots: list[tuple[int, ...]] = [(at,) for at, chunk in enumerate(found) if chunk.kind == "spot"]
    several: list[tuple[int, ...]] = [(*a, *b) for a, b in pairwise(things)]  # several things of one command
    several += [tuple(at for (at,) in things)] if len(things) > 2 else []
    pools: dict[Role, list[tuple[int, ...]]] = {
        "object": [*things, *several],
        "goal": spots,
        "source": spots,
        "beside": things,
    }
    for name, takes in _TAKES.items():
        for chosen in product(*(pools[role] for role in takes)):
            roles = {at: role for role, group in zip(takes, chosen, strict=True) for at in group}
            if len(roles) == sum(map(len, chosen)):
                yield _candidate(name, roles, found)


def _candidate(name: str, roles: dict[int, Role], found: Sequence[Chunk]) -> Candidate:
    named = {role: " and ".join(found[at].text for at, r in roles.items() if r == role) for role in roles.values()}
    bare = " and ".join(_ARTICLE.sub("", found[at].text) for at, r in roles.items() if r == "object")
    return Candidate(name, _FORMS[name].format(bare=bare, **named), roles)
