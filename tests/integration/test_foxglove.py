"""The Foxglove server against a client that reads its protocol by libraries of others."""

import json
import re
from collections.abc import Iterator
from typing import Any

import numpy as np
import pytest
import zenoh

from cli.processes.ports import free_port
from common import messages as m
from common import topics
from common.bus import codec, delivery
from common.robot.joints import ARM
from common.scene import load_scene
from common.schemas import schema_of
from common.topic import Topic
from evaluation.site import Site, eventually, site
from services.foxglove import incoming
from services.sim.physics import Physics
from tests.robot_side import RobotSide
from tests.support import ROOT

pytest.importorskip("foxglove", reason="the extra foxglove is not installed")

from tests.peers.foxglove import FoxgloveClient

PATIENCE = 20.0


class Robot(RobotSide):
    """A server in a namespace of its own, a visitor, and the robot's bus as its services see it."""

    def __init__(self, here: Site, session: zenoh.Session, visitor: FoxgloveClient) -> None:
        super().__init__(session)
        self.here, self.visitor = here, visitor

    def shown(self, name: str, topic: Topic[Any], message: m.Message, key: str = "") -> Any:
        """The last message that a watched channel shows once this was sent."""
        before = len(self.visitor.heard[name])

        def come() -> bool:
            self.send(topic, message, key)
            return len(self.visitor.heard[name]) > before

        eventually(come, f"{name} shows it", PATIENCE)
        return self.visitor.heard[name][-1]


def start(here: Site, session: zenoh.Session, **settings: str) -> FoxgloveClient:
    port = free_port()
    here.start("services.foxglove", TIDYBOT__FOXGLOVE__PORT=str(port), **settings)
    here.wait_alive(session, "foxglove")
    visitor = FoxgloveClient(f"ws://127.0.0.1:{port}")
    eventually(lambda: "viewer/scene" in visitor.channels and visitor.server, "the channels are there", PATIENCE)
    return visitor


@pytest.fixture(scope="module")
def robot(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Robot]:
    with site(tmp_path_factory.mktemp("foxglove")) as here, here.session() as session:
        settings = {"TIDYBOT__FOXGLOVE__COMMANDS": "true", "TIDYBOT__RUNTIME__SCENE": "minimal"}
        visitor = start(here, session, TIDYBOT__PLANNER__LLM_KEY="hidden", **settings)
        try:
            yield Robot(here, session, visitor)
        finally:
            visitor.close()


def test_every_topic_is_a_channel_with_the_schema_of_recordings(robot: Robot) -> None:
    for topic in topics.TABLE:
        if topic.bulk or topic in (topics.SIM_CONTACTS, topics.LOCKSTEP_ACK, *topics.CLOCKS):
            continue
        channel = robot.visitor.channels[topic.key]
        assert (channel["encoding"], channel["schemaName"]) == ("json", f"tidybot.{topic.type.__name__}")
        assert channel["schema"].encode() == schema_of(topic.type)
    known = {name: channel["schemaName"] for name, channel in robot.visitor.channels.items() if "viewer" in name}
    assert known["viewer/scene"] == "foxglove.SceneUpdate" and known["viewer/tf"] == "foxglove.FrameTransforms"
    assert known["viewer/map"] == "foxglove.Grid" and known["viewer/log"] == "foxglove.Log"
    assert known["viewer/head/image"] == "foxglove.CompressedImage"


def test_the_layout_names_channels_and_commands_that_there_are(robot: Robot) -> None:
    layout = json.loads((ROOT / "docs" / "foxglove-layout.json").read_text())
    panels = layout["configById"]
    scene, image = panels["3D!scene"], panels["Image!head"]["imageMode"]
    shown = {*scene["topics"], image["imageTopic"], image["calibrationTopic"], panels["RosOut!log"]["topicToRender"]}
    shown |= {panels["RawMessages!status"]["topicPath"]}
    shown |= {path["value"].partition(".")[0] for path in panels["Plot!joints"]["paths"]}
    assert shown <= {*robot.visitor.channels}
    sent = {scene["publish"]["poseTopic"], panels["Teleop!drive"]["topic"]}
    sent |= {panels[name]["topicName"] for name in ("Publish!say", "Publish!stop")}
    assert {name.strip("/") for name in sent} <= {*incoming.BY_NAME}
    arranged = set(re.findall(r"[A-Za-z0-9]+![a-z]+", json.dumps(layout["layout"])))
    assert arranged == {*panels}


