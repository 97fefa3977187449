"""Constructions that say the same as a wording in another way, as pairs of a pattern and what it comes to.

A pair is of a construction and not of single words: clefts, wishes of whomever, a quality that a place is to have, a
verb that is left out. `common/language/word_order.py` applies them.
"""

import re

from common.language.lexicon import FAMILY, TO_GO
from common.language.verb_classes import one_of

TO_PLACE = "(?:on top of|on|onto|in|into|inside|to|at)"
_BESIDE = "(?:next to|close to|beside|near|right by|by)"
MODAL = "(?:should|may|might|must|has to|have to|needs to|need to|ought to|can|could|is to|are to|shall|will)"
NP = r"((?:\w|')+(?: (?:\w|')+){0,11}?)"
_WHO = (
    r"(?:i|we|(?!(?:\w+ )?(?:might|may|not|never|could|should|would(?! (?:like|love)\b)"
    r"|will|do|did|does|used|no|nobody|if|when|"
    r"what|why)\b)"
    r"(?:(?:my|our|the|your) )?[a-z]+(?: [a-z]+)?)"
)
_WANT = (
    "(?:want|wants|need|needs|require|requires|wish for|wishes for|crave|craves|desire|will need|will have|will take|"
    "am going to need|are going to need|would need|would (?:really |very much |quite |just )?(?:like|love|"
    "prefer)|would rather have|am "
    "needing|am wanting|"
    "are needing|(?:is|are) asking for|(?:is|are) waiting for|is missing|am craving|am in need of|am after|am dying "
    "for|am longing for|"
    "am in the mood for|are after|is after|(?:would |quite |rather |really )*(?:fancy|fancies)|could "
    "(?:really )?(?:use|do "
    "with|murder)|would not (?:mind|say no to)|would (?:very much )?(?:appreciate|welcome|enjoy|be "
    "(?:(?:ever|so|very|really|most) )*(?:glad|grateful|thankful|happy|pleased|obliged) "
    "(?:of|for|with|about))|would kill for|would have(?= "
    "(?:the|a|an|some|my|one|two|another)\\b)|have a craving for|am gasping "
    "for|am desperate for|could go for|(?:was|am|have been) (?:hoping|wishing) for|shall have|shall take|should "
    "have(?= "
    "(?:the|an?|some|my)\\b))"
)
_CONSUME = "(?:have|get|eat|drink|play with|use|read|hold|see|look at|borrow|taste|try|take)"
CONSTRUCTIONS: tuple[tuple[re.Pattern[str], str], ...] = tuple(
    (re.compile(f"^{pattern}$"), result)
    for pattern, result in (
        # Whom or what it is for.
        (rf"{TO_GO}(?: over| back)? (?:to|into) {NP} for ((?:the|my|an?|some) .+)", r"bring me \2 from \1"),
        (rf"((?!look|search|wait|check|hunt|ask|{TO_GO})\w+ .+) "
         r"for (?:dinner|lunch|breakfast|supper|tea|good|a change|"
         r"him|her|them|"
         r"(?:the|my|our|your) (?:\w+ )?\w+|\w+ing .+)", r"\1"),
        (r"(tidy|clean|clear|straighten)(?: up)? in ((?:the|my|our) \w+(?: \w+)?)", r"tidy \2"),
        (rf"(?:can|could|would|might) {NP} (?:go|move|be put|be placed) ({TO_PLACE}|{_BESIDE}) {NP}", r"put \1 \2 \3"),
        (rf"(?:i|we) {_WANT} {NP} (?:to be |all |nice and )?(?:clean|tidy|clear|neat|spotless|tidied|cleaned|"
         rf"cleared|empty)", r"tidy \1"),
        (rf"(?:i|we) (?:search|seek|look|am searching|are searching) (?:for )?{NP}", r"find \1"),
        (rf"{NP} (?:i|we) (?:really )?(?:need|want|would like) (?:it|them|that|this)", r"bring me \1"),
        (rf"(?:go|drive|walk) (?!to\b|and\b|in\b|on\b){NP}", r"go to \1"),
        # Taking up what is then put somewhere.
        (rf"(?:get|fetch|take|grab|collect|gather|pick)(?: up| me)? {NP}(?: up)? and (?:then )?(\w+) (?:it|"
         rf"them) (.+)", r"\2 \1 \3"),
        (rf"(?:get|fetch|take|grab|collect|pick)(?: up)? {NP} (?:and )?(?:then "
         rf")?(put|place|set|drop|lay) (?:it |them )?"
         rf"({TO_PLACE}) {NP}", r"\2 \1 \3 \4"),
        # An exception that is said at the end.
        (rf"(\w+(?: up| away| me)?) {NP} ((?:here|over here|to me|away|back)|{TO_PLACE} (?:\w+ ){{1,3}}?\w+)"
         rf" (but not|but no|except for|except|apart from|other than|besides|but) {NP}", r"\1 \2 \4 \5 \3"),
        (rf"(?:get|take|pick up|pick|have|lift|put) {NP} (?:in|into) your hands?", r"pick up \1"),
        (rf"(?:clutch|clasp|seize|hold(?: on to| onto)?|keep hold of|grip) {NP} (?:until|till) .+", r"pick up \1"),
        (rf"(?:scour|comb|ransack) (?:.+ )?for {NP}", r"find \1"),
        (rf"(?:do )?(?:track|hunt) {NP} down", r"find \1"),
        # Where somebody or something is wanted.
        (rf"(?:you are|your (?:presence|attendance|help|assistance) is) (?:needed|wanted|required|desired|requested)"
         rf"(?: over)? (?:in|at|by) {NP}", r"go to \1"),
        (r"(?:i|we) (?:want|need|would like) you (?:in|at|by) ((?:the|my|our) .+)", r"go to \1"),
        (r"(?:i|we) (?:want|need|would like) you (?:next to|beside|with|by|near|close to|at) (?:me|us)(?: again)?",
         "come back"),
        (rf"{NP}(?: and that)? is where you (?:should be|are needed|are wanted|belong)", r"go to \1"),
        (rf"{NP}(?: and that)? is where {NP} (?:(?:should|must|needs to|ought to|has to|is to|can) "
         rf"(?:go|stand|be|end up|live|sit)|goes)", r"put \2 on \1"),
        (rf"(?:right )?{_BESIDE.replace('(?:', '(', 1)} {NP} is where (?:i|we) {_WANT} {NP}", r"put \3 \1 \2"),
        (rf"{NP}(?: and that)? is where (?:i|we) {_WANT} {NP}", r"put \2 on \1"),
        (rf"(?:make sure|see to it|see|ensure)(?: that)? there is {NP} ({TO_PLACE}) {NP}", r"put \1 \2 \3"),
        # For somebody else than the speaker: there is one place to bring things to.
        (rf"(?:bring|fetch|get) (?:your |my |our |old )*{FAMILY.replace(' ', '').replace('(', '(?:')} "
         r"((?:the|that|a|an|some|his|her|my) .+)", r"bring me \1"),
        # What would be welcome.
        (rf"{NP} (?:would|will) (?:really |just )?(?:help(?: me)?(?: out)?|hit the spot|go down well|make my day|be "
         r"(?:(?:so|very|just|much|really|a|an|great|real|the) )*(?:great|good|nice|lovely|wonderful|perfect|"
         r"super|ideal|"
         r"handy|useful|welcome|help|blessing|treat|godsend|champion|brilliant|fantastic|appreciated|thing|ticket))",
         r"bring me \1"),
        # Clefts.
        (rf"(?:all|what|the only thing|the thing|the one|everything)(?: that)? {_WHO}(?: really| just| "
         rf"actually)? {_WANT}"
         rf"(?: right)? is {NP}", r"bring me \1"),
        (rf"it is {NP}(?: that| which)? (?:i|we)(?: really)? (?:{_WANT}|meant|mean)", r"bring me \1"),
        (rf"{NP} is (?:what|the one|all)(?: that)? (?:i|we)(?: really)? (?:{_WANT}|meant|mean)", r"bring me \1"),
        (r"(?:i|we) (?:can|could|may|might) (?:have|get|borrow|use) ((?:the|my|an?|some|one|two|another|that) .+)",
         r"i want \1"),
        (rf"(?:(?:it|that) would|would it) (?:really )?(?:be|make) (?:\w+ ){{1,4}}?(?:to "
         rf"(?:have|get|ask for)|having|getting|if (?:i|we) (?:had|got|could "
         rf"have)) {NP}", r"i want \1"),
        (r"((?!(?:can|could|would|will|do|you|please|he|she|they|who)\b)(?:\w+ ){1,4}?\w+) "
         r"(?:bring|give|get|hand|pass) (?:me|us)",
         r"bring me \1"),
        (rf"(?:i|we) (?:can not|could not|am not able to|am unable to)(?: quite| really| even)? "
         rf"(?:reach|get (?:at|to)|lift) {NP}",
         r"bring me \1"),
        (rf"(?:i|we) (?:have )?(?:forgotten|forget|forgot|do not (?:know|remember)|can not "
         rf"remember|wonder) where (?:i|we) "
         rf"(?:have )?(?:put|left|laid|placed) {NP}", r"where is \1"),
        # Wishes, of whomever.
        (rf"(?:i|we) (?:would )?(?:rather|prefer|sooner)(?: have)? {NP} (?:to|over|than) {NP}", r"bring me \1"),
        (rf"{_WHO}(?: really| also| just| now| only| kind of| do)? {_WANT} to {_CONSUME} {NP}", r"i want \1"),
        (rf"{_WHO}(?: really| also| just| now| only| kind of| do)? {_WANT} {NP} (?:back )?(?:here|back|over "
         rf"here|over)", r"bring me \1"),
        (rf"{_WHO}(?: really| also| just| now| only| kind of| do)? {_WANT} {NP}", r"i want \1"),
        (rf"(?:need|want|would like|would love|could use|could do with|looking for|fancy|after) (?!to\b|you\b){NP}",
         r"i want \1"),
        (rf"(?:i|we) (?:am|are|was|were) looking for {NP}", r"find \1"),
        (rf"(?:get|take|move) {NP} out of (?:(?:my|our) (?:sight|way|hair|face)|the way)", r"put \1 away"),
        (r"(?:i|we) will (?:take|have) (it|that|this|those|them)(?: (?:off|from|out of) (?:you|your hands?))?",
         r"bring me \1"),
        # Coming with something is bringing it.
        (rf"(?:come|return|be)(?: back| here| over| to me| over here| back here)* with {NP}", r"bring me \1"),
        (rf"{TO_GO} (?:over |back )?(?:to|into) {NP} with {NP}", r"take \2 to \1"),
        # What is to be the case.
        (rf"(?:go and )?(?:make sure|see|see to it|ensure|make certain|take care)(?: that)? {NP} (?:is|are|gets?|"
         rf"goes|go|ends? up)"
         rf" (?:back |put |placed )?({TO_PLACE}) {NP}", r"put \1 \2 \3"),
        # Looking whether something is there.
        (rf"(?:go (?:and |over )?)?(?:look|check|see|peek)(?: on| in| into| at| over)* {NP} and (?:tell me|see|let me "
         rf"know|report|say)(?: back)? (?:if|whether) (?:(?:there is|there are|you (?:can )?(?:see|find)) {NP}(?: "
         rf"there)?|{NP} (?:is|are) (?:still )?(?:there|on it|in it))", r"check \1 for \2\3"),
        # Verbs that no wording has, by what they can ask for where a place follows.
        (rf"(?:{one_of('go')}) (?:yourself )?(?:(?:over|back|across|along|off|on|down|up) )*(?:to|into) {NP}",
         r"go to \1"),
        (rf"(?:{one_of('put')}) ((?:the|my|our|a|an|that) .+?) (?:(?:over|across|along|up) )*(to|into|onto|on) {NP}",
         r"take \1 \2 \3"),
        (rf"(?:it|i|we) would (?:\w+ ){{1,4}}?(?:it )?if {NP} (?:was|were|is|stood|sat|lay) (?:back )?"
         rf"({TO_PLACE}|{_BESIDE}) {NP}",
         r"put \1 \2 \3"),
        # Two places, one of them beside something.
        (rf"(put|place|set|move|lay|stick|pop) {NP} (?:that|which) (?:is|stands|lies) (?:on|in|at) "
         rf"{NP} (?:on|in|at|onto) {NP} "
         rf"(?:right )?{_BESIDE} {NP}", r"\1 \2 on \3 next to \5 on \4"),
        (rf"(put|place|set|move|lay|drop|leave|stick|pop) (?:down )?{NP}(?: down)? (?:on|in|at|onto) {NP} "
         rf"(?:right )?{_BESIDE} {NP}",
         r"\1 \2 next to \4 on \3"),
        (rf"(get|take|remove|move|clear) {NP} (?:off|from|out of) {NP} and (?:(?:put|place|set) (?:it|them) )?"
         rf"{TO_PLACE} {NP}", r"put \2 on \3 in \4"),
        # What there is of a kind.
        (r"(\w+)(?: me)? (?:whatever|(?:all )?what|anything that|all that|(?:all )?the stuff that) (?:is|lies|"
         r"stands) (.+)", r"\1 everything \2"),
        # A quality that a place or a thing is to have.
        (rf"(?:(?:make|get|have|keep) {NP}(?: look| be| all)?|(?:make sure|see to it|ensure|make certain)(?: that)? "
         rf"{NP} (?:is|gets|looks|be)) (?:all |very |really |a bit )?(?:nice and |neat and )?(?:clean|tidy|clear|neat|"
         r"nice|empty|free of \w+|presentable|spotless|ready)(?: again)?(?: for .+)?", r"tidy \1\2"),
    )
)  # fmt: skip
VERBLESS: tuple[tuple[re.Pattern[str], str], ...] = tuple(
    (re.compile(f"^{pattern}$"), result)
    for pattern, result in (
        (rf"(?:back |off |straight )*(?:to|into) {NP}(?: with you)?", r"go to \1"),
        (rf"{NP} (?:now|go|and go)", r"go to \1"),
        (rf"{NP}(?: to me| to us| over here| here| here now| over)", r"bring me \1"),
        (rf"{NP} (?:back )?(to|into|onto) {NP}", r"put \1 \2 \3"),
        (rf"{NP} and {NP}", r"take \1 to \2"),
        (rf"({TO_PLACE}) {NP} with {NP}", r"put \3 \1 \2")
    )
)  # fmt: skip
"""Where the verb is missing."""
_PARTICIPLE = (
    "(brought|taken|put|thrown|given|carried|moved|set|laid|placed|tidied|cleaned|cleared|fetched|delivered|dropped|passed|"
    "handed|collected|transferred|removed|returned|recycled|sorted|stacked|stowed)"
)
PASSIVE = tuple(
    re.compile(f"^{pattern}$")
    for pattern in (
        rf"(?:could|can|may|might) (?:i|we)(?: please)? (?:have|get) {NP} {_PARTICIPLE}( .+)?",
        rf"(?:(?:i|we) would (?:\w+ ){{1,4}}?|it would be (?:\w+ ){{1,2}}?)(?:it )?if {NP} "
        rf"(?:were|was|could be|can be|is|are|got|gets) (\w+)( .+)?",
        rf"(?:have|get) {NP} (?:to be |be )?{_PARTICIPLE}( .+)?",
        rf"(?:have|get) {NP} (?:to be |be )?(\w+(?:ed|en|t|d|n))( .+)?",
        rf"(?:i|we) (?:want|need|would like|would love|expect|wish)(?: to see| to have| to get)? {NP} (?:to be |"
        rf"be )?{_PARTICIPLE}( .+)?",
        rf"(?:go and )?(?:make sure|see to it|ensure|make certain|arrange|see)(?: that| for)? {NP} (?:is|are|"
        rf"gets|get|to be|"
        rf"be|will be|ends up|end up)(?: being)?"
        r" (\w+)( .+)?",
        rf"{NP} {MODAL}(?: now| also| really| please)? be (\w+)( .+)?",
        rf"(?:can|could|should|would|will|may|must){NP.replace('(', '( ', 1)}(?: please| perhaps)? be (\w+)( .+)?",
        rf"{NP} (?:needs?|wants?|requires?|could do with|is due for)(?: some| a bit of| a good| a| to be)* "
        rf"(\w+)( .+)?",
    )
)
