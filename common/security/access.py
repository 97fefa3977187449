"""Zenoh access control, generated from the topic table: who may publish, subscribe to and ask what.

A certificate's common name is `<service>`, or `<namespace>/<service>` for a robot that has a namespace. What is not
granted here is denied: a service writes and reads the topics whose row names it, and answers its own queries. Clients
are people's tools: an operator reads everything and writes what `*` may write, an observer only reads. An agent is a
program that commands the robot in words: it may say what a person may say and stop the robot, and drives nothing. A
ROS peer has the keys of its ROS domain and nothing of the robot's own: the gateway stands between. Routers, which link
with each other, pass everything. A fleet's desk sees where every robot is and what it does, gives commands in words
and stops; it is the one client that reaches several robots, so it has no namespace and may do least.
"""

from collections.abc import Iterable
from typing import Any, Literal

import msgspec

from common import topics as t
from common.topic import ANYONE, EACH, Topic

Role = Literal["service", "operator", "observer", "agent", "fleet", "router", "ros"]
ROUTER, OPERATOR, AGENT, FLEET, EAR, GATEWAY = "router", "operator", "agent", "fleet", "ear", "ros2"

CHANGING = tuple(q.key for q in t.QUERIES if q.changing)
ALL_HEALTH, ALL_ALIVE = t.HEALTH.key, t.ALIVE_KEY.format(name="*")
ADVANCED = "@adv/**"  # caches, heartbeats and tokens of advanced publishers live below the key
EVERY_ROBOT = "**"  # any namespace, and none
EVERYTHING = ("**", f"**/{ADVANCED}")
AGENT_PUTS = (t.VOICE_COMMAND, t.ROBOT_STOP, t.CAMERA_REQUEST)
"""Words, which brain and planner check as a person's, the brake, and the wish for a picture. Not `robot/resume`: what
was stopped goes on when a person says so."""
AGENT_READS = (
    t.BRAIN_STATE, t.SYSTEM_STATUS, t.SPEECH_STATUS, t.SIM_STATUS, t.WORLD_OBJECTS, t.POSE, t.COSTMAP, t.HEAD_RGBD,
    t.WRIST_RGBD,
)  # fmt: skip


FLEET_PUTS = (t.VOICE_COMMAND, t.ROBOT_STOP)
FLEET_READS = (t.BRAIN_STATE, t.SIM_STATUS, t.POSE, t.NAV_PATH, t.BATTERY, t.WORLD_OBJECTS, t.COSTMAP)


class Subject(msgspec.Struct, frozen=True):
    """One certificate. `name` without the namespace; `common_name` with it. `domain`: of those who speak ROS."""

    name: str
    role: Role = "service"
    namespace: str = ""
    domain: int = 0

    @property
    def common_name(self) -> str:
        return f"{self.namespace}/{self.name}" if self.namespace else self.name


class Grants(msgspec.Struct, frozen=True):
    """Keys, without namespace, that a subject may use: publish, subscribe, answer queries, ask, and show as alive.

    `abroad`: those that it may read of every robot on the router, `heard_abroad`: those of its own that others may.
    """

    puts: tuple[str, ...] = ()
    reads: tuple[str, ...] = ()
    answers: tuple[str, ...] = ()
    asks: tuple[str, ...] = ()
    tokens: tuple[str, ...] = ()
    abroad: tuple[str, ...] = ()
    heard_abroad: tuple[str, ...] = ()


def grants(subject: Subject) -> Grants:
    """What the table gives a subject that is not a router."""
    if subject.role == "service":
        return _service(subject.name)
    if subject.role == "agent":
        reads = tuple(topic.key for topic in AGENT_READS)
        return Grants(
            puts=tuple(topic.key for topic in AGENT_PUTS),
            reads=(*reads, ALL_HEALTH, ALL_ALIVE),
            asks=(*reads, ALL_HEALTH, t.BRAIN_MISSIONS),
        )
    if subject.role == "fleet":
        reads = tuple(topic.key for topic in FLEET_READS)
        puts = tuple(topic.key for topic in FLEET_PUTS)
        return Grants(puts=puts, reads=(*reads, ALL_HEALTH, ALL_ALIVE), asks=(*reads, ALL_HEALTH))
    if subject.role == "ros":
        return Grants()
    questions = tuple(q.key for q in t.QUERIES if not q.changing)
    if subject.role == "observer":
        return Grants(reads=EVERYTHING, asks=(*questions, *(topic.key for topic in t.TABLE), ALL_HEALTH))
    puts = tuple(topic.key for topic in t.TABLE if ANYONE in topic.writers)
    return Grants(puts=puts, reads=EVERYTHING, asks=EVERYTHING, tokens=(t.ALIVE_KEY.format(name=EAR),))


