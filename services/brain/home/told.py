"""What a sentence tells of the home, for the pipeline without a planner. Pure."""

from common import messages as m
from common.household import Household
from common.language.clauses import without_fillers
from common.language.contractions import expand
from common.language.meaning import readings
from common.language.normalise import Words, normalise, without_determiners
from common.language.pattern import Slots
from common.language.politeness import without_politeness
from common.naming.part_names import kind_named
from common.plan_rules import is_destination
from common.tidy_rule import is_generic, rule_about


def edit_told(text: str, household: Household) -> m.HouseholdEdit | None:
    """The name or rule that a sentence tells or takes back, None if it does neither."""
    words = tuple(without_politeness(without_fillers(expand(normalise(text)))).split())
    for wording, slots in readings(words, "command"):
        match wording.action:
            case "name_place":
                edit = _name(slots, household)
            case "rule" | "rule_always":
                always = wording.action == "rule_always"
                edit = _rule(slots, household) if always or is_generic(slots["thing"]) else None
            case "forget_rule":
                edit = m.HouseholdEdit(do="forget rule", name=_bare(slots.get("words", ())))
            case "forget":
                edit = m.HouseholdEdit(do="forget", name=_bare(slots["words"]))
            case _:
                continue
        if edit is not None:
            return edit
    return None


def _name(slots: Slots, household: Household) -> m.HouseholdEdit | None:
    name, part = _bare(slots["words"]), _bare(slots.get("spot", ()))
    kind = kind_named(" ".join(slots.get("thing", slots["words"])))
    if part:
        return m.HouseholdEdit(do="name", name=name, part=part) if is_destination(part, household) else None
    known = kind is not None and len(slots.get("thing", ())) <= 1
    return m.HouseholdEdit(do="name", name=name, kind=kind or "") if known else None


def _rule(slots: Slots, household: Household) -> m.HouseholdEdit | None:
    surface = household.receptacle(_bare(slots["spot"]))
    if surface is None:
        return None
    return m.HouseholdEdit(do="rule", rule=rule_about(_bare(slots["thing"]), surface.name, household.words))


def _bare(words: Words) -> str:
    return " ".join(without_determiners(words))
