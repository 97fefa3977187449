"""The topic table against the services that claim to read and write it, and against the generated page."""

import importlib
import re
from pathlib import Path
from typing import Any

import pytest

from cli.processes.services import NAMES
from common import interfaces, topics
from common.time.lockstep import period_of
from common.topic import ANYONE, EACH, Topic
from common.topics import PICTURES

SERVICES = tuple(name for name in NAMES if name != "router")
ROOT = Path(__file__).parents[2]
SHARED = {"gripper_command", "base/cmd_vel"}
"""Two services publish them: the first by the wire contract, the second because the page drives by hand. What people's
tools publish, services may publish for them."""


def service(name: str) -> Any:
    folder = (ROOT / "services" / name).is_dir()
    module = importlib.import_module(f"services.{name}.service" if folder else f"services.{name}")
    return next(v for v in vars(module).values() if isinstance(v, type) and getattr(v, "NAME", None) == name)


@pytest.mark.parametrize("name", SERVICES)
def test_a_service_uses_every_topic_whose_row_names_it(name: str) -> None:
    """By the constants in its code, so that rights which nobody uses are noticed; others are refused at run time.

    Of what a viewer reads, its users choose; pictures are asked for by `common/picture_requests.py`, and
    `Io.household` is what people have told of the home.
    """
    folder = ROOT / "services" / name
    code = "".join(p.read_text() for p in (folder.rglob("*.py") if folder.is_dir() else [folder.with_suffix(".py")]))
    used = [getattr(topics, name, None) for name in re.findall(r"\b(?:topics|t)\.([A-Z][A-Z0-9_]+)\b", code)]
    used += [topics.HOUSEHOLD_EDITS] if ".household" in code else []
    used += [topics.CAMERA_REQUEST, *PICTURES.values()] if "PictureRequests(" in code else []
    rows = {*service(name).READS, *service(name).WRITES}
    if name in topics.VIEWERS:
        rows = {*service(name).WRITES}
    assert not {row.key for row in rows} - {row.key for row in used if isinstance(row, Topic)}


def test_every_read_has_a_writer() -> None:
    for row in topics.TABLE:
        assert row.writers, f"nobody writes {row.key}"
        assert {*row.writers, *row.readers} <= {*SERVICES, ANYONE, EACH}, row.key


def test_one_writer_per_topic() -> None:
    for topic in topics.TABLE:
        if topic.key not in SHARED and ANYONE not in topic.writers:
            assert len({*topic.writers} - {*topics.VIEWERS}) == 1, topic.key


@pytest.mark.parametrize("name", SERVICES)
def test_service_rate_divides_the_tick_rate(name: str) -> None:
    assert period_of(service(name).HZ) >= 1


def test_interfaces_page_is_current() -> None:
    page = ROOT / "docs" / "INTERFACES.md"
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
