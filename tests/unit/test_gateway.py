"""What gateways let through: the rules that all of them share, and ROS names."""

import math

import pytest

from common import messages as m
from common.gateway import due, refusal, standing_pose
from services.foxglove.incoming import Header, Pose, PoseStamped, Quaternion, Vector
from services.ros2.wire import Qos, RosTopic, attachment, ros_name


@pytest.mark.parametrize(
    ("state", "mission", "free"),
    [
        ("WAITING", "", True),
        ("LISTENING", "m1", True),
        ("COMPLETED", "m1", True),
        ("ERROR", "m1", True),
        ("IDLE", "", True),
        ("IDLE", "m1", False),
        ("PLANNING", "m1", False),
        ("NAVIGATING", "m1", False),
        ("CONFIRMING", "m1", False),
    ],
)
def test_others_move_the_robot_between_missions_only(state: m.BrainStateName, mission: str, free: bool) -> None:
    assert (refusal(m.BrainState(state=state, mission_id=mission)) == "") == free


def test_without_a_brain_the_robot_may_be_moved() -> None:
    assert refusal(None) == ""


def test_what_has_a_rate_is_due_once_in_its_period_and_never_at_zero() -> None:
    assert due(2.0, math.inf) and due(2.0, 0.5) and not due(2.0, 0.49)
    assert not due(0.0, math.inf) and not due(-1.0, math.inf)


def stamped(frame: str, x: float, y: float, q: tuple[float, float, float, float]) -> PoseStamped:
    return PoseStamped(Header(frame), Pose(Vector(x, y), Quaternion(*q)))


def test_a_pose_on_the_floor_of_the_map_is_a_goal() -> None:
    goal = standing_pose(stamped("/map", 1.0, -2.0, (math.cos(0.4), 0.0, 0.0, math.sin(0.4))))
    assert (goal.x, goal.y, goal.frame) == (1.0, -2.0, "map")
    assert goal.theta == pytest.approx(0.8)


@pytest.mark.parametrize(
    ("frame", "q"),
    [
        ("odom", (1.0, 0.0, 0.0, 0.0)),
        ("", (1.0, 0.0, 0.0, 0.0)),
        ("map", (0.0, 0.0, 0.0, 0.0)),
        ("map", (math.cos(0.4), math.sin(0.4), 0.0, 0.0)),
        ("map", (math.nan, 0.0, 0.0, 0.0)),
    ],
)
def test_a_pose_elsewhere_or_askew_is_refused(frame: str, q: tuple[float, float, float, float]) -> None:
    with pytest.raises(ValueError, match=r"frame|orientation"):
        standing_pose(stamped(frame, 0.0, 0.0, q))


@pytest.mark.parametrize(
    ("namespace", "name"),
    [("", ""), ("kitchen-bot", "kitchen_bot"), ("flat/2nd", "flat/_2nd"), ("/a//b/", "a/b"), ("küche", "k_che")],
)
def test_a_namespace_becomes_a_name_that_ros_allows(namespace: str, name: str) -> None:
    assert ros_name(namespace) == name


def test_keys_qos_and_attachment_are_as_rmw_zenoh_writes_them() -> None:
    """The forms of its design document, and the layout of its attachment."""
    chatter = RosTopic("/chatter", "std_msgs/msg/String", "RIHS01_df66")
    assert chatter.key(2) == "2/chatter/std_msgs::msg::dds_::String_/RIHS01_df66"
    assert Qos().encoded() == "::,10:,:,:,,"
    assert Qos(transient=True, depth=1).encoded() == ":1:,1:,:,:,,"
    raw = attachment(1, 2, bytes(range(16)))
    assert raw == (1).to_bytes(8, "little") + (2).to_bytes(8, "little") + b"\x10" + bytes(range(16))
