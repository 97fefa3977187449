"""The ROS 2 gateway against an implementation of rmw_zenoh's wire that is not ours."""

import json
from collections.abc import Iterator
from typing import Any

import numpy as np
import pytest
import zenoh

from common import messages as m
from common import topics
from common.bus import codec
from common.robot.joints import ARM
from common.scene import load_scene
from evaluation.site import Site, eventually, site
from services.sim.physics import Physics
from tests.robot_side import RobotSide

pytest.importorskip("rosbags", reason="the extra ros2 is not installed")
pytest.importorskip("zenoh_ros2_sdk", reason="zenoh-ros2-sdk is not installed")

from services.ros2 import incoming, outgoing
from services.ros2.service import TF
from services.ros2.types import Types
from tests.peers.ros import QosDurability, QosProfile, RosPeer, ros_peer

KINDS = sorted({row.type for row in (*outgoing.ROWS, *incoming.ROWS)} | {TF})
PUBLISHED = {
    "std_msgs/msg/String": "RIHS01_df668c740482bbd48fb39d76a70dfd4bd59db1288021743503259e948f6b1a18",
}
"""Hashes as rmw_zenoh's own documentation prints them (docs/design.md)."""
PATIENCE = 20.0


class Robot(RobotSide):
    """A gateway in a namespace of its own, the ROS peer, and the robot's bus as its services see it."""

    def __init__(self, here: Site, session: zenoh.Session, peer: RosPeer) -> None:
        super().__init__(session)
        self.here, self.peer = here, peer

    def drops(self) -> dict[str, int]:
        found: dict[str, int] = {}
        for reply in self.session.get(topics.HEALTH.of("ros2"), timeout=2.0):
            if reply.ok is not None:
                found = codec.decode_as(m.Health, reply.ok.payload.to_bytes()).by_key
        return found


@pytest.fixture(scope="module")
def robot(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Robot]:
    folder = tmp_path_factory.mktemp("ros2")
    with site(folder) as here:
        here.start("services.ros2")
        with here.session() as session:
            here.wait_alive(session, "ros2")
            prefix = "/" + here.namespace.replace("-", "_")
            with ros_peer(folder / "definitions", here.port, prefix, KINDS) as peer:
                yield Robot(here, session, peer)


@pytest.fixture(scope="module")
def types() -> Types:
    return Types("jazzy")


def absolute(robot: Robot, name: str) -> str:
    return name if name.startswith("/") else f"{robot.peer.prefix}/{name}"


def test_the_peer_lists_every_topic_with_its_type(robot: Robot) -> None:
    wanted = {absolute(robot, row.name) for row in (*outgoing.ROWS, *incoming.ROWS)}
    wanted |= {f"{robot.peer.prefix}/{name}" for name in ("tf", "tf_static", "robot_description")}
    eventually(lambda: wanted <= set(robot.peer.topics()), "all topics are listed", PATIENCE)
    listed = robot.peer.topics()
    for row in outgoing.ROWS:
        assert row.type in listed[absolute(robot, row.name)]


def test_the_qos_of_a_latched_topic_is_read_as_transient_local(robot: Robot) -> None:
    (found,) = eventually(lambda: robot.peer.publishers("map"), "somebody publishes the map", PATIENCE)
    assert found.node_name == "tidybot"
    qos = QosProfile.decode(found.qos)
    assert (qos.durability, qos.history_depth) == (QosDurability.TRANSIENT_LOCAL, 1)
    (plain,) = robot.peer.publishers("scan")
    assert QosProfile.decode(plain.qos) == QosProfile()


def test_hashes_are_those_that_others_compute_and_print(robot: Robot, types: Types) -> None:
    for kind, published in PUBLISHED.items():
        assert types.hash(kind) == published
    for kind in KINDS:
        ours = types.hash(kind)
        subscriber = robot.peer.listen("nobody", kind)  # computes the hash of its own accord
        assert subscriber.type_hash == ours, kind


def test_joint_states_arrive_typed_and_only_while_somebody_listens(robot: Robot) -> None:
    key = topics.JOINT_STATES.key
    publisher = robot.session.declare_publisher(key)
    assert not publisher.matching_status.matching, "nobody waits for joint states, so the gateway asks for none"
    listening = robot.peer.listen("joint_states", "sensor_msgs/msg/JointState")
    eventually(lambda: publisher.matching_status.matching, "the gateway subscribes", PATIENCE)
    sent = m.JointStates(t=12.5, name=["joint_1", "gripper"], position=[0.25, 0.08], velocity=[0.0, 0.0], effort=[1, 2])

    def arrived() -> list[Any]:
        robot.send(topics.JOINT_STATES, sent)
        return robot.peer.heard["joint_states"]

    message = eventually(arrived, "joint states arrive", PATIENCE)[0]
    assert message.name == ["joint_1", "gripper"]
    assert message.position.tolist() == [0.25, 0.08]
    assert (message.header.stamp.sec, message.header.stamp.nanosec) == (12, 500_000_000)
    robot.peer.leave(listening)
    eventually(lambda: not publisher.matching_status.matching, "the gateway no longer subscribes", PATIENCE)


