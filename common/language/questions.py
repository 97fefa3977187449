"""The wordings of questions: what is where, what the robot sees, and what it does, did and can do."""

from common.language.lexicon import ASK, BE, LYING
from common.language.wording import Wording

ABOUT_THE_WORLD: tuple[Wording, ...] = (
    Wording(
        "written",
        f"{ASK} what (does | do) (it say on <thing> | (<thing> | it) say [on (it | them)])"
        f" | {ASK} what [words] {BE} (written | printed | said) on <thing> | {ASK} what it says on <thing>"
        f" | {ASK} what does the (label | writing | print | text) [(on | of) <thing>] say"
        f" | read [out] [(to me | me | us | out)] (what <thing> says | what it says on <thing> | [what is] (the | its)"
        f" (label | text | writing | print | words) [(on | of) <thing>] [out] | <thing>)",
    ),
    Wording(
        "seen",
        "[tell me] what (do you | can you | are you able to) see [now | right now | here | from (here | there | "
        "where you are)]"
        " | tell me what you [can] (see | find) | what have you seen [so far | today | until now | up to now "
        "| around here]", heard="what (do | can) you see",
    ),
    Wording(
        "contents",
        f"{ASK} (what [else] | (which | what) (things | objects | items | stuff)) ({BE} [there] | lies | lie | "
        f"do you see | do (we | i | you) have | have (we | i | you) got)"
        f" [{LYING}] (on | in | at | inside) <spot>"
        f" | (tell me | list | name) (what | everything | all | [all [of]] [the] (things | objects | items)) "
        f"[that] [{BE}] [{LYING}] (on | in | at | inside) <spot>"
        f" | [go and] (check | see | look) [that | if | whether] there is (nothing | anything) [left] [{LYING}]"
        " (on | in | at) <spot>"
        f" | {ASK} what <spot> (has | holds | contains) [on it | in it] | {ASK} what {BE} [{LYING}] there",
        heard="what is (on | in) [the] <place>",
    ),
    Wording(
        "recall",
        f"{ASK} (is | are) there (anything | something) [{LYING}] (on | in | at) <spot>"
        f" | {ASK} what {BE} (that | this | those | these | there) [thing | things | stuff] [{LYING}] (on | "
        f"in | at) <spot>"
        f" | {ASK} what (have | did) you [last] (see | seen | find | found | notice | noticed) [last] "
        f"(on | in | at) <spot>"
        f" | {ASK} what (did | have | has) (i | we | you | they | somebody | someone) (leave | left | "
        f"put | forget | forgotten) "
        "(on | in | at) <spot>",
        heard="what is that (on | in) [the] <place>",
    ),
    Wording("where", f"{ASK} (where | whereabouts) [exactly] (is | are) <thing>", heard="where (is | are) <thing>"),
    Wording(
        "where",
        f"{ASK} (where | whereabouts) [exactly] (is | are) [it] <thing> (at | now | located | kept | "
        f"lying | standing)"
        f" | {ASK} (where | whereabouts) (would | could | might | may) <thing> be | {ASK} [in] (which "
        f"| what) (room | place)"
        f" (do | can | would | will) (i | we | you) find <thing> | {ASK} where (it is | is it | they are "
        f"| stands | lies | sits) <thing> | {ASK} where did <thing> (go "
        f"| end up | get to) [to]",
    ),
    Wording(
        "recall", f"{ASK} [if | whether] is <spot> [still] (empty | free | clear | bare) [now | still | again]"
        f" | (is | are) (anything | something) (in | on | at) <spot> [still | left]",
    ),
    Wording("recall", f"(is | are) (anything | something) [still | left] [{LYING}] (in | on | at) <spot>"),
    Wording(
        "extreme",
        f"{ASK} (what | which) (is | are) <words> | {ASK} (which | what) [one] [of] <thing> (is | are) [the] <words>",
    ),
    Wording(
        "where",
        f"{ASK} (where | when) (did | do | would | can | could | have) (you | i | we) [last]"
        " (see | seen | put | leave | left | have | find | found | notice) <thing> [last]",
        heard="where did you [last] see <thing>",
    ),
    Wording(
        "where",
        "have you (seen | found | got | noticed | come across) <thing> [anywhere | somewhere]"
        " | (can | could) (i | we) (find | see) <thing> | have you <thing> seen | did (i | we | somebody | someone"
        " | anybody | anyone) (leave | put | forget | lose) <thing> | (do | can) you (see | know) <thing> [anywhere"
        f" | somewhere] | {ASK} [in | on] (which | what) (room | place | surface | shelf | table) ({BE} <thing> |"
        f" <thing> {BE}) [in | on]"
        f" | {ASK} where <thing> (is | are | was | went | has gone | have gone | might be | could be)",
    ),
    Wording(
        "exists",
        f"{ASK} (is | are) there [still] <thing> [lying | standing] [left | anywhere | around | here | somewhere]"
        " | (check | find out | see) (if | whether) <thing> (is | are) [still] (anywhere | around | here | somewhere)"
        " | (do we | have we | do i | do you [happen to] | happen to | would you happen to) [still] (have | got)"
        " <thing> [left | anywhere | somewhere]",
    ),
    Wording(
        "is_at",
        "([tell me | let me know | do you know] whether | (tell me | let me know | do you know) if | (confirm | verify"
        " | double check) [that | if | whether]) <thing> (is | are) [still] (in | on | at) <spot>"
        f" | {ASK} [if | whether] (is | are) <thing> [still] [{LYING}] (in | on | at) <spot> [still]",
    ),
    Wording(
        "number",
        f"{ASK} how many [of] <thing> [{BE} | do you (see | know) | can you see | have you seen | did you see"
        f" | do we have | have we got | there are] [there | {LYING} | left] (on | in | at) <spot>"
        f" | {ASK} how many [of] <thing> [{BE} there | there are | do (we | i | you) (have | own) | have (we | i) got"
        f" | do you (see | know | remember) [of] | can you see | have you seen | {BE} (left | here | around)] [left]",
    ),
    Wording(
        "colour",
        f"{ASK} (what | which) (colour | color) {BE} <thing> | {ASK} (what | which) (colour | color) "
        f"<thing> {BE} | {ASK} what {BE} the (colour | color) of <thing>"
        " | tell me the (colour | color) of <thing>",
    ),
    Wording("compare", f"{ASK} (is | are) <thing> <words> than <spot>"),
    Wording("beside", f"{ASK} what {BE} [{LYING}] <words>"),
)  # fmt: skip
"""Where things are, what and how many there are."""

