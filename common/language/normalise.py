"""Spoken or typed text as words: lower case, without punctuation and politeness, cut into clauses. Pure."""

import re
import unicodedata
from collections.abc import Container

Words = tuple[str, ...]

DETERMINERS = frozenset({"the", "a", "an", "my", "your", "our", "that", "this", "some", "any", "those", "these"})
"""Words before a noun that say nothing about which object is meant beyond "one of these"."""

_FILLER = re.compile(r"\s*\b(?:u+m+|u+h+|e+r+m*|h+m+|a+h+|o+h+)\b,?|,\s*(?:like|you know)\s*,")
"""Sounds of somebody who thinks while speaking."""
_STUTTER = re.compile(r"\b(the|a|an|to|my|me|i|in|on|and|of|is|you|it|that|can|could|bring|put|get|go)(?:,? \1\b)+")
"""Words that somebody who hesitates says twice."""
_OPENINGS = (
    # Whom it is said to, and what carries no meaning.
    "hey|hello|hi|ok|okay|alright|jarvis|robot|tidybot|please|now|so|well|and|then|also|finally|just|kindly|quickly",
    "maybe|thanks|thank you|great|good|perfect|could it be that|listen|look here|excuse me|sorry|by the way|next",
    r"perhaps|actually|whoa|woah|oi|(?:hold|hang) on(?! (?:to|for)\b)",
    r"first(?=\s+\w+\s+\w)|wait(?=\s+(?:stop|cancel|no)\b)",
    r"(?:go|come|run)(?: ahead| over| on)?(?: and)?"
    r"(?=\s+(?:find|get|fetch|bring|grab|pick|take|put|tidy|clean|clear|throw)\b)",
    r"(?:after that|afterwards|forget (?:about )?that|and then)(?=\s+\w)",
    # What makes a question or a wish of an order.
    r"(?:would|do) you mind|mind(?=\s+\w+ing\b)|would you be (?:so|kind|good|enough|as|to|\s)+",
    r"(?:why do not|why don't|how about|what if) (?:you|we)(?=\s+\w)|(?:can|could|would|will) (?:you|someone|somebody)",
    "you (?:should|must|have to|need to|could|can)|let's|let us",
    "(?:do you think|i was wondering if|i wonder if|i was hoping|(?:is there )?any chance) you (?:could|can|would)",
    r"(?:i wanted|i want|i was going|i would like|i'd like) to ask (?:you )?(?:if you (?:could|can|would)|to)",
    r"(?:i was|i am|i'm) (?:wondering|asking|hoping) (?:if|whether|that) you (?:could|can|would|might)",
    r"(?:would it be|is it|if it is|if) possible(?: for you)?(?: to)?|be (?:a|an|so) \w+ (?:and|as to)",
    r"i(?: would|'d)? (?:like|want|need|love) you to",
    r"(?:it would|it'd) be (?:so |very |really )?\w+ if you(?: (?:could|would|can))?",
    "(?:i'd|i would) (?:appreciate it|be (?:grateful|happy|glad)) if you (?:could|would)",
    "i (?:think|guess|suppose)|do me a favou?r(?: and)?",
    # Conditions that are none.
    r"if you (?:don't|do not|would not|wouldn't) mind|if you (?:can|could|would)",
    r"when you (?:can|(?:have|get) (?:a )?\w+)",
)
"""Politeness before a command: words that may be left out without changing what is asked for."""
_ENDINGS = (
    "please|right now|now|quickly|at once|for me|for us|thanks|thank you|robot|jarvis|then|anyway|and|will you please",
    "(?:and )?hurry(?: up)?|as (?:fast|quickly) as you can|asap",
    "a (?:little )?bit|a little|somewhat|for a (?:bit|while)",
    "(?<!try )(?<!it )(?<!that )(?<!same )(?<!thing )(?<!once )again|as soon as (?:you can|possible)",
    "(?:will|would|could|can) you|if you can|if possible|if you (?:don't|do not|wouldn't) mind",
    r"when you (?:can|(?:have|get) (?:a )?\w+)|(?:for )?(?:a|one) (?:second|sec|moment)",
)
"""Politeness after a command."""
_LEAD = re.compile(rf"^(?:(?:{'|'.join(_OPENINGS)})\s+)+")
_TAIL = re.compile(rf"(?:\s+(?:{'|'.join(_ENDINGS)}))+$")
_FOR_ME = re.compile(r"^(?:grab|take|pick up|reach|snatch|grasp) (?!me\b)(.+?) for (?:me|us)(?= please$|$)")
"""Taking something for somebody is bringing it."""
_PART = re.compile(r"\s*[;.!?]+\s*(?:and\s+)?(?:then\s+)?|,?\s+(?:and\s+)?(?:then|after that|afterwards),?\s+")
_COMMA = re.compile(r"\s*,[\s,]*(?:and\s+)?")
_CONTRACTIONS = tuple(
    (re.compile(short), long)
    for short, long in (
        (r"\b(what|where|who|there|that|it|how|here|which|she|he)'s\b", r"\1 is"),
        (r"\b(what|where|who)s\b", r"\1 is"),
        (r"\b(?:can't|cant|cannot)\b", "can not"),
        (r"\b(did|is|are|was|were|does|have|has|could|should)n'?t\b", r"\1 not"),
        (r"\bwon't\b", "will not"),
        (r"\bdont\b", "do not"),
        (r"\b(you|they|we)'re\b", r"\1 are"),
        (r"\b(i|you|they|we)'ve\b", r"\1 have"),
        (r"\b(i|you|they|we)'ll\b", r"\1 will"),
        (r"\b(want|go|got)(?:na|ta)\b", r"\1 to"),
    )
)
LONG_SPEECH = re.compile(r"^(?:(?:say|announce)(?: that)?|tell (?:them|everybody|everyone|people|us|me) that)\s+(.+)$")
"""A clause whose words are to be spoken and not understood."""


