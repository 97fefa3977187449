"""The plain commands and questions that any words could mean: every form with the things and places they name. Pure."""

import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from itertools import pairwise, product
from typing import Literal, NamedTuple

from common.language.clauses import without_fillers
from common.language.contractions import expand
from common.language.exchange import replaced
from common.language.lexicon import COMMANDING
from common.language.mood import is_asked
from common.language.normalise import DETERMINERS, Words, infinitive, normalise
from services.planner.grammar.chunks import MARK, POINTING, Chunk

Role = Literal["object", "goal", "source", "beside", "time"]
Kind = Literal["act", "ask", "none", "other"]
Deed = Literal["bring", "put", "take", "go", "wait", "fingers", "say", "name", ""]
NONE, OTHER = "none", "other"
"""Forms of a sentence that asks for nothing, and of one that asks for something that no single form says."""
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


_ROLES: tuple[Role, ...] = ("object", "goal", "source", "beside", "time")
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
    "wait_at": Form("go to {goal} and wait", "wait"),
    "wait_for": Form("wait {time}", "wait"),
    "wait_there": Form("go to {goal} and wait {time}", "wait"),
    "wait": Form("wait", "wait"),
    "back": Form("come back", "go"),
    "look": Form("look around", "go"),
    "look_at": Form("look at {goal}", "go"),
    "open": Form("open your hand", "fingers"),
    "close": Form("close your hand", "fingers"),
    "again": Form("{instead}"),
    "with": Form("{instead}"),
    "say": Form("say {words}", "say"),
    "teach": Form("this is my {words}", "name"),
    "place": Form("name this place the {words}", "name"),
    "unname": Form("forget the name {words}", "name"),
    "unrule": Form("forget the rule about {bare}", "name"),
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
"""Each plain command and question by its name; `instead`: the last command, with another thing or place in it."""
_SAYING = frozenset({
    "say", "tell", "shout", "announce", "holler", "yell", "call", "whisper", "repeat", "declare", "sing", "wish",
    "greet", "ask", "remind", "inform", "mention", "read", "recite", "speak", "hear", "know", "cry",
})  # fmt: skip
"""Verbs with words to be said behind them."""
_NAMING = frozenset({"call", "called", "name", "named", "dub", "rename", "forget", "delete", "drop", "known"})
"""Words with a name behind them."""
_BEING = frozenset({"is", "as", "be"})
_POINTED = frozenset({"this", "that", "here", "it", "place", "spot", "name", "there", "these"})
"""Words before `is`, so that a name may follow."""
_LIGHT = frozenset(
    {"go", "make", "do", "say", "have", "get", "mean", "want", "try", "check", "finish", "leave", "wait"}
)
"""Verbs of what only exchanges a part of the command before: `make it the blue one`, `it should go to the desk`."""
_SKIPPED = 4
"""Most words between a verb of saying and what is to be said: `tell the two children` (chosen)."""
_BEHIND = 3
"""Most words behind what is to be said, or behind a name: `from now on` (chosen)."""
_ARTICLE = re.compile(r"^(?:the|my|all|any|a|an|some|another)(?: the| my)? ")


class Candidate(NamedTuple):
    """`text`: the plain command, "" where nothing is planned; `roles`: what each chunk is in it, by its number.

    `span`: begin and end of the words that it quotes.
    """

    form: str
    text: str
    roles: Mapping[int, Role]
    span: tuple[int, int] | None = None

    @property
    def kind(self) -> Kind:
        """Whether it acts or asks; "none" and "other" for the forms of that name."""
        if self.form in FORMS:
            return FORMS[self.form].kind
        return "other" if self.form == OTHER else "none"


def tokens(text: str) -> Words:
    """The words of a text in the spelling of the grammar; every mark is a word `,`."""
    return tuple(re.sub(r"[,;.!?]", f" {MARK} ", without_fillers(expand(normalise(text, ",;.!?")))).split())


