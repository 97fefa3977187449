"""What the access control grants, against the services themselves and against what must never be possible."""

import importlib
from typing import Any

import pytest

from cli.processes.services import NAMES
from common import topics
from common.security import access
from common.security.access import Subject

SERVICES = tuple(n for n in NAMES if n != "router")
MOVES = {
    topics.CMD_VEL.key, topics.BASE_TARGET.key, topics.NAV_GOAL.key, topics.NAVIGATION_GOAL.key,
    topics.MANIPULATION_GOAL.key, topics.ARM_COMMAND.key, topics.GRIPPER_COMMAND.key, topics.ROBOT_RESUME.key,
    topics.SIM_CLOCK.key, topics.WORLD_OBJECTS.key, topics.ACTION_PLAN.key,
}  # fmt: skip


def service(name: str) -> Any:
    module = importlib.import_module(f"services.{name}.service")
    return next(v for v in vars(module).values() if isinstance(v, type) and getattr(v, "NAME", None) == name)


@pytest.mark.parametrize("name", SERVICES)
def test_a_service_may_do_what_its_rows_say_and_no_more(name: str) -> None:
    granted = access.grants(Subject(name=name))
    clock = set() if name == "sim" else {t.key for t in topics.CLOCKS}
    reads = {t.key for t in service(name).READS} | clock | {access.ALL_HEALTH, access.ALL_ALIVE}
    assert set(granted.reads) == reads | ({topics.LOCKSTEP_ACK.key} if name == "sim" else set())
    own = {topics.HEALTH.of(name), topics.LOG.of(name)}
    ticks = {t.key for t in topics.CLOCKS} if name == "sim" else {topics.LOCKSTEP_ACK.key}
    assert set(granted.puts) == {t.key for t in service(name).WRITES} | own | ticks


def test_what_is_really_there_reaches_the_camera_alone() -> None:
    """Whoever decides has to look; the page draws the model of what stands still, viewers show people everything."""
    for name in sorted(set(SERVICES) - set(topics.VIEWERS)):
        granted = access.grants(Subject(name=name))
        assert (topics.SIM_STATE.key in granted.reads) == (name == "camera"), name
        assert topics.SIM_CONTACTS.key not in granted.reads, name
        assert topics.SIM_TRUTH not in granted.asks, name
        assert (topics.SIM_MODEL.key in granted.reads) == (name in ("camera", "dashboard")), name


def test_speech_moves_nothing_but_may_stop() -> None:
    puts = set(access.grants(Subject(name="speech")).puts)
    assert not puts & MOVES
    assert topics.ROBOT_STOP.key in puts


@pytest.mark.parametrize("name", SERVICES)
def test_a_service_speaks_only_for_itself(name: str) -> None:
    granted = access.grants(Subject(name=name))
    for other in set(SERVICES) - {name}:
        for key in (topics.HEALTH.of(other), topics.ALIVE_KEY.format(name=other), topics.LOG.of(other)):
            assert key not in (*granted.puts, *granted.answers, *granted.tokens)


def test_an_observer_changes_nothing() -> None:
    granted = access.grants(Subject(name="guest", role="observer"))
    assert granted.puts == granted.answers == granted.tokens == ()
    assert not set(granted.asks) & set(access.CHANGING)


def test_only_clients_and_services_for_people_write_what_anyone_may() -> None:
    for_people = {"dashboard", *topics.VIEWERS}
    anyone = {t.key for t in topics.TABLE if "*" in t.writers and set(t.writers) <= {"*", *for_people}}
    assert set(access.grants(Subject(name="alice", role="operator")).puts) >= anyone
    for name in set(SERVICES) - for_people:
        assert not set(access.grants(Subject(name=name)).puts) & anyone, name


def rules(made: dict[str, Any], name: str) -> list[dict[str, Any]]:
    ids = next(p["rules"] for p in made["policies"] if p["subjects"] == [name])
    return [r for r in made["rules"] if r["id"] in ids]


def test_denied_unless_granted_and_every_robot_in_its_own_namespace() -> None:
    who = [Subject(name="router", role="router"), Subject(name="speech"), Subject(name="speech", namespace="kitchen")]
    made = access.acl(who)
    assert made["enabled"]
    assert made["default_permission"] == "deny"
    assert [s["cert_common_names"] for s in made["subjects"]] == [["router"], ["speech"], ["kitchen/speech"]]
    for rule in rules(made, "kitchen/speech"):
        assert all(k.startswith("kitchen/") for k in rule["key_exprs"])
    for rule in rules(made, "speech"):
        assert not any(k.startswith("kitchen/") for k in rule["key_exprs"])


