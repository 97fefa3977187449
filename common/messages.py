"""Every payload on the bus, as msgspec structs.

SI units, radians, frame `map` unless the name says otherwise, quaternions (w, x, y, z), `t` robot time [s].
Unknown fields are ignored on receipt. Field names and strings are the wire contract.
"""

from typing import Literal

import msgspec

Vec3 = tuple[float, float, float]
Quat = tuple[float, float, float, float]
IDENTITY: Quat = (1.0, 0.0, 0.0, 0.0)

NavStatus = Literal["idle", "navigating", "arrived", "failed"]
ManipStatus = Literal["idle", "executing", "done", "failed"]
BrainStateName = Literal[
    "IDLE", "WAITING", "LISTENING", "CONFIRMING", "PLANNING", "GROUNDING", "NAVIGATING",
    "GRABBING", "RETURNING", "RELEASING", "COMPLETED", "ERROR",
]  # fmt: skip
SystemStateName = Literal["IDLE", "LISTENING", "PLANNING", "GROUNDING", "NAVIGATING", "EXECUTING", "SUCCESS", "ERROR"]
SpeechStateName = Literal["idle", "listening", "transcribing", "speaking"]
PlannerBackend = Literal["grammar", "llm"]
TouchKind = Literal["furniture", "obstacle", "floor", "self", "held"]
StepAction = Literal["navigate", "find", "grasp", "place", "release", "say", "wait", "return"]
GRIPPER = "gripper"
"""The target of a step that only opens or closes the hand."""


class Message(msgspec.Struct, kw_only=True):
    """Base of all payloads."""


class ObjectRef(Message):
    """What manipulation is told about the object to grab: `position` is its centre, `size` full extent.

    `tilt` as in `WorldObject`.
    """

    label: str
    position: Vec3
    orientation: Quat = IDENTITY
    size: Vec3 = (0.0, 0.0, 0.0)
    kind: str = ""
    frame: str = "map"
    tilt: float = 0.0


class WorldObject(Message):
    """An object the robot knows of. `on` names its receptacle, `seen_at` is the time of the evidence.

    `tilt` [rad]: angle of its own upward axis to the vertical, 0 when it stands. Of what lies on its side, the first
    extent of `size` is along that axis, which points along the yaw of `orientation`.
    """

    label: str
    kind: str
    colour: str
    position: Vec3
    orientation: Quat = IDENTITY
    size: Vec3 = (0.0, 0.0, 0.0)
    on: str = ""
    confidence: float = 1.0
    seen_at: float = 0.0
    held: bool = False
    id: str = ""
    tilt: float = 0.0


class WorldObjects(Message):
    t: float
    objects: list[WorldObject]
    source: str = "survey"


# --- fetch pipeline -------------------------------------------------------------------------------


class SpeechGoal(Message):
    """`listen`, `say <text>` or `cancel`."""

    goal: str
    id: str = ""
    attempt: int = 1


class SpeechResult(Message):
    """What was heard; `text` is `ERROR` after silence, noise or speech that is no command."""

    text: str
    goal_id: str = ""
    confidence: float = 1.0
    attempt: int = 0
    code: str = ""
    detail: str = ""


class SpeechStatus(Message):
    state: SpeechStateName
    goal_id: str = ""
    attempt: int = 0
    detail: str = ""


class TypedText(Message):
    """Text typed by a person; counts as heard with confidence 1."""

    text: str
    id: str = ""


class AudioChunk(Message):
    """Mono int16 little-endian samples that start at robot time `t`; `end` marks the last chunk.

    `addressed`: the speaker means the robot (push-to-talk), so that no wake word is needed.
    """

    t: float
    data: bytes
    rate: int = 16000
    seq: int = 0
    end: bool = False
    addressed: bool = False


class NavigationGoal(Message):
    """`find <item>`, `goto <place>`, `return_to_start` or `stop`."""

    goal: str
    id: str = ""
    attempt: int = 1


class NavigationStatus(Message):
    status: NavStatus
    goal_id: str = ""
    attempt: int = 0
    code: str = ""
    detail: str = ""


class ManipulationGoal(Message):
    """`grab`, `release`, `place <receptacle>`, `home` or `stop`."""

    goal: str
    id: str = ""
    attempt: int = 1
    object: ObjectRef | None = None


class ManipulationStatus(Message):
    status: ManipStatus
    goal_id: str = ""
    attempt: int = 0
    phase: str = ""
    code: str = ""
    detail: str = ""


class BaseTarget(Message):
    x: float
    y: float
    theta: float
    id: str = ""


class GoalReached(Message):
    reached: bool
    target_id: str = ""


class JointStates(Message):
    """100 Hz. base_x base_y base_yaw joint_1..joint_7 gripper; the gripper's position is its width [m]."""

    t: float
    name: list[str]
    position: list[float]
    velocity: list[float]
    effort: list[float]


