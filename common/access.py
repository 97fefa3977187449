"""Who may publish, subscribe and ask what: Zenoh access control generated from the topic table.

A certificate's common name is `<service>`, or `<namespace>/<service>` for a robot that has a namespace. What is not
granted here is denied: a service writes the topics whose table row names it, reads the topics listed below, and
answers its own queries. Clients are people's tools: an operator reads everything and writes what `*` may write, an
observer only reads. Routers, which link with each other, pass everything.
"""

from collections.abc import Iterable
from typing import Any, Literal

import msgspec

from common import topics as t
from common.topics import Topic

Role = Literal["service", "operator", "observer", "router"]
ANYONE = "*"
ROUTER, OPERATOR, EAR = "router", "operator", "ear"

# What each service subscribes to; tests/unit/test_access.py holds it against the services themselves.
READS: dict[str, tuple[Topic[Any], ...]] = {
    "sim": (t.BASE_TARGET, t.CMD_VEL, t.ARM_COMMAND, t.GRIPPER_COMMAND, t.ROBOT_STOP, t.ROBOT_RESUME),
    "camera": (t.SIM_MODEL, t.SIM_STATE, t.CAMERA_REQUEST),
    "navigation": (
        t.NAVIGATION_GOAL, t.NAV_GOAL, t.GOAL_REACHED, t.ODOMETRY, t.JOINT_STATES, t.SCAN, t.WORLD_OBJECTS,
        t.ROBOT_STOP,
    ),
    "manipulation": (
        t.MANIPULATION_GOAL, t.NAVIGATION_GOAL, t.JOINT_STATES, t.POSE, t.ODOMETRY, t.WORLD_OBJECTS,
        t.ROBOT_DESCRIPTION, t.ROBOT_STOP,
    ),
    "speech": (t.SPEECH_GOAL, t.SPEECH_TEXT, t.AUDIO_PCM),
    "brain": (
        t.SPEECH_RESULT, t.SPEECH_STATUS, t.VOICE_COMMAND, t.NAVIGATION_STATUS, t.NAVIGATION_FEEDBACK,
        t.MANIPULATION_STATUS, t.ACTION_PLAN, t.OBJECT_POSE, t.WORLD_OBJECTS, t.SIM_STATUS, t.ROBOT_STOP,
        t.ROBOT_RESUME, t.POSE, t.JOINT_STATES,
    ),
    "planner": (t.PLAN_REQUEST, t.WORLD_OBJECTS, t.POSE),
    "perception": (
        t.OBJECT_QUERY, t.HEAD_RGBD, t.WRIST_RGBD, t.POSE, t.JOINT_STATES, t.ROBOT_DESCRIPTION,
        t.MANIPULATION_STATUS, t.SIM_STATUS,
    ),
    "dashboard": (
        t.SIM_MODEL, t.SIM_STATUS, t.JOINT_STATES, t.POSE, t.SCAN, t.NAV_PATH, t.COSTMAP, t.GRASPS, t.ARM_COMMAND,
        t.WORLD_OBJECTS, t.BRAIN_STATE, t.BRAIN_TREE, t.ACTION_PLAN, t.SPEECH_GOAL, t.SPEECH_RESULT, t.SPEECH_STATUS,
        t.NAVIGATION_FEEDBACK, t.MANIPULATION_STATUS, t.HEAD_RGBD, t.WRIST_RGBD, t.AUDIO_OUT,
    ),
}  # fmt: skip

# Services that a person acts through, and which of the topics that any client may write they do write.
ON_BEHALF: dict[str, tuple[Topic[Any], ...]] = {
    "dashboard": (t.VOICE_COMMAND, t.ROBOT_STOP, t.ROBOT_RESUME, t.NAV_GOAL, t.CAMERA_REQUEST, t.AUDIO_PCM),
}

# Queries: who answers, and whether the question changes something (then observers may not ask).
SERVES: dict[str, str] = {
    t.BRAIN_MISSIONS: "brain",
    t.SIM_RESET: "sim",
    t.SIM_PAUSE: "sim",
    t.SIM_SNAPSHOT: "sim",
    t.SIM_TRUTH: "sim",
}
ASKS: dict[str, tuple[str, ...]] = {"dashboard": (t.BRAIN_MISSIONS,)}
CHANGING = (t.SIM_RESET, t.SIM_PAUSE, t.SIM_SNAPSHOT)

ALL_HEALTH, ALL_ALIVE = t.HEALTH_KEY.format(name="*"), t.ALIVE_KEY.format(name="*")
ADVANCED = "@adv/**"  # caches, heartbeats and tokens of advanced publishers live below the key
EVERYTHING = ("**", f"**/{ADVANCED}")


class Subject(msgspec.Struct, frozen=True):
    """One certificate. `name` without the namespace; `common_name` with it."""

    name: str
    role: Role = "service"
    namespace: str = ""

    @property
    def common_name(self) -> str:
        return f"{self.namespace}/{self.name}" if self.namespace else self.name


class Grants(msgspec.Struct, frozen=True):
    """Keys, without namespace, that a subject may use: publish, subscribe, answer queries, ask, and show as alive."""

    puts: tuple[str, ...] = ()
    reads: tuple[str, ...] = ()
    answers: tuple[str, ...] = ()
    asks: tuple[str, ...] = ()
    tokens: tuple[str, ...] = ()


