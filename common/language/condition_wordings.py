"""The wordings of what has to be so before something is done: `if there is a can on the desk`, `unless it is empty`."""

from common.language.wording import Wording

_THERE = "[left | there | anywhere]"
_FIND = "(find | see | spot | notice | discover | come across | have | got)"
_AT = "(in | on | at)"
_IS = "(is | are | looks | look)"

CONDITIONS: tuple[Wording, ...] = (
    Wording(
        "condition_not",
        f"if there (is | are) (no | not [any]) [more] <thing> {_THERE}"
        f" | if [you] (do not | can not | did not) {_FIND} [any] <thing> {_THERE}"
        f" | if <thing> (is | are) (not | no longer) [lying | standing] {_AT} <spot>"
        f" | unless there (is | are) [still | any] <thing> {_THERE} | unless [you] {_FIND} [any] <thing> {_THERE}"
        f" | unless <thing> (is | are) [still | already | lying | standing] {_AT} <spot>",
    ),
    Wording(
        "condition",
        f"if there (is | are) [still | any] <thing> {_THERE} | if [you] {_FIND} [any] <thing> {_THERE}"
        f" | if <thing> (is | are) [still | lying | standing] {_AT} <spot>",
    ),
    Wording("state", f"if <spot> {_IS} [still | very | too | a bit | all] <words>"),
    Wording("state_not", f"unless <spot> {_IS} [still | already | very | too | all] <words>"),
)
"""What is looked into before the rest of a sentence is carried out."""
EMPTY = frozenset({"empty", "clear", "tidy", "clean", "free"})
LITTERED = frozenset({"messy", "untidy", "dirty", "full", "cluttered", "a mess", "in a mess"})
"""States of a place that can be seen."""