def test_a_topic_is_subscribed_to_and_shown_while_somebody_looks(robot: Robot) -> None:
    publisher = robot.session.declare_publisher(topics.ODOMETRY.key)
    assert not publisher.matching_status.matching
    robot.visitor.watch("base/odom")
    eventually(lambda: publisher.matching_status.matching, "the server subscribes", PATIENCE)
    shown = robot.shown("base/odom", topics.ODOMETRY, m.Odometry(t=7.25, x=1.0, y=2.0, theta=0.5))
    assert (shown["x"], shown["y"]) == (1.0, 2.0)
    assert robot.visitor.times["base/odom"][-1] == 7_250_000_000
    robot.visitor.forget("base/odom")
    eventually(lambda: not publisher.matching_status.matching, "the server no longer subscribes", PATIENCE)


def test_the_present_state_is_shown_at_once(robot: Robot) -> None:
    def answer(query: zenoh.Query) -> None:
        with query:
            query.reply(query.key_expr, b'{"state": "NAVIGATING"}', encoding=codec.JSON)

    key = topics.SYSTEM_STATUS.key
    with robot.session.declare_queryable(key, answer), robot.here.session() as another:
        # The server asks once, and not who has not been heard of yet.
        eventually(lambda: delivery.fetch(another, key), "the state can be asked for", PATIENCE)
        robot.visitor.watch("system_status")
        eventually(lambda: robot.visitor.heard["system_status"], "the state is shown", PATIENCE)
    assert robot.visitor.heard["system_status"][0]["state"] == "NAVIGATING"


def test_pictures_come_as_jpeg_with_depth_and_calibration_while_they_are_watched(robot: Robot) -> None:
    asked = robot.heard(topics.CAMERA_REQUEST)
    names = [f"viewer/head/{part}" for part in ("image", "depth", "calibration")]
    robot.visitor.watch(*names)
    eventually(lambda: asked, "the camera is asked", PATIENCE)
    picture = m.Rgbd(
        t=1.0, id="p", camera="head", width=16, height=8, fx=5.0, fy=5.0, cx=8.0, cy=4.0, position=(0.0, 0.0, 1.0),
        orientation=(1.0, 0.0, 0.0, 0.0), rgb=bytes([200, 30, 30]) * 128, depth=np.full(128, 750, "<u2").tobytes(),
    )  # fmt: skip
    shown = robot.shown("viewer/head/image", topics.HEAD_RGBD, picture)
    assert shown.format == "jpeg" and shown.data[:2] == b"\xff\xd8"
    depth, calibration = (robot.visitor.heard[name] for name in names[1:])
    eventually(lambda: depth and calibration, "depth and calibration", PATIENCE)
    assert np.frombuffer(depth[-1].data, "<u2").tolist() == [750] * 128
    assert (calibration[-1].width, calibration[-1].K[0], calibration[-1].K[2]) == (16, 5.0, 8.0)
    assert calibration[-1].frame_id == shown.frame_id
    robot.visitor.forget(*names)


def test_the_scene_has_home_robot_and_objects_and_frames_move_it(robot: Robot) -> None:
    mjcf = Physics(load_scene("minimal"), 0).robot.mjcf
    robot.visitor.watch("viewer/scene", "viewer/tf")
    scenes = robot.visitor.heard["viewer/scene"]
    joints = m.JointStates(t=3.0, name=[*ARM, "gripper"], position=[0.1] * 7 + [0.05], velocity=[], effort=[])
    mug = m.WorldObject(label="red mug", kind="mug", colour="red", position=(1.0, 2.0, 0.8), size=(0.08, 0.08, 0.1))

    def entities() -> dict[str, Any]:
        return {entity.id: entity for scene in scenes for entity in scene.entities}

    def complete() -> bool:
        robot.send(topics.ROBOT_DESCRIPTION, m.RobotDescription(mjcf=mjcf))
        robot.send(topics.WORLD_OBJECTS, m.WorldObjects(t=3.0, objects=[mug]))
        robot.send(topics.ODOMETRY, m.Odometry(t=3.0, x=1.0, y=0.0, theta=0.0))
        robot.send(topics.JOINT_STATES, joints)
        there = {"home", "object red mug", "robot base_link"} <= set(entities())
        return there and any(len(tf.transforms) > 10 for tf in robot.visitor.heard["viewer/tf"])

    eventually(complete, "everything is drawn", PATIENCE)
    drawn = entities()
    assert drawn["home"].cubes and drawn["home"].frame_id == "map"
    assert drawn["object red mug"].texts[0].text == "red mug"
    assert drawn["object red mug"].cylinders[0].color.r > 0.5
    newest = [tf for tf in robot.visitor.heard["viewer/tf"] if len(tf.transforms) > 10][-1]
    parents = {t.child_frame_id: t.parent_frame_id for t in newest.transforms}
    links = {entity.frame_id for name, entity in drawn.items() if name.startswith("robot ")}
    assert links <= {*parents}, "each part of the robot has a frame that moves it"
    assert all(entity.frame_locked for entity in drawn.values())

    def gone() -> bool:
        robot.send(topics.WORLD_OBJECTS, m.WorldObjects(t=4.0, objects=[]))
        return any(deletion.id == "object red mug" for scene in scenes for deletion in scene.deletions)

    eventually(gone, "what is gone is taken away", PATIENCE)


