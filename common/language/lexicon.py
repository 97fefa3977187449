"""Words that ask for the same, as options of a pattern: a synonym is one more word here and stands in every wording."""

from common.kinds import KINDS
from common.naming.names import ALIKE

BRING = (
    "bring | fetch | get | give | hand | pass | grab | take | carry | retrieve | chuck | toss | throw | slide | lend"
    " | deliver"
)
"""Verbs of bringing that need a receiver: `grab me the mug`."""
FETCH = "bring | fetch | get | give | hand | pass | carry | retrieve | collect | gather"
"""Verbs of bringing that need none."""
PICK = "(get | fetch | take | grab | pick | pick up | collect | gather | collect up | gather up | round up)"
"""The first half of moving something: `get the mug and put it away`."""
PUT = (
    "put | stand | sort | place | set | throw | toss | drop | lay | stick | move | stack | pop | slide | leave | shift"
    " | chuck | yeet | dump | relocate | shove | jam | tuck | deposit | stow | plop | plonk | stash | sling "
    "| fling | transfer"
)
MOVE = (
    "bring | take | carry | deliver | transport | move | get | fetch | return | shift | relocate | transfer | "
    "swap | haul"
    " | convey | switch | send"
)
"""Verbs of moving to a place that is named with "to"."""
THROW = "throw | toss | chuck | yeet"
DISCARD = "trash | chuck | discard | recycle | bin | get rid of | dispose of | ditch | junk"
TIDY = "tidy | clean | clear | declutter | straighten | neaten | sort out | organise | organize"
GO = (
    "drive | navigate | move | walk | return | head | come | roll | run | nip | pop | travel | proceed | hop | "
    "dash | hurry"
    " | rush | wander | stroll | step"
)
SEEK = (
    "find | search for | look for | locate | show me | track down | hunt for | hunt down | seek | look out for | spot"
)
LOOK = (
    "(look | peek | check | see | (have | take) a [quick | good | little | short] (look | peek | glance) | find out"
    " | verify | make sure)"
)
MODAL = "(can | could | may | might)"
WISH = (
    "(want | wants | need | needs | require | would like | would love | would prefer | prefer | "
    "fancy | could [really]"
    " (use | do with) | am after | would rather have)"
)
FAMILY = (
    "(wife | husband | partner | mother | father | mum | mom | mummy | mommy | mama | dad | daddy | papa | son"
    " | daughter | child | kids | children | baby | boss | guest | guests | friend | grandma | grandpa | granny | gran"
    " | nana | grandad | boy | girl | family | brother | sister | aunt | auntie | uncle | nephew | niece | cousin"
    " | parents | grandparents | friends | neighbour | neighbours | visitor | visitors | colleague"
    " | colleagues | flatmate | twins | folks)"
)
PEOPLE = f"([(my | our | the)] {FAMILY} | them | everybody | everyone | people | anybody | anyone | the others)"
PERSON = f"(i | we | he | she | they | (my | our | the) {FAMILY})"
"""Who wants something."""
MOVED = "(put | placed | moved | brought | taken | carried | set | returned | transferred | dropped | left)"
# Words around them.
ON = "(in | into | inside | on top of | on | onto | upon)"
NEAR = "(next to | near | beside | [right] (close | closer | nearer) to | by | with | alongside | together with)"
BACK = "[back | over | straight | down | away]"
"""Particles between an object and its place that change nothing."""
IT = "(<thing> | it | them)"
ASK = (
    "[[can you | could you] tell me | remind me | explain [to] me | let me know"
    " | [do you | would you | might you | (does | do) (anybody | anyone | somebody | someone)] "
    "[happen to] (know | remember | recall) | [have you [got]] any (idea | clue)"
    " | [go and] (find out | see | check) | i wonder | so | and"
    " | (did | do) you (see | notice | remember)]"
)
BE = "(is | are | was | were)"
LYING = "lying around | lying about | standing around | lying | standing | sitting | left"
"""What things do where they are."""
COMMANDING: frozenset[str] = frozenset(
    option.split()[0]
    for verbs in (
        BRING,
        FETCH,
        PUT,
        MOVE,
        THROW,
        DISCARD,
        TIDY,
        GO,
        SEEK,
        "go | visit | pick | wait | say | tell | sort | check | put",
    )
    for option in verbs.split(" | ")
) - {"bin", "roll", "pop"}
"""First words that make a clause a command; without those that are rather nouns."""
A_VERB = rf"(?:{'|'.join(sorted(COMMANDING))})"
"""Regular expression for one of the words in COMMANDING."""
TO_GO = rf"(?:go|{'|'.join(GO.split(' | '))})"
"""Regular expression for a verb of going."""
A_WISH = r"(?:i|we) (?:really |would |do )*(?:want|need|like|fancy)"
"""How somebody says that they want something."""
COLOURS = ALIKE.keys() - KINDS.keys()
"""Words for colours that are no things as well."""
A_COLOUR = rf"(?:{'|'.join(sorted(COLOURS))})"
HANDLING: frozenset[str] = frozenset(
    option.split()[0]
    for verbs in (BRING, FETCH, PUT, MOVE, THROW, DISCARD, TIDY, "pick")
    for option in verbs.split(" | ")
) - {"bin", "roll", "pop"}
"""The verbs among them of what is done to a thing."""
PAIRED = (
    r"(?:scissors|shears|clippers|secateurs|pliers|pincers|tweezers|tongs|(?:sun)?glasses|spectacles|goggles|binoculars|"
    r"(?:head|ear)phones|earbuds|trousers|jeans|shorts|tights|leggings|pyjamas|socks|shoes|slippers|boots|sandals|gloves)"
)
"""Nouns of which a pair is one thing: `a pair of scissors`."""
