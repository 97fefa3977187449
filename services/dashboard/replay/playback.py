"""`python -m services.dashboard.replay.playback FILE`: the page fed from a recording, with a time slider.

`tidybot replay FILE --view` becomes this.
"""

import argparse
import sys
from bisect import bisect_right
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import msgspec

from common import messages as m
from common import topics
from common.bus import codec
from common.bus.memory import MemoryBus, MemoryIo
from common.bus.worker import WorkerJob
from common.household import load_household
from common.mission_log import recorded
from common.mission_log.states import OTHER_STATE, STATE_COLOURS, spans
from common.mission_log.transcript import Transcript
from common.process.host import StopSignal
from common.recording import Recording, RecordingError, Row
from common.runtime import StartError
from common.time.clock import monotonic
from services.dashboard.config import DashboardConfig
from services.dashboard.service import DashboardService
from services.dashboard.web.events import Words

FRAME = 1 / 30
"""Period of the page's steps [s]."""
SPEEDS = (0.5, 1.0, 2.0, 4.0, 8.0)
"""Robot seconds per second that a visitor may choose."""
TALK = (topics.SPEECH_GOAL.key, topics.SPEECH_RESULT.key)


class TapeIo(MemoryIo):
    """Knows from the recording who was alive, and answers for the brain's journal."""

    def __init__(self, bus: MemoryBus, missions: list[recorded.Record]) -> None:
        reads, writes = DashboardService.READS, DashboardService.WRITES
        super().__init__(
            bus,
            DashboardService.NAME,
            reads,
            writes,
            household=load_household("minimal"),
            lockstep=False,
            log_level="warning",
        )
        self._missions = missions
        self.alive: dict[str, bool] = {}

    def peer(self, name: str) -> str | None:
        """ "" while the recorded service was alive, else None."""
        return "" if self.alive.get(name) else None

    def ask(self, key: str, request: bytes = b"") -> WorkerJob[bytes | None]:
        """Answer for the brain's mission log; None for any other key."""
        wanted = msgspec.json.decode(request).get("id") if request else None
        rows = [r for r in self._missions if wanted in (None, r["id"])]
        if key != topics.BRAIN_MISSIONS:
            answer = None
        elif wanted is None:
            answer = msgspec.json.encode([{**row, "entries": []} for row in rows])
        else:
            answer = msgspec.json.encode(rows[0] if rows else None)
        return self.submit(lambda: answer)

    def forget(self) -> None:
        """Empty every mailbox, as if nothing had been received yet."""
        for box in self._boxes.values():
            box.waiting.clear()
            box.take()
            box._last = box._decoded = box._good = None
            box.received_at = float("-inf")


class Tape:
    """The rows that the page reads; `play` delivers what comes next, `seek` what was newest at any time."""

    def __init__(self, recording: Recording, bus: MemoryBus, io: TapeIo) -> None:
        self._bus, self._io = bus, io
        self._rows = [r for r in recording.rows if not r.junk and (r.key in io._boxes or r.key.startswith("service/"))]
        self._times = [row.t for row in self._rows]
        # What came before time ran (the model, the journal's last word) is there from the start.
        moving = [r.t for r in self._rows if r.key == topics.JOINT_STATES.key] or self._times or [0.0]
        self.first, self.last = moving[0], moving[-1]
        self.at = self.first
        self._next = 0

    def seek(self, t: float) -> list[Row]:
        """Deliver everything as it was at `t`; returns the speech until then."""
        self.at = min(max(t, self.first), self.last)
        self._next = bisect_right(self._times, self.at)
        self._io.forget()
        self._io.alive.clear()
        newest: dict[str, Row] = {}
        for row in self._rows[: self._next]:
            newest[row.key] = row
        for row in newest.values():
            self._put(row)
        return [row for row in self._rows[: self._next] if row.key in TALK]

    def play(self, seconds: float) -> None:
        """Go on; stops at the end."""
        self.at = min(self.at + seconds, self.last)
        while self._next < len(self._rows) and self._times[self._next] <= self.at:
            self._put(self._rows[self._next])
            self._next += 1

    def _put(self, row: Row) -> None:
        if row.key in self._io._boxes:
            self._bus.put(topics.BY_KEY[row.key], row.payload)
        elif row.key.endswith("/alive"):
            self._io.alive[row.key.split("/")[1]] = bool(msgspec.json.decode(row.payload)["alive"])
        elif row.key.endswith("/health"):
            self._bus.put(topics.HEALTH, row.payload)