_PAST = {
    "brought": "bring", "took": "take", "taken": "take", "got": "get", "gave": "give", "given": "give", "went": "go",
    "gone": "go", "came": "come", "found": "find", "threw": "throw", "thrown": "throw", "drove": "drive",
    "driven": "drive", "held": "hold", "laid": "lay", "left": "leave", "stuck": "stick", "said": "say", "told": "tell",
}  # fmt: skip
"""Irregular past forms of the verbs of commands."""


def normalise(text: str, keep: str = "") -> str:
    """Lower-case words separated by single spaces; accents and punctuation go, except the marks in `keep`."""
    folded = unicodedata.normalize("NFKD", text.lower().replace("’", "'").replace("_", " "))
    letters = "".join(c for c in folded if not unicodedata.combining(c))
    return " ".join(re.sub(rf"[^\w'{re.escape(keep)}]+", " ", letters).split())


def expand(text: str) -> str:
    """Normalised text with `what's` written as `what is`."""
    for short, long in _CONTRACTIONS:
        text = short.sub(long, text)
    return text


def without_fillers(text: str) -> str:
    """Normalised text without `um`, `er` and words said twice; what is to be said stays as it is."""
    if LONG_SPEECH.match(_LEAD.sub("", text)):
        return text
    return _STUTTER.sub(r"\1", _FILLER.sub("", text)).strip(" ,")


def clauses(text: str) -> list[str]:
    """The clauses of a text one after the other, each without its politeness; what follows "say" is kept whole."""
    return cut_clauses(without_fillers(expand(normalise(text, ",;.!?"))))


def cut_clauses(rest: str) -> list[str]:
    """The same of normalised text with its marks."""
    found: list[str] = []
    while rest:
        saying = LONG_SPEECH.match(_LEAD.sub("", rest))
        cut = None if saying else _PART.search(rest)
        head, rest = (rest, "") if cut is None else (rest[: cut.start()], rest[cut.end() :])
        if bare := without_politeness(head if saying else _commas_as_and(head)):
            found.append(bare)
    return found


def _commas_as_and(text: str) -> str:
    """A comma is an "and": `the mug, the can and the ball`; but `no, the red mug` is one answer."""
    return re.sub(r"^no and ", "no ", _COMMA.sub(" and ", text.strip(" ,")))


def without_politeness(text: str) -> str:
    """A clause without "could you please ..." and "... right now"; "" when nothing else is in it."""
    bare = _LEAD.sub("", text.strip(" ,;.!?") + " ").strip()
    bare = _FOR_ME.sub(r"bring me \1", bare)
    while (shorter := _TAIL.sub("", bare)) != bare:
        bare = shorter
    return bare


def without_determiners(words: Words) -> Words:
    """Words without leading determiners."""
    while words and words[0] in DETERMINERS:
        words = words[1:]
    return words


def infinitive(word: str, verbs: Container[str]) -> str:
    """`bringing` and `brought` as `bring`, as in "would you mind bringing me ..."; other words stay."""
    if word in verbs:
        return word
    if word in _PAST:
        return _PAST[word]
    if word.endswith("ied") and f"{word[:-3]}y" in verbs:
        return f"{word[:-3]}y"
    if word.endswith("ed"):
        return next((v for v in (word[:-2], word[:-1], word[:-3]) if v in verbs), word)
    stem = word.removesuffix("ing")
    if stem == word or word in verbs:
        return word
    return next((v for v in (stem, f"{stem}e", stem[:-1]) if v in verbs), word)


def enumeration(names: list[str], last: str = "and") -> str:
    """Names as spoken: `a, b and c`."""
    return names[0] if len(names) == 1 else f"{', '.join(names[:-1])} {last} {names[-1]}" if names else ""
