"""The one table of topics: key, payload, who publishes and who subscribes, rate, delivery, latched or not.

Everything else is derived from it: what a service subscribes to and publishes (`subscribed`, `published`), access
rules, recordings, and docs/INTERFACES.md (`python -m common.interfaces`).
"""

from typing import Any

from common import messages as m
from common.topic import ANYONE, EACH, Query, Topic, clock, event, goal, row, sound, stream

SPEECH_GOAL = goal("brain/speech_goal", m.SpeechGoal, by="brain ros2", to="speech dashboard", text="goal")
SPEECH_RESULT = event("brain/speech_result", m.SpeechResult, by="speech", to="brain dashboard", text="text")
NAVIGATION_GOAL = goal(
    "brain/navigation_goal", m.NavigationGoal, by="brain ros2", to="navigation manipulation", text="goal"
)
NAVIGATION_STATUS = event("brain/navigation_status", m.NavigationStatus, by="navigation", to="brain", text="status")
MANIPULATION_GOAL = goal("brain/manipulation_goal", m.ManipulationGoal, by="brain ros2", to="manipulation", text="goal")
MANIPULATION_STATUS = event(
    "brain/manipulation_status", m.ManipulationStatus, by="manipulation", to="brain perception dashboard", text="status"
)
BRAIN_STATE = event("brain/state", m.BrainState, by="brain", to="navigation manipulation dashboard")
BRAIN_TREE = event("brain/tree", m.TreeSnapshot, by="brain", to="dashboard")

SPEECH_STATUS = event("speech/status", m.SpeechStatus, by="speech", to="brain dashboard")
SPEECH_TEXT = goal("speech/text", m.TypedText, by="*", to="speech", text="text", latched=False)
AUDIO_PCM = sound("audio/pcm", by="dashboard *", to="speech")
AUDIO_OUT = sound("audio/out", by="speech", to="dashboard")

VOICE_COMMAND = goal(
    "voice_command",
    m.VoiceCommand,
    by="speech dashboard ros2 foxglove *",
    to="brain dashboard",
    text="text",
    latched=False,
)
SPEECH_UNCLEAR = goal("speech/unclear", m.VoiceCommand, by="speech", to="brain", text="text", latched=False)
PLAN_REQUEST = goal("plan_request", m.PlanRequest, by="brain", to="planner")
ACTION_PLAN = event("action_plan", m.ActionPlan, by="planner ros2", to="brain dashboard")
PLANNER_STATUS = event("planner/status", m.PlannerStatus, by="planner")
OBJECT_QUERY = goal("object_query", m.ObjectQuery, by="brain", to="perception")
OBJECT_POSE = event("object_pose", m.ObjectPose, by="perception", to="brain")
NAV_GOAL = goal("nav_goal", m.NavGoal, by="brain mapping dashboard ros2 foxglove *", to="navigation")
NAVIGATION_FEEDBACK = event("navigation_feedback", m.NavigationFeedback, by="navigation", to="brain mapping dashboard")
SYSTEM_STATUS = event("system_status", m.SystemStatus, by="brain")
WORLD_OBJECTS = event(
    "world/objects", m.WorldObjects, by="perception", to="brain planner navigation manipulation dashboard"
)
TEACH = goal("perception/teach", m.TeachRequest, by="brain dashboard *", to="perception", text="name", latched=False)
TAUGHT = event("perception/taught", m.TeachResult, by="perception", to="brain dashboard")
HOUSEHOLD_NAMES = event("household/names", m.TaughtNames, by="perception", to="brain speech")
HOUSEHOLD_EDIT = goal("household/edit", m.HouseholdEdit, by="dashboard *", to="brain", text="name", latched=False)
HOUSEHOLD_EDITED = event("household/edited", m.EditResult, by="brain", to="dashboard")
HOUSEHOLD_EDITS = event(
    "household/edits", m.HouseholdEdits, by="brain", to="planner speech perception navigation manipulation"
)
HOUSEHOLD_PARTS = event("household/parts", m.HomeParts, by="brain", to="dashboard")
SIGHTINGS = event("household/sightings", m.Sightings, by="brain", to="planner navigation")

