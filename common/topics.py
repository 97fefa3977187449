"""The one table of topics: key, payload, who publishes and who subscribes, rate, delivery, latched or not.

Everything else is derived from it: what a service subscribes to and publishes (`subscribed`, `published`), access
rules, recordings, and docs/INTERFACES.md (`python -m common.interfaces`).
"""

from typing import Any, Generic, Literal, TypeVar

import msgspec

from common import messages as m

M = TypeVar("M", bound=m.Message)
Keep = Literal["latest", "all"]
ANYONE = "*"
"""As a publisher: any client that may command the robot."""
EACH = "each"
"""As a publisher or subscriber: every service, by the runtime that it lives in."""


class Topic(msgspec.Struct, Generic[M], frozen=True, kw_only=True):
    """One key expression.

    `writers` and `readers` are services, `ANYONE` or `EACH`. `rate` is the declared frequency [Hz], 0 for events.
    `latched`: the last value also answers a zenoh `get`. `bulk`: pictures and sound, which a recording keeps as they
    are instead of as JSON. `keep` "latest" means only the newest value matters (dropped under load), "all" means
    reliable, in order, recovered after an outage. `text` names the field that bare text fills. `command`: values from
    before the reader's start are not acted on. `recover`: what a router outage swallowed is sent again. `abroad`:
    services of the other robots on the router that read it (`Io.others`). A `*` in the key of a row of `PER_SERVICE`
    stands for a service's name.
    """

    key: str
    type: type[M]
    writers: tuple[str, ...]
    readers: tuple[str, ...] = ()
    rate: float = 0.0
    latched: bool = False
    keep: Keep = "all"
    binary: bool = False
    bulk: bool = False
    text: str = ""
    command: bool = False
    recover: bool = True
    abroad: tuple[str, ...] = ()

    def __hash__(self) -> int:
        return hash(self.key)

    def of(self, name: str) -> str:
        """The key of one service, for a row of `PER_SERVICE`."""
        return self.key.replace("*", name)


class Query(msgspec.Struct, frozen=True):
    """A question that one service answers. `askers`: the services that ask it; people's tools may ask all but those
    that are for evaluators. `changing`: it changes something, so that an observer may not ask."""

    key: str
    server: str
    askers: tuple[str, ...] = ()
    changing: bool = False


# --- kinds of rows; `by` and `to` name services, separated by blanks
def _goal(key: str, type: type[M], *, by: str, to: str, text: str = "", latched: bool = True) -> Topic[M]:
    """What somebody is to do: in order, none lost, none from before its reader's start."""
    return _row(key, type, by, to, text=text, latched=latched, command=True)


def _event(key: str, type: type[M], *, by: str, to: str = "", text: str = "") -> Topic[M]:
    """What has happened or how something stands: in order, none lost."""
    return _row(key, type, by, to, text=text, latched=True)


def _stream(
    key: str,
    type: type[M],
    *,
    by: str,
    to: str,
    rate: float,
    binary: bool = True,
    latched: bool = False,
    bulk: bool = False,
) -> Topic[M]:
    """Samples of which only the newest counts."""
    return _row(key, type, by, to, rate=rate, binary=binary, latched=latched, bulk=bulk, keep="latest")


def _sound(key: str, *, by: str, to: str) -> Topic[m.AudioChunk]:
    """Samples of which every one counts."""
    return _row(key, m.AudioChunk, by, to, rate=10.0, binary=True, bulk=True)


def _clock(key: str, rate: float) -> Topic[m.SimClockTick]:
    return _row(key, m.SimClockTick, "sim", EACH, rate=rate, binary=True, recover=False)


def _row(key: str, type: type[M], by: str, to: str, **how: Any) -> Topic[M]:
    return Topic(key=key, type=type, writers=tuple(by.split()), readers=tuple(to.split()), **how)


SPEECH_GOAL = _goal("brain/speech_goal", m.SpeechGoal, by="brain ros2", to="speech dashboard", text="goal")
SPEECH_RESULT = _event("brain/speech_result", m.SpeechResult, by="speech", to="brain dashboard", text="text")
NAVIGATION_GOAL = _goal(
    "brain/navigation_goal", m.NavigationGoal, by="brain ros2", to="navigation manipulation", text="goal"
)
NAVIGATION_STATUS = _event("brain/navigation_status", m.NavigationStatus, by="navigation", to="brain", text="status")
MANIPULATION_GOAL = _goal(
    "brain/manipulation_goal", m.ManipulationGoal, by="brain ros2", to="manipulation", text="goal"
)
MANIPULATION_STATUS = _event(
    "brain/manipulation_status", m.ManipulationStatus, by="manipulation", to="brain perception dashboard", text="status"
)
BRAIN_STATE = _event("brain/state", m.BrainState, by="brain", to="navigation manipulation dashboard")
BRAIN_TREE = _event("brain/tree", m.TreeSnapshot, by="brain", to="dashboard")

