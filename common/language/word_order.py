"""Clauses in another order or voice than the wordings', put into theirs: `on the desk put the mug`, `the mug has to be
brought here`, `what I want is the mug`. Pure.

Each rewriting is of a construction and not of single words: fronting, passive and causative voice, clefts, wishes of
others, missing verbs. The result is only tried where no wording fits a clause as it stands.
"""

import re
from collections.abc import Iterator

from common.language.constructions import CONSTRUCTIONS, MODAL, NP, PASSIVE, TO_PLACE, VERBLESS
from common.language.lexicon import COMMANDING, HANDLING
from common.language.normalise import DETERMINERS, Words, infinitive

_QUANTITIES = frozenset({"all", "both", "every", "each", "one", "two", "three", "everything", "something", "anything"})
_STARTS = DETERMINERS | _QUANTITIES
_PREPOSITIONS = (
    "on top of", "next to", "close to", "in front of", "out of", "on", "onto", "in", "into", "inside", "to", "at",
    "from", "off", "beside", "near", "for", "by", "under", "behind",
)  # fmt: skip
_PREP = f"(?:{'|'.join(_PREPOSITIONS)})"
_REQUEST_END = re.compile(
    r"(?:,| (?:can|could|would|will) you| you (?:can|could|should|may|must|have to|need to)| please| just| now| "
    r"and| so| to| i want you"
    r" to| i need you to)+$"
)
_COMES = re.compile(rf"^{NP} {MODAL} (?:come|get|go|be|go back|come back)(?: over)? (?:to (?:me|us)|here)$")
_MOVED = re.compile(
    rf"^{NP} (?:{MODAL} (?:go|get|stand|be|come|lie|sit)(?: standing| lying| sitting| kept| "
    rf"moved)?|goes|go|belongs?|gets?|stands?|moves?)(?: back| over| "
    rf"straight| right)*"
    rf" ({TO_PLACE}) {NP}$"
)


_FROM = re.compile(r" (?:in|on|at) (?=(?:the|my|our) )")
"""Before where a thing is now, of which it is told where it is to be."""
_ASKED_TO_GO = re.compile(
    rf"^(?:can|could|might|may|should|would) {NP} (?:go|come|get|move)(?: back| over)* ({TO_PLACE}) {NP}$"
)
"""Where a thing is to go, as a question."""
_QUESTION = re.compile(
    r"^(?:what(?! (?:i|we|you)\b)|where|who|whose|which|why|when|how|is|are|was|were|does|did|has|do "
    r"(?:you|i|we|they)|"
    r"have (?:you|i|we|they))\b"
)


def reworded(words: Words, verbs_only: bool = False, deeper: bool = True) -> Iterator[Words]:
    """Other sentences that say the same, the nearer first; with `verbs_only` none for clauses without a verb.

    `deeper`: what was rewritten is rewritten once more.
    """
    text = " ".join(words)
    if _QUESTION.match(text):
        return  # a question is never taken for a command
    seen = {text}
    for candidate in _candidates(text, words, verbs_only):
        again = " ".join(candidate.split())
        if again and again not in seen:
            seen.add(again)
            yield tuple(again.split())
            if deeper:
                for other in reworded(tuple(again.split()), verbs_only, deeper=False):
                    if (joined := " ".join(other)) not in seen:
                        seen.add(joined)
                        yield other


_WITHIN = (
    (re.compile(r"\bwhichever (\w+) is (?:the )?((?:clos|near)est to)\b"), r"the \1 \2"),
    (re.compile(r"\bwhichever (\w+) is (?:the )?(\w+est)\b(?! to\b)"), r"the \2 \1"),
    (re.compile(r"\banother$"), "another one"),
    (re.compile(r"\b(?:the )?(?:others|rest)$"), "the other ones"),
    (
        re.compile(r"(?<=\w )(?:whatever|what)(?: is| lies| stands)?(?: lying| standing| sitting)? (?=between\b)"),
        "the thing ",
    ),
    (
        re.compile(
            r"\b(?:whatever|anything that|everything that|all that|all the (?:things|stuff) that|(?<=\w )what) "
            r"(?:is|are|lies|stands) (?:lying |standing |sitting )?(?=(?:on|in|at|left|there)\b)"
        ),
        "everything ",
    ),
    (re.compile(r"\bthe (\w+) (closest|nearest) to (?:you|me|us|here)$"), r"the \2 \1"),
    (
        re.compile(
            r"\bthe (\w+) (?:that|which) (?:is|are|stands|lies) (?:the )?(closest|nearest|biggest|smallest|"
            r"tallest|shortest|bigger|smaller|taller|shorter|larger|nearer|farthest|furthest|largest|leftmost|rightmost)"
            r"(?: to (?:you|me|us|here))?"
        ),
        r"the \2 \1",
    ),
)
"""Relative clauses inside a noun phrase, as what they come to."""


