"""The wordings that people use, in one table: the sentence patterns, what each asks for, and what of it can be heard.

The planner turns them into plans, speech listens for them, the brain takes answers, "stop" and the fetch pipeline's
commands from them. A new wording is one more row.
"""

from typing import Literal, NamedTuple

Action = Literal[
    "stop", "cancel", "continue", "yes", "no", "refuse",
    "open_hand", "close_hand", "seen", "contents", "holding", "whereabouts", "where", "number", "say", "wait",
    "come_back", "go", "throw_away", "put_away", "tidy", "put", "put_near", "put_down", "deliver", "deliver_there",
    "fetch", "fetch_named", "pick_up", "find",
]  # fmt: skip
"""What a wording asks for; `services/planner/rules.py` has a function for each that can be planned."""
Kind = Literal["command", "reply", "name"]


class Wording(NamedTuple):
    """Sentences of `pattern` ask for `action`; in order of trial: the first that fits and can be done counts.

    `heard` is the part of it that the speech recogniser listens for, which hears each sentence the better the fewer
    there are: None the whole pattern, "" nothing (typed only). Its slots are the parts of `speech.commands`.
    `kind`: a "command" may be joined to others by "and"; a "reply" is heard by itself only; a "name" is understood
    where nothing else was said. `reason`: why the planner has no plan for it, as a clause.
    """

    action: Action
    pattern: str
    heard: str | None = None
    kind: Kind = "command"
    reason: str = ""


ON = "(in | into | inside | on top of | on | onto)"
NEAR = "(next to | near | beside | close to | by)"
IT = "(<thing> | it | them)"

