"""Parts that both pipelines have: the way home, and the report of what failed."""

from py_trees.behaviour import Behaviour

from common.approach import delivers_at_home
from services.brain.mission.context import Context
from services.brain.mission.mission import Failure
from services.brain.steps.leaf import Call, Say
from services.brain.steps.motion import Navigate
from services.brain.tree.composites import Sequence


def drive_home(ctx: Context, carrying: bool = False) -> Behaviour:
    """Drive back to where the mission began; when `carrying`, to the surface that things are brought to."""
    household = ctx.io.household
    elsewhere = carrying and not delivers_at_home(household)
    return Navigate(
        "return",
        ctx,
        text=lambda: f"goto {household.delivery}" if elsewhere else "return_to_start",
        spoken=lambda: "I could not come back" + (f" with the {ctx.gripper.holding}." if ctx.gripper.holding else "."),
        state="RETURNING",
        place=household.delivery if elsewhere else household.home.name,
    )


def report_failure(ctx: Context) -> Behaviour:
    """ERROR with a published and a spoken reason; never fails and never hangs. What a person called off is no error."""
    return Sequence(
        "report_failure",
        Call("error", ctx, lambda: enter_error(ctx)),
        Say("say_why", ctx, lambda: spoken_reason(ctx)),
    )


def enter_error(ctx: Context) -> None:
    """End the mission by its last failure, and show it."""
    mission = ctx.mission
    failure = mission.failure or Failure(ctx.state, "INTERNAL", spoken="Something went wrong.")
    mission.failure = failure
    reason = failure.reason + ctx.gripper.note
    if failure.stage == "CONFIRMING" and failure.code == "CANCELLED":
        ctx.end_mission("cancelled", reason)
    else:
        ctx.end_mission("failed", reason)
        ctx.show_state("ERROR", step=failure.stage, detail=reason)
    ctx.voice.listen_after = ctx.now + ctx.config.settle


def spoken_reason(ctx: Context) -> str:
    """What is said of the failure, and of what is still in the hand."""
    failure = ctx.mission.failure
    text = failure.spoken if failure else ""
    return f"{text} I am still holding the {ctx.gripper.holding}." if ctx.gripper.holding else text
