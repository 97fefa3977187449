"""The one table of topics: key, payload, rate, latched or not, keep the latest or keep all.

`docs/INTERFACES.md` is generated from this table (`python -m common.interfaces`).
"""

from typing import Any, Generic, Literal, TypeVar

import msgspec

from common import messages as m

M = TypeVar("M", bound=m.Message)
Keep = Literal["latest", "all"]


class Topic(msgspec.Struct, Generic[M], frozen=True, kw_only=True):
    """One key expression.

    `rate` is the declared frequency [Hz], 0 for events. `latched`: the last value also answers a zenoh `get`.
    `keep` "latest" means only the newest value matters (dropped under load), "all" means reliable, in order, recovered
    after an outage. `text` names the field that bare text fills. `command`: values from before the reader's start
    are not acted on. `recover`: what a router outage swallowed is sent again. `writers` lists the services that
    publish it; `*` is any client.
    """

    key: str
    type: type[M]
    writers: tuple[str, ...]
    rate: float = 0.0
    latched: bool = False
    keep: Keep = "all"
    binary: bool = False
    text: str = ""
    command: bool = False
    recover: bool = True

    def __hash__(self) -> int:
        return hash(self.key)


def _goal(key: str, type: type[M], *writers: str, text: str = "", latched: bool = True) -> Topic[M]:
    return Topic(key=key, type=type, writers=writers, text=text, latched=latched, command=True)


def _event(key: str, type: type[M], *writers: str, text: str = "", latched: bool = True) -> Topic[M]:
    return Topic(key=key, type=type, writers=writers, text=text, latched=latched)


def _stream(
    key: str, type: type[M], *writers: str, rate: float, binary: bool = True, latched: bool = False
) -> Topic[M]:
    return Topic(key=key, type=type, writers=writers, rate=rate, binary=binary, latched=latched, keep="latest")


SPEECH_GOAL = _goal("brain/speech_goal", m.SpeechGoal, "brain", text="goal")
SPEECH_RESULT = _event("brain/speech_result", m.SpeechResult, "speech", text="text")
NAVIGATION_GOAL = _goal("brain/navigation_goal", m.NavigationGoal, "brain", text="goal")
NAVIGATION_STATUS = _event("brain/navigation_status", m.NavigationStatus, "navigation", text="status")
MANIPULATION_GOAL = _goal("brain/manipulation_goal", m.ManipulationGoal, "brain", text="goal")
MANIPULATION_STATUS = _event("brain/manipulation_status", m.ManipulationStatus, "manipulation", text="status")
BRAIN_STATE = _event("brain/state", m.BrainState, "brain")
BRAIN_TREE = _event("brain/tree", m.TreeSnapshot, "brain")

SPEECH_STATUS = _event("speech/status", m.SpeechStatus, "speech")
SPEECH_TEXT = _goal("speech/text", m.TypedText, "*", text="text", latched=False)
AUDIO_PCM = Topic(key="audio/pcm", type=m.AudioChunk, writers=("*",), binary=True, rate=10.0)
AUDIO_OUT = Topic(key="audio/out", type=m.AudioChunk, writers=("speech",), binary=True, rate=10.0)

VOICE_COMMAND = _goal("voice_command", m.VoiceCommand, "speech", "*", text="text", latched=False)
PLAN_REQUEST = _goal("plan_request", m.PlanRequest, "brain")
ACTION_PLAN = _event("action_plan", m.ActionPlan, "planner")
PLANNER_STATUS = _event("planner/status", m.PlannerStatus, "planner")
OBJECT_QUERY = _goal("object_query", m.ObjectQuery, "brain")
OBJECT_POSE = _event("object_pose", m.ObjectPose, "perception")
NAV_GOAL = _goal("nav_goal", m.NavGoal, "brain", "*")
NAVIGATION_FEEDBACK = _event("navigation_feedback", m.NavigationFeedback, "navigation")
SYSTEM_STATUS = _event("system_status", m.SystemStatus, "brain")
WORLD_OBJECTS = _event("world/objects", m.WorldObjects, "perception")