class Playback(DashboardService):
    """The page on a tape: words move the tape, nothing reaches a robot."""

    def __init__(self, config: DashboardConfig, io: Any, tape: Tape, missions: list[recorded.Record]) -> None:
        super().__init__(config, io)
        self.deck: TapeIo = io
        self.tape, self.playing, self._speed_up = tape, True, 1.0
        self._shown: object = None
        self._bands = [
            {"from": began + a, "to": began + b, "state": state, "colour": STATE_COLOURS.get(state, OTHER_STATE)}
            for began, entries, until in ((r["started"], r["entries"], r["until"]) for r in missions)
            for state, a, b in spans(entries, began, max(until, began))
        ]
        self.panels.command_by_clicks(False)
        self.jump(tape.first)

    def jump(self, t: float) -> None:
        """Show the robot as it was at `t`."""
        self._transcript = Transcript()
        self._commands.use_transcript(self._transcript)
        for row in self.tape.seek(t):
            message = recorded.decoded(row)
            if isinstance(message, m.SpeechGoal):
                self._transcript.add_goal(row.t, message)
            elif isinstance(message, m.SpeechResult):
                self._transcript.add_result(row.t, message)
        # What was just told must not be told again by the page's own reading.
        self.deck.begin(None, monotonic())
        self.deck.take_all(topics.SPEECH_GOAL)
        self.deck.take_all(topics.SPEECH_RESULT)

    def pause(self, t: float) -> None:
        """Pause the tape at `t`."""
        self.playing = False
        self.jump(t)

    def frame(self, now: float, passed: float) -> None:
        """One step of the page after `passed` seconds."""
        if self.playing:
            self.tape.play(passed * self._speed_up)
            self.playing = self.tape.at < self.tape.last
        self.deck.begin(None, now)
        self.step(now)
        tape = self.tape
        shown = {"t": round(tape.at, 1), "playing": self.playing, "speed": self._speed_up}
        if shown != self._shown:
            self._shown = shown
            self.web.say("tape", {**shown, "first": tape.first, "last": tape.last, "bands": self._bands})

    def _handle_action(self, words: Words, now: float) -> None:
        if words.do == "seek":
            try:
                self.jump(float(words.text))
            except ValueError:
                self._io.count_drop("page", f"{words.text[:20]!r} is no time")
        elif words.do in ("play", "pause"):
            if words.do == "play" and self.tape.at >= self.tape.last:
                self.jump(self.tape.first)
            self.playing = words.do == "play"
        elif words.do == "speed" and words.text in map(str, SPEEDS):
            self._speed_up = float(words.text)
        else:
            self._io.count_drop("page", f"{words.do[:20]!r}: this is a recording")


def wanted_keys() -> set[str]:
    """The keys of a recording that the page reads."""
    return {t.key for t in DashboardService.READS if t.key in topics.BY_KEY} | recorded.TOLD


def opened(path: Path, config: DashboardConfig) -> Playback:
    """The page on a recording.

    Raises:
        RecordingError: no recording, or nothing of a robot in it.
        StartError: the page cannot be served.
    """
    keys = wanted_keys()
    recording = Recording(path, lambda key: key in keys or key.startswith("service/"))
    if not any(row.key == topics.JOINT_STATES.key for row in recording.rows):
        raise RecordingError(f"{path}: no joint_states in it, so there is nothing to see")
    bus, missions = MemoryBus(), recorded.missions(recording.rows)
    io = TapeIo(bus, missions)
    return Playback(config, io, Tape(recording, bus, io), missions)


def frames(stop: StopSignal) -> Iterator[tuple[float, float]]:
    """(now, seconds since the last) until stopped."""
    before = monotonic()
    while not stop.is_set():
        now = monotonic()
        yield now, now - before
        before = now
        stop.wait(max(0.0, now + FRAME - monotonic()))


def main(argv: list[str]) -> int:
    """Serve the page on a recording until stopped; 1 when that is impossible."""
    parser = argparse.ArgumentParser(prog="tidybot replay --view", description=__doc__)
    parser.add_argument("file", type=Path)
    parser.add_argument("--port", type=int, default=8080)
    parser.add_argument("--at", type=float, metavar="S", help="begin there, paused [s of robot time]")
    args = parser.parse_args(argv)
    stop = StopSignal()
    try:
        page = opened(args.file, DashboardConfig(port=args.port))
    except (RecordingError, StartError, codec.DecodeError) as error:
        print(f"tidybot: {error}", file=sys.stderr)
        return 1
    if args.at is not None:
        page.pause(args.at)
    for now, passed in frames(stop):
        page.frame(now, passed)
    page.close()
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
