"""The wordings of questions: what is where, what the robot sees, and what it does, did and can do."""

from common.language.lexicon import ASK, BE, LYING, WHAT_DID
from common.language.wording import Wording

ABOUT_THE_WORLD: tuple[Wording, ...] = (
    Wording(
        "seen",
        "[tell me] what (do you | can you | are you able to) see [now | right now | here | from (here | there | "
        "where you are)]"
        " | tell me what you [can] (see | find) | what have you seen [so far | today | until now | up to now "
        "| around here]", heard="what (do | can) you see"
    ),
    Wording(
        "contents",
        f"{ASK} (what [else] | (which | what) (things | objects | items | stuff)) ({BE} [there] | lies | lie | "
        f"do you see | do (we | i | you) have | have (we | i | you) got)"
        f" [{LYING}] (on | in | at | inside) <spot>"
        f" | (tell me | list | name) (what | everything | all | [all] the (things | objects | items)) "
        f"[that] [{BE}] [{LYING}] (on | in | at | inside) <spot>"
        f" | {ASK} what <spot> (has | holds | contains) [on it | in it]",
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
    Wording("where", f"{ASK} where (has | have | is | are) <thing> (gone | been | got to | ended up)"),
    Wording("where", f"{ASK} (where | whereabouts) [exactly] (is | are) <thing>", heard="where (is | are) <thing>"),
    Wording(
        "where",
        f"{ASK} (where | whereabouts) [exactly] (is | are) [it] <thing> (at | now | located | kept | "
        f"lying | standing)"
        f" | {ASK} where (it is | is it | they are | stands | lies | sits) <thing> | {ASK} where did <thing> (go "
        f"| end up | get to) [to]",
    ),
    Wording(
        "where",
        "(what do you know | tell me [something | more | all you know] | what can you tell me) (about | of) <thing>"
        " | describe <thing>",
    ),
    Wording("recall", f"(is | are) (anything | something) [still | left] [{LYING}] (in | on | at) <spot>"),
    Wording(
        "recall",
        "is <spot> [still] (empty | free | clear | tidy | full | clean | occupied | untidy | a mess)"
        " | is there nothing (on | in | at) <spot>",
    ),
    Wording(
        "extreme",
        f"{ASK} (what | which) (is | are) <words> | {ASK} (which | what) [one] [of] <thing> (is | are) [the] <words>",
    ),
    Wording("where", f"{ASK} where <thing> (is | are | was | went | has gone | have gone | might be | "
                     f"could be)"),
    Wording("where", f"{ASK} where (can | could | might | would) <thing> be"),
    Wording(
        "where",
        f"{ASK} (where | when) (did | do | would | can | could | have) (you | i | we) [last]"
        " (see | seen | put | leave | left | have | find | found | notice) <thing> [last]",
        heard="where did you [last] see <thing>",
    ),
    Wording(
        "where",
        f"{ASK} [in | on] (which | what) (room | place | surface | shelf | table) ({BE} <thing> | "
        f"<thing> {BE}) [in | on]",
    ),
    Wording(
        "where", f"{ASK} where (i | we | you) [have] [last] (left | put | saw | seen | have | had) <thing>"
    ),
    Wording(
        "where",
        "have you (seen | found | got | noticed | come across) <thing> [anywhere | somewhere]"
        " | have you <thing> seen | did (i | we | somebody | someone | anybody | anyone) (leave | put | forget | "
        "lose) <thing>",
    ),
    Wording("where", "(do | can) you (see | know) <thing> [anywhere | somewhere]"),
    Wording("where", "(did you see | any sign of | what about | what happened to) <thing> [anywhere]"),
    Wording(
        "exists",
        f"{ASK} (is | are) there [still] <thing> [lying | standing] [left | anywhere | around | here | somewhere]",
    ),
    Wording(
        "exists",
        "(do we | have we | do i | do you [happen to] | happen to | would you happen to) [still] (have | got) "
        "<thing> [left | anywhere | somewhere]",
    ),
    Wording(
        "is_at",
        "([tell me | let me know | do you know] whether | (tell me | let me know | do you know) if)"
        " <thing> (is | are) [still] (in | on | at) <spot>",
    ),
    Wording("is_at", f"{ASK} [if | whether] (is | are) <thing> [still] [{LYING}] (in | on | at) "
                     f"<spot> [still]"),
    Wording("number", f"{ASK} how many [of] <thing> [{BE} | do you (see | know) | can you see | have you "
                      f"seen | did you see | do we have | have we "
                      f"got | there are]"
        f" [there | {LYING} | left] (on | in | at) <spot>"),
    Wording(
        "number",
        f"{ASK} how many [of] <thing> [(are there | there are | do (we | i | you) (have | own) | have "
        f"(we | i) got | do "
        f"you (see | know | remember) | can you see | have "
        f"you seen | do we have |"
        f" {BE} (left | here | around))] [left]",
    ),
    Wording(
        "colour",
        f"{ASK} (what | which) (colour | color) {BE} <thing> | {ASK} (what | which) (colour | color) "
        f"<thing> {BE} | {ASK} what {BE} the (colour | color) of <thing>"
        " | tell me the (colour | color) of <thing>",
    ),
    Wording(
        "kinds",
        "(which | what) <thing> (do you know [of | about] | have you seen | do you see | can you see | are there |"
        " do we have)",
    ),
    Wording("compare", f"{ASK} (is | are) <thing> <words> than <spot>"),
    Wording("beside", f"{ASK} what {BE} [{LYING}] <words>"),
)  # fmt: skip
"""Where things are, what and how many there are."""

ABOUT_ITSELF: tuple[Wording, ...] = (
    Wording("holding", "what (are you | is (it | that | this) [that] you are) (holding | carrying)",
            heard="what are you holding"),
    Wording("holding", "what do you (have | hold) [in your (hand | hands | gripper)]"),
    Wording(
        "holding",
        "(are you (holding | carrying) | do you (have | hold | carry) | have you got | is there)"
        " (anything | something | it) [in your (hand | hands | gripper)] | is your hand (empty | free | full)"
        " | what have you got [there | in there | for me]",
    ),
    Wording("holding", "what (is | have you | have you got | do you have | are you holding | do you hold) [that |"
                       " this | it]"
        " in (your | the) (hand | hands | gripper | claw | fingers)"),
    Wording(
        "whereabouts",
        f"{ASK} where (are you | you are) [standing | at] | [in] (which | what) room are you [standing] [in]",
        heard="where are you",
    ),
    Wording(
        "doing",
        "what (are you | you are) (doing | up to | working on | busy with) [there | here | right now | now |"
        " at the moment | currently] | what is going on | how is it going | how are you (doing | getting on)"
        " | how (much longer | long) (will (you | it | that) (be | take | need) | (does | is) it "
        "(take | going to take)"
        " | do you need | until you are done) [still]"
        " | (what | which <words>) are you (getting | bringing | fetching | looking for | searching "
        "for | taking | after)"
        " | what (did i | was it [that] i | did we) (ask | asked | tell | told) you [for | to do | "
        "to bring | to get | to fetch]"
        " | where are you (going | headed | off to) | what are you (going to do | about to do) [next | now]"
        " | how far (are you | have you (got | come)) | are you (done | busy | finished | ready | (nearly | almost) "
        "(there | done | finished | ready)) [yet]"
        " | what is (happening | your [current | present] (task | job | mission | status)) | what is taking "
        "[you] so long | "
        "[status] report | status | (give me | any) [a | an] (update | news) | how are things",
        heard="what are you doing",
    ),
    Wording(
        "done",
        f"what {WHAT_DID} | what (was | is) (the last thing you did | (my | your) last (task | job | "
        f"mission | command | order | request))"
        " | (did | have) you (manage | managed | succeed | succeeded | finish | finished | do | done) [it | that |"
        " (to | in) <words>] | what did you do (with | to) <words> | what did you (put | bring | move | take | "
        "throw | fetch | tidy) <words> | did (it "
        "| that) work [out] | (did | have) you (bring | brought | put | fetch "
        "| fetched |"
        " find | found | tidy | tidied | throw | thrown) <words> [already | yet]"
        " | what have you (done | been doing) [today | so far | lately] | did everything go well"
        " | how did (it | that) go",
        heard="what did you [just] do",
    ),
    Wording(
        "why",
        "why (did | have) you [just] (fail | failed | stop | stopped | give up | given up)"
        " | why (did | could | can | have | do | are | would) (not you | you not) <words> | why did (it | that) "
        "(fail | not work "
        "| go wrong)"
        " | what (went wrong | was the (problem | matter | trouble | reason) | is the (matter | problem) | happened"
        " [there]) | why not | why (is | was) (that | it) | why (were you not able | "
        "are you not able) to <words> | how come [<words>]"
        " | where (did you | have you) (look | looked | search | searched | check | checked)",
        heard="why did you fail | what went wrong",
    ),
    Wording(
        "origin",
        "(where | which place | what place) (did | do | have) you (get | got | take | taken | find | found | pick |"
        " fetch | have | had) <thing> [up] [from]"
        " | where (did | was | were) <thing> (stand | sit | lie | be | come from | standing | lying) [before | "
        "originally]"
        " | where (was | were) <thing> [before | originally] | where does <thing> come from",
    ),
    Wording(
        "abilities",
        "(tell me | explain) what you (can do | are able to do) | what [else | jobs | things | tasks "
        "| work | stuff] (can | could) you (do | manage | handle) "
        "[for (me | us) | here] | what are you (able to do | capable of | good (at | for))"
        " | how can you help [me | us] | what (do you know how to do | can i (ask [you] [for | to do] | "
        "say [to you]))"
        " | help [me] | what are your (skills | abilities | capabilities)",
        heard="what can you do",
    ),
    Wording("identity", "who are you | what are you | [tell me] what is your name | introduce yourself | what "
                        "(should | shall | do | can) i call you"
        " | are you [really | actually | just] (a | an) [real] (robot | human | person | machine | man | woman | "
        "computer | ai)"
        " | are you (real | alive | human)", heard="who are you"),
    Wording(
        "rooms",
        "[tell me] (which | what) (rooms | places) ([do] you know | are there | do you know | can "
        "you go to | are in <words>)"
        " | where can you go [to] | how many rooms (are there | do you know)",
    ),
    Wording(
        "thanks",
        "(thank you | thanks | cheers) [very much | a lot | so much | robot] | (well | good) (done | job)"
        " | good (robot | boy | morning | evening | night) | hello | hi [there]",
        kind="reply",
    ),
)  # fmt: skip
"""What the robot does, did, holds and can do."""
