"""Questions about the known world: their forms, and what answers each. Pure."""

import re
from collections.abc import Callable

from common.language.normalise import Words
from services.planner.commands import queries
from services.planner.commands.telling import not_after_moving
from services.planner.plan_builder import PlanBuilder, Refusal

_LEAD = re.compile(
    r"^(?:(?:so|and|now|ok|okay|well|right|hey|seen from the front|as far as you know|last time you looked) )*"
    r"(?:(?:can|could|would) you )?(?:(?:tell me|do you (?:happen to )?know|remind me|i wonder|let me know) )?"
)
_TAIL = re.compile(
    r"(?: (?:and )?(?:right now|at the moment|now|as far as you know|to your knowledge|all told|in total|in all|again|"
    r"altogether|just|roughly|about|around|around here|about here|(?:seen )?from the front|as you face it|please|left|"
    r"when i face \w+ \w+|(?:are |is )?in (?:the|this|our) (?:whole )?(?:flat|house|home|apartment|place)|"
    r"(?:that )?(?:do )?you (?:can see|know|remember|see)(?: of| about)?|can you see|have you (?:seen|got)|"
    r"(?:have|do) (?:we|i)(?: have| got| own)?|(?:are|is) there|there (?:are|is)))+$"
)
"""Words before and behind a question that narrow nothing down."""
_KINDS = r"(?P<kind>rooms?|surfaces?|tables?|shelf|shelves|bins?|places?)"
_THING = r"(?:(?:the|my|our|that|this|a) .+?|it|that|this)"
_FORMS: tuple[tuple[str, Callable[[PlanBuilder, re.Match[str]], str]], ...] = (
    (
        rf"(?:which|what)(?: (?:one )?of the)? {_KINDS} (?:(?:has|have|holds?|contains?)(?: got)?"
        r"(?: (?P<few>no|nothing|(?:the )?(?:least|fewest))| (?P<many>(?:the )?most))?"
        r"(?: (?P<what>(?!in\b|on\b|at\b).+?))?(?: (?:in|on|at) (?:it|them))?"
        r"|(?:is|are) (?P<empty>empty|free|clear|bare))(?: and (?P<options>.+ or .+))?",
        queries.where,
    ),
    (
        r"(?:(?:are there|do (?:we|you|i) (?:have|know)|have (?:we|you|i)(?: got)?) )?more (?P<one>\w+(?: \w+)?) "
        r"(?:or|than) (?:more )?(?P<other>\w+(?: \w+)?)",
        queries.compared,
    ),
    (r"do (?:the )?(?P<one>\w+(?: \w+)?) outnumber (?:the )?(?P<other>\w+(?: \w+)?)", queries.compared),
    (r"on (?:which|what) side of (?P<anchor>.+?) (?:is|stands|does) (?P<item>.+?)(?: stand| sit| lie)?", queries.side),
    (r"is (?P<item>.+?) (?:to the )?(?:left or right|right or left) of (?P<anchor>.+)", queries.side),
    (
        r"(?:what|which things?)(?: else)? (?:shares? (?:a|the|its) \w+ with|(?:is|are) keeping|keeps|"
        r"(?:is|stands|lies|sits)(?: \w+ing)? (?:(?:on|in) the \w+ )?"
        rf"(?:together with|alongside|with|on the same \w+ as)) (?P<item>{_THING})(?: company)?",
        queries.company,
    ),
    (
        r"what(?: else)? is (?P<where>(?:on|in|at) .+?) (?:besides|apart from|other than|except(?: for)?) (?P<but>.+)",
        queries.beside_what,
    ),
    (
        r"(?:what )?(?:besides|apart from|other than|except(?: for)?) (?P<but>.+?) (?:and )?(?:what )?(?:else )?is "
        r"(?P<where>(?:on|in|at) .+)",
        queries.beside_what,
    ),
    (r"that makes how many (?P<what>.+?)(?: (?:up |down |over )?(?P<there>there))?", queries.counted_there),
    (
        r"how many (?P<what>.+?) (?:does|will|would) (?:that|it|this) (?:make|leave)(?: us| me)?"
        r"(?: (?:up |down |over )?(?P<there>there))?",
        queries.counted_there,
    ),
    (r"how many (?:of )?(?P<what>.+?)", queries.counted),
    (
        r"(?:was|is|were|are) (?:it|there|that) \w+ (?P<what>(?:items|things|objects) (?:in|on|at) .+?) or \w+",
        queries.counted,
    ),
    (r"(?:name|list)(?: me)? (?P<what>(?:all|every|the|everything|anything)\b.*)", queries.listed),
    (r"(?:(?:is|are|was|were) (?:there )?)?(?P<what>anything \w+(?: (?:in|on|at) .+)?)", queries.listed),
    (rf"is (?P<item>{_THING}) (?:standing |lying )?between (?P<one>.+) and (?P<other>.+)", queries.between),
    (
        rf"(?:is|does) (?P<item>{_THING}) (?:(?:stand|sit|lie|live)(?:ing)? )?(?:next to|near|beside|close to|with) "
        rf"(?P<other>{_THING})",
        queries.near,
    ),
    (rf"how (?:tall|big|high|wide|large|small) (?:is|are) (?P<item>{_THING})", queries.measured),
    (rf"(?P<item>{_THING}) (?:and )?how (?:tall|big|high|wide|large) is (?:it|that)", queries.measured),
    (rf"what (?:do|did|would) (?:you|i|we) call (?P<item>{_THING})(?: these days)?", queries.called),
    (rf"(?:what is )?(?P<item>{_THING})(?: is)? called(?: what)?", queries.called),
)
"""Forms of questions in order of trial, and what answers each."""
_PATTERNS = tuple((re.compile(form), tell) for form, tell in _FORMS)


def answer(words: Words, builder: PlanBuilder) -> str | None:
    """The answer to a question about what is known, None for words that are none of these."""
    text = _TAIL.sub("", _LEAD.sub("", " ".join(words).replace("'s got", " has")))
    for pattern, tell in _PATTERNS:
        if (found := pattern.fullmatch(text)) is not None:
            trial = builder.fork()
            try:
                not_after_moving(trial)
                return tell(trial, found)
            except Refusal:
                continue
    return None
