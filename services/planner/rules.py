"""The grammar rules: what each action of the wordings' table does to the plan under construction."""

from collections.abc import Callable

from common.language.meaning import readings
from common.language.normalise import Words
from common.language.pattern import Slots
from common.language.wording import Action, Kind
from services.planner import about_itself, actions, answers, conditions, home, teaching, tidying
from services.planner.plan_builder import PlanBuilder, Refusal

ACTIONS: dict[Action, Callable[[PlanBuilder, Slots], None]] = {
    "open_hand": actions.open_hand,
    "close_hand": actions.close_hand,
    "seen": answers.seen,
    "contents": answers.contents,
    "holding": answers.holding,
    "whereabouts": answers.whereabouts,
    "where": answers.where,
    "number": answers.number,
    "say": actions.say,
    "wait": actions.wait,
    "wait_there": actions.wait_there,
    "come_back": actions.come_back,
    "go": actions.go,
    "remark": actions.remark,
    "untidy": actions.untidy,
    "throw_away": tidying.throw_away,
    "put_away": tidying.put_away,
    "tidy": tidying.tidy,
    "put": actions.put,
    "put_near": actions.put_near,
    "put_down": actions.put_down,
    "deliver": actions.deliver,
    "deliver_there": actions.deliver_there,
    "fetch": actions.fetch,
    "fetch_named": actions.fetch_named,
    "pick_up": actions.pick_up,
    "find": actions.find,
    "teach": teaching.teach,
    "forget": teaching.forget,
    "name_place": home.name_place,
    "rule": home.rule,
    "rule_always": home.rule_always,
    "forget_rule": home.forget_rule,
    "rules": home.rules,
    "belongs": home.belongs,
    "usual": home.usual,
    "last_seen": home.last_seen,
    "mention": actions.mention,
    "put_back": actions.put_back,
    "put_where": actions.put_near,
    "wish_at": actions.wish_at,
    "named_at": actions.named_at,
    "again": actions.again,
    "look_around": answers.look_around,
    "go_and_see": answers.go_and_see,
    "check": answers.check,
    "recall": answers.recall,
    "exists": answers.where,
    "is_at": answers.where,
    "colour": answers.colour,
    "beside": answers.beside,
    "kinds": answers.number,
    "extreme": answers.extreme,
    "condition": conditions.condition,
    "doing": about_itself.doing,
    "done": about_itself.done,
    "why": about_itself.why,
    "origin": about_itself.origin,
    "abilities": about_itself.abilities,
    "identity": about_itself.identity,
    "rooms": about_itself.rooms,
    "thanks": about_itself.thanks,
}


def apply_first(words: Words, builder: PlanBuilder, *kinds: Kind) -> str | None:
    """Carry out the first reading of a clause that can be done, in the table's order.

    None when one was; else the reason against the first that fits, "" when none fits.
    """
    reason = ""
    for wording, slots in readings(words, *kinds):
        trial = builder.fork()
        try:
            if wording.reason:
                raise Refusal(wording.reason)
            ACTIONS[wording.action](trial, slots)
        except Refusal as refusal:
            reason = reason or str(refusal)
            continue
        builder.adopt(trial)
        return None
    return reason
