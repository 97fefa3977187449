"""What a wording is: a sentence pattern, what it asks for, and what of it can be heard."""

from typing import Literal, NamedTuple

Action = Literal[
    "stop", "cancel", "continue", "yes", "no", "refuse", "greeting", "parting",
    "open_hand", "close_hand", "seen", "contents", "holding", "whereabouts", "where", "number", "say", "wait", "count",
    "wait_there", "come_back", "leave", "go", "remark", "untidy", "throw_away", "put_away", "tidy", "put", "put_near",
    "put_down", "deliver", "deliver_there", "fetch", "fetch_named", "pick_up", "find", "teach", "teach_owned", "forget",
    "name_place", "rule", "rule_always", "forget_rule", "rules", "belongs", "usual", "last_seen",
    "look_around", "check", "go_and_see", "mention", "put_back", "put_where", "again", "thanks",
    "recall", "wish_at", "named_at", "get", "put_held", "put_held_near",
    "exists", "is_at", "colour", "written", "beside", "extreme", "compare",
    "condition", "condition_not", "state", "state_not",
    "rooms", "doing", "done", "why", "origin", "abilities", "capacity", "limits", "hearing", "identity", "battery",
    "repeat", "swap", "go_there",
]  # fmt: skip
"""What a wording asks for; `services/planner/grammar/rules.py` has a function for each that can be planned."""
Kind = Literal["command", "reply", "name", "told"]
QUESTIONS: frozenset[Action] = frozenset(
    {
        "seen", "contents", "holding", "whereabouts", "where", "number", "recall", "exists", "is_at", "colour",
        "written", "beside", "extreme", "compare",
        "rooms", "doing", "done", "why", "origin", "abilities", "capacity", "limits", "hearing", "identity", "battery",
        "rules", "belongs", "usual", "last_seen", "repeat",
    }
)  # fmt: skip
"""What is answered in words."""
COURTESIES: tuple[Action, ...] = ("thanks", "greeting", "parting")
"""What is answered by a word of courtesy, and asks for nothing."""


class Wording(NamedTuple):
    """Sentences of `pattern` ask for `action`; in order of trial: the first that fits and can be done counts.

    `heard` is the part of it that the recogniser searches for, which hears each sentence the better the fewer there
    are; what is not in it is understood as far as the recogniser writes it down right without. Its slots are the parts
    of `speech.commands`.
    `kind`: a "command" may be joined to others by "and"; a "reply" is heard by itself only; a "name" is understood
    where nothing else was said; what is "told" beside a command is understood where no command is. `reason`: why the
    planner has no plan for it, as a clause; `lost`: unless they mean something else.
    """

    action: Action
    pattern: str
    heard: str = ""
    kind: Kind = "command"
    reason: str = ""
    lost: bool = False
