"""What is to be said: words that are spoken as they stand, and the ways to ask for them. Pure."""

import re

from common.language.lexicon import FAMILY

_FAMILY = FAMILY.replace(" ", "")
_WHOM = (
    r"(?:them|him|her|everyone|everybody|people|the others|"
    rf"(?:the|my|our) (?!robot\b|machine\b|vacuum\b)\w+|{_FAMILY})"
)
_BEGIN = r"(?P<before>^|[,.;!?] |\b(?:and|then|please|(?:can|could|would|will) you) )"
_TOLD_TO_DO = re.compile(
    rf"{_BEGIN}(?:tell|ask|remind|warn) (?P<whom>{_WHOM}(?: (?:in|at) (?:the|my|our) \w+(?: room)?)?) to "
    r"(?P<what>(?!me\b|us\b)\w.*)$"
)
"""What somebody is to be told to do."""
_LET_KNOW = re.compile(rf"{_BEGIN}let {_WHOM}(?P<where> (?:in|at) (?:the|my|our) \w+(?: room)?) know(?: that)? (?=\w)")
_CRIED = re.compile(
    rf"{_BEGIN}(?:(?:shout|yell|holler|cry|call)(?: out)?(?: (?:loudly|please))*(?P<mark>,| that)"
    r"|(?:shout|yell|holler|cry)(?: out)?) (?!at\b|for\b|if\b|when\b|to\b|out\b)(?=\w)"
)
_CEREMONY = re.compile(
    rf"{_BEGIN}(?P<verb>say|announce|declare|proclaim)(?:,? (?:please|kindly|loudly|aloud|out loud|the following|"
    r"word for word|"
    r"to (?:everyone|everybody|all|the (?:whole )?(?:house|room|family))|"
    r"in an? (?:\w+ )?(?:voice|tone|whisper)|"
    r"(?:nice and )?(?:loud|clear|quiet|slow)(?:ly)?(?: and (?:loud|clear|quiet|slow)(?:ly)?)?))*, (?:that )?(?=\w)"
)
"""A verb of saying with a mark before what is said."""
_TO_BE_ASKED = re.compile(
    rf"{_BEGIN}ask (?P<whom>{_WHOM}|(?!(?:me|us|you|for|about|yourself|if|whether|it|that|this)\b)\w+)"
    r"(?P<where> (?:in|at) (?:the|my|our) \w+(?: room)?)? (?:if|whether) (?:he|she|they) "
    r"(?P<verb>wants?|needs?|likes?|knows?|ha(?:s|ve)|is|are|would|can|could|will) (?P<what>[^,;.]+)"
)
"""What somebody is to be asked."""
_BEFORE_YOU = frozenset({"is", "are", "would", "can", "could", "will"})
"""Verbs of a question that come before the one who is asked."""
_OF_YOU = {"is": "are", "has": "have", "wants": "want", "needs": "need", "likes": "like", "knows": "know"}
_NAMELESS = re.compile(r"(?:the|my|our|them|him|her|every\w+|people)\b")
"""How somebody is named without a name to call them by."""
_QUOTED = re.compile(r"(?<=\bsay),? (?:open )?quotes?,? (?P<said>.+?)(?:,? (?:unquote|(?:close|end) quotes?)\b|$)")
"""What is to be said between spoken quotation marks: `say quote dinner is ready unquote`."""
_REPEATED = re.compile(r"^repeat after me[,:]? (?:and )?")
_THEIRS = re.compile(r"\b(?:their|his|her)\b")
LONG_SPEECH = re.compile(
    r"^(?:(?:say|announce)(?: that)?|(?:shout|yell|call)(?: out)? that|tell (?:them|everybody|everyone|people|"
    r"us|me) that|"
    r"tell (?:everybody|everyone|people) in (?:the|my|our) \w+(?: \w+)? that|"
    r"tell (?:them|everybody|everyone|people|the others)(?! (?:to|where|what|how|if|whether|about|when|why|who|"
    r"which)\b)|"
    r"(?:tell|inform) (?:my|our|the) \w+(?: that)?(?! (?:to|where|what|how|if|whether|about|when|why|who|which)\b)|"
    rf"tell {_FAMILY}(?: that)?(?! (?:to|where|what|how|if|whether|about|when|why|who|which)\b)|"
    r"tell whoever is (?:in|at) (?:the|my|our) \w+(?: \w+)? (?:that|to)|repeat after me,?|"
    r"let (?:(?:my|our|the) \w+|everyone|everybody|them|people) know(?: that)?|inform (?:everyone|everybody|them|"
    r"people)(?: that)?)\s+(.+)$"
)
"""A clause whose words are to be spoken and not understood."""

TO_BE_SAID = re.compile(r"(?:^|(?<=[,.;!?] )|(?<= and )|(?<= then )|(?<=please )|(?<= you ))(?:say|announce) ")
"""Behind it stands what is to be said."""


def as_speech(text: str) -> str:
    """Normalised text with what is to be said behind `say` and `tell them`: `shout dinner`, `tell mum to come`."""
    text = _TO_BE_ASKED.sub(_asked, _REPEATED.sub("say ", _QUOTED.sub(r" \g<said>", text)))
    text = _LET_KNOW.sub(r"\g<before>tell them\g<where> that ", _TOLD_TO_DO.sub(_told, text))
    return _CEREMONY.sub(r"\g<before>say ", _CRIED.sub(r"\g<before>say ", text))


def _asked(found: re.Match[str]) -> str:
    """`ask the boys if they want tea` as what is said to them."""
    verb = _OF_YOU.get(found["verb"], found["verb"])
    question = f"{verb} you" if found["verb"] in _BEFORE_YOU else f"do you {verb}"
    whom = "" if _NAMELESS.match(found["whom"]) else f"{found['whom']} "
    say = f"tell them{found['where']} that" if found["where"] else "say"
    return f"{found['before']}{say} {whom}{question} {_THEIRS.sub('your', found['what'], count=1)}"


def _told(found: re.Match[str]) -> str:
    """`tell the boys to brush their teeth` as what is said to them."""
    where = re.search(r" (?:in|at) (?:the|my|our) .+$", found["whom"])
    place = where[0] if where else ""
    return f"{found['before']}tell them{place} {_THEIRS.sub('your', found['what'], count=1)}"
