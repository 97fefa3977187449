"""What the access control grants, against the services themselves and against what must never be possible."""

import importlib
from typing import Any

import pytest

from cli.services import NAMES
from common import access, topics
from common.access import Subject

SERVICES = tuple(n for n in NAMES if n != "router")
MOVES = {
    topics.CMD_VEL.key, topics.BASE_TARGET.key, topics.NAV_GOAL.key, topics.NAVIGATION_GOAL.key,
    topics.MANIPULATION_GOAL.key, topics.ARM_COMMAND.key, topics.GRIPPER_COMMAND.key, topics.ROBOT_RESUME.key,
    topics.SIM_CLOCK.key, topics.WORLD_OBJECTS.key, topics.ACTION_PLAN.key,
}  # fmt: skip


def service(name: str) -> Any:
    module = importlib.import_module(f"services.{name}.service")
    return next(v for v in vars(module).values() if isinstance(v, type) and getattr(v, "NAME", None) == name)


def test_every_service_has_its_row_and_no_other_has() -> None:
    assert set(access.READS) == set(SERVICES), "common/access.py: READS has one row for each of cli/services.py"


@pytest.mark.parametrize("name", SERVICES)
def test_reads_are_those_of_the_service(name: str) -> None:
    read = {t.key for t in service(name).READS if t.key in topics.BY_KEY}
    granted = {t.key for t in access.READS[name]}
    assert granted == read, (
        f"common/access.py, READS[{name!r}]: add {sorted(read - granted)}, remove {sorted(granted - read)}"
    )


@pytest.mark.parametrize("name", SERVICES)
def test_writes_are_those_of_the_service(name: str) -> None:
    granted = set(access.grants(Subject(name=name)).puts)
    written = {t.key for t in service(name).WRITES}
    assert written <= granted, f"common/access.py, ON_BEHALF[{name!r}]: add {sorted(written - granted)}"
    for topic in access.ON_BEHALF.get(name, ()):
        assert "*" in topic.writers, f"{name} writes {topic.key} as any client may"
        assert topic.key in written


def test_speech_moves_nothing_but_may_stop() -> None:
    puts = set(access.grants(Subject(name="speech")).puts)
    assert not puts & MOVES
    assert topics.ROBOT_STOP.key in puts


@pytest.mark.parametrize("name", SERVICES)
def test_a_service_speaks_only_for_itself(name: str) -> None:
    granted = access.grants(Subject(name=name))
    for other in set(SERVICES) - {name}:
        for key in (topics.HEALTH_KEY, topics.ALIVE_KEY, topics.LOG_KEY):
            assert key.format(name=other) not in (*granted.puts, *granted.answers, *granted.tokens)


def test_an_observer_changes_nothing() -> None:
    granted = access.grants(Subject(name="guest", role="observer"))
    assert granted.puts == granted.answers == granted.tokens == ()
    assert not set(granted.asks) & set(access.CHANGING)


def test_only_clients_and_services_for_people_write_what_anyone_may() -> None:
    anyone = {t.key for t in topics.TABLE if t.writers == ("*",)} - {topics.LOCKSTEP_ACK.key}
    assert set(access.grants(Subject(name="alice", role="operator")).puts) >= anyone
    for name in set(SERVICES) - set(access.ON_BEHALF):
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
        assert {k for k in granted.reads if "*" in k} == {access.ALL_HEALTH, access.ALL_ALIVE}


def test_only_the_page_may_ask_for_the_missions_and_it_answers_for_nobody() -> None:
    asking = {name for name in SERVICES if topics.BRAIN_MISSIONS in access.grants(Subject(name=name)).asks}
    assert asking == {"dashboard"}
    granted = access.grants(Subject(name="dashboard"))
    assert not set(granted.asks) & {*access.CHANGING, topics.SIM_TRUTH}
    assert topics.BRAIN_MISSIONS not in granted.answers
