"""The wordings by which people tell of their home: what its parts are called, where things belong and usually are."""

from common.language.lexicon import ASK, PERSON
from common.language.wording import Wording

_ON = "(on | in | into | onto | at | inside)"
_ALWAYS = (
    "(always | from (now | here | today | this day) on | from today | as of now | starting today | henceforth"
    " | in [the] future | generally)"
)
_BELONG = (
    "(go | goes | (have | has) (their | its) (place | home) | stay | get put | are to (go | stay) | belong "
    "| belongs | live | lives | "
    "(should | ought to | are supposed to | is supposed to) (go | be | live | belong) | are kept | are put | are stored"
    " | (should | must | are to) be (kept | stored))"
)
_MUST = "(should | must | ought to | have to | are to)"
_HOUSE = "[in (this | our | my) (house | home | household | family | flat | place)]"
_BELONGING = "(go | goes | going | belong | belongs | belonging | live | living | are kept | being kept)"
_FORGET = "(forget | ignore | scrap | drop | cancel | wipe)"
_WHAT_ABOUT = "(what i (said | told you) | (that | the) (thing | business | bit | stuff)) about"
_AGAIN = "[any (more | longer) | anymore | now]"
_NOTE = "(remember | know | learn | note | bear in mind)"
_TIDYING = "[(when | whenever) you (tidy | clear) [up] | when (tidying | clearing) [up]]"
_USUALLY = "(usually | normally | mostly | generally | typically | most of the time | most often)"
_THE = "[the | my | our | a]"

TOLD: tuple[Wording, ...] = (
    Wording(
        "name_place",
        f"[(remember | learn) [that | and]] ((this | that) <thing> | this | that | here) is [called | named] {_THE}"
        f" <words> | (call | name) ((this | that) <thing> | this | that | here) {_THE} <words>"
        f" | (remember | learn) (this | that | here) [place | spot] as {_THE} <words>"
        f" | (remember | learn | know) (this | that) <thing> as {_THE} <words>"
        f" | (this | that) <thing> (to be | shall be | will be | should be) (called | named | known as) {_THE} <words>"
        f" | (you are | you're) [now] (in | at) {_THE} <words> [now]"
        f" | (call | rename) <spot> (to | as) {_THE} <words> | <spot> is [now] (called | named) {_THE} <words>"
        f" | (call | rename) (the | my | our) <spot> {_THE} <words>"
        f" | [i | we] [hereby] (christen | dub | name | declare) (this | that) <thing> {_THE} <words>"
        f" | let (this | that) <thing> be [known as | called] {_THE} <words>",
    ),
    Wording(
        "forget_rule",
        "(forget | drop | scrap | scratch | erase | delete | undo | remove | take back | cancel | abolish) [about]"
        " (that | the | this | my | your) [last | new]"
        " rule [(about | for | on) <words>] | (scrap | scratch | drop | cancel | delete | forget) the <words> rule"
        " | the rule (about | for | on) <words> is (cancelled | off | over | gone) [now]"
        " | <words> have no (fixed | set | special) (place | home) [any more | now]"
        " | (i | we) (no longer | do not) (want | need) (that | the | your) rule [(about | for | on) <words>]",
        heard="forget that rule",
    ),
    Wording(
        "forget_rule",
        f"(you | i | we) (do not (have | need) to | need not | no longer (have | need) to) (put | keep | store | take)"
        f" <words> {_ON} <spot> [any (more | longer)] | stop (putting | keeping | storing) <words> {_ON} <spot>"
        f" | <words> (do not have to | do not need to | need not | no longer (have to | need to)) {_BELONG} [back]"
        f" ({_ON} | to) <spot> {_AGAIN} | <words> no longer {_BELONG} {_ON} <spot> {_AGAIN}"
        f" | <words> do not {_BELONG} [back] {_ON} <spot> (any (more | longer) | anymore | now)"
        f" | there is no (fixed | set | special | particular) (place | home | spot) for <words> {_AGAIN}"
        f" | stop (taking | bringing | moving) <words> to <spot> as a rule"
        f" | (no more | no | drop the | cancel the) (rule | rules) (about | for | on) <words>"
        f" | {_FORGET} {_WHAT_ABOUT} [where] <words> {_BELONGING} [{_ON} <spot>]"
        f" | {_FORGET} {_WHAT_ABOUT} <words>"
        f" | (forget | unlearn) (where | that) <words> {_BELONG} [{_ON} <spot>]",
    ),
    Wording(
        "rule_always",
        f"[no] {_ALWAYS} [please | i | we] (put | keep | place | store | leave | sort) <thing> {_ON} <spot>"
        f" | [no] (put | keep | place | store | leave | sort) <thing> {_ON} <spot> {_ALWAYS}"
        f" | [no] {_ALWAYS} <thing> {_BELONG} {_ON} <spot> | [no] <thing> {_ALWAYS} {_BELONG} {_ON} <spot>"
        f" | [no] <thing> {_BELONG} {_ON} <spot> {_ALWAYS}"
        f" | [no] <thing> {_MUST} {_ALWAYS} (go | be | live | belong | stay | be (kept | put | stored)) [back] ({_ON} "
        f"| to) <spot>"
        f" | {_TIDYING} [and] ({_NOTE} that | new rule [that | and]) <thing> {_BELONG} ({_ON} | to) <spot>"
        f" | new rule [that | and] <thing> {_ON} <spot>"
        f" | {_HOUSE} (any | every | each) <thing> [[that] you (come across | find | see)] {_BELONG} {_ON} <spot>"
        f" | the (right | proper | usual | correct) (place | home | spot) for <thing> is [{_ON}] <spot>",
    ),
    Wording(
        "rule",
        f"[no] [{_NOTE} [that]] {_HOUSE} <thing> {_BELONG} {_ON} <spot>"
        f" | [{_NOTE} [that]] {_HOUSE} <thing> {_MUST} be {_ON} <spot>"
        f" | (i | we) (keep | store) <thing> {_ON} <spot>"
        f" | {PERSON} (want | wants | would like | prefer | prefers) <thing> [to be] (kept | stored | put away) "
        f"{_ON} <spot>",
    ),
)  # fmt: skip
"""What is to be kept."""