def _service(name: str) -> Grants:
    """What the rows that name a service, or each, give it: the other side of a row of each does not get both."""
    written = [row.key for row in t.TABLE if name in row.writers or (EACH in row.writers and name not in row.readers)]
    own_rows = t.subscribed(name)
    read = [row.key for row in t.TABLE if row in own_rows or _reads(row, name)]
    latched = [key for key in written if t.BY_KEY[key].latched]
    own, health = [row.of(name) for row in t.PER_SERVICE], t.HEALTH.of(name)
    return Grants(
        puts=(*written, *own),
        reads=(*read, *(row.key for row in t.PER_SERVICE if row in (*own_rows, t.HEALTH)), ALL_ALIVE),
        answers=(*latched, health, *(q.key for q in t.QUERIES if q.server == name)),
        asks=(*read, ALL_HEALTH, *(q.key for q in t.QUERIES if name in q.askers)),
        tokens=(t.ALIVE_KEY.format(name=name),),
        abroad=tuple(row.key for row in t.TABLE if name in row.abroad),
        heard_abroad=tuple(row.key for row in t.TABLE if name in row.writers and row.abroad),
    )


def _reads(row: Topic[Any], name: str) -> bool:
    return name in row.readers or (EACH in row.readers and name not in row.writers)


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


def _ros(name: str, domain: int) -> dict[str, Any]:
    """The keys of one ROS domain, which are below no robot's namespace: what gateways do is said by their own rows."""
    keys = (f"{domain}/**", f"{domain}/**/{ADVANCED}", f"@ros2_lv/{domain}/**")
    return _rule(f"{name}: ros domain {domain}", MESSAGES, ("ingress", "egress"), keys)


def _rules(subject: Subject, robots: list[str]) -> list[dict[str, Any]]:
    """Ingress is what the subject sends to the router, egress what it gets from it."""
    granted, name = grants(subject), subject.common_name
    if subject.role == "ros":
        return [_ros(name, subject.domain)]

    def below(keys: Iterable[str], advanced: bool = False) -> tuple[str, ...]:
        """The keys in the robot's namespace, with those of advanced publishers below them."""
        keys = tuple(keys)
        if advanced:
            keys += tuple(f"{k}/{ADVANCED}" for k in keys if not k.endswith("**"))
        if subject.role == "fleet":
            return tuple(k if k.startswith(EVERY_ROBOT) else f"{EVERY_ROBOT}/{k}" for k in keys)
        return tuple(f"{subject.namespace}/{k}" if subject.namespace else k for k in keys)

    abroad = tuple(f"{EVERY_ROBOT}/{key}" for key in granted.abroad)
    puts, reads = below(granted.puts, True), (*below(granted.reads, True), *abroad)
    matched = tuple(f"{EVERY_ROBOT}/{key}" for key in granted.heard_abroad)
    answers, asks = below(granted.answers), below(granted.asks)
    tokens = below(granted.tokens)
    caches = tuple(k for k in puts if k.endswith(ADVANCED))
    histories = tuple(k for k in reads if k.endswith(ADVANCED))
    listening = ("declare_subscriber", "declare_liveliness_subscriber", "liveliness_query")
    parts = (
        ("publishes", ("put", "delete"), ("ingress",), puts),
        # A subscription may be wider than the key, as that to everybody's health is; only what is asked for is sent.
        ("is matched", ("declare_subscriber",), ("egress",), (*below(EVERYTHING), *matched)),
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
    if subject.role == "service" and subject.name == GATEWAY:
        made.append(_ros(name, subject.domain))
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
