"""A condition and what depends on it, cut apart in whatever order and words they are said. Pure."""

import re

from common.language.exchange import replaced, verb_first
from common.language.lexicon import COMMANDING, HANDLING
from common.language.normalise import infinitive
from common.language.politeness import without_politeness

REQUESTS = COMMANDING | {"make", "let", "show", "help", "look", "arrange", "keep", "open", "clean"}
"""First words of a request."""
_CONDITION = re.compile(
    r"^(?:and |but |then )?(?P<word>(?:only )?if|in case|provided(?: that)?|as long as|assuming|when|unless)\s+"
    r"(?P<rest>(?:there (?:is|are)|you (?:do not |can not |did not "
    r")?(?:find|see|spot|notice|discover|come across|have)"
    r"|(?:the|my|our|any|a|an) .+? (?:is|are|looks?))\s.+)$"
)
_INVERTED = re.compile(r"^(?:and |but )?should (?:there be|(?P<you>you)(?= (?:find|see|spot|notice|come)))")
_AT_END = re.compile(
    r"^(?P<command>.+?),? (?:but )?(?:only )?(?P<word>if|in case|unless|provided|as long as) "
    r"(?P<condition>(?:there (?:is|are)|(?:the|my) .+ (?:is|are)|(?:it|they) (?:is|are)(?: not)?(?: "
    r"still)? (?:in|on|at|"
    r"empty|full|messy|untidy|dirty|a mess|cluttered|clean|clear|tidy)|you (?:find|see|spot))(?: .+)?)$"
)
_ASKS = re.compile(r"\b(?:tell(?: me| us)?|see|know|check|look|find out|ask|say|and)$")
"""How a question goes on with "if"."""
_IF_THERE = re.compile(
    r"^(?:check|look (?:at|on|in)|go to|search) (?P<spot>(?:the|my) \w+(?: \w+)?),? and,? if "
    r"(?P<thing>(?:the|my|a|an) .+?)"
    r" (?:is|are) (?:there|on it|in it),? (?P<command>.+)$"
)
"""A look, and what is to be done if something is there."""
_SO = r"(?:so|yes|it is|they are|there (?:is|are)(?: any| one| some)?)"
"""How a condition says that the answer is yes."""
_IS_IT = re.compile(
    r"^(?:is|are) (?P<there>there )?(?P<thing>.+?)(?(there)(?P<spot> (?:on|in|at) .+?)?|(?P<at> (?:on|in|at) .+?)),? "
    rf"(?:and )?if {_SO},? (?P<command>.+)$"
)
"""A question, and what is to be done if the answer is yes."""
_IS_THERE = re.compile(
    rf"^(?:is|are) there (?P<thing>(?:still |any |an? |some ).+?),? (?P<command>(?:(?:please|can you|could you) )*"
    rf"(?:{'|'.join(sorted(HANDLING))}) (?:(?:me|us) )?(?:it|them|one|those|some)\b.*?)"
    rf"(?:,? if {_SO})?$"
)
"""A question, and what is to be done with what it is about."""
_IF_ANY = re.compile(
    r"^(?P<command>.+?),? if (?:there (?:is|are) (?:one|any|some)|you (?:can )?(?:find|see) "
    r"(?:it|one|any)|(?:it|one) is (?:there|"
    r"available)),? (?:and )?(?:otherwise|if not|or else|else),? (?P<other>.+)$"
)
"""A condition in the middle, of the thing that was just named."""
_FAILING = re.compile(
    r"^(?P<command>(?!if\b|is\b|are\b).+?),? (?:(?:or|and|but) )?(?:if (?:you (?:can|do|could|did) not "
    r"(?:find|see|get|spot|have) "
    r"(?:it|one|that|any|them)|(?:it|that|one) is not (?:there|around|available)|there is(?: not (?:one|"
    r"any)| none)|not)"
    r"(?: there| anywhere| any more)?|failing that),? (?:then )?(?:just )?(?P<other>.+)$"
)
"""What is wanted, and what instead where there is none."""
_FIRST_THING = re.compile(r"\b(?:the|a|an|my|all) \w+(?: (?!(?:in|on|to|into|onto|at|from|away|over|next|near)\b)\w+)?")
_OF_IT = re.compile(r"^(?:it|they)(?= (?:is|are)\b)")
_WISHED = re.compile(
    r"^if you (?:were to )?(?:(?:went|came|nipped|popped)(?: over| along)? and )?(?P<verb>[a-z]+) (?P<rest>.+?),? "
    r"(?:i|we|he|she|it|that) would (?:feel|be|sleep|rest|make|help|mean|do)\b.*$"
)
"""What somebody would like to be done: `if you stood by the door i would feel safer`."""
_ELSE = re.compile(
    r"(?:,| and| or| but|;|\.|(?<=\w)(?= otherwise))+\s*(?:otherwise|if (?:not|there (?:is|are) (?:none|not any|"
    r"no))|or else|else),?\s+"
)
_BEGINS = frozenset({"the", "a", "an", "my", "our", "me", "us", "it", "them", "to", "one", "all", "that", "those"})