def candidates(words: Words, found: Sequence[Chunk], before: str = "") -> list[Candidate]:
    """What could be meant where these things and places are named, behind the command `before`.

    The two forms without words are always among it.
    """
    seen: dict[str, Candidate] = {}
    for candidate in (*_candidates(found), *_quoting(words), *_exchanged(words, found, before)):
        seen.setdefault(candidate.text, candidate)
    return [Candidate(NONE, "", {}), Candidate(OTHER, "", {}), *list(seen.values())[:MOST]]


def _candidates(found: Sequence[Chunk]) -> Iterator[Candidate]:
    things, spots, times = ([(at,) for at, c in enumerate(found) if c.kind == k] for k in ("thing", "spot", "time"))
    several: list[tuple[int, ...]] = [(*a, *b) for a, b in pairwise(things)]  # several things of one command
    several += [tuple(at for (at,) in things)] if len(things) > 2 else []
    pools: dict[Role, list[tuple[int, ...]]] = {
        "object": [*things, *several],
        "goal": [*spots],
        "source": [*spots],
        "beside": [*things],
        "time": [*times],
    }
    for name, form in FORMS.items():
        if "{words}" in form.text or "{instead}" in form.text:
            continue
        takes = form.takes
        for chosen in product(*(pools[role] for role in takes)):
            roles = {at: role for role, group in zip(takes, chosen, strict=True) for at in group}
            if len(roles) == sum(map(len, chosen)):
                yield _candidate(name, roles, found)


def _candidate(name: str, roles: dict[int, Role], found: Sequence[Chunk]) -> Candidate:
    named = {role: " and ".join(found[at].text for at, r in roles.items() if r == role) for role in roles.values()}
    bare = " and ".join(_ARTICLE.sub("", found[at].text) for at, r in roles.items() if r == "object")
    return Candidate(name, FORMS[name].text.format(bare=bare, **named), roles)


def _quoting(words: Words) -> Iterator[Candidate]:
    """Forms with words of the sentence in them: to be said, or a name."""
    marks = [at for at, word in enumerate(words) if word == MARK]
    says = any(_is(word, _SAYING) for word in words)
    for at, word in enumerate(words):
        begins = range(at + 1, at + 2 + _SKIPPED) if _is(word, _SAYING) else [at + 1] if says and word == MARK else []
        yield from _quotes(words, begins, marks, ("say",))
        if word in _NAMING or (word in _BEING and not _POINTED.isdisjoint(words[:at])):
            yield from _quotes(words, range(at + 1, at + 3), marks, ("teach", "place", "unname"))


def _is(word: str, verbs: frozenset[str]) -> bool:
    return word in verbs or infinitive(word, COMMANDING) in verbs


def _quotes(words: Words, begins: Iterable[int], marks: Sequence[int], names: Sequence[str]) -> Iterator[Candidate]:
    for begin in begins:
        for end in {len(words), *marks, *range(len(words) - _BEHIND, len(words))}:
            if begin < end and MARK not in (words[begin], words[end - 1]) and words[end - 1] not in DETERMINERS:
                text = " ".join(words[begin:end])
                for name in names if "say" in names or words[begin] not in POINTING else ():
                    quoted = text if name == "say" else _ARTICLE.sub("", text)
                    yield Candidate(name, FORMS[name].text.format(words=quoted), {}, (begin, end))


def _exchanged(words: Words, found: Sequence[Chunk], before: str) -> Iterator[Candidate]:
    """The command before, as it is or with one thing or place of the sentence in it, which has no verb of its own."""
    if before:
        yield Candidate("again", before, {})
    if not before or any(infinitive(word, COMMANDING) in COMMANDING - _LIGHT for word in words) or is_asked(words):
        return
    for at, chunk in enumerate(found):
        if chunk.kind != "time":
            is_place = chunk.kind == "spot"
            text = replaced(before, chunk.text, lambda _: is_place)  # noqa: B023  called at once
            if text and text != before:
                yield Candidate("with", text, {at: "goal" if is_place else "object"})
