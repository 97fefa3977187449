"""Which recoveries follow a failed step of a plan, in the order they are tried.

To add one: write its two functions in a module beside this one, and a row here (docs/EXTENDING.md).
"""

from services.brain.recoveries.clarify import ask_which, several_match
from services.brain.recoveries.identify import ask_about_the_rest, ask_and_grab, ask_whether, may_be, remains_possible
from services.brain.recoveries.look_closer import look_at_the_rest, look_closer, unseen_from_near, unsure
from services.brain.recoveries.put_back import put_back, took_another
from services.brain.recoveries.put_right import needs_replacing, put_right
from services.brain.recoveries.recovery import Recovery
from services.brain.recoveries.regrasp import grab_failed, regrasp
from services.brain.recoveries.search import can_go_on, report_not_found, search
from services.brain.recoveries.step_back import may_have_fallen, step_back
from services.brain.steps.identify import not_plain

AFTER_LOOKING = (
    Recovery("several_match", several_match, ask_which),
    Recovery("look_closer", unsure, look_closer),
    Recovery("identify", may_be, ask_whether),
    Recovery("step_back", may_have_fallen, step_back),
    Recovery("search", can_go_on, search),
    Recovery("look_at_the_rest", unseen_from_near, look_at_the_rest),
    Recovery("identify_at_last", remains_possible, ask_about_the_rest),
    Recovery("not_found", can_go_on, report_not_found),
)
"""The object was not seen from where the robot stands, or several match."""

AFTER_GRASPING = (
    Recovery("took_another", took_another, put_back),
    Recovery("grab_failed", grab_failed, regrasp),
    Recovery("not_plain", not_plain, ask_and_grab),
)
"""The hand does not hold the object, or another one."""

AFTER_PUTTING_DOWN = (Recovery("lost_or_not_where_it_belongs", needs_replacing, put_right),)
"""The object was lost on the way, or does not stand where it belongs."""
