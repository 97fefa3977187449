"""The operator's page: shows what the robot does and lets a person talk to it; does only what any client may."""

import sys
from functools import partial
from typing import Any

from common import messages as m
from common import topics
from common.bus.port import Io
from common.mission_log import timeline
from common.mission_log.transcript import Transcript
from common.process.health_records import HealthRecords
from common.runtime import StartError
from services.dashboard.background_requests import BackgroundRequests
from services.dashboard.commands import Commands
from services.dashboard.config import DashboardConfig
from services.dashboard.panels import markup
from services.dashboard.panels.cameras import Cameras
from services.dashboard.panels.history_buffers import TreeReasons
from services.dashboard.panels.markup import status_bar
from services.dashboard.panels.plots import Plots
from services.dashboard.panels.tracking_error import FRESH
from services.dashboard.panels.widgets import Panels
from services.dashboard.scene.live import LiveScene
from services.dashboard.scene.picking import pick
from services.dashboard.supervisor_client import Supervisor
from services.dashboard.teleoperation import HandTeleoperation, Teleoperation
from services.dashboard.web.events import Asked, Click, Sound, Words
from services.dashboard.web.listener import PageError
from services.dashboard.web.server import Web

SLOW, PLOT = 0.25, 0.5
"""Periods [s] of panels and of the curves; chosen: as often as a person reads them."""


