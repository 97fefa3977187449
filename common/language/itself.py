"""Questions about the robot itself, by the words of which they are made and not by their order. Pure.

A row names an action and groups of words: a question with a word of each group is about it. In order of trial.
"""

import re
from typing import NamedTuple

from common.language.frame import SMALL_TALK
from common.language.normalise import Words
from common.language.wording import Action

_YOU = "you your yourself yours robot"
_DONE = "do doing done finish finished manage managed accomplish accomplished achieve achieved succeed succeeded"
_ABILITY = "skill skills ability abilities capability capabilities talents job jobs function functions purpose good"
_TASKS = "do help jobs job things tasks task chores work stuff tricks ask say orders at for best handle manage"
_ROWS: tuple[tuple[Action, str], ...] = (
    ("battery", "battery batteries charge charging charged recharge recharging power juice energy plugged + you "
                "your the"),
    ("why", f"why + {_YOU} + fail failed give given stop stopped manage work worked not"),
    ("why", "what + wrong problem trouble matter issue happened reason"),
    ("why", "where + did have + you + look looked search searched check checked"),
    ("rooms", f"rooms places + know are there {_YOU}"),
    ("rooms", "where + can could + you + go drive"),
    ("limits", "how + big wide large strong far + hand hands gripper claw fingers arm + your"),
    ("holding", f"hand hands gripper claw fingers holding carrying grasping gripping + {_YOU} the + what anything "
                f"something is are have empty free full"),
    ("holding", "what anything something + have + you + got carry hold"),
    ("identity", "who + you i + are am"),
    ("identity", "name + you your"),
    ("identity", "who + made built created invented + you"),
    ("hearing", "are can do did + you + listening hear hearing awake asleep understand understood + you me yet still "
                "there english"),
    ("identity", "call called + what + you your + should shall do can are"),
    ("identity", "tell + about yourself + yourself"),
    ("identity", "introduce describe + yourself"),
    ("identity", "are + you + human real alive person machine robot computer ai man woman somebody"),
    ("holding", "what + have + you + picked grabbed taken"),
    ("abilities", "explain + what + you + do"),
    ("doing", "almost nearly + done finished ready there"),
    ("abilities", "how + can could + i we + use of you + you"),
    ("abilities", f"what how which + can could should able capable + you i we + {_TASKS}"),
    ("abilities", f"what how which + are is + you your + {_ABILITY} capable able"),
    ("doing", "any + luck joy success progress"),
    ("abilities", "anything something + you + can not able"),
    ("capacity", "can could do able + you + carry hold lift take bring fetch manage + two three several many more once "
                 "both"),
    ("limits", "how + much heavy high far low fast quick quickly big wide strong tall large + can could do are does "
               "is + you your + carry lift reach hold bring drive go move grab grip strong fast tall big heavy hand "
               "arm"),
    ("limits", "what how which + heaviest biggest highest fastest widest largest limit limits limitations speed "
               "payload strength weight weigh height reach + you your"),
    ("limits", "can could able do + you + stairs steps upstairs downstairs climb"),
    ("doing", "are is + you everything + alright ok okay right well fine"),
    ("doing", "where + you + going headed off heading"),
    ("doing", "what + did was i + i we + ask asked tell told want wanted say said order ordered + you"),
    ("doing", "how + long longer far much soon + take takes taking need until till you it this that more longer"),
    ("doing", "when + will are is + you it that this + done finished ready back through"),
    ("doing", "what + keeping taking delay delaying hold holding holdup + you so long it up is"),
    ("done", "what + did have has was were been + you + just last before far today to " + _DONE),
    ("done", f"last + task job mission command thing order + {_YOU} what"),
    ("done", "how + did + it that + go"),
    ("done", f"did + you it that everything + {_DONE} work go well out"),
    ("done", "have + you it that everything + done finished managed succeeded worked gone"),
    ("doing", "are is + you it that we + done finished ready through nearly almost yet soon busy there"),
    ("doing", "what how why + are is + you + doing up busy working going happening on coming getting standing waiting"),
    ("doing", "how + are is + you it things everything + going coming getting are"),
    ("doing", "what + is + happening going task job mission + on your current happening present"),
    ("doing", "what + next + is are do you comes now"),
    ("doing", "status report update news + status report update news any give your the"),
    ("whereabouts", "where whereabouts room + you + are standing at"),
    ("why", "why"),
)  # fmt: skip


class _Topic(NamedTuple):
    action: Action
    groups: tuple[frozenset[str], ...]


_TOPICS = tuple(_Topic(action, tuple(frozenset(g.split()) for g in row.split(" + "))) for action, row in _ROWS)
WORDS: frozenset[str] = frozenset[str]().union(*(group for topic in _TOPICS for group in topic.groups))
_REST = (
    "level state indicate house flat home apartment place many had else left along whole long we low enough use full "
    "make remind most much go up down"
)
_SMALL = (SMALL_TALK | WORDS | set(_REST.split())) - {"and"}
_ASKED = re.compile(
    r"^(?:and |so |but |well |now |"
    r"(?:(?:tell|remind) (?:me|us)|explain|i wonder|do you know|any idea|is it)(?: if| whether)? )*"
    r"(?:what|who|where|whereabouts|why|how|when (?:will|are|is)|which|is|are|am|do|does|did|have|has|was|were|can|"
    r"could|any|anything|got|state|indicate|(?:in|on) (?:what|which)|status|report|your|almost|nearly|"
    r"(?:a bit )?about yourself|introduce|describe|"
    r"give (?:me|us) (?:a|an|your))\b"
)
"""How such questions begin."""


def about_itself(words: Words, wholly: bool = True) -> Action | None:
    """What of the robot itself the words ask for; None if they do not. `wholly`: they have no other words."""
    said = frozenset(words)
    if not _ASKED.match(" ".join(words)) or (wholly and not _SMALL.issuperset(said)):
        return None
    return next((t.action for t in _TOPICS if all(map(said.intersection, t.groups))), None)