def test_an_operator_of_the_nameless_robot_is_kept_out_of_the_others() -> None:
    made = access.acl([Subject(name="op", role="operator"), Subject(name="op", role="operator", namespace="kitchen")])
    denied = [r for r in rules(made, "op") if r["permission"] == "deny"]
    assert denied
    assert "kitchen/**" in denied[0]["key_exprs"]
    assert not [r for r in rules(made, "kitchen/op") if r["permission"] == "deny"]


def test_no_key_hides_behind_another() -> None:
    """Wildcards in grants would let one key in through the pattern of another."""
    for name in SERVICES:
        granted = access.grants(Subject(name=name))
        assert not [k for k in (*granted.puts, *granted.answers, *granted.tokens) if "*" in k]
        logs = {topics.LOG.key} if name in topics.VIEWERS else set()
        assert {k for k in granted.reads if "*" in k} == {access.ALL_HEALTH, access.ALL_ALIVE} | logs


def test_what_is_really_so_is_for_evaluators_alone() -> None:
    """No service may read or ask for it, and none asks the bus for it; who evaluates may."""
    truth = {topics.SIM_TRUTH, topics.SIM_CONTACTS.key}
    for name in SERVICES:
        granted = access.grants(Subject(name=name))
        assert not truth & {*granted.reads, *granted.asks}, name
        assert topics.SIM_CONTACTS not in service(name).READS
    assert topics.SIM_CONTACTS.writers == ("sim",)
    judge = access.grants(Subject(name="judge", role="observer"))
    assert "**" in judge.reads and truth <= {*judge.asks}


def test_only_the_page_may_ask_for_the_missions_and_it_answers_for_nobody() -> None:
    asking = {name for name in SERVICES if topics.BRAIN_MISSIONS in access.grants(Subject(name=name)).asks}
    assert asking == {"dashboard"}
    granted = access.grants(Subject(name="dashboard"))
    assert not set(granted.asks) & {*access.CHANGING, topics.SIM_TRUTH}
    assert topics.BRAIN_MISSIONS not in granted.answers


def test_a_ros_peer_has_the_keys_of_its_domain_and_nothing_of_the_robot() -> None:
    who = [Subject(name="ros2", domain=7), Subject(name="laptop", role="ros", domain=7), Subject(name="speech")]
    made = access.acl(who)
    keys = ["7/**", "7/**/@adv/**", "@ros2_lv/7/**"]
    assert rules(made, "laptop") == [row("laptop: ros domain 7", EVERY_MESSAGE, "ingress egress", keys)]
    assert row("ros2: ros domain 7", EVERY_MESSAGE, "ingress egress", keys) in rules(made, "ros2")
    assert access.grants(who[1]) == access.Grants()
    assert not [r for r in rules(made, "speech") if any("ros" in key for key in r["key_exprs"])]


# --- written out in full: what the router is told of one certificate of each sort
def below(prefix: str, keys: str, deep: str = "") -> list[str]:
    """Keys of a namespace, then those of advanced publishers below them."""
    return [prefix + key for key in keys.split()] + [f"{prefix}{key}/@adv/**" for key in deep.split()]


def row(name: str, messages: str, flows: str, keys: list[str], permission: str = "allow") -> dict[str, Any]:
    return {
        "id": name, "permission": permission, "messages": messages.split(), "flows": flows.split(), "key_exprs": keys,
    }  # fmt: skip


EVERY_MESSAGE = (
    "put delete declare_subscriber query declare_queryable reply "
    "liveliness_token liveliness_query declare_liveliness_subscriber"
)
LISTENING = "declare_subscriber declare_liveliness_subscriber liveliness_query"
COMING = "put delete reply liveliness_token"
CLOCKS = "sim/clock sim/clock/50hz sim/clock/20hz sim/clock/10hz"


def test_the_rules_of_a_router() -> None:
    made = access.acl([Subject(name="router", role="router")])
    everything = ["**", "**/@adv/**", "@/**"]
    assert made == {
        "enabled": True,
        "default_permission": "deny",
        "rules": [row("router: everything", EVERY_MESSAGE, "ingress egress", everything)],
        "subjects": [{"id": "router", "cert_common_names": ["router"]}],
        "policies": [{"rules": ["router: everything"], "subjects": ["router"]}],
    }