def _candidates(text: str, words: Words, verbs_only: bool) -> Iterator[str]:
    for pattern, result in _WITHIN:
        if text != (shorter := pattern.sub(result, text)):
            yield shorter
    yield from _fronted(words)
    for pattern in PASSIVE:
        if (found := pattern.match(text)) and (verb := _verb(found[2])):
            yield f"{verb} {found[1]}{found[3] or ''}"
    if found := _COMES.match(text):
        yield f"bring me {found[1]}"
    if (found := _ASKED_TO_GO.match(text)) and words[1] not in ("you", "i", "we", "he", "she", "they"):
        home = found[2] == "to" and found[3] in ("me", "us")
        yield f"bring me {found[1]}" if home else f"put {found[1]} {'in' if found[2] == 'to' else found[2]} {found[3]}"
    if (found := _MOVED.match(text)) and words[0] != "anything":
        yield f"put {_FROM.sub(' from ', found[1])} {'in' if found[2] == 'to' else found[2]} {found[3]}"
    yield from _topic(words)
    for pattern, result in (*CONSTRUCTIONS, *(() if verbs_only or words[0] in COMMANDING else VERBLESS)):
        if found := pattern.match(text):
            yield found.expand(result)


def _verb(word: str) -> str:
    """The verb of `tidied`, `thrown` and `clearing`; "" of words that are none."""
    verb = infinitive(word, COMMANDING)
    same = word in ("put", "set", "tidy", "clean", "clear")  # the participle, or "needs a tidy"
    return verb if verb in COMMANDING and (verb != word or same) else ""


def _fronted(words: Words) -> Iterator[str]:
    """`put on the desk the mug` as `put the mug on the desk`; `on the desk put the mug` too."""
    verb = next((i for i, w in enumerate(words) if w in COMMANDING), None)
    if verb is None or len(words) < 4:
        return
    text = " ".join(words)
    if verb > 1 and re.match(rf"{_PREP} ", text) and words[verb - 1] not in _STARTS:
        yield " ".join((*words[verb:], *words[:verb]))
    if verb or not re.match(rf"{_PREP} ", " ".join(words[1:])):
        return
    for at in range(3, len(words)):
        before = words[at - 1]
        if (
            words[at] in _STARTS
            and before not in _STARTS
            and before not in _PREPOSITIONS
            and before not in ("of", "and")
        ):
            place = words[1:at] if words[1] != "for" else ("to", *words[2:at])
            yield " ".join((words[0], *words[at:], *place))


def _topic(words: Words) -> Iterator[str]:
    """`the green can you can throw away` as `throw the green can away`."""
    if words[0] in COMMANDING:
        return
    for at in range(2, len(words)):
        rest = words[at + 1 :]
        if words[at] not in HANDLING or words[at - 1] in _STARTS or words[at - 1] in _PREPOSITIONS:
            continue
        thing = _REQUEST_END.sub("", " ".join(words[:at]))
        if thing.split()[0] not in _STARTS and thing == " ".join(words[:at]):
            continue
        if not rest or rest[0] in _STARTS - {"that", "this", "those", "these"}:
            continue
        if rest[0] == "them" and not thing.endswith("s") and "and" not in words[: at - 1]:
            continue  # "the apple and put them on the desk" is about others, too
        if " ".join(rest[:1]) in ("it", "them", "that", "this", "those", "these"):
            rest = rest[1:]
        receiver = rest[:1] if rest[:1] in (("me",), ("us",)) else ()
        tail = rest[len(receiver) :]
        if tail[:1] in (("it",), ("them",)):
            tail = tail[1:]
        yield " ".join((words[at], *receiver, thing, *tail))
