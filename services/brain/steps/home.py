"""Leaves that keep what people tell of their home: names of its parts, and where things belong."""

from collections.abc import Callable
from typing import get_args

from py_trees.common import Status

from common import messages as m
from common.tidy_rule import rule_about
from services.brain.mission.context import Context
from services.brain.steps.leaf import Leaf, Say
from services.brain.tree.composites import Sequence


def tell_home(ctx: Context, edit: Callable[[], m.HouseholdEdit], node_id: str, name: str) -> Sequence:
    """Keep what was told, and say what came of it."""
    keep = EditHousehold("keep", ctx, edit)
    return Sequence(node_id, keep, Say("say_done", ctx, lambda: done(ctx, edit(), keep.result)), name=name)


def edit_of(step: m.PlanStep, ctx: Context) -> m.HouseholdEdit:
    """The edit that a step of a plan stands for."""
    if step.action == "name":
        kinds: tuple[m.PartKind, ...] = get_args(m.PartKind)
        kind = next((k for k in kinds if k == step.target), None)
        return m.HouseholdEdit(do="name", name=step.text, part=step.object, kind=kind or "")
    if step.action == "rule":
        words = ctx.io.household.words
        return m.HouseholdEdit(do="rule", rule=rule_about(step.object, step.target, words))
    return m.HouseholdEdit(do="forget rule" if step.target == "rule" else "forget", name=step.text)


def done(ctx: Context, edit: m.HouseholdEdit, result: m.EditResult | None) -> str:
    """What is said of an edit that was kept."""
    name, was = (result.name, result.part) if result is not None else (edit.name, "")
    match edit.do:
        case "rule":
            return f"All right, {name} go {_at(ctx, was)} from now on."
        case "forget rule":
            return f"I have forgotten that {name} go {_at(ctx, was)}."
        case "forget":
            return f"I have forgotten the name {name}."
        case "name":
            before = f", the {was}" if was and was != name and not was.startswith("room ") else ""
            return f"I will call this{before} the {name} from now on."


def _at(ctx: Context, name: str) -> str:
    r = ctx.io.household.receptacle(name)
    return f"{'in' if r is not None and r.depth else 'on'} the {name}"


class EditHousehold(Leaf):
    """Keeps an edit; `result` is what came of it."""

    def __init__(self, node_id: str, ctx: Context, edit: Callable[[], m.HouseholdEdit]) -> None:
        super().__init__(node_id, ctx)
        self._edit = edit
        self.result: m.EditResult | None = None

    def update(self) -> Status:
        ctx, edit = self.ctx, self._edit()
        self.result = result = ctx.home.apply(edit)
        if result.ok:
            ctx.note(f"{edit.do}: {result.name}", result.part, "did")
            return Status.SUCCESS
        self.feedback_message = result.detail
        spoken = f"I did not keep that: {result.detail}."
        return ctx.fail("GROUNDING", result.code or "FAILED", result.detail, spoken)
