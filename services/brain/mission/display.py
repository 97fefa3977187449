"""The mission as the world sees it: `brain/state`, `system_status`, and the transitions in the log."""

import msgspec

from common import messages as m
from common import topics
from common.bus.port import Io
from services.brain.mission.mission import SYSTEM_STATE, Mission, Outcome


class Display:
    """What is shown now, and how the last mission ended."""

    def __init__(self, io: Io, pipeline: str, last: m.MissionOutcome | None) -> None:
        self._io, self._pipeline = io, pipeline
        self.last = last
        self.shown = m.BrainState(state="IDLE", pipeline=pipeline, detail="starting", last=last)
        self._publish()

    def show(
        self,
        mission: Mission,
        t: float,
        state: m.BrainStateName,
        step: str,
        detail: str,
        plan_step: int,
        resumable: bool,
    ) -> m.BrainState | None:
        """Show a state at robot time `t` [s]; what was shown before when it differs by more than time, else None."""
        running = mission.active or state in ("COMPLETED", "ERROR")
        if self.last is not None and self.last.resumable != resumable:
            self.last = msgspec.structs.replace(self.last, resumable=resumable)
        before, about = self.shown, mission.search.about
        now = m.BrainState(
            state=state,
            t=t,
            mission_id=mission.id if running else "",
            command=mission.command if running else "",
            step=step,
            detail=detail,
            started=mission.started if running else 0.0,
            pipeline=self._pipeline,
            last=self.last,
            plan_step=plan_step if mission.active else 0,
            command_id=mission.command_id if running else "",
            offered=[p.position for p in about] if state == "CONFIRMING" else [],
        )
        if now == msgspec.structs.replace(before, t=t):
            return None
        self.shown = now
        self._publish()
        was, is_now = SYSTEM_STATE[before.state], SYSTEM_STATE[state]
        if was != is_now:
            self._io.log.info(f"State: {was} -> {is_now}")
        return before

    def ended(self, mission: Mission, outcome: Outcome, reason: str, t: float) -> None:
        """Keep how a mission ended; shown with the next state."""
        failure = mission.ended_by
        self.last = m.MissionOutcome(
            id=mission.id,
            command=mission.command,
            outcome=outcome,
            reason=reason,
            t=t,
            stage=failure.stage,
            code=failure.code,
            spoken=failure.spoken,
            command_id=mission.command_id,
        )

    def _publish(self) -> None:
        self._io.publish(topics.BRAIN_STATE, self.shown)
        status = m.SystemStatus(
            state=SYSTEM_STATE[self.shown.state],
            mission_id=self.shown.mission_id,
            detail=self.shown.detail or self.shown.step,
        )
        self._io.publish(topics.SYSTEM_STATUS, status)