BASE_TARGET = _goal("base/target_pose", m.BaseTarget, "navigation", latched=False)
GOAL_REACHED = _event("base/goal_reached", m.GoalReached, "sim")
CMD_VEL = _stream("base/cmd_vel", m.CmdVel, "navigation", rate=20.0, binary=False)
ARM_COMMAND = _stream("arm/command", m.ArmCommand, "manipulation", rate=50.0)
GRIPPER_COMMAND = _goal("gripper_command", m.GripperCommand, "manipulation", "brain", latched=False)
JOINT_STATES = _stream("joint_states", m.JointStates, "sim", rate=100.0, latched=True)
ODOMETRY = _stream("base/odom", m.Odometry, "sim", rate=100.0, latched=True)
POSE = _stream("navigation/pose", m.PoseEstimate, "navigation", rate=20.0, binary=False, latched=True)
NAV_PATH = _event("navigation/path", m.NavPath, "navigation")
COSTMAP = _stream("navigation/costmap", m.Costmap, "navigation", rate=1.0)
GRASPS = _event("manipulation/grasps", m.GraspCandidates, "manipulation")
SCAN = _stream("scan", m.LaserScan, "sim", rate=10.0, latched=True)
ROBOT_STOP = _goal("robot/stop", m.RobotStop, "*", "speech", text="reason", latched=False)
ROBOT_RESUME = _goal("robot/resume", m.RobotResume, "*", text="source", latched=False)
ROBOT_DESCRIPTION = _event("robot/description", m.RobotDescription, "sim")

SIM_STATE = _stream("sim/state", m.SimState, "sim", rate=20.0, latched=True)
SIM_MODEL = _event("sim/model", m.SimModel, "sim")
SIM_STATUS = _event("sim/status", m.SimStatus, "sim")


def _clock(key: str, rate: float) -> Topic[m.SimClockTick]:
    return Topic(key=key, type=m.SimClockTick, writers=("sim",), rate=rate, binary=True, recover=False)


SIM_CLOCK = _clock("sim/clock", 100.0)
SIM_CLOCK_50HZ = _clock("sim/clock/50hz", 50.0)
SIM_CLOCK_20HZ = _clock("sim/clock/20hz", 20.0)
SIM_CLOCK_10HZ = _clock("sim/clock/10hz", 10.0)
SLOWER_CLOCKS = {2: SIM_CLOCK_50HZ, 5: SIM_CLOCK_20HZ, 10: SIM_CLOCK_10HZ}
"""By the period of whoever is due at their ticks: a process is not woken for those of others."""
CLOCKS = (SIM_CLOCK, *SLOWER_CLOCKS.values())
LOCKSTEP_ACK = Topic(key="sim/ack", type=m.LockstepAck, writers=("*",), binary=True, recover=False)

CAMERA_REQUEST = _goal("camera/request", m.CameraRequest, "perception", "*", latched=False)
HEAD_RGBD = _stream("camera/head/rgbd", m.Rgbd, "camera", rate=10.0)
WRIST_RGBD = _stream("camera/wrist/rgbd", m.Rgbd, "camera", rate=10.0)

PAGE_STATUS = _event("page/status", m.PageStatus, "dashboard")

TABLE: tuple[Topic[Any], ...] = tuple(t for t in list(globals().values()) if isinstance(t, Topic))
BY_KEY: dict[str, Topic[Any]] = {t.key: t for t in TABLE}

HEALTH_KEY = "service/{name}/health"
ALIVE_KEY = "service/{name}/alive"
LOG_KEY = "log/{name}"
BRAIN_MISSIONS = "brain/missions"
SIM_RESET, SIM_PAUSE, SIM_SNAPSHOT, SIM_TRUTH = "sim/reset", "sim/pause", "sim/snapshot", "sim/truth"


def type_of(key: str) -> type[m.Message] | None:
    """The payload type of any key this project uses, per-service keys included; None if unknown."""
    if key in BY_KEY:
        found: type[m.Message] = BY_KEY[key].type
        return found
    if key.startswith("service/") and key.endswith("/health"):
        return m.Health
    return m.LogRecord if key.startswith("log/") else None
