"""The wordings that people use, in one table: the sentence patterns, what each asks for, and what of it can be heard.

The planner turns them into plans, speech listens for them, the brain takes answers, "stop" and the fetch pipeline's
commands from them. A new wording is one more row.
"""

from typing import Literal

from common.language.condition_wordings import CONDITIONS
from common.language.home_wordings import ASKED, TOLD
from common.language.lexicon import BACK, BRING, GO, LOOK, NEAR, ON, PEOPLE, PICK, PUT, TIDY
from common.language.moving import MOVING
from common.language.questions import ABOUT_ITSELF, ABOUT_THE_WORLD
from common.language.refusals import REFUSALS
from common.language.replies import REPLIES
from common.language.wording import Wording

WORDINGS: tuple[Wording, ...] = (
    *REPLIES,
    Wording("refuse", "yes <words>", reason="I did not ask anything"),
    Wording(
        "refuse", "(do not | never | not | did not | refrain | avoid) <words>",
        reason="you told me not to, so I leave it",
    ),
    *CONDITIONS,
    *REFUSALS,
    Wording("refuse", "(if | when | unless) <words>", reason="I cannot wait for conditions"),
    Wording(
        "open_hand",
        "(open [up] | let go [of] | release) [the | your | that | those] (gripper | hand | fingers | claw) [of yours]"
        " | (spread | stretch | unclench | loosen | relax | slacken) (the | your | those) (fingers | hand | claw)"
        " | (set | put) [the | your] (gripper | hand) to open",
        heard="open (the | your) (hand | gripper)",
    ),
    Wording(
        "close_hand",
        "(close | shut) [the | your | that | those] (gripper | hand | fingers | claw) [of yours] | make a fist"
        " | (pinch | squeeze | put) (the | your | those) fingers [of yours] together"
        " | (set | put) [the | your] (gripper | hand) to closed",
        heard="close (the | your) (hand | gripper)",
    ),
    *ABOUT_ITSELF,
    *ASKED,
    *ABOUT_THE_WORLD,
    *TOLD,
    # Names of things.
    Wording(
        "teach",
        "[(remember | learn | look) [that | and]] (this | that) [<thing>] is [called] (my | our) <words>"
        " | [(remember | learn) [that | and]] (this | that) [<thing>] is (called | named) <words>"
        " | <thing> (is | shall be | will be) (called | named | known as) [my | our | the] <words>"
        " | (the | this | that) <thing> is (my | our) <words>"
        " | (call | name) (this | that | it) [<thing>] [my | our | the] <words> | (call | name) (the "
        "| my | our) <thing> <words>"
        " | (remember | learn) (this | that) [<thing>] as [my | our | the] <words>"
        " | (remember | learn) <thing> as (my | our) <words>"
        " | [you should know [that]] (this | that) [here] is (called | named | known as) [my | our | the] <words>"
        " | we call <thing> (my | our | the) <words>"
        " | [in (this | our) (house | home | family)] (this | that | it) goes by [the name [of]] [my | our "
        "| the] <words>"
        " | another (name | word) for (this | that | it | <thing>) (is | would be) [my | our | the] <words>"
        " | what you (have [got] in your hand | are (holding | carrying)) is [called] (my | our | the) <words>",
    ),
    Wording("teach_owned", "[you should know [that] | learn this one [and]] (this | that | it) is <words>"),
    Wording(
        "forget",
        "(forget | unlearn | drop | delete) the name [of] [my | our | the] <words>"
        " | (forget | unlearn) ([about] [the name [of] | what is] (my | our) | the name [of] [the]"
        " | that (it | this | that | <thing>) is (called | named) [my | our | the]) <words>"
        " | (stop | quit) (calling | naming) (it | this | that | <thing>) [my | our | the] <words>",
    ),
    Wording("untidy", "<spot> (is | looks) (a mess | messy | untidy | dirty | a tip)"),
    Wording(
        "again",
        "[do] (that | it | the same [thing] | same [thing]) [once] [again | more] [but] (with | for | to) <thing>"
        " | [do] (that | it | the same [thing] | same [thing]) [once] (again | more)"
        " | [try | repeat] (that | it) (again | once more | one more time) | repeat (that | it) "
        "[with <thing>] | retry"
        " | (try | do it | go) (again | once more | one more time) | (once [more] | again | one more time) [with "
        "<thing>]"
        " | (have | take) another look | (look | check | search | try) (again | once more | harder | properly) |"
        " (have | take | give it) (another | one more) (go | try "
        "| shot | attempt)",
        heard="try again | do that again",
    ),
    # The robot itself.
    Wording(
        "say",
        f"(tell | inform | (say | announce) to) ({PEOPLE} | whoever is) (in | at) <spot> [that | to] <words>"
        f" | let ({PEOPLE} | whoever is) know (in | at) <spot> [that] <words>"
        f" | wish {PEOPLE} <words> (in | at) <spot> | say <words> to {PEOPLE} (in | at) <spot>",
    ),
    Wording(
        "say",
        f"wish {PEOPLE} [a | an] <words> | (tell | inform | (say | announce) to) {PEOPLE} [that] <words>"
        f" | let {PEOPLE} know [that] <words> | say <words> to {PEOPLE}"
        " | repeat after me [and] <words> | (say | announce) [that] <words> | (tell | inform) <thing> that <words>",
    ),
    Wording("wait", "(wait | pause | hold [your] position) [here | there | a moment | a bit | a while | for me]",
            heard="wait"),
    Wording(
        "wait",
        "give it <words> | "
        "(wait | pause | sleep | hold (on | off) | hang (on | about | around) | stay [here | there] | stand by | rest) "
        "[here | there] [for] <words>"
        " | (give | allow) (me | us) <words> | (stay | remain | wait) (put | where you are | right there) [for] <words>"
        " | (do nothing | do not (move | budge | go anywhere | drive anywhere) | freeze | (stand | stay | keep) still"
        " | let (me | us) rest) for [the next] <words> | take a break (for | of) <words>",
    ),
    Wording("count", "count [up | down] [to | from] <words>"),
    Wording(
        "look_around",
        "(look | take a look | have a look | go and look | glance | scan | search) [all] (around | about | round)"
        " [the (room | flat | place | apartment) | you | here | in here]"
        " | (look | search | scan) [around] everywhere | turn (around | round)"
        " | [go [and]] (look [at] | scan | survey | observe | inspect | explore | study | take in | check [out])"
        " ([(all | everything)] [that | what] is around you | (the | your) [whole] (room | surroundings | area))",
        heard="[take a] look around",
    ),
    Wording(
        "go_and_see",
        f"[go [and] | come and] {LOOK} [around | round] [in | at | on | inside | into] <spot>"
        f" | [go [and]] {LOOK} what (is | lies | there is) [lying | standing] (on | in | at) <spot>"
        f" | (search | inspect | survey | scan | explore) <spot>",
    ),
    Wording(
        "check",
        "(check | inspect | scan) <spot> for <thing>"
        f" | [go [over] [and | to]] {LOOK} (if | whether)"
        " ((there is | there are | you (see | find) | we have) [still] <thing> [left] | (somebody | someone | anybody"
        " | anyone | i | we | they | you) [has | have] (left | put | forgotten | forgot | dropped) <thing>"
        " | <thing> (is | are) [still] (in | on | at) <spot>)",
    ),
    Wording(
        "find",
        f"[go [and] | help me [to] | try [to | and]] {LOOK} (if | whether) you can (find | see | spot) <thing>",
    ),
    Wording("wait_there", "[go [and]] (wait [for me] | stay | stand) (in | at | by | near) <spot>"),
    Wording(
        "come_back",
        "(come | go | drive | get) [yourself] [on] [over] (here | back [here] [to me])"
        " | (come | go | return | head) [back] [to] where ((i am | we are) [sitting | standing | lying] | you (started"
        " | came from)) | over here | here to me | to me | this way | come | home | back [here | to me | home]"
        " | return [home | here | to (start | me | base)] | [go [home | back] [and]] (park | dock |"
        " charge | recharge) [up] [yourself] [for now]"
        " | [off | shoo | (go | get | drive | head | roll) [back] | (go [and] (sit | stand | wait)) | back] (to | in)"
        " your [own] (spot | corner | place | dock | station | charger | nest | (charging | parking | docking) (station"
        " | spot | place | bay)) | (come | go | drive) [back] home",
        heard="go home | come (here | back)",
    ),
    Wording("put", f"{PICK} <thing> [up] and ({PUT}) it {BACK} {ON} <spot>"),
    Wording("fetch", f"(go | get | {GO}) [over | along] and ({BRING} | find) [me | us] <thing>"),
    # Tidying, going.
    Wording("tidy", f"({TIDY}) up [<spot>]", heard="(tidy | clean) up [the | my] <place>"),
    Wording("tidy", f"({TIDY}) <spot> [up]", heard="(tidy | clean | clear) [the | my] <place>"),
    Wording(
        "tidy",
        "(sort | straighten) <spot> [out | up] | (clean | clear) <spot> off | empty <spot>"
        " | make [some | a bit of | a little] (space | room | order) (on | in) <spot>"
        " | give <spot> a [quick | good] (tidy | clean | tidying | cleaning) [up]"
        " | (clean | clear | take | get | remove) (everything | all of it | it all) (off | from) <spot>",
    ),
    Wording(
        "go", "go [over | back | along] (to | into | in | near | towards) <spot>", heard="go [back] to [the] <place>",
    ),
    Wording(
        "go",
        f"({GO} | off you go) [over | back | along] (to | into | towards) <spot>",
        heard="drive [back] to [the] <place>",
    ),
    Wording("go_there", f"(go | {GO}) [over | back | straight | right] there"),
    Wording("go", "(swing | drop | stop | pop | pass | come | go) by <spot> | visit <spot>"),
    Wording("leave", "(get | go | come) out of <spot> | (vacate | exit | leave) <spot> | (get | go) (out | away)"),
    Wording(
        "go",
        "(approach | look at | head for | make for | set off for) <spot>"
        " | (i | we) (need | want) you (in | at | by) <spot>"
        f" | (go | {GO}) [over | back | up] to (where | the (room | place | table | spot) where) <spot> (is | are"
        f" | stands | lies) | ([go [and]] stand | go | {GO}) (next to | beside | in front of | up to | over to | by"
        " | close to) <spot> | (park | place | put | position | station | move | bring | drive | get | take) yourself"
        " [over | back] (to | into | in | at | on | by | near | next to | beside | in front of) <spot>"
        " | make your way [over | back] (to | into) <spot>"
        " | (show | lead | guide | accompany | take) (me | us) [the way] to <spot> | meet (me | us) (in | "
        "at | by) <spot>",
    ),
    *MOVING,
    # What is said beside a command.
    Wording("teach_owned", "(the | my | our) <thing> is <words>", kind="told"),
    Wording(
        "mention",
        "[do | can | did | have] [you] (see | know | remember | seen) <thing> [right] |"
        " (in | on | at) <spot> (is | are | there is | there are | stands | lies) <thing> |"
        " (start | begin) with <thing> | there (is | are | was | were | should be | must be) <thing>"
        " | (i | we) (left | put | saw | forgot | "
        "dropped) <thing>"
        " | <thing> (is | are) (in | on | at) <spot> | <thing> (is | are | was | were | looks | look | has | "
        "have) <words>", kind="told",
    ),
    Wording(
        "remark",
        "(i am | we are | it is | my (throat | mouth | stomach | tummy) is) <words>"
        " | is there (anything | something) [that] you (can | could) (bring | get | give | fetch) (me | us)",
        kind="told",
    ),
    # Names alone.
    Wording("put_held", f"[back] ({ON} | at | to) <spot>", kind="name"),
    Wording("put_held_near", f"[back] {NEAR} <spot> [again]", kind="name"),
    Wording("named_at", "<thing> (in | on | into | onto) <spot>", kind="name"),
    Wording("fetch", "[no] i (said | meant) <thing> | no (the | my | that | this | "
                     "all) <thing>", heard="no [i said] <thing>", kind="name"),
    Wording("fetch_named", "<thing>", heard="<thing> | the (<colour> | <ordinal> | left | right) one", kind="name"),
)  # fmt: skip

INTERRUPTS: dict[Literal["stop", "cancel"], tuple[str, ...]] = {
    "stop": ("[robot | please | no] stop [it | now | moving | please]", "stop stop [stop]"),
    "cancel": ("[robot | please | no] cancel [it | that | please]",),
}
"""What is listened for at any time, without the wake word and while the robot itself speaks."""