SPEECH_STATUS = _event("speech/status", m.SpeechStatus, by="speech", to="brain dashboard")
SPEECH_TEXT = _goal("speech/text", m.TypedText, by="*", to="speech", text="text", latched=False)
AUDIO_PCM = _sound("audio/pcm", by="dashboard *", to="speech")
AUDIO_OUT = _sound("audio/out", by="speech", to="dashboard")

VOICE_COMMAND = _goal(
    "voice_command",
    m.VoiceCommand,
    by="speech dashboard ros2 foxglove *",
    to="brain",
    text="text",
    latched=False,
)
PLAN_REQUEST = _goal("plan_request", m.PlanRequest, by="brain", to="planner")
ACTION_PLAN = _event("action_plan", m.ActionPlan, by="planner ros2", to="brain dashboard")
PLANNER_STATUS = _event("planner/status", m.PlannerStatus, by="planner")
OBJECT_QUERY = _goal("object_query", m.ObjectQuery, by="brain", to="perception")
OBJECT_POSE = _event("object_pose", m.ObjectPose, by="perception", to="brain")
NAV_GOAL = _goal("nav_goal", m.NavGoal, by="brain mapping dashboard ros2 foxglove *", to="navigation")
NAVIGATION_FEEDBACK = _event("navigation_feedback", m.NavigationFeedback, by="navigation", to="brain mapping dashboard")
SYSTEM_STATUS = _event("system_status", m.SystemStatus, by="brain")
WORLD_OBJECTS = _event(
    "world/objects", m.WorldObjects, by="perception", to="brain planner navigation manipulation dashboard"
)
TEACH = _goal("perception/teach", m.TeachRequest, by="brain dashboard *", to="perception", text="name", latched=False)
TAUGHT = _event("perception/taught", m.TeachResult, by="perception", to="brain dashboard")
HOUSEHOLD_NAMES = _event("household/names", m.TaughtNames, by="perception", to="brain speech")
HOUSEHOLD_EDIT = _goal("household/edit", m.HouseholdEdit, by="dashboard *", to="brain", text="name", latched=False)
HOUSEHOLD_EDITED = _event("household/edited", m.EditResult, by="brain", to="dashboard")
HOUSEHOLD_EDITS = _event(
    "household/edits", m.HouseholdEdits, by="brain", to="planner speech perception navigation manipulation"
)
HOUSEHOLD_PARTS = _event("household/parts", m.HomeParts, by="brain", to="dashboard")
SIGHTINGS = _event("household/sightings", m.Sightings, by="brain", to="planner navigation")

BASE_TARGET = _goal("base/target_pose", m.BaseTarget, by="navigation", to="sim", latched=False)
GOAL_REACHED = _event("base/goal_reached", m.GoalReached, by="sim", to="navigation")
CMD_VEL = _stream("base/cmd_vel", m.CmdVel, by="navigation ros2 foxglove dashboard", to="sim", rate=20.0, binary=False)
ARM_COMMAND = _stream("arm/command", m.ArmCommand, by="manipulation", to="sim dashboard", rate=50.0)
HAND_VELOCITY = _stream("hand/velocity", m.HandVelocity, by="dashboard", to="manipulation", rate=20.0, binary=False)
GRIPPER_COMMAND = _goal("gripper_command", m.GripperCommand, by="brain manipulation", to="sim", latched=False)
JOINT_STATES = _stream(
    "joint_states",
    m.JointStates,
    by="sim",
    to="brain perception navigation manipulation dashboard",
    rate=100.0,
    latched=True,
)
ODOMETRY = _stream("base/odom", m.Odometry, by="sim", to="navigation mapping manipulation", rate=100.0, latched=True)
POSE = _stream(
    "navigation/pose",
    m.PoseEstimate,
    by="navigation",
    to="brain planner perception manipulation dashboard",
    rate=20.0,
    binary=False,
    latched=True,
)
NAV_PATH = _event("navigation/path", m.NavPath, by="navigation", to="dashboard")
DRIVE_INTENT = _row(
    "navigation/intent", m.DriveIntent, "navigation", "", rate=5.0, keep="latest", latched=True, abroad=("navigation",)
)
COSTMAP = _stream("navigation/costmap", m.Costmap, by="navigation", to="dashboard", rate=1.0)
MAPPING_GOAL = _goal("mapping/goal", m.MappingGoal, by="*", to="mapping", text="goal", latched=False)
MAPPING_STATUS = _event("mapping/status", m.MappingStatus, by="mapping")
MAP_GRID = _event("mapping/map", m.MapGrid, by="mapping", to="navigation")
GRASPS = _event("manipulation/grasps", m.GraspCandidates, by="manipulation", to="dashboard")
SCAN = _stream("scan", m.LaserScan, by="sim", to="navigation mapping dashboard", rate=10.0, latched=True)
BATTERY = _stream("robot/battery", m.BatteryState, by="sim", to="", rate=1.0, binary=False, latched=True)
ROBOT_STOP = _goal(
    "robot/stop",
    m.RobotStop,
    by="speech dashboard ros2 foxglove *",
    to="brain navigation manipulation sim",
    text="reason",
    latched=False,
)
ROBOT_RESUME = _goal(
    "robot/resume", m.RobotResume, by="dashboard ros2 foxglove *", to="brain sim", text="source", latched=False
)
ROBOT_DESCRIPTION = _event(
    "robot/description", m.RobotDescription, by="sim", to="brain perception navigation manipulation"
)

