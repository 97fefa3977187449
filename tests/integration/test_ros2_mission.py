"""A whole mission commanded from a ROS 2 peer, which follows it on ROS topics; physics says whether it is done."""

from pathlib import Path
from typing import Any

import pytest

from cli.link import Link
from common import topics
from common.bus.session import open_session
from evaluation.site import eventually
from tests.integration.test_cli_up import Run, run

pytest.importorskip("rosbags", reason="the extra ros2 is not installed")
pytest.importorskip("zenoh_ros2_sdk", reason="zenoh-ros2-sdk is not installed")

from tests.peers.ros import ros_peer

__all__ = ["run"]
STRING = "std_msgs/msg/String"
KINDS = [STRING, "geometry_msgs/msg/PoseStamped", "tf2_msgs/msg/TFMessage", "sensor_msgs/msg/Image"]


@pytest.mark.slow
@pytest.mark.timeout(400)
def test_a_ros_peer_commands_a_mission_and_follows_it(run: Run, tmp_path: Path) -> None:
    done = run.detached("--without", "dashboard", "--speed", "max", "--seed", "1", "--ros2")
    assert done.returncode == 0, done.stdout + done.stderr
    assert run.rows()["ros2"]["alive"]
    with (
        ros_peer(tmp_path / "definitions", run.port, "", KINDS) as peer,
        open_session(f"tcp/127.0.0.1:{run.port}") as session,
    ):
        for name in ("system_status", "brain/manipulation_status", "object_query"):
            peer.listen(name, STRING)
        peer.listen("object_pose", "geometry_msgs/msg/PoseStamped")
        peer.listen("tf", "tf2_msgs/msg/TFMessage")
        peer.listen("camera/head/image", "sensor_msgs/msg/Image")
        say = peer.talk("voice_command", STRING)
        states = peer.heard["system_status"]
        eventually(lambda: states, "the state that stands arrives", 30)

        def planning() -> bool:
            say.publish(data='{"text": "bring me the red mug", "confirmed": true, "id": "ros-1"}')
            return any(state.data in ("PLANNING", "GROUNDING", "NAVIGATING") for state in states)

        eventually(planning, "the mission begins", 60)
        ended = eventually(lambda: [s.data for s in states if s.data in ("SUCCESS", "ERROR")], "the mission ends", 300)
        assert ended == ["SUCCESS"]
        truth: dict[str, Any] = Link(session, "").query(topics.SIM_TRUTH)
        assert truth["objects"]["red mug"]["on"] == "delivery tray" and truth["holding"] is None
        order = [state.data for state in states]
        assert order.index("GROUNDING") < order.index("NAVIGATING") < order.index("EXECUTING")
        assert "done" in {status.data for status in peer.heard["brain/manipulation_status"]}
        assert any("red mug" in query.data for query in peer.heard["object_query"])
        assert peer.heard["object_pose"][0].header.frame_id == "map"
        picture = peer.heard["camera/head/image"][-1]
        assert len(picture.data) == picture.height * picture.step and picture.data.any()
        frames = {t.child_frame_id for message in peer.heard["tf"] for t in message.transforms}
        assert {"odom", "base_link", "gripper", "head_camera_optical_frame"} <= frames
