"""The frame around a request: `could you please ...`, `I would be glad if you ...`, `... when you get a chance`. Pure.

A frame is built from a few parts (who is addressed, how it is put, adverbs) and says nothing about what is asked for.
Frames that speak of the past, of somebody else's words or of what must not be are no requests: see mood.py.
"""

import re

from common.language.frame import without_frame, without_frame_behind
from common.language.lexicon import A_VERB, FAMILY
from common.language.speeches import LONG_SPEECH

_ADVERBS = (
    r"(?: "
    r"(?:please|just|kindly|maybe|perhaps|possibly|quickly|now|also|really|actually|then|so|simply|like|too|again|"
    r"by any chance|if possible|at all|at least|at some point|to please))*"
)
_YOU = r"(?:you|someone|somebody|anyone|anybody)(?: guys| all)?"
_CAN = "(?:can|could|would|will|may|might)"
_ANY_WORD = r"(?!not\b|never\b|no\b|hard\b|difficult\b|wrong\b|bad\b|i\b|have\b)\w+ "
"""A word of how something would be: `lovely`, `a terrible bother`."""
_FAMILY = FAMILY.replace(" ", "")
_TIME = (
    "(?:a |the |some |one |any |your )?(?:free |spare )?(?:chance|moment|minute|second|sec|time|hand|opportunity|go)"
)
_DEARS = (
    "hen|pal|hun|hon|luv|ducky|petal|poppet|cobber|sunshine|guv|guvnor|boss|chief|champ|lass|lad|"
    "babe|bruv|brother|darlin|darling|sir|madam|ma'am|jeeves|butler|mr robot|my lovely|my good man|old "
    "thing|old bean"
)
"""How the robot is called by those who like it."""
_DEAR_THINGS = "pet|duck|sugar|baby|doll"
"""The same by names that things have as well: `the rubber duck`."""
_NO_NAME = "".join(
    f"(?<={word} )|" for word in ("me", "us", "it", "you", "now", "here", "that", "there", "please", "tidying")
)
"""Behind which they are no part of a thing's name."""
_NO_TOY = "".join(
    f"(?<!{word} )" for word in ("toy", "tin", "wooden", "plastic", "gingerbread", "action", "lego", "snow")
)
"""Not behind what makes a figure of a robot or a man."""
_OCCASION = (
    rf"(?:when|whenever|once|if|as soon as) you (?:(?:have|get|find|have got|got) {_TIME}(?: to spare| free| for it)?"
    r"|can|could|would|like|please|want|may|are not (?:doing anything|too busy|busy)(?: else)?|are (?:free|ready|done|"
    r"finished|able|not busy|up for it|around|there))"
    r"|if (?:it is |that is )?(?:not |no )?(?:too (?:hard|difficult|"
    r"much(?: (?:trouble|bother|hassle|of a \w+|to ask))?)|(?:an? |any )?(?:bother|trouble|problem|hassle|imposition)|"
    r"asking too much|possible|"
    r"convenient)"
    r"|(?:when|whenever) it (?:suits|pleases) you|if need be|if i may|if necessary|whenever|"
    r"at your (?:convenience|leisure)"
)
"""Occasions and conditions that are none."""