def test_log_lines_are_shown_with_their_level(robot: Robot) -> None:
    robot.visitor.watch("viewer/log")
    line = m.LogRecord(t=2.0, service="brain", level="warning", event="dropped", fields={"key": "x"})
    lines = robot.visitor.heard["viewer/log"]

    def come() -> bool:
        robot.session.put(topics.LOG.of("brain"), codec.encode(topics.LOG, line), encoding=codec.JSON)
        return any(one.name == "brain" for one in lines)

    eventually(come, "the line is shown", PATIENCE)
    found = next(one for one in lines if one.name == "brain")
    assert (found.message, found.level) == ("dropped key=x", 3)


def test_words_joystick_and_goals_reach_the_robot(robot: Robot) -> None:
    commands, speeds, goals = (robot.heard(t) for t in (topics.VOICE_COMMAND, topics.CMD_VEL, topics.NAV_GOAL))
    say, drive = robot.visitor.offer(1, "/voice_command"), robot.visitor.offer(2, "/cmd_vel")
    go = robot.visitor.offer(3, "/move_base_simple/goal")

    def all_there() -> bool:
        say({"data": "bring me the red mug"})
        drive({"linear": {"x": 0.2, "y": 0, "z": 0}, "angular": {"x": 0, "y": 0, "z": -0.5}})
        place = {"position": {"x": 1, "y": 2, "z": 0}, "orientation": {"x": 0, "y": 0, "z": 0, "w": 1}}
        go({"header": {"frame_id": "map"}, "pose": place})
        return bool(commands and speeds and goals)

    eventually(all_there, "everything arrives", PATIENCE)
    assert commands[0].text == "bring me the red mug" and commands[0].confirmed
    assert (speeds[0].vx, speeds[0].omega) == (0.2, -0.5)
    assert (goals[0].x, goals[0].y, goals[0].theta) == (1.0, 2.0, 0.0)


@pytest.mark.parametrize(
    ("topic", "value", "why"),
    [
        ("/cmd_vel", {"linear": {"x": 1e300}, "angular": {}}, "not a finite number"),
        ("/cmd_vel", ["no", "twist"], "Expected"),
        ("/goal_pose", {"header": {"frame_id": "moon"}, "pose": {"position": {}, "orientation": {"w": 1}}}, "moon"),
        ("/gripper", {}, "nothing listens"),
    ],
)
def test_what_cannot_be_meant_is_refused_with_the_reason(robot: Robot, topic: str, value: Any, why: str) -> None:
    speeds = robot.heard(topics.CMD_VEL)
    send = robot.visitor.offer(hash((topic, why)) % 2**31, topic)
    del robot.visitor.warnings[:]

    def refused() -> bool:
        send(value)
        return any(why in words for words in robot.visitor.warnings)

    eventually(refused, f"refused: {why}", PATIENCE)
    assert all(abs(speed.vx) <= 0.2 for speed in speeds)


def test_parameters_are_read_those_of_the_server_set_and_secrets_hidden(robot: Robot) -> None:
    robot.visitor.ask()
    told = robot.visitor.parameters
    eventually(lambda: "brain.max_retry_attempts" in told, "the parameters are told", PATIENCE)
    assert told["runtime.scene"] == "minimal"
    assert told["foxglove.camera_rate"] == 2.0
    assert "hidden" not in told.values()
    robot.visitor.set("foxglove.camera_rate", 5)
    eventually(lambda: told["foxglove.camera_rate"] == 5, "its own can be set", PATIENCE)
    del robot.visitor.warnings[:]
    robot.visitor.set("brain.max_retry_attempts", 9)
    eventually(lambda: any("brain.max_retry_attempts" in w for w in robot.visitor.warnings), "others cannot", PATIENCE)
    assert told["brain.max_retry_attempts"] == 3


def test_without_leave_visitors_may_only_stop_the_robot(here: Site) -> None:
    with here.session() as session:
        visitor = start(here, session)
        try:
            robot = Robot(here, session, visitor)
            commands, stops = robot.heard(topics.VOICE_COMMAND), robot.heard(topics.ROBOT_STOP)
            say, stop = visitor.offer(1, "/voice_command"), visitor.offer(2, "/robot/stop")

            def stopped() -> bool:
                say({"data": "bring me the red mug"})
                stop({})
                return bool(stops) and any("commands are off" in words for words in visitor.warnings)

            eventually(stopped, "the stop goes through and the words do not", PATIENCE)
            assert not commands and stops[0].source == "foxglove"
        finally:
            visitor.close()
