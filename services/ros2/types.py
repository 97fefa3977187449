"""ROS messages without ROS: made, encoded and decoded (CDR) by `rosbags`, with the hashes that name their types."""

from collections.abc import Sequence
from typing import Any

from common.bus.validation import LIMIT
from common.messages.base import Quat, Vec3
from common.robot.frames import FramePose

NANO = 1_000_000_000
"""Nanoseconds in a second."""
MISSING = "the ROS 2 gateway needs the package rosbags: pip install 'tidybot-zenoh[ros2]'"


class Types:
    """The message definitions of one ROS distribution.

    Raises:
        ImportError: `rosbags` is not installed.
    """

    def __init__(self, distro: str) -> None:
        from rosbags.typesys import Stores, get_typestore

        self._store: Any = get_typestore(Stores(f"ros2_{distro}"))

    def hash(self, kind: str) -> str:
        """The RIHS01 hash of a type such as `std_msgs/msg/String` (REP 2016)."""
        return str(self._store.hash_rihs01(kind))

    def new(self, kind: str, **fields: Any) -> Any:
        """A message of `package/Name` with all its fields."""
        return self._store.types[kind.replace("/", "/msg/", 1)](**fields)

    def encode(self, kind: str, message: Any) -> bytes:
        """CDR, little endian, with its header."""
        return bytes(self._store.serialize_cdr(message, kind))

    def decode(self, kind: str, payload: bytes) -> Any:
        """The message that a peer sent.

        Raises:
            ValueError: not of this type.
        """
        try:
            return self._store.deserialize_cdr(payload, kind)
        except Exception as error:  # of a stranger's bytes the generated decoder raises whatever its line meets
            raise ValueError(f"not a {kind}: {type(error).__name__}: {error}") from None

    # --- parts that many messages have
    def text(self, words: str) -> Any:
        """A std_msgs/String."""
        return self.new("std_msgs/String", data=words)

    def stamp(self, t: float) -> Any:
        """The builtin_interfaces/Time of a robot time [s]."""
        whole, nanoseconds = divmod(round(min(max(t, 0.0), LIMIT) * NANO), NANO)
        return self.new("builtin_interfaces/Time", sec=min(whole, 2**31 - 1), nanosec=nanoseconds)

    def header(self, t: float, frame: str) -> Any:
        """Time and frame of a message."""
        return self.new("std_msgs/Header", stamp=self.stamp(t), frame_id=frame)

    def vector(self, x: float, y: float, z: float) -> Any:
        """A geometry_msgs/Vector3."""
        return self.new("geometry_msgs/Vector3", x=x, y=y, z=z)

    def quaternion(self, q: Quat) -> Any:
        """A geometry_msgs/Quaternion of (w, x, y, z)."""
        return self.new("geometry_msgs/Quaternion", x=q[1], y=q[2], z=q[3], w=q[0])

    def pose(self, position: Vec3, orientation: Quat) -> Any:
        """A geometry_msgs/Pose."""
        x, y, z = position
        point = self.new("geometry_msgs/Point", x=x, y=y, z=z)
        return self.new("geometry_msgs/Pose", position=point, orientation=self.quaternion(orientation))

    def pose_stamped(self, t: float, frame: str, position: Vec3, orientation: Quat) -> Any:
        """A geometry_msgs/PoseStamped."""
        pose = self.pose(position, orientation)
        return self.new("geometry_msgs/PoseStamped", header=self.header(t, frame), pose=pose)

    def frames(self, poses: Sequence[FramePose]) -> Any:
        """A tf2_msgs/TFMessage."""
        return self.new("tf2_msgs/TFMessage", transforms=[self._transform(pose) for pose in poses])

    def _transform(self, pose: FramePose) -> Any:
        turn = self.quaternion(pose.orientation)
        moved = self.new("geometry_msgs/Transform", translation=self.vector(*pose.position), rotation=turn)
        header = self.header(pose.t, pose.parent)
        return self.new("geometry_msgs/TransformStamped", header=header, child_frame_id=pose.child, transform=moved)
