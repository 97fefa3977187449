"""What the peers answer, handed to the channels of their goals."""

from common import messages as m
from common import topics
from services.brain.mission.asides import Asides
from services.brain.mission.channel import Channel, GoalStatus, Result
from services.brain.mission.context import Context
from services.brain.mission.remarks import Remarks

_NAVIGATION: dict[m.NavStatus, GoalStatus] = {"navigating": "busy", "arrived": "ok", "failed": "failed"}
_MANIPULATION: dict[m.ManipStatus, GoalStatus] = {"executing": "busy", "done": "ok", "failed": "failed"}


def receive_statuses(ctx: Context, asides: Asides, remarks: Remarks) -> None:
    """Hand every status and answer of the peers to the channel of its goal."""
    io, peers = ctx.io, ctx.peers
    for status in io.take_all(topics.NAVIGATION_STATUS):
        _handle(peers.navigation, status, _NAVIGATION.get(status.status), status.code, status.detail)
    for feedback in io.take_all(topics.NAVIGATION_FEEDBACK):
        remarks.hear(feedback, ctx.now)
        if peers.navigation.goal_id and feedback.goal_id == peers.navigation.goal_id:
            _handle(peers.navigation, feedback, _NAVIGATION.get(feedback.status), feedback.code, "")
    for done in io.take_all(topics.MANIPULATION_STATUS):
        detail = done.detail or done.phase
        _handle(peers.manipulation, done, _MANIPULATION.get(done.status), done.code, detail)
    for heard in io.take_all(topics.SPEECH_RESULT):
        text = heard.text.strip()
        if text:
            status_: GoalStatus = "failed" if text == "ERROR" else "ok"
            _handle(peers.speech, heard, status_, heard.code, heard.detail)
    for speech in io.take_all(topics.SPEECH_STATUS):
        ctx.voice.speaking = speech
    for plan in io.take_all(topics.ACTION_PLAN):
        if not asides.answered(plan):
            peers.planner.handle_status(plan.request_id, 0, Result("ok", message=plan))
    for pose in io.take_all(topics.OBJECT_POSE):
        peers.perception.handle_status(pose.query_id, 0, Result("ok", message=pose))
    for taught in io.take_all(topics.TAUGHT):
        if taught.goal_id == peers.perception.goal_id:  # the page and the command line teach as well
            peers.perception.handle_status(taught.goal_id, taught.attempt, Result("ok", message=taught))


def _handle(channel: Channel, message: m.Message, status: GoalStatus | None, code: str, detail: str) -> None:
    if status is not None:  # `idle` of a service that has just started is no answer
        goal_id, attempt = getattr(message, "goal_id", ""), getattr(message, "attempt", 0)
        channel.handle_status(goal_id, attempt, Result(status, code, detail, message))