ASKED: tuple[Wording, ...] = (
    Wording(
        "rules",
        "[tell me | list | show me | repeat] (what are | what were) (your | the | my | our) rules"
        " | (tell me | list | show me | repeat) (your | the | my | our) rules"
        " | (what | which) rules (do you (have | know | follow) | are there | (did | have) (i | we) (give "
        "| tell | given "
        "| told | taught) you) | (are there | have you [got] | do you (have | know)) (any | some) rules [(about | for "
        "| on) <words>]",
        heard="what are your rules",
    ),
    Wording(
        "belongs",
        f"{ASK} where (do | does | should | would) <thing> (go | belong | live | be | stand)"
        f" | {ASK} where (do | does) <thing> {_USUALLY} (go | belong) | {ASK} where <thing> "
        f"{_USUALLY} (go | goes | belong | belongs)"
        f" | {ASK} where (should | do) (i | you | we) put <thing> [away]",
    ),
    Wording(
        "usual",
        f"{ASK} where (is | are) <thing> {_USUALLY} [kept | found | put | left | stored | lying | to be found]"
        f" | {ASK} where (is | are) {_USUALLY} <thing>"
        f" | {ASK} where (do | does | did) <thing> {_USUALLY} (lie | stand | sit | be | stay | hang out | live)"
        f" | {ASK} where (do | did) (i | we | you) {_USUALLY} (leave | put | keep | find | see | have) <thing>"
        f" | {ASK} where (do | did) (i | we | you) (leave | put | keep | find | see | have) <thing> {_USUALLY}",
        heard="where (is | are) <thing> usually",
    ),
    Wording(
        "last_seen",
        f"{ASK} (where | when) (did | have) you last (see | seen | notice | noticed | spot | spotted) <thing>"
        f" | {ASK} (where | when) (did | have) you (see | seen | notice | noticed) <thing> last"
        f" | {ASK} (where | when) (was | were) <thing> last seen",
    ),
)  # fmt: skip
"""Questions about what was kept."""