def grants(subject: Subject) -> Grants:
    """What the table gives a subject that is not a router."""
    if subject.role == "service":
        return _service(subject.name)
    questions = tuple(k for k in SERVES if k not in CHANGING)
    if subject.role == "observer":
        return Grants(reads=EVERYTHING, asks=(*questions, *(topic.key for topic in t.TABLE), ALL_HEALTH))
    puts = tuple(topic.key for topic in t.TABLE if ANYONE in topic.writers)
    return Grants(puts=puts, reads=EVERYTHING, asks=EVERYTHING, tokens=(t.ALIVE_KEY.format(name=EAR),))


def _service(name: str) -> Grants:
    written = [topic for topic in t.TABLE if name in topic.writers] + list(ON_BEHALF.get(name, ()))
    read = list(READS.get(name, ()))
    if name == "sim":
        read.append(t.LOCKSTEP_ACK)
    else:
        written.append(t.LOCKSTEP_ACK)
        read += t.CLOCKS
    health, alive = t.HEALTH_KEY.format(name=name), t.ALIVE_KEY.format(name=name)
    served = (k for k, server in SERVES.items() if server == name)
    return Grants(
        puts=(*(topic.key for topic in written), health, t.LOG_KEY.format(name=name)),
        reads=(*(topic.key for topic in read), ALL_HEALTH, ALL_ALIVE),
        answers=(*(topic.key for topic in written if topic.latched), health, *served),
        asks=(*(topic.key for topic in read), ALL_HEALTH, *ASKS.get(name, ())),
        tokens=(alive,),
    )


def acl(subjects: Iterable[Subject]) -> dict[str, Any]:
    """Zenoh's `access_control` for these certificates; everything else is denied."""
    subjects = list(subjects)
    robots = sorted({s.namespace for s in subjects if s.role != "router"})
    rules: list[dict[str, Any]] = []
    policies: list[dict[str, Any]] = []
    for subject in subjects:
        name = subject.common_name
        made = [_open(name)] if subject.role == "router" else _rules(subject, robots)
        rules += made
        policies.append({"rules": [r["id"] for r in made], "subjects": [name]})
    listed = [{"id": s.common_name, "cert_common_names": [s.common_name]} for s in subjects]
    return {"enabled": True, "default_permission": "deny", "rules": rules, "subjects": listed, "policies": policies}


MESSAGES = (
    "put", "delete", "declare_subscriber", "query", "declare_queryable", "reply",
    "liveliness_token", "liveliness_query", "declare_liveliness_subscriber",
)  # fmt: skip


def _open(name: str) -> dict[str, Any]:
    return _rule(f"{name}: everything", MESSAGES, ("ingress", "egress"), (*EVERYTHING, "@/**"))


def _rules(subject: Subject, robots: list[str]) -> list[dict[str, Any]]:
    """Ingress is what the subject sends to the router, egress what it gets from it."""
    granted, name = grants(subject), subject.common_name

    def below(keys: Iterable[str], advanced: bool = False) -> tuple[str, ...]:
        """The keys in the robot's namespace, with those of advanced publishers below them."""
        keys = tuple(keys)
        if advanced:
            keys += tuple(f"{k}/{ADVANCED}" for k in keys if not k.endswith("**"))
        return tuple(f"{subject.namespace}/{k}" if subject.namespace else k for k in keys)

    puts, reads = below(granted.puts, True), below(granted.reads, True)
    answers, asks = below(granted.answers), below(granted.asks)
    tokens = below(granted.tokens)
    caches = tuple(k for k in puts if k.endswith(ADVANCED))
    histories = tuple(k for k in reads if k.endswith(ADVANCED))
    listening = ("declare_subscriber", "declare_liveliness_subscriber", "liveliness_query")
    parts = (
        ("publishes", ("put", "delete"), ("ingress",), puts),
        # A subscription may be wider than the key, as that to everybody's health is; only what is asked for is sent.
        ("is matched", ("declare_subscriber",), ("egress",), below(EVERYTHING)),
        ("answers", ("declare_queryable",), ("ingress",), (*answers, *caches)),
        ("replies", ("reply",), ("ingress",), (*answers, *puts)),
        # A question may be wider than the key; it only comes to who may declare that it answers.
        ("is asked", ("query",), ("egress",), below(EVERYTHING) if answers else ()),
        ("is alive", ("liveliness_token",), ("ingress",), (*tokens, *caches)),
        ("subscribes", listening, ("ingress",), reads),
        ("receives", ("put", "delete", "reply", "liveliness_token"), ("egress",), (*reads, *asks)),
        ("asks", ("query",), ("ingress",), (*asks, *histories)),
        ("finds", ("declare_queryable",), ("egress",), (*asks, *histories)),
    )
    made = [_rule(f"{name}: {what}", messages, flows, keys) for what, messages, flows, keys in parts if keys]
    others = [f"{r}/**" for r in robots if r and r != subject.namespace and not subject.namespace.startswith(f"{r}/")]
    if others and "**" in reads:
        denied = (*others, *(f"{k}/{ADVANCED}" for k in others))
        made.append(_rule(f"{name}: other robots", MESSAGES, ("ingress", "egress"), denied, "deny"))
    return made


def _rule(
    name: str, messages: Iterable[str], flows: Iterable[str], keys: Iterable[str], permission: str = "allow"
) -> dict[str, Any]:
    return {
        "id": name,
        "permission": permission,
        "messages": list(messages),
        "flows": list(flows),
        "key_exprs": list(dict.fromkeys(keys)),
    }