_REASON = re.compile(
    r"^(?:since|as|because|now that|seeing (?:that|as)|given that|while) (?P<reason>(?:you|i|we|"
    r"it|the|my) .+)$"
)


_IF_SO = re.compile(
    r"^(?:please |go (?:and )?|could you |can you )*(?:check|see|look|find out) (?:if|whether) "
    r"(?P<condition>[^,]+?),?(?: and)? if "
    r"(?:so|yes|it is|there is(?: one)?|they are),? "
)


def _without_reason(text: str) -> str:
    """`since you are going to the kitchen bring me the mug` without why."""
    found = _REASON.match(without_politeness(text))
    if found is None:
        return text
    words = found["reason"].split()
    for at in range(2, len(words) - 1):
        if words[at].strip(",") in REQUESTS and words[at + 1] in _BEGINS:
            return " ".join(words[at:])
    return text


def conditional(text: str) -> str:
    """`if there is a mug on the desk bring it` and the same in the other order as `if ... . bring it`."""
    text = _INVERTED.sub(lambda found: "if you" if found["you"] else "if there is", text)
    text = re.sub(r"^only (?=\w+ .+ (?:if|when|unless) )", "", text)
    text = _IF_SO.sub(r"if \g<condition> , ", _without_reason(text))
    bare = without_politeness(text)
    if (found := _WISHED.match(bare)) and (verb := infinitive(found["verb"], REQUESTS)) in REQUESTS:
        return f"{verb} {found['rest']}"
    if found := _CONDITION.match(bare):
        word = "unless" if found["word"] == "unless" else "if"
        rest = _ELSE.sub(" . otherwise ", found["rest"])
        for comma in re.finditer(r",\s*(?:then\s+)?|\s+then\s+", rest):
            if without_politeness(rest[comma.end() :]).split(" ")[0] in REQUESTS:
                condition, command = rest[: comma.start()], rest[comma.end() :]
                return f"{word} {condition} . {_of_all(condition, command)}"
        words = rest.split()
        for at in range(3, len(words) - 1):
            if words[at] in REQUESTS and words[at + 1] in _BEGINS:
                condition, command = " ".join(words[:at]), " ".join(words[at:])
                return f"{word} {condition} . {_of_all(condition, command)}"
    elif found := _IS_IT.match(bare):
        thing = found["thing"].removesuffix(" still")
        so = f"there is {thing}{found['spot'] or ''}" if found["there"] else f"{thing} is{found['at']}"
        return f"if {so} . {_of_all(so, found['command'])}"
    elif found := _IS_THERE.match(bare):
        return f"if there is {found['thing']} . {found['command']}"
    elif found := _IF_THERE.match(bare):
        return f"if {found['thing']} is on {found['spot']} . {found['command']}"
    elif (found := _IF_ANY.match(bare)) and (thing := _FIRST_THING.search(found["command"])):
        return f"if you find {thing[0]} . {found['command']} . otherwise {found['other']}"
    elif (found := _FAILING.match(bare)) and verb_first(found["command"]):
        thing = _FIRST_THING.search(found["command"])
        asked = without_politeness(found["other"])
        other = asked if verb_first(asked) else replaced(found["command"], asked)
        if thing and other:
            return f"if you find {thing[0]} . {found['command']} . otherwise {other}"
    elif (found := _AT_END.match(bare)) and bare.split()[0] in REQUESTS and not _ASKS.search(found["command"]):
        thing = _FIRST_THING.search(found["command"])
        condition = _OF_IT.sub(thing[0] if thing else "it", found["condition"])
        return f"{'unless' if found['word'] == 'unless' else 'if'} {condition} . {found['command']}"
    return text


_ANYTHING = re.compile(r"\banything (?:is )?(?:left |still |lying )?(?:on|in|at)\b")


def _of_all(condition: str, command: str) -> str:
    """The command with "them" for the "it" that means all that is somewhere."""
    return re.sub(r"(?<=\w )it\b", "them", command, count=1) if _ANYTHING.search(condition) else command
