"""What is not meant beside what is: `not the red mug, the blue one`, `instead of the can bring the mug`. Pure."""

import re

from common.language.exchange import filled, first_match, noun_phrases, verb_first, with_thing
from common.language.lexicon import A_VERB, COMMANDING
from common.language.normalise import DETERMINERS, infinitive
from common.language.politeness import without_politeness

_BUT = r"(?:,\s*(?:but\s+)?|\s+but\s+)(?:rather )?"
CONTRAST = re.compile(rf"^(?:i (?:said|meant|mean|want|wanted) )?not (?P<wrong>.+?){_BUT}(?P<right>.+)$")
_CONTRASTS = (
    CONTRAST,
    re.compile(
        r"^not (?P<wrong>(?:(?:on|in|to|into) )?(?:the|a|my) (?:\w+ )?\w+?)(?P<right> (?:the|on|in|into|to) .+)$"
    ),
    re.compile(rf"^do not (?P<wrong>{A_VERB} .+?)\s+(?P<right>{A_VERB} (?:me|us|the|a|an|my|it|to)\b.+)$"),
    re.compile(rf"^do not (?P<wrong>\w+ .+?){_BUT}(?P<right>.+)$"),
    re.compile(
        rf"^(?:instead of|rather than) (?P<wrong>.+?),? (?P<right>(?:please )?(?:{A_VERB}|"
        r"i (?:want|need|would (?:like|have|rather have)|will (?:have|take)))"
        r" .+)$"
    ),
)
"""What is wrong before what is right, in order of trial."""
_RIGHT_FIRST = re.compile(
    r"^(?P<right>.+?),? (?:and )?(?:instead of|rather than) (?P<wrong>\w+ing .+|(?:the|my|a|an|that|this|to|in|on|at|"
    r"into|onto) .+)$"
)
"""`put it on the desk instead of bringing it to me`."""
_PREFERRED = re.compile(r"^(?P<right>.*\b(?:rather|prefer|sooner)\b.+?),? than (?P<wrong>(?:in|on|at|to|with) .+)$")
"""`i would rather have it on the desk than on the counter`."""
NOT_WANTED = re.compile(
    r"^(?:(?:never mind|forget(?: about)?|skip|leave|ignore|not|no need for|no more|(?:i|we) do not (?:need|want|like))"
    r" (?:the|that|my|those|this)(?: \w+){1,3}?|no (?!the\b|no\b|need\b)\w+(?=,))(?:,\s*(?:and |but )?| and | but | )"
    rf"(?=(?:please |just |rather )*(?:{A_VERB}|i want|i need|i would like)\b"
    r"|(?<=, )(?:the|a|an|my) (?!\w+ ones?\b))"
)
"""What is not wanted, before what is."""
_NOT_HERE = re.compile(r"^(?:no,? )?not (?:here|there|over (?:here|there)|like (?:this|that)),? (?:but )?(?=\w+ \w)")
_ELSEWHERE = re.compile(
    r"^(?P<thing>(?!(?:i|we|you)\b).+?) (?:does|do|should|must|can|may) not (?:belong|go|live|stay|stand|be)\b.+?,? "
    r"(?:(?:but|and),? )?(?:it|they) (?P<right>(?:belongs?|go(?:es)?|lives?|should|must|has to|have to)\b.+)$"
)
"""Where something does not belong, and where it does."""


def instead(text: str) -> str | None:
    """What is to be done instead of what is said to be left: `put it there instead of here`; None without such."""
    if text.startswith(("instead of", "rather than")):
        return contrasted(text)
    if found := _RIGHT_FIRST.match(text) or _PREFERRED.match(text):
        return filled(found["right"], found["wrong"]) if " one" in found["right"] else found["right"]
    return None


def contrasted(text: str) -> str:
    """A text without politeness as what is meant by it in the end; as it is when it sets nothing against another."""
    if unwanted := NOT_WANTED.match(text):
        text = filled(without_politeness(text[unwanted.end() :]), unwanted[0].replace(",", ""))
    if found := _ELSEWHERE.match(text):
        return f"{found['thing']} {found['right']}"
    text = _NOT_HERE.sub("", text)
    found = first_match(_CONTRASTS, text)
    return text if found is None else _right(found["wrong"], found["right"])


def _right(wrong: str, right: str) -> str:
    """`not the red mug, the blue one` is the blue mug; a verb that was said only with the wrong one is kept."""
    first, _, thing = wrong.partition(" ")
    verb = infinitive(first, COMMANDING)
    right = re.sub(r",? (?:instead|rather)$", "", without_politeness(right))
    if verb not in COMMANDING:
        return filled(right, wrong)
    if verb_first(right):
        said = thing.split()
        return filled(right if said[:1] in (["it"], ["them"]) else with_thing(right, said), thing)
    words = wrong.split()
    receiver = f"{words[1]} " if len(words) > 2 and words[1] in ("me", "us") else ""
    return f"{verb} {receiver}{filled(right, thing)}"


def with_qualities(said: str, wrong: str, right: str) -> str:
    """`the box` for `the bottle` where `the white bottle` was said is `the white box`."""
    bare, other = ([w for w in text.split() if w not in DETERMINERS] for text in (wrong, right))
    phrases = [said.split()[a:b] for a, b in noun_phrases(said.split())]
    phrase = next((p for p in phrases if p[-1:] == bare and len(p) > 2), None)
    return " ".join((*phrase[:-1], *other)) if phrase and len(other) == 1 else right