class DashboardService:
    """The operator's page: 3-D view, panels, microphone, stop."""

    NAME = "dashboard"
    HZ = 100 / 3
    CLOCK = "wall"
    CONFIG = DashboardConfig
    READS, WRITES = topics.subscribed(NAME), topics.published(NAME)

    def __init__(self, config: DashboardConfig, io: Io) -> None:
        self._config, self._io = config, io
        try:
            self.web = Web(config)
        except PageError as error:
            raise StartError(str(error)) from None
        self.panels = Panels(self.web.viser, config.camera_width, config.camera_height)
        self.scene = LiveScene(self.web.viser, io, self.panels, config.ghost_after)
        self._cameras = Cameras(config, io, self.panels)
        self._transcript, self._health, self._reasons = Transcript(), HealthRecords(), TreeReasons()
        self._requests = BackgroundRequests(
            io, Supervisor(config.supervisor), lambda words: self._transcript.add(self._t, "robot", words)
        )
        self._commands = Commands(io, self._transcript)
        self._teleoperation = Teleoperation(io)
        self._hand = HandTeleoperation(io)
        self._plots = Plots(self.panels)
        self._t = 0.0
        self._move_at = self._slow_at = self._plot_at = float("-inf")
        self._shown_bar: object = None
        self._tree: m.TreeNode | None = None
        io.publish(topics.PAGE_STATUS, m.PageStatus(url=self.web.url))
        io.log.info("page", url=self.web.url)
        # The token is for eyes at this terminal only, not for the log on the bus.
        sys.stderr.write(f"dashboard: open {self.web.entrance}\n")

    def step(self, now: float) -> None:
        """Take what came from the bus and from visitors, then show what changed."""
        self._receive(now)
        self._handle_events(now)
        self._teleoperation.step(now)
        self._hand.step(now)
        self.scene.redraw_model(now)
        watched = self.web.watched
        self._requests.step(now, watched)
        if watched or now >= self._move_at:
            # All that is new goes out at once: each message of its own would wake the web server and every visitor.
            with self.web.viser.atomic():
                self._draw(now, watched)

    def _draw(self, now: float, watched: bool) -> None:
        period = 1 / self._config.frame_rate if watched else 1.0
        self._move_at = min(self._move_at, now + period)
        if now >= self._move_at:
            # From when it was due, not from now: steps that do not fit the period must not make frames rarer.
            self._move_at = max(self._move_at + period, now)
            self.scene.move(now, self._t)
        if now - self._slow_at >= (SLOW if watched else 1.0):
            self._slow_at = now
            self._refresh()
        if watched:
            self._cameras.look(now, self.scene.base)
            if now - self._plot_at >= PLOT:
                self._plot_at = now
                self.panels.redraw()

    # --- from the bus
    def _receive(self, now: float) -> None:
        io, t = self._io, self._t
        joints = io.latest(topics.JOINT_STATES)
        if joints is not None and joints.t != t:
            self._t = t = joints.t
            command = io.latest(topics.ARM_COMMAND) if io.age(topics.ARM_COMMAND, now) < FRESH else None
            self._plots.take(now, joints, command, self.scene.off_path)
        for goal in io.take_all(topics.SPEECH_GOAL):
            self._transcript.add_goal(t, goal)
        for result in io.take_all(topics.SPEECH_RESULT):
            self._transcript.add_result(t, result)
        for said in io.take_all(topics.VOICE_COMMAND):
            self._transcript.add_command(t, said)
        for taught in io.take_all(topics.TAUGHT):
            self._commands.taught(taught, t)
        for edited in io.take_all(topics.HOUSEHOLD_EDITED):
            self._commands.edited(edited, t)
        for health in io.take_all(topics.HEALTH):
            self._health.take(health)
        for chunk in io.take_all(topics.AUDIO_OUT):
            if len(chunk.data) % 2 or not 4000 <= chunk.rate <= 192000:
                io.count_drop(topics.AUDIO_OUT.key, "not 16 bit samples at 4 to 192 kHz")
            else:
                self.web.play(chunk.data, chunk.rate)

    # --- from the visitors
    def _handle_events(self, now: float) -> None:
        state = self._io.latest(topics.BRAIN_STATE)
        while not self.web.inbox.empty():
            event = self.web.inbox.get_nowait()
            if isinstance(event, Asked):
                self._requests.mission(event.mission, partial(self._show_mission, event))
            elif isinstance(event, Words):
                self._handle_action(event, now)
            elif isinstance(event, Sound):
                self._commands.sound(event.data, self._t)
            elif isinstance(event, Click) and (self.panels.clicks.value or self._commands.naming):
                world = self._io.latest(topics.WORLD_OBJECTS)
                objects = world.objects if world is not None else []
                picked = pick(event.origin, event.direction, self.scene.view.drawing.flat, objects)
                self._commands.picked(picked, self.scene.base, state, self._t)

    def _handle_action(self, words: Words, now: float) -> None:
        if words.do == "drive":
            self._teleoperation.hold(words.text, now)
        elif words.do == "hand":
            self._hand.hold(words.text, now)
        elif words.do == "restart":
            self._requests.restart(words.text)
        else:
            self._commands.words(words.do, words.text, self._t)

    def _show_mission(self, asked: Asked, record: dict[str, Any] | None) -> None:
        self.web.answer(asked, timeline.page(record) if record is not None else "")

    # --- to the visitors
    def _refresh(self) -> None:
        io, panels = self._io, self.panels
        state, plan = io.latest(topics.BRAIN_STATE), io.latest(topics.ACTION_PLAN)
        steps = plan.steps if plan is not None and state is not None and state.pipeline == "vla" else []
        navigation, manipulation = io.latest(topics.NAVIGATION_FEEDBACK), io.latest(topics.MANIPULATION_STATUS)
        panels.text("mission", markup.mission(state, self._t, steps, navigation, manipulation))
        if self._transcript.changed:
            self._transcript.changed = False
            panels.text("transcript", markup.transcript(self._transcript.lines))
        for tree in io.take_all(topics.BRAIN_TREE):
            self._reasons.take(tree)
            self._tree = tree.root
        if self._tree is not None:
            panels.text("tree", markup.tree(self._tree, self._reasons.last))
        rows = self._health.rows(lambda name: io.peer(name) is not None)
        panels.text("services", markup.services(rows, self._requests.restartable, self._requests.why))
        if self._requests.missions is not None:
            panels.text("missions", markup.missions(self._requests.missions))
        self._show_bar(state)

    def _show_bar(self, state: m.BrainState | None) -> None:
        """Send the status bar at the top of the page when it changed."""
        sim, speech = self._io.latest(topics.SIM_STATUS), self._io.latest(topics.SPEECH_STATUS)
        shown = status_bar(state, sim, self._t) | {
            "listening": speech is not None and speech.state == "listening",
            "sim": self._io.peer("sim") is not None,
        }
        if shown != self._shown_bar:
            self._shown_bar = shown
            self.web.say("state", shown)

    def close(self) -> None:
        """End the web server."""
        self.web.close()
