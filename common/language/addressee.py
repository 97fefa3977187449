"""To whom a request is said by name: `Tom, can you get me the mug` is not for the robot. Pure."""

import re
from collections.abc import Callable

from common.language.contractions import expand
from common.language.exchange import verb_first
from common.language.frame import SMALL_TALK
from common.language.lexicon import COMMANDING, FAMILY
from common.language.meaning import VERBS, WORDS
from common.language.normalise import DETERMINERS, normalise
from common.language.politeness import without_lead, without_politeness
from common.language.verb_classes import classes

_TITLES = "mr|mrs|ms|miss|dr|doctor|aunt|auntie|uncle|nurse"
_ASKS = r"(?:can|could|would|will) you\b(?! (?:see|know)\b)"
_FOR_ME = re.compile(r"^(?:can|could|may) (?:i|we) (?:please )?(?:have|get|borrow)\b")
_BEFORE = re.compile(
    rf"^(?:(?:hey|hi|hello|ok|okay|oh|well|and),? )*(?P<name>(?:(?:{_TITLES}) )?[a-z]+)"
    rf"(?: (?:love|dear|darling|honey))?(?:,\s*(?P<rest>.+)|\s+{_ASKS}.+)$"
)
_BEHIND = re.compile(rf"^(?:please )?{_ASKS}[^,]+,\s*(?P<name>(?:(?:{_TITLES}) )?[a-z]+)$")
_ANSWERS_TO = frozenset({"robot", "tidybot", "jarvis", "bot", "robby", "machine"})
"""What the robot is called, beside all that politeness.py takes off."""
_KIN = frozenset(re.findall(r"[a-z]+", FAMILY)) | {"children", "everybody", "everyone", "guys", "folks"}
_POINTING = frozenset({"it", "them", "that", "those", "one", "ones"})


def addressee(text: str, is_name: Callable[[str], bool] = lambda _: True) -> str:
    """The name that a request is addressed by, "" for the robot or nobody.

    A word that is no part of the language of commands counts as a name, unless `is_name` denies it (it names a thing)
    or a pronoun in the request stands for it: `stapler, can you bring it`.
    """
    whole = expand(normalise(text, ","))
    found = _BEFORE.match(whole) or _BEHIND.match(whole)
    if found is None:
        return ""
    name, rest = found["name"], found.groupdict().get("rest") or ""
    if rest and not _FOR_ME.match(rest) and not verb_first(without_politeness(rest)):
        return ""
    asked = whole[: found.start("name")] + whole[found.end("name") :]
    if not _is_strange(name) or not is_name(name) or _POINTING.intersection(re.findall(r"\w+", asked)):
        return ""
    return name


def _is_strange(name: str) -> bool:
    """Is it somebody's name or title rather than a word to the robot, a verb, an adverb or an exclamation?"""
    word = name.split()[-1]
    if word in _KIN or name != word:
        return True
    known = WORDS | VERBS | SMALL_TALK | COMMANDING | DETERMINERS | _ANSWERS_TO
    plain = word in known or word.endswith(("ly", "ing", "ed")) or bool(classes(word))
    return not plain and len(word) > 2 and without_lead(f"{word}, bring me it").startswith(word)