def test_the_state_that_stands_reaches_who_comes_late(robot: Robot) -> None:
    def answer(query: zenoh.Query) -> None:
        with query:
            query.reply(query.key_expr, b'{"state": "NAVIGATING"}', encoding=codec.JSON)

    with robot.session.declare_queryable(topics.SYSTEM_STATUS.key, answer):
        robot.peer.listen("system_status", "std_msgs/msg/String")
        heard = robot.peer.heard["system_status"]
        eventually(lambda: heard, "the present state arrives", PATIENCE)
    assert heard[0].data == "NAVIGATING"


def test_a_picture_is_asked_for_while_somebody_subscribes(robot: Robot) -> None:
    asked = robot.heard(topics.CAMERA_REQUEST)
    assert not asked
    kinds = {"image": "sensor_msgs/msg/Image", "camera_info": "sensor_msgs/msg/CameraInfo"}
    watching = [robot.peer.listen(f"camera/head/{name}", kind) for name, kind in kinds.items()]
    request = eventually(lambda: asked, "the head camera is asked", PATIENCE)[0]
    assert request.camera == "head"
    rgb = np.arange(4 * 3 * 3, dtype=np.uint8)
    picture = m.Rgbd(
        t=1.0, id=request.id, camera="head", width=4, height=3, fx=5.0, fy=5.0, cx=2.0, cy=1.5,
        position=(0.0, 0.0, 1.0), orientation=(1.0, 0.0, 0.0, 0.0), rgb=rgb.tobytes(), depth=bytes(24),
    )  # fmt: skip
    robot.send(topics.HEAD_RGBD, picture)
    heard = robot.peer.heard
    eventually(lambda: heard["camera/head/image"] and heard["camera/head/camera_info"], "the picture", PATIENCE)
    image, info = heard["camera/head/image"][0], heard["camera/head/camera_info"][0]
    assert (image.width, image.height, image.encoding, image.step) == (4, 3, "rgb8", 12)
    assert image.data.tolist() == rgb.tolist()
    assert image.header.frame_id == info.header.frame_id
    assert info.k.tolist() == [5, 0, 2, 0, 5, 1.5, 0, 0, 1]
    for one in watching:
        robot.peer.leave(one)


def test_words_goals_and_velocities_of_the_peer_reach_the_robot(robot: Robot, types: Types) -> None:
    commands, goals = robot.heard(topics.VOICE_COMMAND), robot.heard(topics.NAV_GOAL)
    words, speeds = robot.heard(topics.NAVIGATION_GOAL), robot.heard(topics.CMD_VEL)
    voice = robot.peer.talk("voice_command", "std_msgs/msg/String")
    find = robot.peer.talk("brain/navigation_goal", "std_msgs/msg/String")
    drive = robot.peer.talk("cmd_vel", "geometry_msgs/msg/Twist")
    go = robot.peer.talk("goal_pose", "geometry_msgs/msg/PoseStamped")

    def all_there() -> bool:
        voice.publish(data="bring me the red mug")
        find.publish(data='{"goal": "goto kitchen", "id": "g-1"}')
        drive.publish(linear=types.vector(0.2, 0.0, 0.0), angular=types.vector(0.0, 0.0, -0.5))
        goal = types.pose_stamped(0.0, "map", (1.0, 2.0, 0.0), (2**-0.5, 0.0, 0.0, 2**-0.5))
        go.publish(header=goal.header, pose=goal.pose)
        return bool(commands and words and speeds and goals)

    eventually(all_there, "everything arrives", PATIENCE)
    assert commands[0].text == "bring me the red mug" and commands[0].id
    assert (words[0].goal, words[0].id) == ("goto kitchen", "g-1")
    assert (speeds[0].vx, speeds[0].omega) == (0.2, -0.5)
    assert (goals[0].x, goals[0].y, goals[0].frame) == (1.0, 2.0, "map")
    assert goals[0].theta == pytest.approx(np.pi / 2)


