"""Several words for which there are fewer: `plus the can` as `and the can`, `anything at all` as `anything`. Pure."""

import re

from common.kinds import KINDS
from common.language.lexicon import A_COLOUR, A_VERB, PAIRED, TO_GO

_NOUN = r"(?=(?:the|a|an|my|our|your|some|any|one|two|three|all|both|every|that|those)\b)"
_PREPOSITION = (
    r"(?=(?:on|in|at|by|beside|near|next to|under|behind|between|inside|close to|in front of|to the "
    r"(?:left|right))\b)"
)
_LOOKS = rf"(?:{A_COLOUR}|small|big|little|large|tall|other)\b"
"""A word of colour or size: the name of a thing that begins with one may have its noun from a thing before."""
_KIN = "(?:brother|sister|mate|cousin|twin|friend|pal|buddy|partner|companion|counterpart|sibling|neighbour)"
"""What somebody calls another thing of the same kind: `its green mate`."""
_APART = r"(?:side by side|next to (?:each other|one another)|beside each other|in a row|together)"
_PLACED = r"(?:stood|stand|be|were|was|are|sat|sit|placed|put|lined up)"
_TO_DO = (
    r"(?:[,.;]|,? and| so)* (?:so )?(?:(?:please|can you|could you|would you) )*"
    r"(?:move|take|put|bring|carry|do|see to) (?:it|them|that)(?: there| over)?[.?!]*(?: please[.!]*)?$"
)
"""That something is to be done, said behind what is to be done."""
_HOME = "(?:house|home|family|household|flat)"
_CARDINALS = tuple(enumerate(("one", "two", "three", "four", "five", "six"), 1))
SHORTER = tuple(
    (re.compile(words), plain)
    for words, plain in (
        (rf"\b(?:plus|as well as|along with|and also|and additionally|not to mention)\b {_NOUN}", "and "),
        (r"\b(what|which) (?:kinds?|sorts?|types?) of\b", r"\1"),
        (r"\b(anything|something|nothing) at all\b", r"\1"),
        *((rf"(?<![\w:.] )(?<![:.])\b{n} (?=[a-z])|(?<=[a-z] ){n} (?=[a-z])", f"{word} ") for n, word in _CARDINALS),
        (r"\b(?:a few|several) (?!times\b|\w+ ago\b)(?=[a-z]+s\b)(?!seconds\b|minutes\b|hours\b|moments\b)", "some "),
        (r"\b(from (?:now|today) on), (?=\w)", r"\1 "),
        (r"^from (?:now|today) on (?:(?:i|we|you)(?: will| shall| can)? )?(?=(?:call|name)\b)", ""),
        (rf"\b(?:its|their|the|my|his|her) ({A_COLOUR}) {_KIN}\b", r"the \1 one"),
        (r"\b(?:just|right) now\b", "now"),
        (r"\bwhat (?:stands|lies|sits) (?=(?:between|next to|near|beside|to the)\b)", "what is "),
        (r"\b(how many \w+) (?:stand|lie|sit) (?=(?:on|in|at)\b)", r"\1 are "),
        (r"\b(?:just|right|directly|immediately|straight) (?=next to|beside|behind|between|in front of|under)", ""),
        (rf"\b(?:(?:over|up|down|out|back|right) (?:there|here)|(?<!not )(?<!that )there|(?<!\bright )over) "
         rf"{_PREPOSITION}", ""),
        (r"\b(this|that|these|those) (?:(?:right |over )?here|(?:right|over) there)(?= "
         r"(?:is|are|should|must|will|goes?)\b)", r"\1"),
        (r"\b(this|that) (\w+) (?:right |over )?(?:here|there)(?= is\b)", r"\1 \2"),
        (r"\b(wh(?:at|ere|o|y|ich)|how) (?:on earth|in the world|the (?:heck|hell|devil)|exactly|actually)\b", r"\1"),
        (rf"\b(?:a|the|my|our|some|that) pair of (?=(?:\w+ )?{PAIRED}\b)", "the "), (r"\ba pair of (?=\w+s\b)", "two "),
        (r"\b(put|place|set|take|bring|carry|move|leave|drop) both (?=(?:to|on|in|into|onto)\b)", r"\1 them "),
        (r"[,.;] (?:so )?both(?: of them)? (?=(?:in|into|to|on|onto) (?:the|my|our)\b)", ". put them "),
        (r"\bboth (?=(?:to|here|on|in|into|onto|over)\b)|\bfor the life of (?:me|us)\b", ""),
        (r"\bone of each(?: of)?,? (?=(?:the|a|an)\b)", ""),
        (r"\b(the \w+) ones? of the (\w+?)s\b", r"\1 \2"),
        (r"\b(?:of|in) (?:the )?colou?r (?:of )?(\w+)", r"that is \1"),
        (r"\b(?:of|in) (?!the\b|that\b|this\b|what\b|which\b|any\b|same\b|a\b)(\w+) colou?r\b", r"that is \1"),
        (rf"\b({A_VERB}) (?:please|kindly) (?=(?:the|my|our|a|an|me|us|it|to|in|on|up|that|this)\b)", r"\1 "),
        (
            r"^(any\w* (?!idea|chance|clue|sign|way|news)(?:\w.+ )?(?:(?:in|on|at) (?:the|my|our) \w+(?: "
            r"\w+)?|there|around|about|left))[.?!]?$",
            r"is there \1"
        ),
        (r"^(?:you )?(seen(?= (?:the|my|our|any|that)\b)|got(?= any\b)) ", r"have you \1 "),
        (r"\bhow come\b", "why"),
        (r"\b(the|a|my) (?!same\b|other\b|different\b)(\w+) colou?r(?:ed)? (?=\w)", r"\1 \2 "),
        (
            r"\b(bring|get|fetch|carry) (it|them|that) (?:in|through|along|over|down|round)"
            r"(?= to me\b| here\b| from\b| please\b|$|[,;.!?])",
            r"\1 \2",
        ),
        (r"\b(bring|bringing|fetch) ((?:the|my|a) (?:\w+ ){1,3}?)(?:along|through)(?=$|[,;.!?])", r"\1 \2"),
        (r"\b(?:the|my) (\w+s),? (?:both|all|each) of them,? (?=(?:into|onto|to|on|in)\b)", r"all the \1 "),
        (r",? no matter which,?(?= |$)", ""),
        (
            r"\b(?:have|take) (?:a|another) (?:\w+ )?(?:look|squiz|gander|nosey|shufti|hunt|search|peek|scout|rummage)"
            r"(?: round| around| about)? for\b",
            "look for",
        ),
        (
            r"\b(?:having|taking) (?:a|another) (?:\w+ )?(?:look|squiz|gander|hunt|search|peek|rummage)"
            r"(?: round| around| about)? for\b",
            "looking for",
        ),
        (r"\b(get|take|have|has|got|keep) (?:a )?hold of\b", r"\1"),
        (r"\b(?:find|make) (?:its|their) way (?:back |over |across )*(?=(?:to|into|onto)\b)", "go "),
        (r"\b(?:take|get|see|shift|haul|drag) yourself (?:(?:off|over|along|down|on) )*(?=(?:in|on)?to\b)", "go "),
        (r"\b(?:take|get|shift|haul|drag|bring) yourself (?:over )?(?=here|home|back)", "come "),
        (r"^(back|home|here|over here) you come\b", r"come \1"),
        (
            rf"\b({TO_GO}(?: over| back| off| across| along)*) (into|to) ((?:the|my) \w+(?: \w+)?) with (?:it|them)\b",
            r"\1 \2 \3",
        ),
        (
            r"\b(?:take|carry|bring) (?:it|them|that) (?:over )?(into|to) ((?:the|my) \w+(?: \w+)?)(?:,| and|, and) "
            r"(?:then )?(?:stay|wait|remain|stand)(?: there)? "
            r"(?:(?:and )?(?:holding|hold) it|with it)(?: in your hand)?\b",
            r"go \1 \2",
        ),
        (
            r",? (?:and |so |then |back |straight |off )*(into|in|onto|to) ((?:the|my) \w+(?: \w+)?) with (it|them)\b",
            r" and put \3 \1 \2",
        ),
        (r"\b(?:a|an|that|this|the|some) ((?:\w+ ){1,2}?)of (?:mine|ours)\b", r"my \1"),
        (r"\b(?:a|an|that|this|the|some) ((?:\w+ ){1,2}?)of yours\b", r"your \1"),
        (r"\b(?P<all>(?:everything|all the \w+)\b[^,.;]*?) bar (?=the|my|our|one)", r"\g<all> except "),
        (
            r"^(?P<but>(?:except(?: for)?|apart from|other than|besides) (?:the|my|our) \w+(?: \w+)?), "
            r"(?P<all>(?:everything|all the \w+)(?: (?:on|in|at) the \w+(?: \w+)?)?) (?P<rest>\w+ .+)$",
            r"\g<all> \g<but> \g<rest>",
        ),
        (
            r"\b(?:(?:swap|exchange|make|let|have) )?((?:the |my )?\w+ \w+) and ((?:the |my )?\w+ \w+),? "
            r"(?:let them |should |are to |can |must )?"
            r"(?:trade|swap|change|exchange|switch) (?:places|positions|spots)\b",
            r"swap \1 and \2",
        ),
        (
            r"\b(?:when|once|after|as soon as) (?:he|she|they|it|that|this) "
            r"(?:is|are|has been|have been|has|have)(?: been)? "
            r"(?:told|done|finished|settled|sorted)\b,?",
            "then",
        ),
        (r"\bgive (?:me|us|everyone|everybody) a (?:shout|yell|holler|heads-up|heads up) (?=that\b)", "say "),
        (r"\b(?:sing|call|shout|yell) out (?=that\b)", "say "),
        (r"\b(?:what|who|which) all\b", "what"),
        (
            r"\b(?:get|have|set|lay|leave) ((?:the|my|a|an|some) (?:\w+ ){0,2}?\w+) (?:ready|out|waiting)"
            r"(?: for (?:me|us|him|her|them))? "
            r"(?=(?:on|in|at) (?:the|my|our)\b)",
            r"put \1 ",
        ),
        (
            r"\b(?:get|have) ((?:the|my|a|an|some) (?:\w+ ){0,2}?\w+) ready(?: for (?:me|us))?(?=$|[,.;!?])",
            r"bring me \1",
        ),
        (r"^(?:well,? |oh,? )?it does not matter,? (?:then |just )?(?=\w)", ""),
        (r"\b(the|my) ((?:\w+ )?\w+)'s (?:place|home|spot) is (?:on |in |at )?(?=the |my )", r"\1 \2 belongs on "),
        (r"^(how many .+?) (?:did|do|could) you (?:see|find|notice|spot)\b", r"\1 are there"),
        (r"^(how many \w+) (?:did|have|has|do|does) (?:\w+ ){1,2}?(?:leave|left|keep|got)\b[^.?!]*", r"\1 are there"),
        (r"^there (?:would|will) not (?:happen to )?be (an? .+?)(?:,? by any chance)?\?*$", r"is there \1"),
        (r"^(?:who|what) is keeping ((?:the|my|our) \w+(?: \w+)?) company\b", r"what is next to \1"),
        (r"\bwhat (?:do|can) you see (?:in )?there\b", "what is there"),
        (r"^you (?:did|have) not (?:look|check)(?:ed)? (in|on|at) ([^,.?]+),? (?:did|have) you\b", r"look \1 \2"),
        (r"^you (?:need not|do not (?:need|have) to) (?:hold|keep)(?: on to)? it(?: any (?:longer|more))?[.!]?$",
         "put it down"),
        (
            rf"^(?:that|this|it) is (?:the|a) (.+?)(?: in (?:this|our|my) {_HOME})?,? (?:so )?(?:please )?"
            r"(?:learn to |do )?call it that[.!]?$",
            r"this is called \1",
        ),
        (r",? (?:remember it by|call it) that(?: from now on)?[.!]?$", ""),
        (r"[.;!] (?!(?:the|my|our)\b)(\w+(?: \w+)?), (?:please,? )?(?:both|all) of (?:them|it)\b",
         r". put them in the \1"),
        (r"^did you (?:see|notice|spot|find|come across) (?=(?:the|my|our)\b)", "have you seen "),
        (r"(?<=\w) when you (?:were|went|passed) (?=(?:in|on|at|by)\b)", " "),
        (
            r"^(?:and )?do(?:es)? ((?:the|my) (?:\w+ )?\w+) (?:still )?(?:stand|lie|sit|hang|live) "
            r"(?=(?:on|in|at|by|next)\b)",
            r"is \1 still ",
        ),
        (r"\b(call|name) (.+?) from (?:now|today) on[.!]?$", r"\1 \2"),
        (r",? (?:just )?so (?:that )?you know[.!]?$", ""), (rf"\b(call .+?) in (?:this|our|my) {_HOME}\b", r"\1"),
        (rf"^(?:in (?:this|our|my) {_HOME} )?((?:the|my|our|this|that) (?:\w+ ){{1,2}}?)(?:here )?(?:(?:answers|"
         r"listens) to|goes by|is known (?:by|as))(?: the name(?: of)?)? (?=\w)", r"\1is called "),
        (r"^((?:the|my|our|this|that) (?:\w+ )?\w+)'s name (?:is|shall be|will be|should be) (?=\w)",
         r"\1 is called "),
        (r"^((?:the|my|our|that|this) \w+ \w+)\? (?:that|this|it) is (?=(?:my|our)\b)", r"\1 is "),
        (
            r"^(?:nobody|no one) (?:uses|calls (?:it|this|that)|says)(?: the(?: name)?)? (.+?) (?:any ?more|any longer|"
            r"now)\b.*$",
            r"forget the name \1",
        ),
        (
            r"^(?:what (?:i|we) (?:told you|said) about|(?:that|the) (?:business|thing) (?:about|with)|"
            r"(?:the|your|that) rules? (?:about|for|with|on))(?: where)? (?:the )?(\w+)\b.*?\b"
            r"(?:forget|do not follow|no longer|not apply|ignore|drop|scrap|wipe|erase|not valid|cancel\w*)\b.*$",
            r"forget the rule about \1",
        ),
        (
            r"^(?:i|we) (?:do not|no longer) (?:need|want|use|like) the name (.+?)(?: any ?more)?"
            r"(?:[,.;]? (?:so )?(?:please )?forget (?:it|that name|that))?[.!]?$",
            r"forget the name \1",
        ),
        (r"^(?:please )?do not call (?:it|this|that) (.+?) any(?: longer| ?more)[.!]?$", r"forget the name \1"),
        (
            r"\b((?:tidy|clear|clean|sort)(?: up| off)? (?:the|my|our) \w+(?: \w+)?)[?!.,;]+ (?:and )?"
            r"(?:just |simply |please )*"
            r"(?:put|take|move) (?:all )?(?:(?:of )?(?:the|those) (?:things|stuff)|"
            r"everything|it all|them all|all of it) away\b",
            r"\1",
        ),
        (
            r"\b(?:take|carry|bring|move) ((?:the|my) \w+(?: \w+)?) (?:through |over |along |across )?"
            r"(?:to|into) the (\w+)(?: room)? and "
            r"(leave|put|set|place|drop) it (?:down )?on the (\w+) there\b",
            r"put \1 on the \2 \4",
        ),
        (r"(?<=\w),? (?:in the end|after all)(?=[?]|$)|\bwith you (?=to|into|on|in|over)", ""),
        (r"^(there (?:is|are) [^,.;?]+),? (?:is|are)(?: not| n't)? there[?.]+ (?=\w)", r"\1. "),
        (r"\b(where (?:was|is|were|are) (?:it|they|(?:the|my) (?:\w+ )?\w+)) hiding\b", r"\1"),
        (r"\bwhat (it|is|they|are) (it|is|they|are) (?:standing|sitting|lying|resting) on\b", r"where \1 \2"),
        (
            r"\b(?:which|what) room (?:has|have|holds|contains) ((?:the|my|a) \w+(?: \w+)??)(?: in it)?\b",
            r"where is \1",
        ),
        (
            r"\b(?:it|that) (?:was|looked|stood) (?:fine|better|good|nicer|all right|okay|ok|best)(?: just| right)? "
            r"where it (?:was|stood)(?: before)?\b|"
            r"\bi (?:liked|preferred) it (?:better |more )?where it (?:was|stood)(?: before)?\b",
            "put it back where it was",
        ),
        (r"\bboth (?=(?:go|belong|need|should|must|have to)\b)", ""),
        (r",? (?:preferably|ideally|for preference),? (?=(?:the|a|my)\b)", ", "),
        (r"\b(bring|give|fetch|hand|pass|get|take) to (me|us) (?=(?:the|my|a|an|some|that)\b)", r"\1 \2 "),
        (r" for to (?:eat|drink|use|read|see) (?:it|them)\b", ""),
        (r"\b(once|as soon as) ((?:the|my) (?:\w+ )?\w+) (?:is|are) (?=(?:in|on|into|onto)\b)", r"\1 you put \2 "),
        (r"\bany (?:notion|inkling|clue|hint)\b", "any idea"),
        (r"\b(?:(?:that|which) (?:is having|has)|with) (?:a |the )?(\w+) colou?r\b", r"that is \1"),
        (r"\boff you (?:go|pop|trot|toddle|run)(?: then)? (?=to|into)", "go "),
        (r"\b(some|any)thing to (?:munch|nibble|snack|chew)(?: on)?\b", r"\1thing to eat"),
        (r"\b(?:some|any)thing (?:that )?(?:i can |we can |to )(?:write|draw|note it down|jot it down|"
        r"scribble) with\b", "a pen"),
        (r"\b((?:some|any)thing) to drink (?:out of|with)\b", r"\1 to drink from"),
        (r"\b(some|any)thing to (?:sip|gulp|swig)(?: on)?\b", r"\1thing to drink"),
        (r"^you (could|would|can) not (?!happen)(.+?),? (?:could|would|can) you\??$", r"\1 you \2"),
        (r"^you (?:would|do|could) not (?:happen|chance) to (.+?)(?:,? (?:do|would|could) you)?\??$", r"do you \1"),
        (r",? (?:the one |one )?(?:that|which) (?:is|are) not (?=(?:the )?\w+(?: or \w+)?$)", r" but not "),
        (
            r"(?<!\bis)(?<!\bare)(?: anywhere| somewhere)? (?:in|around|inside|within) (?:the|this|our|my|your) "
            r"(?:(?:whole|entire) )?(?:house|flat|apartment|home|building)\b",
            "",
        ),
        (r"^((?:what|which|who)\b[^,]*), (?=(?:the|my|our|a)\b.* or \w)", r"\1 "),
        (
            rf"(?<=\bif )there is nothing (?:left )?(?:on|in|at) ((?:the|my|our) \w+(?: (?!then\b|{A_VERB}\b)\w+)?)",
            r"\1 is empty",
        ),
        (r"\bwhich (?:one )?of (?:the|those|these|my|our) (?:two |three |four )?([a-z]+)s (?=(?:is|stands|lies)\b)",
         r"which \1 "),
        (
            r"^(?:list|name|tell me) (?:all|every|each)(?: of)?(?: the| my| our)? ([a-z]+?)s?(?: (?:that )?you know)?"
            r"(?:,? (?:with|and) (?:its|their) (?:place|location)s?|,? and where (?:it is|they are))?[.!]?$",
            r"where are all the \1s",
        ),
        (r"\bfrom off(?: of)?\b", "from"),
        (
            r",? ?\b(?:since|as|while|seeing (?:that|as)|given that) you (?:are|will be|were) "
            r"(?:(?:going|passing) )?(?:(?:in|at|by|through|to|near) (?:the|my|our) \w+(?: \w+)??|there|up|at it)"
            r" (?:anyway|anyhow|in any case|already)\b,?",
            " ",
        ),
        (rf"\byou (?:might|may|could) (?:just )?as well (?={A_VERB}\b)", ""),
        (
            r"\bwhere (?:might|may|could|can|would|does|do) (?:one|a (?:chap|fellow|person|man|woman|guy|girl|body)|"
            r"somebody|someone|people) (?=find|get|see)",
            "where can i ",
        ),
        (
            rf"\b(?:the|that|a) (?:(?!{_LOOKS})\w+ )?(?:thing|thingy|gadget|gizmo|wotsit|whatsit)"
            rf"(?: (?:for|to|that|which|you|with|of) [^,]+)?, (?:you know,? )?(?=(?:the|a|my) (?!{_LOOKS})\w)",
            "",
        ),
        (r"\bwhereabouts (?=is|are|did|do|was|were|has|have)", "where "),
        (r",? on (?:the|your) way to (?=the|my|our)", " then go to "),
        (r"[.;,]? (not (?:the|a|my) \w+ one)[.;,] (?=(?:the|a|my) )", r", \1, "),
        (r"\b(inside|off|outside) of\b", r"\1"),
        (rf"\b({_PLACED}) {_APART},? (?=(?:on|in|at)\b)", r"\1 "),
        (r"^(?!.*\b(?:what|does|did|do)\b)(.*\b(?:on|in|by) (?:the|my|our) \w+(?: \w+)?),? say[.!]?$", r"\1"),
        (r"(?<=[.!;]) off you (?:go|pop|trot|toddle)[.!]*$", ""),
        (r"^does (anything|something) (?:\w+ )?(?:stand|lie|sit|live) (?=(?:on|in|at)\b)", r"is \1 "),
        (rf"(\b(?:the|a|my|that) |\b)({'|'.join(sorted(KINDS))})[.;!?]+ (?:the|my) (\w+) one(?=[,.;!?]|$| "
         r"(?:please|on|in|from|by|with)\b)", r"the \3 \2"),
        (
            r"^(.+? (?:should|must|has to|have to|ought to|belongs?|goes?|go|needs?)\b[^,.;]* (?:(?:on|in|at|to|"
            rf"beside) (?:the|my|our) [^,.;]+?|\w+ing))(?: tonight| now| today)?{_TO_DO}",
            r"\1",
        ),
        (
            r"^(?:if|when) (?:i|you|we|one) (?:am |are )?(?:stand(?:s|ing)?|look(?:s|ing)?|faces?|facing)"
            r"(?: (?:at|facing|in front of|towards))? ((?:the|my|our) \w+(?: \w+)?), ((?:what|which) [^?.]+)",
            r"\2 on \1",
        ),
        (r" (?:if|when) (?:i|you|we) (?:am |are )?(?:face|facing|look at|looking at) (?:the|my|our) \w+(?=[?.]|$)", ""),
        (
            r"^(?:out )?of the (?:\w+ )?(\w+?)(?:(?<=x)es|s),? (?:(?:i|we) (?:would (?:like|go for|have|take|prefer|"
            r"love)|want|need|will (?:have|take))|(?:bring|get|fetch|give) me) the one\b",
            r"bring me the \1",
        ),
        (r"\bone more(?= please$|$)", "another one"),
        (r"\bone more (?!time|go\b|thing|try|shot|attempt|please)", "another "),
        (r"\bnothing (?:but|except|other than) (?=(?:the|a|an|my|one)\b)", ""),
        (r"\b(?:far|extreme|very|outer) (left|right)\b|\b(left|right)[- ]hand\b", r"\1\2"),
    )
)  # fmt: skip
"""Several words for which there are fewer, wherever they stand."""