_ADDRESS = (
    rf"(?:{_DEARS}|{_DEAR_THINGS})(?=,)|(?:{_DEARS}|{_DEAR_THINGS})(?= "
    r"(?:please|can|could|will|would|go|come|back|bring|fetch|get|give|put|take|pick|move|clear|find|tidy)\b)|"
    "mr robot|mister robot|at some point|(?:no|now) then|righto|right then|right you are|as discussed|as agreed|"
    "no (?:pressure|rush(?: at all)?|"
    "hurry)(?:,? but)?|"
    "if (?:i|you) (?:may|might)(?=,)|ta for (?:earlier|that)|much obliged|cheers|"
    r"whatever (?:you do|happens)|no(?=,? (?:something|bring|put|take|get|fetch|give|go|throw|come|tidy|find|move|"
    r"leave|set)\b)|"
    r"(?:second|third|fourth|secondly|thirdly|lastly|firstly)(?=,? (?:bring|put|take|get|fetch|give|go|throw|"
    r"come|tidy|find|grab|pick)\b)|"
    "henceforth(?= call\\b)|basically|essentially|literally|obviously|hopefully|ideally|meanwhile|if so|if yes|"
    "in that case|"
    r"i hate to (?:ask|bother you|trouble you)|i know you are busy|no offence|like(?=,? (?:can|could|would|i|you)\b)|"
    r"(?:scratch|disregard|ignore) that(?=,? \w)|(?:(?:yes|yeah|yep|sure|right|ok|okay|now|well)(?: "
    r"then)?|wait)(?=,(?! (?:then|and)\b))|"
    r"(?:i|we)(?: have)? changed (?:my|our) minds?(?=,? \w)|never mind (?:what i said|that)(?=,? \w)|"
    "(?:hey|hi|hello|oi|yo),? (?:there|you(?! \\w+ing\\b))(?=,)|(?:hey|hi|hello) there|as i was saying|here is the "
    "(?:thing|deal)|let us say|"
    "hey|hello|hi|hiya|yo|oi|howdy|mister|madam|ok|okay|alright|all right|right(?=,)|jarvis|robot|"
    "tidybot|buddy|mate|dude|pal|bro|bruh|fam|lowkey|highkey|first things first|ugh|"
    "the (?:thing|point|problem|trouble|fact|truth) is(?: that)?(?=,? (?:i|we|you|he|she|they|my|our|there|if)\\b)|"
    "man|sir|dear|(?:my|little|good|old|young) (?:man|lad|lady|fellow|chap|friend|helper|love|one|robot|bot)"
    "(?! (?:here |there )?(?:is|was|wants?|would|needs?|has|likes?|said|asked|brought|and)\\b)|sweetie|honey|"
    "no,? (?:wait|no)(?=,? (?:bring|put|take|get|fetch|give|go|throw|come|tidy|find|move)\\b)|i said(?=,? "
    "(?:bring|put|take|get|fetch|give|go|throw|come|tidy|find|move|leave|set|clear|clean|carry)\\b)|"
    "(?:that is )?enough(?= (?:now )?(?:come|stop|go)\\b)|sweetheart|(?:go|move|drive) (?:faster|quicker)(?: and)?|"
    "speed up(?: and)?|wake up(?: and)?|step on it(?: and)?|"
    "never mind(?=,? (?:bring|get|fetch|put|take|go|give)\\b)|mind you|before "
    "(?:anything|everything) else|most importantly|first thing|no time to "
    "(?:lose|waste)|do not just stand there|make yourself useful(?: "
    "and)?|(?:lend|give) me a hand"
    "(?: and)?|"
    "bot|machine|darling|good (?:morning|evening|afternoon|day)|hello there|please|now|so|well|and|"
    "then|also|finally|"
    "just|kindly|quickly|maybe|perhaps|actually|anyway|oh|whoa|woah|hmm|ah|yeah|thanks|thank you|great|good|"
    "perfect|fine|"
    "cool|lovely|excellent|listen(?: up)?|(?:please )?take note|"
    "look(?:(?=,)| here)|excuse me|sorry to (?:bother|disturb|"
    "trouble|interrupt) you|"
    "(?:stop|quit) (?:wasting (?:my |our )?time|messing about|fooling around|dawdling)(?: "
    "and)?|sorry (?:to|for|that|if) [^,]{3,40}?(?:,| but)(?= "
    "(?:can|could|would|will|please|i)\\b)|sorry|by the way|next(?! to )|let me "
    "(?:think|see)|(?:quick|one|another|just a) question|guess what|you know what|you "
    "know(?! the| what| where| how| my)|see(?=,)|but(?! not)|"
    "i say|as i said|for me|one more thing|could it be that|"
    "(?:be )?quick|hurry(?: up)?|attention|fast|come on|pretty please|honestly|also|plus|oh and|one "
    "(?:last|more|other|final) (?:thing|request)|"
    "(?:first|second) of all|"
    r"(?:hold|hang) on(?! (?:to|for|(?:\w+ "
    r"){1,3}(?:seconds?|minutes?|moments?|secs?))\b)|first(?=\s+\w+\s+\w)|wait(?=\s+(?:stop|cancel|no)\b)|"
    r"(?:after that|afterwards|and then|forget (?:about )?that)(?=\s+(?!rule\b|.+ (?:called|named) )\w)"
)
"""Words to somebody, that carry no meaning."""
_WAY = (
    r"(?:go|come|run|hurry|nip|pop)(?: ahead| over| on| along| off| back| here| over here)?(?: and)?"
    r"(?=\s+(?:find|get|fetch|bring|grab|pick|take|put|tidy|clean|clear|throw|collect|retrieve|look "
    r"for|search for)\b)"
)
_FRAMES = (
    # What makes a question or a wish of an order, where frame.py does not see that a command follows.
    rf"{_CAN} {_YOU}(?! see (?:the|my|a|any)\b| rather\b){_ADVERBS}(?: to(?= \w))?"
    rf"(?: (?:be able to|try to|like to|want to|mind|do me (?:a|the) favou?r(?: and| of)?"
    rf"|be (?:\w+ ){{1,6}}?(?:to|and|as to))\b)?",
    rf"(?:let us see|show me(?: that)?|i (?:want|would like) to see) you(?: can)?(?= (?:{A_VERB}|lift)\b)",
    rf"(?:can |could |please )?help (?:me|us)(?: to)?(?= {A_VERB}\b)|do(?= (?:pick|track|look) )",
    r"can(?= (?:bring|fetch|give|put|go|come|find|tidy|clean|help)\b)",
    r"(?:might|may|could) i (?:\w+ )?(?:impose (?:up)?on|trouble|ask|bother|prevail (?:up)?on) you to(?= \w)",
    rf"(?:execute|perform|initiate|commence|proceed to|carry out)(?: an?| the)?(?= {A_VERB}\b)",
    r"(?:i|we) (?:was|am|were|are) wondering (?:if|whether)(?= .+ (?:could|might|can|may) (?:come|go|get|be|move)\b)|"
    r"want to(?=\s+\w)|(?<=please )(?:you|to)(?= \w)",
    r"you(?= (?:bring|give|take(?= .+ (?:to|from|off|out|into|and|up)\b)|go|get|fetch|throw|find|come|carry|move|"
    r"clean|tidy|grab|pick)\b"
    r"(?!.*\b(?:always|never|often|yesterday|every|usually|it when)\b))",
    rf"you{_ADVERBS} (?:should|must|have to|need to|could|can|may|might want to|are to|ought to|"
    r"are (?:free|welcome) to|are going to|shall|will)",
    rf"(?:(?:would|will|could|might) it(?: be)?|is it(?= [^,]* if you)) (?:{_ANY_WORD}){{1,5}}?(?:if you(?: {_CAN})?|"
    rf"if i ask(?:ed)? you to|(?:for you )?to|that you)(?= (?:{_ANY_WORD})?(?:{A_VERB}|have|get)\b)",
    r"(?:it|that) would make (?:me|us|my day|him|her)(?: \w+){0,2} if you(?! (?:not|did not|never)\b)",
    rf"(?:it|that) (?:would|will) be (?:{_ANY_WORD}){{1,6}}?(?:if|when) {_YOU}(?: {_CAN})?{_ADVERBS}(?! "
    rf"(?:not|did not|never)\b)",
    r"(?:is there )?(?:any|a|some) (?:chance|way|possibility)(?: that)?(?=\s+(?:i|we)\b)|"
    r"do you (?:think|suppose|reckon)(?: that)?(?=\s+(?:i|we) (?:could|can|may|might)\b)|"
    r"help (?:me|us|(?:a|an|your|my) (?:\w+ )?\w+) out(?: and| by| here and)?|"
    r"while you are (?:over )?(?:in|at|on) (?:the|my|our) \w+(?: (?:room|table|shelf|box))?",
    r"(?:why (?:do not|not)|how about) (?:you|we)(?=\s+\w)|(?:what|how) about(?=\s+\w+ing\b)",
    r"(?:i|we|people|everyone|everybody|they)(?: always| all| usually)?(?=\s+call\b)|let us|we "
    r"(?:should|could|must|need to|have to|ought to|want to|had better|better)",
    r"(?:keep|hold|hang on to|hold on to) it(?: in your hand)?(?: and|,)(?= (?:go|drive|come|move|wait)\b)",
    r"(?:do )?be (?:careful|quick|gentle|good|nice|kind|sweet)(?: with it)? and(?= \w)",
    r"(?:do )?be (?:a|an|so|very) (?:\w+ ){0,2}?\w+ (?:and|as to|to)",
    r"(?:(?:do not|never) (?:forget|fail)|remember|(?:make|be) sure|feel free|try|go ahead|start|"
    r"get (?:busy|going|to work|moving|up))(?: to| and| by|(?: that)? you)(?=\s+\w)",
    r"(?:it is |about )?(?:high )?time (?:you (?:\w+ed)?|to|for you to)|"
    r"(?:(?:i|we)(?: have)? (?:decided|agreed)|let us agree)(?: that)?(?=\s+\w)|"
    r"what (?:i|we) (?:want|need) you to do is|on second thoughts?",
    r"i (?:think|guess|suppose|believe|reckon|say|suggest)(?: that)?(?= (?:the|my|this|that|we|you|it|i)\b)",
    r"while you are (?:at it|there|up|about it)|(?:on|along) (?:the|your) way(?: back)?",
    r"drop everything(?: else)?(?: and)?(?=\s+\w)|without \w+ing .+?(?=,)",
    rf"without \w+ing .+?(?= {A_VERB} (?:me|the|my|a|an)\b)",
    rf"to(?= {A_VERB} (?:me|the|my|a|an|it)\b)|(?:go and )?see (?:if|whether) you can",
    rf"(?:i|we|he|she|they|(?:(?:my|our|the) )?{_FAMILY}) (?:wants?|needs?|would (?:like|love)|am|is|are) "
    r"(?:to know|wondering|asking|curious)(?: to know)?(?= (?:where|what|which|how|(?:if|whether)(?! you\b))\b)",
    _OCCASION,
)
"""Frames of a request; what is asked for follows."""
_ENDINGS = (
    rf"(?<!the )(?<!my )(?<!our )(?<!his )(?<!her )(?<!an )(?<! a )(?<!to )(?<!for )(?<!with )(?:{_DEARS})|"
    rf"(?:{_NO_NAME}(?<=, ))(?:{_DEAR_THINGS})|"
    r"(?:and )?(?:that|it|this|which) (?:would|will) (?:really )?(?:be (?:\w+ ){0,2}?(?:great|super|nice|lovely|good|"
    r"brilliant|champion|wonderful|perfect|fantastic|handy|grand|smashing|appreciated)|help(?: (?:me|us|a lot|out))*|"
    r"make my day)|(?:could|can|would|will) you (?:see to|sort|arrange) (?:it|that|this)|"
    r"and (?:just |then |you )*(?:keep|hold|hang)(?: (?:a )?(?:hold|haud))?(?: (?:on ?to|of))? it"
    r"(?: (?:tight|nice and tight|there|safe|for me|for now|a (?:minute|moment|bit|while)|like that)(?: only)?)?|"
    "like a good (?:lad|lass|boy|girl|fellow|chap|robot)|there is a (?:good )?(?:lad|lass|dear|love|boy|girl|"
    "pet|sport|chap)|"
    r"before (?:it|he|she|they|(?:your|my|the) \w+|someone|somebody) (?!you\b).+|"
    r"else (?:i|he|she|they|we) (?:will|am|is|are|might) .+|"
    "on the double|pronto|sharpish|lickety split|in (?:a|the) jiffy|or what|or not|if you (?:would|will)(?: be "
    "so kind)?|"
    "if it is no (?:bother|trouble|hassle)|urgently|why do not you|go ahead|"
    "(?:it )?(?:does|do) not matter(?: which(?: one)?)?|(?:i|we) do not (?:mind|care) which(?: one)?|"
    "(?:pretty )?please(?: with .+)?|right now|(?:right )?about now|right away|now|quickly|at once|"
    "immediately|straight away|this instant|for me|(?:just )?for now|"
    "at the moment|at all|at present|currently|"
    "for us|thanks|thank you"
    rf"(?: very much| so much| a lot)?|(?<!real )(?<! a ){_NO_TOY}robot|tidybot|jarvis|then|anyway|and|"
    "will you please|okay|"
    rf"ok|alright|(?<=, )right|{_NO_TOY}man|mate|"
    "buddy|dude|my friend|(?<!the )(?<!an )(?<!that )(?<!our )(?:old|young|good) "
    "(?:man|lad|lady|fellow|chap|friend)|dear|love|darling|sir|real quick|really quick|quick|fast|if you please|or "
    "something|or so|"
    "and stuff|(?:any (?:one|\\w+) will do|"
    "whichever(?: is (?:closest|nearest|easiest))?)|(?:while|when) you are (?:at it|there|up|about it)|on "
    "(?:the|your) way(?: back)?|by the "
    "way|(?<!rooms )(?<!places )(?<!what )(?<!do )you know(?: "
    "that)?|i "
    "guess|i think",
    "though|in (?:that|this) order|(?:and |but )?hurry(?: up)?|as (?:fast|quickly) as you can|asap|and be quick(?: "
    "about it)?|and that "
    "is all|that is all|"
    "come on|go on|chop chop|before i forget|some ?time(?: today)?|today|tonight|this (?:morning|evening|afternoon)|"
    "(?:and )?(?:be|take) care(?:ful)?(?: with (?:it|them|that))?|carefully|gently|when you come back|"
    "(?:and )?thanks in advance|if you get (?:there|the chance)",
    r"that is (?:the one|what) (?:i|we) (?:want|need|would like|meant|mean|am after)|handy|to hand|"
    r"(?:and |but )*do not (?:let (?:it )?go(?: of it)?|bring it)|(?:and |but |just )*hold (?:on to |onto )?it|"
    r"or (?:so help me|else)|by the time .+|(?:good)?bye(?: bye)?|"
    r"and leave (?:it|them)(?: there| alone)?|(?<!are )(?<!is )you (?:\w+ )?(?:thing|machine|dummy|darling|fool)|"
    "(?:please |and )*(?:remember|note|memori[sz]e) (?:that|it|this|everything)|please (?:remember|note)|"
    "(?:and |please )*do not (?:you )?forget (?:that|it)|"
    "one (?:after the other|after another|by one|at a time)|in turn|"
    "(?<!the )(?<!one )first|before (?:dinner|lunch|breakfast|supper|bedtime|bed|tea|school|work|the guests "
    "(?:come|arrive))|already|altogether|in total|in all|overall|(?:(?:would|do) you )?mind (?:having|taking) a "
    "look(?: for it)?|after all|with you|from (?:there|here|where you (?:are|stand))|a (?:little )?bit|a "
    "little|somewhat|for a (?:bit|while)",
    "(?<!try )(?<!it )(?<!that )(?<!same )(?<!thing )(?<!once )(?<!go )(?<!look )again",
    "as soon as possible|would be (?:great|nice|lovely|good)(?= please)",
    r"if (?:you (?:can |could |do |happen to )?(?:find|see|spot|have) (?:it|one|any|them|some)|"
    r"there (?:is|are) (?:still )?(?:one|any|some|(?:room|space)(?: for (?:it|them))?)(?: "
    r"left)?|(?:it|they) (?:is|are) (?:still )?(?:there|around|available))",
    rf"{_OCCASION}|(?:for )?(?:a|one) (?:second|sec|moment)",
    r"(?:because|since|so that|so i can|so we can|in case|otherwise i|as i|as we|for i|in order to)\s.+",
)
"""Politeness and reasons after a command."""
_LEAD = re.compile(rf"^(?:(?:{'|'.join((_ADDRESS, _WAY, *_FRAMES))})(?:\s+|\s*,\s*))+")
_TAIL = re.compile(rf"(?:,?\s+(?:{'|'.join(_ENDINGS)}))+$")
_FOR_ME = re.compile(
    r"(?:^|(?<= and ))(?:grab|take|pick up|reach|snatch|grasp|get) (?!me\b)((?:(?! and (?:it|"
    rf"{A_VERB})\b).)+?) for (?:me|us)(?= "
    r"please$|$| and | then )"
)
"""Taking something for somebody is bringing it."""


def without_politeness(text: str) -> str:
    """A clause without "could you please ..." and "... right now"; "" when nothing else is in it."""
    bare = without_lead(text.strip(" ,;.!?"))
    if LONG_SPEECH.match(bare):
        return bare.removesuffix(" please")
    bare = _FOR_ME.sub(r"bring me \1", bare)
    while (shorter := without_frame_behind(_TAIL.sub("", bare))) != bare:
        bare = shorter
    return bare


def without_lead(text: str) -> str:
    """A clause without what is polite before it."""
    bare = _LEAD.sub("", text.strip(" ,") + " ").strip()
    while (shorter := _LEAD.sub("", without_frame(bare) + " ").strip()) != bare:
        bare = shorter
    return bare