WORDINGS: tuple[Wording, ...] = (
    Wording(
        "stop", "[no] (stop | halt | freeze) [it | now | moving | stop [stop]] | emergency stop",
        heard="stop [it]", kind="reply", reason="stopping needs no plan",
    ),
    Wording(
        "cancel", "[no] (cancel | abort) [that | it] | never mind | nevermind | forget it",
        heard="cancel [that] | never mind", kind="reply", reason="there is nothing to cancel",
    ),
    Wording(
        "continue", "continue | resume | go on | go ahead",
        heard="continue | resume", kind="reply", reason="there is nothing to continue",
    ),
    Wording(
        "yes",
        "(yes | yeah | yep) [please | i did | it is] | correct | [that is] right | exactly | sure | okay | ok"
        " | go ahead | do it | do | affirmative",
        heard="yes [please | it is] | yeah | correct", kind="reply", reason="I did not ask anything",
    ),
    Wording(
        "no", "(no | nope) [thanks | i did not | i didn't] | [that is] wrong | negative | not that",
        heard="no [thanks] | nope", kind="reply", reason="I did not ask anything",
    ),
    Wording("refuse", "yes <words>", heard="", reason="I did not ask anything"),
    Wording("refuse", "(don't | do not | never) <words>", heard="", reason="you told me not to, so I leave it"),
    Wording("refuse", "(if | when | unless) <words>", heard="", reason="I cannot wait for conditions"),
    Wording("refuse", "follow <words>", heard="follow me", reason="I cannot follow people"),
    Wording(
        "open_hand", "(open | let go [of] | release) [the | your] (gripper | hand | fingers)",
        heard="open (the | your) (hand | gripper)",
    ),
    Wording(
        "close_hand", "(close | shut) [the | your] (gripper | hand | fingers)",
        heard="close (the | your) (hand | gripper)",
    ),
    # Questions.
    Wording(
        "seen", "what (do | can) you see | look around | tell me what you [can] see", heard="what (do | can) you see"
    ),
    Wording("contents", "(what | tell me what) (is | are | lies | do you see) (on | in | at) <spot>", heard=""),
    Wording("holding", "what are you holding | what do you (have | hold) [in your (hand | gripper)]", heard=""),
    Wording("holding", "what (is | have you got | do you have) in your (hand | gripper)", heard=""),
    Wording("whereabouts", "where are you", heard=""),
    Wording("where", "(where | tell me where) (is | are) <thing>", heard="where (is | are) <thing>"),
    Wording("where", "(do | can) you (see | know) <thing>", heard=""),
    Wording("where", "(is | are) there <thing>", heard=""),
    Wording("where", "(is | are) <thing> (in | on | at) <spot>", heard=""),
    Wording(
        "number", "how many <thing> (are there | do you see | can you see | do you know | are <words>)", heard=""
    ),
    # The robot itself.
    Wording("say", "(say | announce) <words>", heard=""),
    Wording("wait", "wait [here | a moment | a bit | for me | a second]", heard="wait"),
    Wording("come_back", "(come | go | drive) [back] home", heard="go home"),
    Wording(
        "come_back", "(come | go | drive | get) (here | back | to me | back here | back to me | over here)",
        heard="come (here | back)",
    ),
    Wording("come_back", "return [home | here | to (start | me | base)] | come", heard=""),
    # Two things at once, said of one object.
    Wording("throw_away", "(get | fetch | take | grab) <thing> and throw (it | them) away", heard=""),
    Wording("put_away", "(get | fetch | take | grab) <thing> and put (it | them) away", heard=""),
    Wording(
        "put", f"(get | fetch | take | grab) <thing> and (put | place | throw | drop | set) (it | them) {ON} <spot>",
        heard="",
    ),
    Wording(
        "deliver", "(get | fetch | take | grab) <thing> and (bring | take | carry) (it | them) to <spot>", heard="",
    ),
    Wording("fetch", "(go | drive | get | walk) and (get | fetch | bring | find) [me | us] <thing>", heard=""),
    Wording("fetch", "go (get | fetch | bring) [me | us] <thing>", heard=""),
    # Tidying, going.
    Wording("tidy", "(tidy | clean | clear) up [<spot>]", heard="(tidy | clean) up [the | my] <place>"),
    Wording("tidy", "(tidy | clean | clear) [<spot>] [up]", heard="(tidy | clean | clear) [the | my] <place>"),
    Wording("tidy", "(clean | clear) <spot> off | empty <spot>", heard=""),
    Wording("go", "go [over | back] (to | into | in | near | towards) <spot>", heard="go [back] to [the] <place>"),
    Wording(
        "go",
        "(drive | navigate | move | walk | return | head | come | roll) [over | back] (to | into | towards) <spot>",
        heard="drive [back] to [the] <place>",
    ),
    Wording("go", "(approach | look at) <spot>", heard=""),
    # Putting.
    Wording(
        "put",
        "(put | set | lay) (down <thing> | <thing> down) (in | into | inside | on top of | on | onto | at) <spot>"
        " | leave <thing> (in | on | at) <spot>",
        heard="",
    ),
    Wording(
        "put_down",
        "put (down <thing> | back down <thing> | <thing> [back] down) | set (down <thing> | <thing> down)",
        heard="put (it | them) down",
    ),
    Wording(
        "put_down", "(drop | release | let go of | let go) <thing> | let go", heard="release it | let go"
    ),
    Wording(
        "put_near", f"(put | place | set | move | throw | toss | drop) <thing> {NEAR} <spot>",
        heard=f"(put | place | set) {IT} <near> | move <thing> <near>",
    ),
    Wording("throw_away", "(throw | toss) <thing> (away | out)", heard=f"throw {IT} away"),
    Wording(
        "throw_away",
        "(throw | toss) (away | out) <thing> | (get rid | dispose) of <thing> | (trash | discard | recycle) <thing>",
        heard="",
    ),
    Wording(
        "put_away", "(put | tidy | clear | clean) away <thing> | (put | tidy | clear | clean) <thing> away",
        heard=f"put {IT} away",
    ),
    Wording("put_away", "put <thing> (back | where it belongs | where they belong | in its place)", heard=""),
    # Bringing.
    Wording("deliver_there", "(bring | take | carry | move | put | deliver) <thing> there", heard=""),
    Wording(
        "fetch", "(bring | fetch | get | give | hand | pass | grab | take | carry | find) (me | us) <thing>",
        heard="(bring | fetch | get | give | hand) me <thing>",
    ),
    Wording(
        "fetch",
        "(bring | fetch | get | give | hand | pass | grab | take | carry | move) <thing> [over | back] to (me | us)",
        heard="(bring | take | carry) <thing> to me",
    ),
    Wording("fetch", "(bring | fetch | get) <thing> [over] (here | back)", heard=""),
    Wording(
        "put",
        "(put | place | set | throw | toss | drop | lay | stick | move | stack)"
        " <thing> (in | into | inside | on top of | on | onto | at | under | to) <spot>",
        heard=f"(put | place | set) {IT} <onto> | throw {IT} (in | into) <inside> | move <thing> (to <spot> | <onto>)",
    ),
    Wording(
        "deliver",
        "(bring | take | carry | deliver | transport | move | get | fetch | return) [me] <thing>"
        " [over | back] (to | into) <spot>",
        heard="(bring | take | carry) <thing> to <spot>",
    ),
    Wording("put", "(take | carry | bring) <thing> (on | onto | in) <spot>", heard=""),
    Wording(
        "pick_up", "(pick | take | grab | lift) up <thing> | pick <thing> up | lift <thing> [up]",
        heard="pick (up <thing> | <thing> up)",
    ),
    Wording("pick_up", "(grab | grasp | take | hold | pick) <thing>", heard="(grab | take) <thing>"),
    Wording("find", "(find | search for | look for | locate | show me) <thing>", heard="find <thing>"),
    Wording("fetch", "(bring | fetch | get | give | hand | pass | carry | collect | gather) <thing>", heard=""),
    Wording("fetch", "(i | we) (want | need | would like | 'd like) <thing> | i'd like <thing>", heard=""),
    Wording("refuse", "(put | place | set) <thing>", heard="", reason="you did not say where to put it"),
    Wording(
        "refuse", "(open | close | shut | lock | unlock) <words>", heard="(open | close) the <openable>",
        reason="I cannot open or close doors, drawers or lids",
    ),
    Wording("refuse", "(turn | switch) (on | off) <words>", heard="", reason="I cannot switch things on or off"),
    # Names alone.
    Wording("fetch", "[no] i (said | meant) <thing> | no <thing>", heard="no [i said] <thing>", kind="name"),
    Wording("fetch_named", "<thing>", heard="<thing> | the (<colour> | <ordinal> | left | right) one", kind="name"),
)  # fmt: skip

INTERRUPTS: dict[Literal["stop", "cancel"], tuple[str, ...]] = {
    "stop": ("[robot | please | no] stop [it | now | moving | please]", "stop stop [stop]"),
    "cancel": ("[robot | please | no] cancel [it | that | please]",),
}
"""What is listened for at any time, without the wake word and while the robot itself speaks."""