def test_what_cannot_be_meant_is_counted_and_goes_nowhere(robot: Robot, types: Types) -> None:
    goals, speeds = robot.heard(topics.NAV_GOAL), robot.heard(topics.CMD_VEL)
    go = robot.peer.talk("goal_pose", "geometry_msgs/msg/PoseStamped")
    drive = robot.peer.talk("cmd_vel", "geometry_msgs/msg/Twist")
    torn = f"0{robot.peer.prefix}/voice_command/std_msgs::msg::dds_::String_/{PUBLISHED['std_msgs/msg/String']}"
    elsewhere = types.pose_stamped(0.0, "moon", (7.0, 2.0, 0.0), (1.0, 0.0, 0.0, 0.0))

    def counted() -> bool:
        go.publish(header=elsewhere.header, pose=elsewhere.pose)
        drive.publish(linear=types.vector(float("nan"), 0.0, 0.0), angular=types.vector(0.0, 0.0, 0.0))
        robot.peer.put(torn, b"\x00\x01")
        drops = robot.drops()
        return all(drops.get(f"ros:{name}", 0) > 0 for name in ("goal_pose", "cmd_vel", "voice_command"))

    eventually(counted, "the drops are counted", PATIENCE)
    assert not [goal for goal in goals if goal.x == 7.0]
    assert not [speed for speed in speeds if speed.vx != 0.2]


def test_during_a_mission_peers_may_talk_and_stop_but_not_drive(robot: Robot, types: Types) -> None:
    speeds, stops = robot.heard(topics.CMD_VEL), robot.heard(topics.ROBOT_STOP)
    drive = robot.peer.talk("cmd_vel", "geometry_msgs/msg/Twist")
    stop = robot.peer.talk("robot/stop", "std_msgs/msg/String")
    before = robot.drops().get("ros:cmd_vel", 0)

    def refused() -> bool:
        robot.send(topics.BRAIN_STATE, m.BrainState(state="NAVIGATING", mission_id="m1"))
        drive.publish(linear=types.vector(0.1, 0.0, 0.0), angular=types.vector(0.0, 0.0, 0.0))
        return robot.drops().get("ros:cmd_vel", 0) > before

    eventually(refused, "the velocity is refused", PATIENCE)
    del speeds[:]
    drive.publish(linear=types.vector(0.1, 0.0, 0.0), angular=types.vector(0.0, 0.0, 0.0))

    def stopped() -> bool:
        stop.publish(data="")
        return bool(stops)

    eventually(stopped, "the stop goes through", PATIENCE)
    assert not speeds and stops[0].source == "ros2"
    robot.send(topics.BRAIN_STATE, m.BrainState(state="WAITING"))


def test_the_frames_of_the_robot_are_a_tree_from_map_to_gripper(robot: Robot) -> None:
    mjcf = Physics(load_scene("minimal"), 0).robot.mjcf
    robot.peer.listen("tf", TF)
    robot.peer.listen("robot_description", "std_msgs/msg/String")
    joints = m.JointStates(
        t=3.0, name=[*ARM, "gripper"], position=[0.1] * 7 + [0.05], velocity=[0.0] * 8, effort=[0.0] * 8
    )

    def complete() -> bool:
        robot.send(topics.ROBOT_DESCRIPTION, m.RobotDescription(mjcf=mjcf))
        robot.send(topics.ODOMETRY, m.Odometry(t=3.0, x=1.0, y=0.0, theta=0.0))
        robot.send(topics.POSE, m.PoseEstimate(t=3.0, x=1.0, y=2.0, theta=np.pi / 2))
        robot.send(topics.JOINT_STATES, joints)
        return any(len(message.transforms) > 10 for message in robot.peer.heard["tf"])

    eventually(complete, "all frames are sent", PATIENCE)
    newest = [message for message in robot.peer.heard["tf"] if len(message.transforms) > 10][-1]
    parents = {t.child_frame_id: t.header.frame_id for t in newest.transforms}
    frame, way = "gripper", []
    while frame in parents:
        frame = parents[frame]
        way.append(frame)
    assert way[-3:] == ["base_link", "odom", "map"]
    assert "<robot" in eventually(lambda: robot.peer.heard["robot_description"], "URDF", PATIENCE)[0].data


def test_a_list_of_steps_answers_the_last_plan_request(robot: Robot) -> None:
    plans = robot.heard(topics.ACTION_PLAN)
    robot.peer.listen("plan_request", "std_msgs/msg/String")
    talk = robot.peer.talk("action_plan", "std_msgs/msg/String")

    def asked() -> bool:
        robot.send(topics.PLAN_REQUEST, m.PlanRequest(id="p-7", command="bring me the mug"))
        return bool(robot.peer.heard["plan_request"])

    eventually(asked, "the request reaches the planner of the peer", PATIENCE)
    assert json.loads(robot.peer.heard["plan_request"][0].data)["id"] == "p-7"

    def answered() -> bool:
        talk.publish(data='[{"action": "find", "object": "mug"}]')
        return bool(plans)

    eventually(answered, "the plan arrives", PATIENCE)
    assert plans[0].request_id == "p-7"
    assert [step.action for step in plans[0].steps] == ["find"]