BASE_TARGET = goal("base/target_pose", m.BaseTarget, by="navigation", to="sim", latched=False)
GOAL_REACHED = event("base/goal_reached", m.GoalReached, by="sim", to="navigation")
CMD_VEL = stream("base/cmd_vel", m.CmdVel, by="navigation ros2 foxglove dashboard", to="sim", rate=20.0, binary=False)
ARM_COMMAND = stream("arm/command", m.ArmCommand, by="manipulation", to="sim dashboard", rate=50.0)
HAND_VELOCITY = stream("hand/velocity", m.HandVelocity, by="dashboard", to="manipulation", rate=20.0, binary=False)
GRIPPER_COMMAND = goal("gripper_command", m.GripperCommand, by="brain manipulation", to="sim", latched=False)
JOINT_STATES = stream(
    "joint_states",
    m.JointStates,
    by="sim",
    to="brain perception navigation manipulation dashboard",
    rate=100.0,
    latched=True,
)
ODOMETRY = stream("base/odom", m.Odometry, by="sim", to="navigation mapping manipulation", rate=100.0, latched=True)
POSE = stream(
    "navigation/pose",
    m.PoseEstimate,
    by="navigation",
    to="brain planner perception manipulation dashboard",
    rate=20.0,
    binary=False,
    latched=True,
)
NAV_PATH = event("navigation/path", m.NavPath, by="navigation", to="dashboard")
DRIVE_INTENT = row(
    "navigation/intent", m.DriveIntent, "navigation", "", rate=5.0, keep="latest", latched=True, abroad=("navigation",)
)
COSTMAP = stream("navigation/costmap", m.Costmap, by="navigation", to="dashboard", rate=1.0)
MAPPING_GOAL = goal("mapping/goal", m.MappingGoal, by="*", to="mapping", text="goal", latched=False)
MAPPING_STATUS = event("mapping/status", m.MappingStatus, by="mapping")
MAP_GRID = event("mapping/map", m.MapGrid, by="mapping", to="navigation")
GRASPS = event("manipulation/grasps", m.GraspCandidates, by="manipulation", to="dashboard")
SCAN = stream("scan", m.LaserScan, by="sim", to="navigation mapping dashboard", rate=10.0, latched=True)
BATTERY = stream("robot/battery", m.BatteryState, by="sim", to="planner", rate=1.0, binary=False, latched=True)
ROBOT_STOP = goal(
    "robot/stop",
    m.RobotStop,
    by="speech dashboard ros2 foxglove *",
    to="brain navigation manipulation sim",
    text="reason",
    latched=False,
)
ROBOT_RESUME = goal(
    "robot/resume", m.RobotResume, by="dashboard ros2 foxglove *", to="brain sim", text="source", latched=False
)
ROBOT_DESCRIPTION = event(
    "robot/description", m.RobotDescription, by="sim", to="brain perception navigation manipulation"
)

SIM_STATE = stream("sim/state", m.SimState, by="sim", to="camera", rate=20.0, latched=True)
SIM_MODEL = event("sim/model", m.SimModel, by="sim", to="camera dashboard")
SIM_STATUS = event("sim/status", m.SimStatus, by="sim", to="brain perception navigation dashboard")
SIM_CONTACTS = row("sim/contacts", m.SimContacts, "sim", "", binary=True)
"""For evaluators alone, like `sim/truth`: no service reads it."""

SIM_CLOCK = clock("sim/clock", 100.0)
SIM_CLOCK_50HZ = clock("sim/clock/50hz", 50.0)
SIM_CLOCK_20HZ = clock("sim/clock/20hz", 20.0)
SIM_CLOCK_10HZ = clock("sim/clock/10hz", 10.0)
SLOWER_CLOCKS = {2: SIM_CLOCK_50HZ, 5: SIM_CLOCK_20HZ, 10: SIM_CLOCK_10HZ}
"""By the period of whoever is due at their ticks: a process is not woken for those of others."""
CLOCKS = (SIM_CLOCK, *SLOWER_CLOCKS.values())
LOCKSTEP_ACK = row("sim/ack", m.LockstepAck, f"{EACH} {ANYONE}", "sim", binary=True, recover=False)

CAMERA_REQUEST = goal(
    "camera/request",
    m.CameraRequest,
    by="perception mapping manipulation dashboard ros2 foxglove *",
    to="camera",
    latched=False,
)
HEAD_RGBD = stream(
    "camera/head/rgbd", m.Rgbd, by="camera", to="perception mapping manipulation dashboard", rate=10.0, bulk=True
)
WRIST_RGBD = stream(
    "camera/wrist/rgbd", m.Rgbd, by="camera", to="perception manipulation dashboard", rate=10.0, bulk=True
)
PICTURES: dict[m.CameraName, Topic[m.Rgbd]] = {"head": HEAD_RGBD, "wrist": WRIST_RGBD}
"""What each camera shows."""

PAGE_STATUS = event("page/status", m.PageStatus, by="dashboard")

TABLE: tuple[Topic[Any], ...] = tuple(t for t in list(globals().values()) if isinstance(t, Topic))
BY_KEY: dict[str, Topic[Any]] = {t.key: t for t in TABLE}

HEALTH = row("service/*/health", m.Health, EACH, f"{EACH} dashboard", recover=False)
LOG = row("log/*", m.LogRecord, EACH, "", recover=False)
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
    for each in PER_SERVICE:
        before, _, after = each.key.partition("*")
        if key.startswith(before) and key.endswith(after):
            per_service: type[m.Message] = each.type
            return per_service
    return None