class BrainState(Message):
    state: BrainStateName
    t: float = 0.0
    mission_id: str = ""
    command: str = ""
    step: str = ""
    detail: str = ""
    started: float = 0.0
    pipeline: str = ""
    last: "MissionOutcome | None" = None


class MissionOutcome(Message):
    """How the last mission ended."""

    id: str
    command: str
    outcome: Literal["delivered", "failed", "cancelled"]
    reason: str = ""
    t: float = 0.0


class TreeNode(Message):
    name: str
    type: str
    status: str
    detail: str = ""
    children: list["TreeNode"] = []


class TreeSnapshot(Message):
    t: float
    root: TreeNode
    tick: int = 0


# --- VLA pipeline ---------------------------------------------------------------------------------


class VoiceCommand(Message):
    """A command in words; `confirmed`: the sender vouches for them (typed text), so nobody asks "Did you say ...?"."""

    text: str
    confidence: float = 1.0
    id: str = ""
    confirmed: bool = False


class KnownWorld(Message):
    objects: list[str] = []
    places: list[str] = []
    receptacles: list[str] = []
    held: str = ""


class RejectedPlan(Message):
    steps: list["PlanStep"] = []
    reason: str = ""


class PlanStep(Message):
    """One step of a plan. `grasp` and `release` with the target `gripper` close and open the hand around nothing."""

    action: StepAction
    object: str = ""
    target: str = ""
    text: str = ""

    @property
    def hand_alone(self) -> bool:
        """A step of the gripper that needs no arm and names no object."""
        return self.action in ("grasp", "release") and self.target == GRIPPER and not self.object


class PlanRequest(Message):
    """`done`: steps already carried out for this command, from a sender that asks again after a plan marked `again`."""

    id: str
    command: str
    world: KnownWorld = msgspec.field(default_factory=KnownWorld)
    rejected: RejectedPlan | None = None
    done: list["PlanStep"] | None = None


class ActionPlan(Message):
    """`again`: these steps only go and look; the command has to be planned anew with what they show."""

    request_id: str
    steps: list[PlanStep]
    source: str = ""
    detail: str = ""
    again: bool = False


class PlannerStatus(Message):
    """Who plans now: the `model` at `url`, or the grammar; `detail` says why there is no model."""

    backend: PlannerBackend
    model: str = ""
    url: str = ""
    detail: str = ""


class ObjectQuery(Message):
    """`since` [s]: only what a picture taken at that robot time or later shows counts, and the picture is wanted."""

    id: str
    query: str
    since: float = 0.0


class ObjectPose(Message):
    """The answer to a query. `candidates` names the objects that match when several do and none is chosen.

    `seen_at`: when a picture last showed the object; `on` names its receptacle, "" the floor or not known; `tilt` as
    in `WorldObject`. `picture`: a JPEG of the view behind the answer, for queries with `since`.
    """

    query_id: str
    found: bool
    label: str = ""
    confidence: float = 0.0
    frame: str = "map"
    position: Vec3 = (0.0, 0.0, 0.0)
    orientation: Quat = IDENTITY
    size: Vec3 = (0.0, 0.0, 0.0)
    seen_at: float = 0.0
    detail: str = ""
    candidates: list[str] = []
    on: str = ""
    tilt: float = 0.0
    picture: bytes = b""


class NavGoal(Message):
    """A standing pose [m, rad] to drive to; the answers come on `navigation_feedback`.

    `object`: what the pose is for. A navigator that knows where the arm reaches it from may stand elsewhere before it.
    """

    x: float
    y: float
    theta: float = 0.0
    frame: str = "map"
    id: str = ""
    attempt: int = 1
    object: ObjectRef | None = None


class NavigationFeedback(Message):
    """How a goal stands: `distance_remaining` [m], `eta` [s].

    `recoveries` counts other paths taken or tried since the goal was sent; the sender of a goal that failed BLOCKED
    adds to them only what is missing to two. An `attempt` of 0 is one that the navigator does not state.
    """

    goal_id: str
    status: NavStatus
    distance_remaining: float = 0.0
    eta: float = 0.0
    recoveries: int = 0
    code: str = ""
    attempt: int = 0
    detail: str = ""


class GripperCommand(Message):
    """`position` 0 open .. 1 closed; `max_effort` [N]."""

    position: float
    max_effort: float = 40.0


class SystemStatus(Message):
    state: SystemStateName
    mission_id: str = ""
    detail: str = ""


# --- robot and simulation -------------------------------------------------------------------------


class RobotStop(Message):
    reason: str = ""
    source: str = ""


class RobotResume(Message):
    """Releases the brake. `go_on`: the brain also takes up the mission that the stop has cut short."""

    source: str = ""
    go_on: bool = False


class CmdVel(Message):
    """Base velocity in the robot's own frame [m/s, m/s, rad/s]; 0.25 s of silence means hold."""

    vx: float
    vy: float
    omega: float


class ArmCommand(Message):
    """Joint set-points [rad] to be reached `period` seconds after receipt; a stream, 0.25 s of silence means hold."""

    position: list[float]
    period: float = 0.02
    t: float = 0.0


