"""The topic table against the services that claim to read and write it, and against the generated page."""

import importlib
from pathlib import Path
from typing import Any

import pytest

from common import interfaces, topics
from common import messages as m
from common.lockstep import period_of

SERVICES = ("brain", "speech", "navigation", "manipulation", "sim", "camera", "planner", "perception", "dashboard")
FROM_ANYONE = "*"
SHARED = {"gripper_command", "voice_command", "robot/stop", "nav_goal", "camera/request"}


def service(name: str) -> Any:
    module = importlib.import_module(f"services.{name}.service")
    return next(v for v in vars(module).values() if isinstance(v, type) and getattr(v, "NAME", None) == name)


@pytest.mark.parametrize("name", SERVICES)
def test_service_writes_only_what_the_table_grants(name: str) -> None:
    for topic in service(name).WRITES:
        assert topics.BY_KEY[topic.key] is topic
        assert name in topic.writers or FROM_ANYONE in topic.writers, f"{name} may not write {topic.key}"


def test_every_granted_topic_is_written() -> None:
    for topic in topics.TABLE:
        if topic.type is m.SimClockTick or topic.key in SHARED:
            continue  # the clocks are written by the simulation's loop in common/runtime.py
        for name in set(topic.writers) & set(SERVICES):
            assert topic in service(name).WRITES, f"{name} never writes {topic.key}"


def test_every_read_has_a_writer() -> None:
    writers = {t.key for name in SERVICES for t in service(name).WRITES}
    for name in SERVICES:
        for topic in service(name).READS:
            assert topic.key in writers or set(topic.writers) - set(SERVICES), f"nobody writes {topic.key}"


def test_one_writer_per_topic() -> None:
    for topic in topics.TABLE:
        if topic.key not in SHARED:
            assert len(set(topic.writers) - {FROM_ANYONE}) <= 1, topic.key


@pytest.mark.parametrize("name", SERVICES)
def test_service_rate_divides_the_tick_rate(name: str) -> None:
    assert period_of(service(name).HZ) >= 1


def test_interfaces_page_is_current() -> None:
    page = Path(__file__).parents[2] / "docs" / "INTERFACES.md"
    assert page.read_text() == interfaces.render(), "run: python -m common.interfaces > docs/INTERFACES.md"


WIRE = {
    "brain/speech_goal": {"goal", "id", "attempt"},
    "brain/speech_result": {"text", "goal_id", "confidence"},
    "brain/navigation_goal": {"goal", "id", "attempt"},
    "brain/navigation_status": {"status", "goal_id", "attempt", "code", "detail"},
    "brain/manipulation_goal": {"goal", "id", "attempt", "object"},
    "brain/manipulation_status": {"status", "goal_id", "attempt", "phase", "code", "detail"},
    "base/target_pose": {"x", "y", "theta", "id"},
    "base/goal_reached": {"reached", "target_id"},
    "joint_states": {"t", "name", "position", "velocity", "effort"},
    "voice_command": {"text", "confidence"},
    "plan_request": {"id", "command", "world", "rejected"},
    "action_plan": {"request_id", "steps", "source"},
    "object_query": {"id", "query"},
    "object_pose": {
        "query_id", "found", "label", "confidence", "frame", "position", "orientation", "size", "seen_at",
    },
    "nav_goal": {"id", "attempt", "frame", "x", "y", "theta", "object"},
    "navigation_feedback": {"goal_id", "status", "distance_remaining", "eta", "recoveries", "code"},
    "gripper_command": {"position", "max_effort"},
    "system_status": {"state", "mission_id", "detail"},
}  # fmt: skip
BULKY = {"joint_states", "base/odom", "scan", "camera/head/rgbd", "camera/wrist/rgbd", "sim/clock"}


@pytest.mark.parametrize(("key", "fields"), WIRE.items())
def test_wire_fields(key: str, fields: set[str]) -> None:
    assert fields <= set(topics.BY_KEY[key].type.__struct_fields__)
    assert topics.BY_KEY[key].binary == (key in BULKY)


def test_bulky_topics_are_message_pack() -> None:
    assert all(topics.BY_KEY[key].binary for key in BULKY)


def test_state_like_topics_of_the_wire_are_latched() -> None:
    for key in ("base/goal_reached", "brain/state", "brain/navigation_status", "brain/manipulation_status"):
        assert topics.BY_KEY[key].latched