def test_the_rules_of_a_service() -> None:
    made = access.acl([Subject(name="planner", namespace="k")])
    puts = "action_plan planner/status sim/ack service/planner/health log/planner"
    asks = "plan_request world/objects household/edits household/sightings navigation/pose robot/battery"
    asks += f" {CLOCKS} service/*/health"
    reads = f"{asks} service/*/alive"
    answers, name = "action_plan planner/status service/planner/health", "k/planner"
    caches = below("k/", "", puts)
    assert made["rules"] == [
        row(f"{name}: publishes", "put delete", "ingress", below("k/", puts, puts)),
        row(f"{name}: is matched", "declare_subscriber", "egress", ["k/**", "k/**/@adv/**"]),
        row(f"{name}: answers", "declare_queryable", "ingress", below("k/", answers) + caches),
        row(f"{name}: replies", "reply", "ingress", below("k/", f"{answers} sim/ack log/planner") + caches),
        row(f"{name}: is asked", "query", "egress", ["k/**", "k/**/@adv/**"]),
        row(f"{name}: is alive", "liveliness_token", "ingress", ["k/service/planner/alive", *caches]),
        row(f"{name}: subscribes", LISTENING, "ingress", below("k/", reads, reads)),
        row(f"{name}: receives", COMING, "egress", below("k/", reads, reads)),
        row(f"{name}: asks", "query", "ingress", below("k/", asks, reads)),
        row(f"{name}: finds", "declare_queryable", "egress", below("k/", asks, reads)),
    ]
    assert made["subjects"] == [{"id": name, "cert_common_names": [name]}]
    assert made["policies"] == [{"rules": [r["id"] for r in made["rules"]], "subjects": [name]}]


def test_the_rules_of_an_operator() -> None:
    made = access.acl([Subject(name="op", role="operator", namespace="k")])
    puts = " ".join(topic.key for topic in topics.TABLE if "*" in topic.writers)
    assert {"voice_command", "robot/stop", "sim/ack"} <= set(puts.split())
    everything, name, caches = ["k/**", "k/**/@adv/**"], "k/op", below("k/", "", puts)
    assert made["rules"] == [
        row(f"{name}: publishes", "put delete", "ingress", below("k/", puts, puts)),
        row(f"{name}: is matched", "declare_subscriber", "egress", everything),
        row(f"{name}: answers", "declare_queryable", "ingress", caches),
        row(f"{name}: replies", "reply", "ingress", below("k/", puts, puts)),
        row(f"{name}: is alive", "liveliness_token", "ingress", ["k/service/ear/alive", *caches]),
        row(f"{name}: subscribes", LISTENING, "ingress", everything),
        row(f"{name}: receives", COMING, "egress", everything),
        row(f"{name}: asks", "query", "ingress", everything),
        row(f"{name}: finds", "declare_queryable", "egress", everything),
    ]


SEEN_ABROAD = "brain/state sim/status navigation/pose navigation/path robot/battery world/objects navigation/costmap"
SEEN_BY_AGENTS = (
    "brain/state system_status speech/status sim/status world/objects navigation/pose navigation/costmap "
    "camera/head/rgbd camera/wrist/rgbd"
)


@pytest.mark.parametrize(
    ("who", "prefix", "puts", "seen", "question"),
    [
        (Subject("bot", "agent", "k"), "k/", "voice_command robot/stop camera/request", SEEN_BY_AGENTS,
         " brain/missions"),
        (Subject("desk", "fleet"), "**/", "voice_command robot/stop", SEEN_ABROAD, ""),
    ],
)  # fmt: skip
def test_the_rules_of_who_gives_commands_in_words(
    who: Subject, prefix: str, puts: str, seen: str, question: str
) -> None:
    """A program has them of one robot, a fleet's desk of every one."""
    asks, reads = f"{seen} service/*/health", f"{seen} service/*/health service/*/alive"
    name, caches = who.common_name, below(prefix, "", puts)
    everything = ["k/**", "k/**/@adv/**"] if who.namespace else ["**", "**/@adv/**"]
    assert access.acl([who])["rules"] == [
        row(f"{name}: publishes", "put delete", "ingress", below(prefix, puts, puts)),
        row(f"{name}: is matched", "declare_subscriber", "egress", everything),
        row(f"{name}: answers", "declare_queryable", "ingress", caches),
        row(f"{name}: replies", "reply", "ingress", below(prefix, puts, puts)),
        row(f"{name}: is alive", "liveliness_token", "ingress", caches),
        row(f"{name}: subscribes", LISTENING, "ingress", below(prefix, reads, reads)),
        row(f"{name}: receives", COMING, "egress", below(prefix, reads, reads) + below(prefix, question)),
        row(f"{name}: asks", "query", "ingress", below(prefix, f"{asks}{question}", reads)),
        row(f"{name}: finds", "declare_queryable", "egress", below(prefix, f"{asks}{question}", reads)),
    ]


