"""A mission driven from outside, with something done to the robot in the middle of it."""

from collections.abc import Callable

from cli.link import Link
from cli.missions.conversation import Conversation
from cli.missions.verdict import Verdict, Witness
from common import messages as m
from common import topics
from common.scene import load_scene
from common.time.clock import monotonic


def carry_out(
    link: Link, thing: str, disturb: dict[str, Callable[[], None]], timeout: float, show: Callable[[str], None] = print
) -> Verdict:
    """Ask for `thing` by typed text; `disturb[state]` runs once, a little after the brain enters that state."""
    scene = load_scene("apartment")
    witness = Witness(link, scene, thing)
    pending = dict(disturb)
    since: dict[str, float] = {}

    def seen(state: m.BrainState) -> None:
        show(f"{state.t:8.1f} s  {state.state}  {state.step}  {state.detail}")
        since.setdefault(state.state, state.t)

    def idle() -> None:
        witness.look()
        name = talk.state.state
        if name in pending and witness.now - since[name] > 1.0:
            pending.pop(name)()

    talk = Conversation(link, seen)
    end = monotonic() + 60
    while talk.closed():
        assert monotonic() < end, talk.closed()
        talk.refresh()
    witness.begin()
    link.send(topics.VOICE_COMMAND, m.VoiceCommand(text=f"bring me the {thing}", confirmed=True))
    assert talk.accepted(20.0), f"not accepted: {talk.state}"
    outcome = talk.outcome(timeout, idle)
    assert not pending, f"never came to {list(pending)}: {outcome}"
    verdict = witness.judge()
    if outcome.outcome != "delivered":
        return Verdict(False, f"{outcome.outcome}: {outcome.reason}; {verdict.why}")
    return verdict
