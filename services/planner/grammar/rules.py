"""The grammar rules: what each action of the wordings' table does to the plan under construction."""

from collections.abc import Callable

from common.language.meaning import readings
from common.language.normalise import Words
from common.language.pattern import Slots
from common.language.wording import Action, Kind
from common.messages import SENSELESS
from services.planner.commands import (
    about_itself,
    answers,
    bringing,
    conditions,
    going,
    hand,
    home,
    looking,
    queries,
    query_forms,
    remarks,
    tidying,
)
from services.planner.plan_builder import Lost, PlanBuilder, Refusal

ACTIONS: dict[Action, Callable[[PlanBuilder, Slots], None]] = {
    "open_hand": hand.open_hand,
    "close_hand": hand.close_hand,
    "seen": looking.seen,
    "contents": looking.contents,
    "holding": answers.holding,
    "whereabouts": answers.whereabouts,
    "where": answers.where,
    "number": queries.number,
    "say": going.say,
    "wait": going.wait,
    "count": going.count,
    "wait_there": going.wait_there,
    "come_back": going.come_back,
    "leave": going.leave,
    "go": going.go,
    "go_there": going.go_there,
    "remark": remarks.remark,
    "untidy": remarks.untidy,
    "throw_away": tidying.throw_away,
    "put_away": tidying.put_away,
    "tidy": tidying.tidy,
    "put": bringing.put,
    "put_near": bringing.put_near,
    "put_down": hand.put_down,
    "deliver": bringing.deliver,
    "deliver_there": bringing.deliver_there,
    "fetch": bringing.fetch,
    "get": bringing.get,
    "fetch_named": bringing.fetch_named,
    "pick_up": hand.pick_up,
    "find": going.find,
    "teach": remarks.teach,
    "teach_owned": remarks.teach_owned,
    "forget": remarks.forget,
    "name_place": home.name_place,
    "rule": home.rule,
    "rule_always": home.rule_always,
    "forget_rule": home.forget_rule,
    "rules": home.rules,
    "belongs": home.belongs,
    "usual": home.usual,
    "last_seen": home.last_seen,
    "mention": remarks.mention,
    "put_back": bringing.put_back,
    "swap": bringing.swap,
    "put_where": bringing.put_where,
    "wish_at": bringing.wish_at,
    "named_at": bringing.named_at,
    "put_held": bringing.put_held,
    "put_held_near": bringing.put_held_near,
    "again": remarks.again,
    "look_around": looking.look_around,
    "go_and_see": looking.go_and_see,
    "check": looking.check,
    "recall": looking.recall,
    "exists": looking.exists,
    "is_at": looking.is_at,
    "colour": answers.colour,
    "written": answers.written,
    "beside": answers.beside,
    "extreme": answers.extreme,
    "compare": answers.compare,
    "condition": conditions.condition,
    "condition_not": conditions.condition_not,
    "state": conditions.state,
    "state_not": conditions.state_not,
    "doing": about_itself.doing,
    "done": about_itself.done,
    "why": about_itself.why,
    "origin": about_itself.origin,
    "abilities": about_itself.abilities,
    "capacity": about_itself.capacity,
    "limits": about_itself.limits,
    "hearing": about_itself.hearing,
    "identity": about_itself.identity,
    "battery": about_itself.battery,
    "rooms": about_itself.rooms,
    "repeat": about_itself.repeat,
    "thanks": about_itself.thanks,
    "greeting": about_itself.greeting,
    "parting": about_itself.parting,
}


class NoWording(Lost):
    """No wording fits the words."""


def apply_first(words: Words, builder: PlanBuilder, *kinds: Kind) -> Refusal | None:
    """Carry out the first reading of a clause that can be done, in the table's order.

    None when one was; else the reason against the first that fits.
    """
    if "command" in kinds and (known := query_forms.answer(words, builder)) is not None:
        builder.say(known)
        return None
    reason: Refusal = NoWording(f"{SENSELESS} {' '.join(words)!r}")
    for wording, slots in readings(words, *kinds):
        trial = builder.fork()
        try:
            if wording.reason:
                raise (Lost if wording.lost else Refusal)(wording.reason)
            ACTIONS[wording.action](trial, slots)
        except Refusal as refusal:
            reason = refusal if isinstance(reason, NoWording) else reason
            continue
        builder.adopt(trial)
        return None
    return reason
