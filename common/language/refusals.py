"""The wordings of what a robot with one arm and wheels cannot do, each with its reason.

A later wording that can be planned goes before the reason; the verbs stand before a determiner or a pronoun, since many
of them are nouns, too ("water bottle").
"""

from common.language.lexicon import ASK, FAMILY
from common.language.wording import Wording

_ALL_I_DO = "I can fetch, carry and tidy things and tell you what I saw, but not that"
_IT = "(the | a | an | my | our | your | his | her | this | that | these | those | some | all | me | us | it | them)"
_PEOPLE = f"(me | us | him | her | [(my | our | the | your)] {FAMILY})"


def _acts(verbs: str, reason: str) -> Wording:
    return Wording("refuse", f"({verbs}) {_IT} [<words>]", reason=reason)


REFUSALS: tuple[Wording, ...] = (
    Wording(
        "refuse", "(go | come | drive | climb | get | take <words>) (up | down) (the | those | some) (stairs | steps)"
        " | [<words>] (upstairs | downstairs) | climb <words>", reason="I drive on one floor and cannot climb",
    ),
    Wording("refuse", "follow <words>", heard="follow me", reason="I cannot follow people"),
    Wording(
        "refuse", "(open | close | shut | lock | unlock) <words>", heard="(open | close) the <openable>",
        reason="I cannot open or close doors, drawers or lids",
    ),
    Wording(
        "refuse",
        f"(turn | switch) (on | off) <words> | (turn | switch) {_IT} <words> (on | off) [<words>] | dim the lights"
        f" | (put | turn | switch) {_IT} (light | lights | lamp | telly | tv | radio | music | heating | kettle | oven)"
        " (on | off)",
        reason="I cannot switch things on or off",
    ),
    _acts(
        "cook | bake | fry | roast | toast | heat | warm | reheat | brew | grill | microwave | peel | chop | slice"
        " | mix | stir | prepare | pour | fill | refill | water | feed",
        "I can bring things, but neither cook, pour nor feed",
    ),
    Wording("refuse", f"make {_IT} <words>", reason="I can bring things, but not make any", lost=True),
    Wording(
        "refuse",
        "(take | shoot | snap | make | get) (a | an | some | another) (picture | photo | photograph | selfie | video)"
        " [of <words>] | (photograph | film) <words>",
        reason="I take no pictures for people; my page shows what I see",
    ),
    _acts(
        "wash | rinse | scrub | wipe | sweep | vacuum | hoover | mop | dust | polish | iron | launder",
        "I can put things away, but neither wash, wipe nor sweep",
    ),
    Wording(
        "refuse",
        "give [<words>] (a | an | another) [good | quick | gentle | big | proper | little] (rub | scrub | wipe | wash"
        " | rinse | polish | shake | stir | massage | kick | push | hug | kiss | cuddle | pat | stroke | squeeze)",
        reason=_ALL_I_DO,
    ),
    Wording(
        "refuse",
        "do (the | some | my | our) (washing | dishes | laundry | ironing | cooking | hoovering | cleaning | vacuuming"
        " | shopping | homework | beds) [up]",
        reason=_ALL_I_DO,
    ),
    _acts(
        "fix | repair | mend | charge | break | smash | burn | kill | hurt | hit | kick | paint | draw | cut | play"
        " | read | sing | dance | push | jump | fly | buy | sell",
        _ALL_I_DO,
    ),
    Wording(
        "refuse",
        "(sing | dance | jump | fly) [<words>] | play <words> | tell (me | us) (a | another) (joke | story)"
        " | order (me | us) <words>",
        reason=_ALL_I_DO,
    ),
    Wording(
        "refuse",
        f"(phone | telephone | email | message | text) {_IT} [<words>] | (phone | telephone | call | ring) ({_PEOPLE}"
        " | (the | an | a) (doctor | nurse | ambulance | police | taxi | plumber) | for help)",
        reason="I cannot call anybody",
    ),
    Wording(
        "refuse", f"(carry | lift | push | walk | drive) {_PEOPLE} [<words>]", reason="I cannot carry people", lost=True
    ),
    Wording(
        "refuse",
        f"(keep (an | your) eye on | watch over | look after | guard | babysit) <words> | watch {_IT} <words>",
        reason="I cannot keep watch over anything",
    ),
    Wording(
        "refuse",
        f"{ASK} what (time | day | date | year | month) (is it | it is) [<words>] | {ASK} what is the (time | date"
        f" | day) [<words>] | have you [got] the time",
        reason="I know neither the time of day nor the date",
    ),
    Wording(
        "refuse", f"{ASK} whose <words> | {ASK} who owns <words> | {ASK} who (does | do) <words> belong to",
        reason="I do not know what belongs to whom",
    ),
    Wording(
        "refuse",
        "remind (me | us) (to | of | in | at | about | that) <words> | wake (me | us) <words> | set (a | an | the | my)"
        " (alarm | timer | clock) [<words>]",
        reason="I cannot remind anybody of anything",
    ),
    Wording(
        "refuse", f"{ASK} (what | how) is the (weather | news | temperature) [<words>]",
        reason="I know nothing but this home",
    ),
)  # fmt: skip
