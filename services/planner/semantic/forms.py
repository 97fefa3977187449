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
Deed = Literal["bring", "put", "take", "go", "fingers", ""]
NONE, OTHER = "none", "other"
"""Forms of a sentence that asks for nothing, and of one that asks for something that no single form says."""
MARK = ","
"""The word that stands for every mark."""
MOST = 200
"""Most candidates of one sentence (chosen: bounds the time; a sentence with two things and a place has 90)."""


class Form(NamedTuple):
    """`text`: the plain words that the grammar plans, `bare` for the object without its article; `kind`: act or ask.

    `deed`: what is done for it, a look for an answer, too; "" for words alone.
    """

    text: str
    deed: Deed = ""
    kind: Kind = "act"

    @property
    def takes(self) -> tuple[Role, ...]:
        """What it says of the things and places."""
        return tuple(role for role in _ROLES if f"{{{role}}}" in self.text.replace("bare", "object"))


_ROLES: tuple[Role, ...] = ("object", "goal", "source", "beside")
FORMS: dict[str, Form] = {
    "bring": Form("bring me {object}", "bring"),
    "bring_from": Form("bring me {object} on {goal}", "bring"),
    "drink": Form("bring me something to drink", "bring"),
    "eat": Form("bring me something to eat", "bring"),
    "put": Form("put {object} on {goal}", "put"),
    "put_from": Form("put {object} on {source} on {goal}", "put"),
    "near": Form("put {object} next to {beside}", "put"),
    "away": Form("put {object} away", "put"),
    "discard": Form("throw away {object}", "put"),
    "discard_from": Form("throw away {object} on {goal}", "put"),
    "put_back": Form("put it back where it was", "put"),
    "down": Form("put it down", "put"),
    "rule": Form("{bare} always belong on {goal}", "put"),
    "tidy": Form("tidy up {goal}", "put"),
    "tidy_up": Form("tidy up", "put"),
    "take": Form("pick up {object}", "take"),
    "find": Form("find {object}", "go"),
    "find_on": Form("find {object} on {goal}", "go"),
    "go": Form("go to {goal}", "go"),
    "wait_at": Form("go to {goal} and wait", "go"),
    "wait": Form("wait", "go"),
    "back": Form("come back", "go"),
    "look": Form("look around", "go"),
    "look_at": Form("look at {goal}", "go"),
    "open": Form("open your hand", "fingers"),
    "close": Form("close your hand", "fingers"),
    "again": Form("try again"),
    "where": Form("where is {object}", "go", "ask"),
    "exists": Form("is there {bare}", "go", "ask"),
    "on": Form("is {object} on {goal}", "go", "ask"),
    "number": Form("how many {bare} are there", "go", "ask"),
    "number_on": Form("how many {bare} are there on {goal}", "go", "ask"),
    "contents": Form("what is on {goal}", "go", "ask"),
    "see": Form("what do you see", "go", "ask"),
    "colour": Form("what colour is {object}", kind="ask"),
    "belongs": Form("where does {object} belong", kind="ask"),
    "abilities": Form("what can you do", kind="ask"),
    "doing": Form("what are you doing", kind="ask"),
    "did": Form("what did you just do", kind="ask"),
    "why": Form("why did you fail", kind="ask"),
    "where_you": Form("where are you", kind="ask"),
    "battery": Form("how full is your battery", kind="ask"),
    "who": Form("who are you", kind="ask"),
    "holding": Form("what are you holding", kind="ask"),
    "rules": Form("what are your rules", kind="ask"),
}
"""Each plain command and question by its name."""
_ARTICLE = re.compile(r"^(?:the|my|all|any|a|an|some|another)(?: the| my)? ")


class Candidate(NamedTuple):
    """`text`: the plain command, "" where nothing is planned; `roles`: what each chunk is in it, by its number."""

    form: str
    text: str
    roles: Mapping[int, Role]

    @property
    def kind(self) -> Kind:
        """Whether it acts or asks; "none" and "other" for the forms of that name."""
        if self.form in FORMS:
            return FORMS[self.form].kind
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
    for name, form in FORMS.items():
        takes = form.takes
        for chosen in product(*(pools[role] for role in takes)):
            roles = {at: role for role, group in zip(takes, chosen, strict=True) for at in group}
            if len(roles) == sum(map(len, chosen)):
                yield _candidate(name, roles, found)


def _candidate(name: str, roles: dict[int, Role], found: Sequence[Chunk]) -> Candidate:
    named = {role: " and ".join(found[at].text for at, r in roles.items() if r == role) for role in roles.values()}
    bare = " and ".join(_ARTICLE.sub("", found[at].text) for at, r in roles.items() if r == "object")
    return Candidate(name, FORMS[name].text.format(bare=bare, **named), roles)