class Odometry(Message):
    """Wheel odometry: pose in frame `odom`, velocity in the robot's frame."""

    t: float
    x: float
    y: float
    theta: float
    vx: float = 0.0
    vy: float = 0.0
    omega: float = 0.0


class PoseEstimate(Message):
    """The robot's pose in frame `map` as navigation believes it; `covariance` row-major 3 x 3."""

    t: float
    x: float
    y: float
    theta: float
    covariance: list[float] = []


class LaserScan(Message):
    """Ranges [m] counter-clockwise from `angle_min` in the lidar's frame; > range_max means nothing seen.

    `ranges` is float32 little-endian; the lidar sits at (`x`, `y`) in the base frame.
    """

    t: float
    ranges: bytes
    angle_min: float = -3.141592653589793
    angle_increment: float = 0.017453292519943295
    range_min: float = 0.05
    range_max: float = 10.0
    x: float = 0.0
    y: float = 0.0


class NavPath(Message):
    """The path being followed, for viewers: points in frame map."""

    t: float
    points: list[tuple[float, float]]
    goal_id: str = ""


class Costmap(Message):
    """Room for the base's centre, for viewers: clearance of `width` x `height` cells of `resolution` [m].

    `cells` is zlib of uint8, row by row from the south-west corner (`x`, `y`): 0 occupied, 255 for `far` [m] or more.
    """

    t: float
    x: float
    y: float
    resolution: float
    width: int
    height: int
    far: float
    cells: bytes


class GraspCandidate(Message):
    """Pose of the pinch point (z: approach, y: across the fingers) and width there [m], in frame map."""

    name: str
    position: Vec3
    orientation: Quat
    width: float
    state: Literal["open", "failed", "chosen"] = "open"


class GraspCandidates(Message):
    """What manipulation considers for the object that it is about to grab, in the order it tries, for viewers."""

    t: float
    object: str
    candidates: list[GraspCandidate]
    goal_id: str = ""


class SimState(Message):
    """Full physics state for cameras and viewers: float64 little-endian qpos and mocap poses."""

    t: float
    tick: int
    epoch: str
    qpos: bytes
    mocap: bytes = b""


class Touch(Message):
    """The robot or what it holds in contact with something, without a break; updates carry the same `id`.

    `kind`: what the robot's `part` touches, itself included, or `held`: then `part` is the object in the hand. Greatest
    `force` [N], `impulse` [Ns] and contact time `seconds` so far, greatest `depth` [m] of overlap.
    """

    id: int
    part: str
    thing: str
    kind: TouchKind
    first: float
    last: float
    seconds: float = 0.0
    force: float = 0.0
    impulse: float = 0.0
    depth: float = 0.0


class SimContacts(Message):
    """Touches that began or went on since the last message, from every physics step; for evaluators alone."""

    t: float
    epoch: str
    touches: list[Touch]


class SimModel(Message):
    scene: str
    seed: int
    epoch: str
    mjcf: str


class RobotDescription(Message):
    """Robot-only MJCF, the robot's drawing as on `robot_description`."""

    mjcf: str


class SimStatus(Message):
    """`epoch` names the process, `world` the layout that it simulates, which outlives the process."""

    state: Literal["running", "paused", "stopped"]
    speed: str = "realtime"
    epoch: str = ""
    scene: str = ""
    seed: int = 0
    world: str = ""
    detail: str = ""


class SimClockTick(Message):
    """Robot time; published after the state of that tick."""

    t: float
    tick: int = -1
    epoch: str = ""
    lockstep: bool = False


class LockstepAck(Message):
    """Participant `name` has finished `tick` (tick -1: joins) and is due every `period` ticks.

    `heard`: the keys of messages without a tick, from clients, that the step saw first, one entry for each.
    """

    name: str
    tick: int
    period: int
    epoch: str = ""
    heard: list[str] = []


class CameraRequest(Message):
    id: str
    camera: Literal["head", "wrist"]
    width: int = 320
    height: int = 240


class Rgbd(Message):
    """One RGB-D image: rgb uint8 h*w*3, depth uint16 [mm] h*w (0: nothing seen).

    `position`, `orientation`: pose of the optical frame (x right, y down, z forward) in the base frame.
    """

    t: float
    id: str
    camera: str
    width: int
    height: int
    fx: float
    fy: float
    cx: float
    cy: float
    position: Vec3
    orientation: Quat
    rgb: bytes
    depth: bytes
    backend: str = ""


class PageStatus(Message):
    """Where the operator's page is."""

    url: str


# --- every process --------------------------------------------------------------------------------


class Health(Message):
    name: str
    epoch: str
    t: float
    uptime: float
    hz: float
    drops: int
    rss_mb: float
    pid: int
    last_error: str = ""
    by_key: dict[str, int] = {}


class LogRecord(Message):
    t: float
    service: str
    level: str
    event: str
    fields: dict[str, object] = {}