SIM_STATE = _stream("sim/state", m.SimState, by="sim", to="camera", rate=20.0, latched=True)
SIM_MODEL = _event("sim/model", m.SimModel, by="sim", to="camera dashboard")
SIM_STATUS = _event("sim/status", m.SimStatus, by="sim", to="brain perception navigation dashboard")
SIM_CONTACTS = _row("sim/contacts", m.SimContacts, "sim", "", binary=True)
"""For evaluators alone, like `sim/truth`: no service reads it."""

SIM_CLOCK = _clock("sim/clock", 100.0)
SIM_CLOCK_50HZ = _clock("sim/clock/50hz", 50.0)
SIM_CLOCK_20HZ = _clock("sim/clock/20hz", 20.0)
SIM_CLOCK_10HZ = _clock("sim/clock/10hz", 10.0)
SLOWER_CLOCKS = {2: SIM_CLOCK_50HZ, 5: SIM_CLOCK_20HZ, 10: SIM_CLOCK_10HZ}
"""By the period of whoever is due at their ticks: a process is not woken for those of others."""
CLOCKS = (SIM_CLOCK, *SLOWER_CLOCKS.values())
LOCKSTEP_ACK = _row("sim/ack", m.LockstepAck, f"{EACH} {ANYONE}", "sim", binary=True, recover=False)

CAMERA_REQUEST = _goal(
    "camera/request",
    m.CameraRequest,
    by="perception mapping manipulation dashboard ros2 foxglove *",
    to="camera",
    latched=False,
)
HEAD_RGBD = _stream(
    "camera/head/rgbd", m.Rgbd, by="camera", to="perception mapping manipulation dashboard", rate=10.0, bulk=True
)
WRIST_RGBD = _stream(
    "camera/wrist/rgbd", m.Rgbd, by="camera", to="perception manipulation dashboard", rate=10.0, bulk=True
)

PAGE_STATUS = _event("page/status", m.PageStatus, by="dashboard")

TABLE: tuple[Topic[Any], ...] = tuple(t for t in list(globals().values()) if isinstance(t, Topic))
BY_KEY: dict[str, Topic[Any]] = {t.key: t for t in TABLE}

HEALTH = _row("service/*/health", m.Health, EACH, f"{EACH} dashboard", recover=False)
LOG = _row("log/*", m.LogRecord, EACH, "", recover=False)
PER_SERVICE: tuple[Topic[Any], ...] = (HEALTH, LOG)
ALIVE_KEY = "service/{name}/alive"
"""The liveliness token of a service."""

BRAIN_MISSIONS = "brain/missions"
SIM_RESET, SIM_PAUSE, SIM_SNAPSHOT, SIM_TRUTH = "sim/reset", "sim/pause", "sim/snapshot", "sim/truth"
VIEWERS = ("ros2", "foxglove")
"""Services that show people's tools whatever these ask for: they may read every topic but those for evaluators."""
QUERIES = (
    Query(BRAIN_MISSIONS, "brain", ("dashboard",)),
    Query(SIM_RESET, "sim", changing=True),
    Query(SIM_PAUSE, "sim", changing=True),
    Query(SIM_SNAPSHOT, "sim", changing=True),
    Query(SIM_TRUTH, "sim"),
)


def subscribed(service: str) -> tuple[Topic[Any], ...]:
    """What a service reads, in the order of the table; clock and acknowledgements are the runtime's."""
    viewer = service in VIEWERS
    hidden = (SIM_CONTACTS, LOCKSTEP_ACK, *(CLOCKS if viewer else ()))
    return tuple(t for t in (*TABLE, *PER_SERVICE) if (viewer or service in t.readers) and t not in hidden)


def published(service: str) -> tuple[Topic[Any], ...]:
    """What a service writes, in the order of the table; clock, acknowledgement and health are the runtime's."""
    return tuple(t for t in TABLE if service in t.writers and EACH not in t.readers)


def type_of(key: str) -> type[m.Message] | None:
    """The payload type of any key this project uses, per-service keys included; None if unknown."""
    if key in BY_KEY:
        found: type[m.Message] = BY_KEY[key].type
        return found
    for row in PER_SERVICE:
        before, _, after = row.key.partition("*")
        if key.startswith(before) and key.endswith(after):
            per_service: type[m.Message] = row.type
            return per_service
    return None
