"""Sampling of messages into frames of state, action and pictures at a fixed rate, episode by episode. Pure."""

from collections import deque
from dataclasses import dataclass, field
from typing import Any

from common import messages as m
from common.demonstration import STATE
from common.robot.joints import ARM

FRESH = 0.25
"""Age [s] from which a command counts no more: the silence after which the robot holds."""
ROUNDING = 1e-6
"""Error [s] of sums of periods."""
PATIENCE = 0.5
"""Time [s] that a frame waits for its pictures; chosen: above what a picture takes on a busy machine."""


@dataclass(frozen=True)
class Picture:
    """A camera's picture of robot time `t`: rgb uint8, row by row."""

    t: float
    width: int
    height: int
    rgb: bytes


@dataclass
class Frame:
    """One sample; `pictures` by camera, `late` [s] how far the worst of them is from `t`."""

    t: float
    state: list[float]
    action: list[float]
    pictures: dict[str, Picture] = field(default_factory=dict)
    late: float = 0.0


@dataclass
class Episode:
    """One mission; `outcome` as the brain reported it."""

    mission_id: str
    task: str
    frames: list[Frame]
    outcome: str = ""

    @property
    def late(self) -> float:
        """The worst distance in time [s] between a frame and one of its pictures."""
        return max((frame.late for frame in self.frames), default=0.0)


class Sampler:
    """Takes messages in the order they come, gives an episode when its mission has ended.

    Frames lie at `1 / fps` of robot time from the mission's first sample on. Each takes the pictures nearest to it.
    """

    def __init__(self, fps: int, cameras: tuple[str, ...]) -> None:
        self._period, self._cameras = 1.0 / fps, cameras
        self._pictures: dict[str, deque[Picture]] = {name: deque(maxlen=2 * fps + 10) for name in cameras}
        self._joints: m.JointStates | None = None
        self._velocity = (0.0, 0.0, 0.0)
        self._arm: tuple[float, list[float]] | None = None
        self._closed = 0.0
        self._episode: Episode | None = None
        self._waiting: deque[Frame] = deque()
        self._next = 0.0
        self._ended: list[Episode] = []

    @property
    def now(self) -> float:
        """Robot time of the last joint states."""
        return self._joints.t if self._joints is not None else 0.0

    @property
    def recording(self) -> bool:
        """A mission is under way."""
        return self._episode is not None

    def take(self, message: Any) -> None:
        """Take a message; kinds that a demonstration does not contain are ignored."""
        match message:
            case m.JointStates():
                self._sample(message)
            case m.Odometry():
                self._velocity = message.vx, message.vy, message.omega
            case m.ArmCommand():
                self._arm = self.now, message.position
            case m.GripperCommand():
                self._closed = message.position
            case m.BrainState():
                self._follow(message)
            case m.Rgbd() if message.camera in self._pictures:
                seen = Picture(message.t, message.width, message.height, message.rgb)
                self._pictures[message.camera].append(seen)

    def ended(self) -> list[Episode]:
        """The episodes that have come to an end since the last call."""
        found, self._ended = self._ended, []
        return found

    def _follow(self, state: m.BrainState) -> None:
        ended = state.last
        if self._episode is not None and ended is not None and ended.id == self._episode.mission_id:
            self._episode.outcome = ended.outcome
            self._settle(float("inf"))
            self._ended.append(self._episode)
            self._episode = None
        begun = state.mission_id if state.command and (ended is None or ended.id != state.mission_id) else ""
        if begun and (self._episode is None or self._episode.mission_id != begun):
            self._episode = Episode(begun, state.command, [])
            self._waiting.clear()
            self._next = float("-inf")

    def _sample(self, joints: m.JointStates) -> None:
        self._joints = joints
        if self._episode is None or joints.t < self._next - ROUNDING:
            return
        position = dict(zip(joints.name, joints.position, strict=False))
        if not set(STATE) <= position.keys():
            return
        state = [position[name] for name in STATE]
        arm = [position[name] for name in ARM]
        if self._arm is not None and joints.t - self._arm[0] <= FRESH and len(self._arm[1]) == len(ARM):
            arm = self._arm[1]
        self._waiting.append(Frame(joints.t, state, [*self._velocity, *arm, self._closed]))
        # After a gap the frames go on from there.
        late = joints.t - self._next > self._period
        self._next = (joints.t if late else self._next) + self._period
        self._settle(joints.t - PATIENCE)

    def _settle(self, until: float) -> None:
        """Give frames of before `until` their pictures; a frame before the first picture is left out."""
        while self._waiting and self._waiting[0].t <= until and self._episode is not None:
            frame = self._waiting.popleft()
            for name in self._cameras:
                nearest = min(self._pictures[name], key=lambda p: abs(p.t - frame.t), default=None)
                if nearest is not None:
                    frame.pictures[name] = nearest
                    frame.late = max(frame.late, abs(nearest.t - frame.t))
            if len(frame.pictures) == len(self._cameras):
                self._episode.frames.append(frame)
