"""The wordings of putting, bringing, picking up and finding things."""

from common.language.lexicon import (
    BACK,
    BRING,
    DISCARD,
    FETCH,
    IT,
    MODAL,
    MOVE,
    MOVED,
    NEAR,
    ON,
    PERSON,
    PUT,
    SEEK,
    THROW,
    TIDY,
    WISH,
)
from common.language.wording import Wording

MOVING: tuple[Wording, ...] = (
    # Putting.
    Wording("put", f"({PUT}) (down <thing> | <thing> down) ({ON} | at) <spot>"),
    Wording(
        "put",
        f"(line | stack | pile | set | put | lay) (<thing> (up | out) | (up | out) <thing>) ({ON} | at) <spot>",
    ),
    Wording("put", f"(gather | collect | bring | get | put) <thing> together ({ON} | at) <spot>"),
    Wording("put", f"drop (off <thing> | <thing> off) ({ON} | at) <spot>"),
    Wording(
        "put_down",
        "put (down <thing> | back down <thing> | <thing> [back] down) | set (down <thing> | <thing> down)",
        heard="put (it | them) down",
    ),
    Wording("put_down", "(drop | release | let go of | let go) <thing> | let go", heard="release it | let go"),
    Wording(
        "put_near",
        f"({PUT}) <thing> {BACK} {NEAR} <spot>"
        f" | <thing> (belongs | belong | goes | go | (should | must | ought to | has to | have to | needs to | is to"
        f" | can) (go | stand | be | lie | sit)) (next to | near | beside | close to) <spot>"
        f" | keep <thing> (next to | near | beside | close to) <spot>",
        heard=f"(put | place | set) {IT} <near> | move <thing> <near>",
    ),
    Wording(
        "refuse",
        f"({PUT}) <thing> {BACK} (under | underneath | beneath | behind) <spot>",
        reason="I put things on or in others, but neither under nor behind them",
    ),
    Wording("put", f"chuck <thing> {BACK} ({ON} | to | at) <spot>"),
    Wording("throw_away", f"({THROW}) <thing> (away | out)", heard=f"throw {IT} away"),
    Wording("throw_away", f"({THROW}) (away | out) <thing> | ({DISCARD}) <thing>"),
    Wording("put_away", f"(put | {TIDY}) away <thing> | (put | {TIDY}) <thing> away", heard=f"put {IT} away"),
    Wording(
        "put_back",
        "(put | take | bring | return | set | place | move | carry) <thing> [back] (where | to where)"
        " (it | they | that) (was | were | came from | had been | stood | has been | belongs | used to be) [before]"
        " | (put | take | bring | return | set | place | move | carry) <thing> [back] (where | to where) (you | i)"
        " (found | got | took | had | picked | took) (it | them | that) [up] [from]"
        " | (put | place | set | take) <thing> back | return <thing> | take <thing> away | (undo | revert) <thing>"
        " | (put | take | bring | return) <thing> [back] (to its place | in its place)",
        heard="put (it | that) back [where it was]",
    ),
    Wording(
        "put_away",
        "put <thing> [back] (where (it belongs | they belong) | (in | to) its place | in order)"
        " | sort [out] <thing> | <thing> (needs | need) (putting | to be put) away",
    ),
    Wording(
        "put_where",
        f"({PUT} | bring | take | carry) <thing> [over] [to] where (<spot> (is | are | stands | lies) | (is | are) "
        f"<spot>)",
    ),
    Wording(
        "swap",
        "(swap | exchange | switch | trade) [over | around | round] <thing> [with <spot>] [over | around | round]"
        " | (swap | exchange | switch | change) the (places | positions) of <thing>"
        " | (make | let) <thing> (swap | change | trade | exchange | switch) (places | positions)",
    ),
    # Bringing.
    Wording("deliver_there", f"({MOVE} | {PUT}) <thing> ([over] there | in [there] too | (in | on) there)"),
    Wording("deliver_there", "<thing> (goes | belongs | go | can go | should go | is to go) there"),
    Wording(
        "fetch", f"({BRING} | find) (me | us) <thing> [back]", heard="(bring | fetch | get | give | hand) me <thing>"
    ),
    Wording(
        "fetch", f"({BRING} | move) <thing> [over | back] to (me | us)", heard="(bring | take | carry) <thing> to me"
    ),
    Wording("fetch", f"({FETCH}) (<thing> [back | over] here | <thing> (back | over) | (over | [over] here) <thing>)"),
    Wording(
        "put",
        f"({PUT}) <thing> {BACK} ({ON} | at | to) <spot>",
        heard=f"(put | place | set) {IT} <onto> | throw {IT} (in | into) <inside> | move <thing> (to <spot> | <onto>)",
    ),
    Wording(
        "deliver", f"({MOVE}) [me] <thing> {BACK} (to | into) <spot>", heard="(bring | take | carry) <thing> to <spot>"
    ),
    Wording("wish_at", "(bring | get | fetch | carry | have) <thing> (on | in) <spot>"),
    Wording("put", f"(take | deliver | move | shift | relocate | transfer | swap) <thing> {BACK} (on | in) <spot>"),
    Wording("put", f"({MOVE}) <thing> {BACK} onto <spot>"),
    Wording(
        "put", f"<thing> (belongs | belong | goes | go | can go | should be | should go | must go) ({ON} | to) <spot>"
    ),
    Wording(
        "put",
        f"(can | could | should | would | may | must) <thing> (go | be | get | come) [back | over] ({ON} | to) <spot>",
    ),
    Wording(
        "put",
        f"(can | could | should | must | may | shall | would) <thing> be {MOVED} {BACK} ({ON} | to) <spot>"
        f" | <thing> (should | must | has to | have to | needs to | need to | "
        f"ought to) be {MOVED} {BACK} ({ON} | to) <spot>",
    ),
    Wording("wish_at", "(have | get) <thing> back (on | in | into) <spot>"),
    Wording(
        "fetch",
        f"(can | could | should | would) <thing> be {MOVED} (here | over | to (me | us)) | have <thing> [over "
        f"| brought] [here]",
    ),
    Wording(
        "put",
        f"let <thing> (stand | be | go | sit | lie) {ON} <spot> | make sure [that] <thing> (is | are | "
        f"ends up | end up) {ON} <spot>",
    ),
    Wording(
        "pick_up",
        "(pick | take | grab | lift | gather | collect) up <thing> | pick <thing> up | lift <thing> [up]",
        heard="pick (up <thing> | <thing> up)",
    ),
    Wording("pick_up", "(get | take | grab) hold of <thing> | (hold | hang) on to <thing> | hold onto <thing>"),
    Wording("pick_up", "(grab | grasp | take | hold | pick | reach [for]) <thing>", heard="(grab | take) <thing>"),
    Wording("fetch", "(i | we) feel like [having | eating | drinking] <thing>"),
    Wording("find", f"({SEEK}) <thing>", heard="find <thing>"),
    Wording(
        "find",
        "check on <thing> | keep an eye (out | open) for <thing> | watch out for <thing>"
        " | (i | we) (can not | cannot | could not | did not) find <thing> [anywhere]"
        " | (i | we) [have] (lost | misplaced | mislaid) <thing>"
        " | (i | we) [have] (left | put) <thing> (somewhere | around here)"
        " | show me where <thing> (is | are) | (search | look | look around) [through | in] <spot> for <thing>"
        " | ((have | take) a look [around | round] | look (around | round)) for <thing>"
        " | (help me | try to) (look for | find | search for | locate) <thing>",
    ),
    Wording("get", f"({FETCH} | get) <thing>"),
    Wording("wish_at", f"{PERSON} {WISH} <thing> [to be] {ON} <spot>"),
    Wording("fetch", f"{PERSON} {WISH} <thing> [[over] here]"),
    Wording("put_near", f"{PERSON} {WISH} <thing> [to be] (next to | beside | close to) <spot>"),
    Wording("fetch", f"{MODAL} (i | we) (have | get) <thing> | let (me | us) (have | borrow | use | hold) <thing>"),
    Wording("fetch", f"{MODAL} i (trouble | bother | ask) you for <thing> | gimme <thing> | how about <thing>"),
    Wording(
        "fetch",
        "<thing> (would be (nice | great | good | lovely | perfect | welcome) | (will | would) do [nicely | fine])",
    ),
    Wording("fetch", "[is there] any chance of [getting | having] <thing>"),
    Wording("fetch", "(pick | grab | fetch | get) (me | us) up <thing>"),
    Wording("refuse", "(put | place | set) <thing>", reason="you did not say where to put it", lost=True),
)
"""In order of trial, as in the table that takes them in."""
