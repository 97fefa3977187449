"""The sentence forms that are understood and what each does, in order of trial."""

from services.planner import answers, commands, tidying
from services.planner.commands import Action
from services.planner.forms import Form

FORMS: tuple[tuple[Form, Action], ...] = tuple(
    (Form(pattern), action)
    for pattern, action in (
        ("(stop | halt | freeze) [it | now | moving]", commands.refuse("stopping needs no plan")),
        ("(cancel | abort) [that | it] | never mind | forget it", commands.refuse("there is nothing to cancel")),
        ("continue | resume | go on | go ahead", commands.refuse("there is nothing to continue")),
        (
            "yes [<words>] | yeah | yep | no | nope | no thanks | correct | right | okay",
            commands.refuse("I did not ask anything"),
        ),
        ("(don't | do not | never) <words>", commands.refuse("you told me not to, so I leave it")),
        ("if <words> | when <words> | unless <words>", commands.refuse("I cannot wait for conditions")),
        ("follow <words>", commands.refuse("I cannot follow people")),
        ("(open | let go [of] | release) [the | your] (gripper | hand | fingers)", commands.open_hand),
        ("(close | shut) [the | your] (gripper | hand | fingers)", commands.close_hand),
        ("what (do | can) you see | look around | tell me what you (can | ) see", answers.seen),
        ("(what | tell me what) (is | are | lies | do you see) (on | in | at) <spot>", answers.contents),
        ("what are you holding | what do you (have | hold) [in your (hand | gripper)]", answers.holding),
        ("what (is | have you got | do you have) in your (hand | gripper)", answers.holding),
        ("where are you", answers.whereabouts),
        ("(where | tell me where) (is | are) <thing>", answers.where),
        ("(do | can) you (see | know) <thing>", answers.where),
        ("(is | are) there <thing>", answers.where),
        ("(is | are) <thing> (in | on | at) <spot>", answers.where),
        ("how many <thing> (are there | do you see | can you see | do you know | are <words>)", answers.number),
        ("(say | announce) <words>", commands.say),
        ("wait [here | a moment | a bit | for me | a second]", commands.wait),
        ("(come | go | drive) [back] home", commands.come_back),
        ("(come | go | drive | get) (here | back | to me | back here | back to me | over here)", commands.come_back),
        ("return [home | here | to (start | me | base)] | come", commands.come_back),
        ("(get | fetch | take | grab) <thing> and throw (it | them) away", tidying.throw_away),
        ("(get | fetch | take | grab) <thing> and put (it | them) away", tidying.put_away),
        (
            "(get | fetch | take | grab) <thing> and (put | place | throw | drop | set) (it | them)"
            " (in | into | inside | on top of | on | onto) <spot>",
            commands.put,
        ),
        ("(get | fetch | take | grab) <thing> and (bring | take | carry) (it | them) to <spot>", commands.deliver),
        ("(go | drive | get | walk) and (get | fetch | bring | find) [me | us] <thing>", commands.fetch),
        ("go (get | fetch | bring) [me | us] <thing>", commands.fetch),
        ("(tidy | clean | clear) up [<spot>]", tidying.tidy),
        ("(tidy | clean | clear) [<spot>] [up]", tidying.tidy),
        ("(clean | clear) <spot> off | empty <spot>", tidying.tidy),
        ("go [over | back] (to | into | in | near | towards) <spot>", commands.go),
        (
            "(drive | navigate | move | walk | return | head | come | roll) [over | back] (to | into | towards) <spot>",
            commands.go,
        ),
        ("(approach | look at) <spot>", commands.go),
        (
            "(put | set | lay) (down <thing> | <thing> down) (in | into | inside | on top of | on | onto | at) <spot>"
            " | leave <thing> (in | on | at) <spot>",
            commands.put,
        ),
        (
            "put (down | back down) <thing> | put <thing> [back] down | set down <thing> | set <thing> down",
            commands.put_down,
        ),
        ("(drop | release | let go of | let go) <thing> | let go", commands.put_down),
        (
            "(put | place | set | move | throw | toss | drop) <thing> (next to | near | beside | close to | by) <spot>",
            commands.put_near,
        ),
        ("(throw | toss) <thing> (away | out)", tidying.throw_away),
        (
            "(throw | toss) (away | out) <thing> | (get rid | dispose) of <thing>"
            " | (trash | discard | recycle) <thing>",
            tidying.throw_away,
        ),
        ("(put | tidy | clear | clean) away <thing> | (put | tidy | clear | clean) <thing> away", tidying.put_away),
        ("put <thing> (back | where it belongs | where they belong | in its place)", tidying.put_away),
        ("(bring | take | carry | move | put | deliver) <thing> there", commands.deliver_there),
        ("(bring | fetch | get | give | hand | pass | grab | take | carry | find) (me | us) <thing>", commands.fetch),
        (
            "(bring | fetch | get | give | hand | pass | grab | take | carry | move) <thing>"
            " [over | back] to (me | us)",
            commands.fetch,
        ),
        ("(bring | fetch | get) <thing> [over] (here | back)", commands.fetch),
        (
            "(put | place | set | throw | toss | drop | lay | stick | move | stack)"
            " <thing> (in | into | inside | on top of | on | onto | at | under | to) <spot>",
            commands.put,
        ),
        (
            "(bring | take | carry | deliver | transport | move | get | fetch | return) [me] <thing>"
            " [over | back] (to | into) <spot>",
            commands.deliver,
        ),
        ("(take | carry | bring) <thing> (on | onto | in) <spot>", commands.put),
        ("(pick | take | grab | lift) up <thing> | pick <thing> up | lift <thing> [up]", commands.pick_up),
        ("(grab | grasp | take | hold | pick) <thing>", commands.pick_up),
        ("(find | search for | look for | locate | show me) <thing>", commands.find),
        ("(bring | fetch | get | give | hand | pass | collect | gather) <thing>", commands.fetch),
        ("(i | we) (want | need | would like | 'd like) <thing> | i'd like <thing>", commands.fetch),
        ("(put | place | set) <thing>", commands.refuse("you did not say where to put it")),
        (
            "(open | close | shut | lock | unlock) <words>",
            commands.refuse("I cannot open or close doors, drawers or lids"),
        ),
        ("(turn | switch) (on | off) <words>", commands.refuse("I cannot switch things on or off")),
    )
)
"""In order: the first form that fits and can be done counts."""

ALONE: tuple[tuple[Form, Action], ...] = (
    (Form("[no] i (said | meant) <thing> | no <thing>"), commands.fetch),
    (Form("<thing>"), commands.fetch_named),
)
"""Forms that stand only as a whole command."""

VERBS = frozenset({
    "bring", "fetch", "get", "give", "hand", "pass", "grab", "take", "carry", "put", "place", "set", "throw", "toss",
    "drop", "move", "pick", "find", "go", "drive", "tidy", "clean", "clear", "open", "close", "release", "come",
    "return", "wait", "say", "tell", "look", "search", "show", "deliver",
})  # fmt: skip
