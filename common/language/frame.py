"""The frame of a request, read as a bag of words: `i was kind of hoping that you might be able to ...`. Pure.

What stands before the verb of a command is a frame if all of its words are among those of which requests are made,
if it is the robot who is to act, and if one of the words asks. Their order does not matter, so that a new way to be
polite needs no pattern of its own. What tells of the past, forbids, or speaks of somebody else is no frame.
"""

from common.language.lexicon import COMMANDING
from common.language.normalise import DETERMINERS, infinitive

_ASKING_WORDS = (
    "can could would will may might please pls mind kind kindly favour favor possible possibly wish hope hoping "
    "wonder wondering appreciate grateful feasible glad happy thankful delighted obliged lovely "
    "chance trouble ask asking "
    "beg trust expect suppose reckon think help need want love like great nice good wonderful best way request "
    "urge"
)
_ASKING = frozenset(_ASKING_WORDS.split())
"""Words of which one makes a request of a frame."""
_WISHES = frozenset({
    "need", "want", "love", "like", "think", "suppose", "reckon", "trust", "expect", "help", "great", "nice", "good",
    "best", "way",
})  # fmt: skip
"""Those that make one only where the speaker's wish is spoken of."""
_DUTIES = frozenset(
    {"turn", "job", "task", "mission", "order", "command", "duty", "time", "favour", "favor", "solid", "kindness"}
)
"""Those that make one of `your job is to`."""
_SMALL_WORDS = (
    "i we you someone somebody anyone anybody it this that me us one a an the any some my your to of for from in "
    "on at all by with and so as if whether be is am are was were do does have there just also maybe perhaps then "
    "now really quite very too ever even much more most kinda sort bit little lot once again quickly simply "
    "actually still awfully terribly super extremely incredibly absolutely dear angel star sweetheart darling pal "
    "mate friend robot moment minute second time day hand thing problem bother ok okay fine alright right enough "
    "thinking doing anything special make earliest going happen manage try trying care willing not too busy free "
    "ready able get got go ahead thanks "
    "thank well hey hello hi morning afternoon evening sorry excuse listen look here up about your changed only "
    "so that high long soon next first point chore job task let suggest propose require requesting anyhow anyway today "
    "tonight whenever convenient convenience leisure possible spare suits fast get gets have has feel feeling fancy"
)
_SMALL = frozenset(_SMALL_WORDS.split())
"""What else a frame is made of."""
_ROBOT = frozenset({"you", "someone", "somebody", "anyone", "anybody"})
_HARMLESS_NOT = frozenset({"mind", "suppose", "trouble", "problem", "busy", "bother", "much", "doing"})
"""Words with which "not" forbids nothing."""
_OF_DOING = frozenset({"mind", "of", "about", "for", "by", "try", "trying"})
"""Words with which the verb may end in -ing."""
_OCCASIONS = frozenset({"if", "when", "whenever", "while"})
_COURTESIES = frozenset({
    "as soon", "as quickly", "as fast", "once you", "would you", "could you", "can you", "will you",
    "thanks for", "at your", "thank you",
})  # fmt: skip
"""How an occasion or a courtesy begins that stands before or behind a request."""
_EASE = frozenset({
    "trouble", "problem", "bother", "ok", "okay", "fine", "alright", "possible", "convenient", "suits", "fast", "soon",
    "thanks", "convenience", "leisure",
})  # fmt: skip
_FREE = frozenset({"moment", "minute", "second", "time", "day", "hand"})
"""With which `if you have one moment` is no condition on a thing."""
_QUESTIONS = frozenset({"what", "who", "how", "which", "where", "why", "whose"})
SMALL_TALK = _SMALL | _ASKING | _DUTIES
"""Words that name nothing and ask for nothing in particular."""
LONGEST = 20
"""Words of the longest frame (chosen)."""


def without_frame(text: str) -> str:
    """A clause from the verb of its command on, if all before that is a frame; else the clause as it is."""
    words = [w.strip(",") for w in text.split()]
    for at in range(1, min(len(words), LONGEST)):
        before = words[:at]
        if words[at - 1] not in SMALL_TALK:
            return text
        if _begins_command(words[at], before) and _is_frame(before):
            return " ".join((infinitive(words[at], COMMANDING), *text.split()[at + 1 :]))
    return text


def without_frame_behind(text: str) -> str:
    """A clause without the occasion or the courtesy behind it: `... whenever you get the chance`, `... could you`."""
    words = [w.strip(",") for w in text.split()]
    if _QUESTIONS.intersection(words):
        return text
    for at in range(2, len(words) - 1):
        if _is_occasion(words[at:]):
            return " ".join(text.split()[:at]).strip(" ,")
    return text


def _is_occasion(words: list[str]) -> bool:
    """`if it is not too much trouble`, `as soon as you possibly can`: no condition, only a courtesy."""
    said = set(words)
    if words[0] not in _OCCASIONS and " ".join(words[:2]) not in _COURTESIES:
        return False
    if (
        said & {"was", "were"}
        or {"i", "would"} <= said
        or (said & {"one", "any", "some", "there"} and not said & _FREE)
    ):
        return False
    asks = said & (_ASKING | _EASE | {"you"})
    return bool(asks) and SMALL_TALK.issuperset(said) and ("not" not in said or bool(_HARMLESS_NOT & said))


def _begins_command(word: str, before: list[str]) -> bool:
    if before[-1] in DETERMINERS - {"that"}:
        return False
    if ({"if", "would"} <= set(before) or "time" in before) and infinitive(word, COMMANDING) in COMMANDING:
        return True  # "i would be glad if you fetched"
    return word in COMMANDING or (
        word.endswith("ing") and infinitive(word, COMMANDING) in COMMANDING and bool(_OF_DOING & set(before))
    )


def _is_frame(words: list[str]) -> bool:
    if len(words) > 2 and _is_occasion(words):
        return True
    said = set(words)
    if "anything" in said and "doing" not in said:  # "is there anything you can bring me"
        return False
    speaks = bool(said & {"i", "we"})
    asks = (said & _ASKING) - (frozenset() if speaks else _WISHES)
    if words[0] not in ("is", "are", "does") and words[:2] != ["do", "you"] and "my" not in said:
        asks |= said & _DUTIES
    if not asks or (said & {"was", "were"} and not said & {"wondering", "hoping", "thinking"}):
        return False
    if "not" in said and not said & _HARMLESS_NOT:
        return False
    who = [w for w in words if w in {"i", "we"} | _ROBOT]
    if not who:
        return words[-1] in ("to", "and", "please", "kindly") or words[-1] in _OF_DOING
    return who[-1] in _ROBOT