def test_the_navigation_of_every_robot_hears_where_the_others_drive() -> None:
    navigation, speech = (access.grants(Subject(name)) for name in ("navigation", "speech"))
    assert navigation.abroad == navigation.heard_abroad == ("navigation/intent",)
    assert speech.abroad == speech.heard_abroad == ()
    made = {r["id"]: r["key_exprs"] for r in access.acl([Subject("navigation", namespace="k")])["rules"]}
    assert made["k/navigation: is matched"] == ["k/**", "k/**/@adv/**", "**/navigation/intent"]
    abroad = {what for what, keys in made.items() if "**/navigation/intent" in keys}
    assert abroad == {f"k/navigation: {what}" for what in ("is matched", "subscribes", "receives")}


def test_the_rules_of_an_observer_beside_another_robot() -> None:
    others = [Subject(name="speech", namespace=n) for n in ("k", "m")]
    made = access.acl([Subject(name="me", role="observer"), *others, Subject(name="router", role="router")])
    asks = ["brain/missions", "sim/truth", *(topic.key for topic in topics.TABLE), "service/*/health"]
    everything, name = ["**", "**/@adv/**"], "me"
    denied = ["k/**", "m/**", "k/**/@adv/**", "m/**/@adv/**"]
    assert rules(made, "me") == [
        row(f"{name}: is matched", "declare_subscriber", "egress", everything),
        row(f"{name}: subscribes", LISTENING, "ingress", everything),
        row(f"{name}: receives", COMING, "egress", [*everything, *asks]),
        row(f"{name}: asks", "query", "ingress", [*asks, "**/@adv/**"]),
        row(f"{name}: finds", "declare_queryable", "egress", [*asks, "**/@adv/**"]),
        row(f"{name}: other robots", EVERY_MESSAGE, "ingress egress", denied, "deny"),
    ]


def test_a_router_in_a_namespace_is_no_robot_to_be_denied() -> None:
    made = access.acl([Subject(name="me", role="observer"), Subject(name="router", role="router", namespace="k")])
    assert not [r for r in made["rules"] if r["permission"] == "deny"]


def test_a_service_is_denied_nothing_of_robots_that_it_was_never_granted() -> None:
    made = access.acl([Subject(name="speech"), Subject(name="speech", namespace="k")])
    assert not [r for r in made["rules"] if r["permission"] == "deny"]


def test_a_robot_below_another_in_name_is_its_own() -> None:
    made = access.acl([Subject(name="op", role="operator", namespace="k/arm"), Subject(name="speech", namespace="k")])
    assert not [r for r in rules(made, "k/arm/op") if r["permission"] == "deny"]


def test_the_simulation_takes_acknowledgements_and_says_the_time() -> None:
    sim, brain = (access.grants(Subject(name=name)) for name in ("sim", "brain"))
    clocks = {topic.key for topic in topics.CLOCKS}
    assert "sim/ack" in sim.reads and "sim/ack" not in sim.puts and not clocks & set(sim.reads)
    assert {"sim/reset", "sim/pause", "sim/snapshot", "sim/truth"} <= set(sim.answers)
    assert "sim/ack" in brain.puts and "sim/ack" not in brain.reads and clocks <= set(brain.reads)
    assert "brain/missions" in brain.answers and "sim/truth" not in brain.answers


def test_a_name_that_the_table_does_not_know_gets_its_health_and_the_time_only() -> None:
    granted = access.grants(Subject(name="odometer"))
    assert granted.puts == ("sim/ack", "service/odometer/health", "log/odometer")
    assert granted.reads == (*CLOCKS.split(), "service/*/health", "service/*/alive")
    assert granted.answers == ("service/odometer/health",)
    assert granted.asks == (*CLOCKS.split(), "service/*/health")
    assert granted.tokens == ("service/odometer/alive",)
