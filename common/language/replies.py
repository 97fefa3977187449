"""The wordings that stop, go on, agree and deny: what is said to a robot at work or in answer to its question."""

from common.language.wording import Wording

REPLIES: tuple[Wording, ...] = (
    Wording(
        "stop",
        "[no] (stop | halt | freeze | hold it | whoa)"
        " [it | that | now | [right] there | at once | immediately | everything]"
        " | [no] stop ([please] stop [stop] | (looking | searching | trying) [for (it | that)] | moving | driving | "
        "going | doing that | what you are doing)"
        " | hold still | [no | please] do not [move | do (that | it | this)]"
        " | [that is it] [that is | it is] enough | quit "
        "(it | that) | cut it out | knock it off | give over | pack it in | leave off | give it a rest | stay "
        "(there | where you are) | emergency stop | [hit the] brakes [on] | brake",
        heard="stop [it]", kind="reply", reason="stopping needs no plan",
    ),
    Wording(
        "cancel",
        "[no] (cancel | abort | scrap) [that | this | it | the (mission | task | job | command | plan)]"
        " | [there is] no need [for (it | that)] [any more] | cancel cancel | abort abort | abort mission"
        " | never mind | nevermind | [no | nah | nope] forget [about] (it | that) | leave it [be | then] | skip it | "
        "drop that | call it off | call off the (search | hunt) |"
        " (forget | ignore) [that] i (asked | said (anything | that | it) | spoke)"
        " | (i | we) [have] changed (my | our) mind | [actually] do not bother [any more | with (it | that)]"
        " | [(it | that) is] (not needed | no longer needed | not necessary) [any more]"
        " | (that | it) will do [for (now | today)] [thanks] | (i | we) (no longer | do not) (need "
        "| want) (it | that) [any more] | not (now | yet) | [maybe] (later | "
        "another time | some other time)",
        heard="cancel [that] | never mind", kind="reply", reason="there is nothing to cancel",
    ),
    Wording(
        "continue", "continue | resume | go on | go ahead | carry on",
        heard="continue | resume", kind="reply", reason="there is nothing to continue",
    ),
    Wording(
        "yes",
        "(yes | yeah | yep | yup | aye) (bring | get | fetch | take | do) (it | that | them) [to me]"
        " | (yes | yeah | yep | yup | aye) [please | thanks | thank you | that is what i (said | meant | "
        "want) | i did | it is | that is right | "
        "please do | do | do that | go for it | "
        "exactly | go ahead] | [that is] (correct | right | true) | exactly | sure | okay | ok"
        " | go ahead | do it | do | affirmative | sure thing | of course | absolutely | definitely | indeed | "
        "certainly | fine | that is what i (said | meant | want)"
        " | [(sure | indeed)] (i | we) (did | do) [indeed | [just] say that] | (too | quite | dead) right"
        " | (sure | yes) did | aye [aye] | mm hm | naturally | that is what i am after"
        " | that is [exactly] what i (was after | asked for)"
        " | go [on | for it] | bang on | spot on | you [have] got it | right you are | you [have] got (it | that) "
        "right | precisely | you bet | uh huh | mhm | by all "
        "means | please do | right | that is (it | the one) | why not | perfect"
        " | carry on | off you (go | pop)"
        " | bingo | jackpot | that is the (ticket | stuff) | [you have] hit the nail on the head | [right] on the money"
        " | [i] could not have (put | said) it better [myself] | loud and clear",
        heard="yes [please | it is] | yeah | correct", kind="reply", reason="I did not ask anything",
    ),
    Wording(
        "no", "no no [no] | uh uh | (neither | none) [[one] of (them | those | these | the two)] [thanks "
        "| please] | not (either | any) "
        "[of (them | those | these | the two)] | (goodness | heavens | gosh | god | hell "
        "| dear me | certainly) (no | not) | (no | nope "
        "| nah) [thanks | i did not | that is wrong] | [that is] "
              "(wrong | incorrect) | negative "
              "| not (that | really | at all) | no way"
        " | [no] that is not (what i (said | meant | want | asked for) | right | correct | it | true) | not what "
        "i (said | meant)"
        " | [no] i (did not | never) (say | mean) that | you (misheard | misunderstood) [me] | absolutely not"
        " | you (dreamt | dreamed | imagined) (that | it) | you must be dreaming | in your dreams | over my dead body"
        " | (what | whatever) gave you that idea",
        heard="no [thanks] | nope", kind="reply", reason="I did not ask anything",
    ),
)  # fmt: skip
"""In order of trial, before all others."""