_DID = "put | bring | brought | move | take | throw | thrown | fetch | fetched | find | found | tidy | tidied"
ABOUT_ITSELF: tuple[Wording, ...] = (
    Wording("holding", "what are you holding | do you have it", heard="what are you holding"),
    Wording("whereabouts", "where are you", heard="where are you"),
    Wording(
        "doing",
        "what are you doing | (what | which <words>) are you (getting | bringing | fetching | looking for | searching "
        "for | taking | after)",
        heard="what are you doing",
    ),
    Wording(
        "done",
        f"what did you [just] (do [(with | to) <words>] | ({_DID}) <words>)"
        f" | (did | have) you ({_DID} | manage | managed | succeed | succeeded) <words> [already | yet]",
        heard="what did you [just] do",
    ),
    Wording(
        "why",
        "why did you fail | what went wrong | why (did | could | can | have | do | are | would) (not you | you not) "
        "<words> | why you (did | could | can) not <words>",
        heard="why did you fail | what went wrong",
    ),
    Wording(
        "origin",
        "(where | [in | on | from] (which | what) (place | table | shelf | room | surface)) (did | do | have) you"
        " (get | got | take | taken | find | found | pick | fetch | have | had) <thing> [up] [from]"
        " | where (did | was | were) <thing> (stand | sit | lie | be | come from | standing | lying) [before | "
        "originally]"
        " | where (was | were) <thing> [before | originally] | where does <thing> come from",
    ),
    Wording("limits", "how (much | heavy) can you (carry | lift) | how high can you reach | how fast can "
    "you (go | drive)"),
    Wording("abilities", "what can you do | help [me]", heard="what can you do"),
    Wording(
        "repeat",
        "say (that | it | this) (again | once more | one more time) | say again | repeat what you [just | have] said"
        " | what [else] did you [just] (say | tell me | ask [me]) | what have you [just] said | come again | pardon"
        " | what was that | (i | we) (did not | could not) (hear | catch | get | understand) (that | you | it)",
        heard="say that again",
    ),
    Wording("battery", "how full is your battery"),
    Wording("rooms", "(which | what) (rooms | places) are in <words>"),
    Wording(
        "capacity",
        "[(can | could) you] (carry | hold | lift) (two | three | four | several | many | more than one) "
        "(thing | things | objects | items) [at once | at a time | at the same time | together]",
    ),
    Wording("hearing", "[(can | do | did) you] (hear | understand) me"),
    Wording("identity", "who are you", heard="who are you"),
    Wording(
        "thanks",
        "(thank you | thanks | cheers) [very much | a lot | so much | robot] | (well | good) (done | job)"
        " | good (robot | boy)",
        kind="reply",
    ),
    Wording("greeting", "(hello | hi | hey | good (morning | afternoon | evening)) [there | robot]", kind="reply"),
    Wording("parting", "(bye | goodbye | good night | see you) [then | robot]", kind="reply"),
)  # fmt: skip
"""What can be heard of questions about the robot, and those with other words in them; the rest: itself.py."""
