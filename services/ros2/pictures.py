"""A picture of the robot as ROS messages: colour, depth and the camera's parameters."""

from typing import Any

import numpy as np

from common import messages as m
from common.robot.frames import optical_frame
from services.ros2.types import Types


def _picture(types: Types, message: m.Rgbd, encoding: str, data: bytes, pixel: int) -> Any:
    if len(data) != message.width * message.height * pixel:
        raise ValueError(f"{len(data)} bytes of {message.width} x {message.height} pixels")
    return types.new(
        "sensor_msgs/Image",
        header=types.header(message.t, optical_frame(message.camera)),
        height=message.height,
        width=message.width,
        encoding=encoding,
        is_bigendian=0,
        step=message.width * pixel,
        data=np.frombuffer(data, np.uint8),
    )


def image(types: Types, message: m.Rgbd) -> Any:
    return _picture(types, message, "rgb8", message.rgb, 3)


def depth(types: Types, message: m.Rgbd) -> Any:
    """Millimetres, 0 where nothing is seen (REP 118)."""
    return _picture(types, message, "16UC1", message.depth, 2)


def camera_info(types: Types, message: m.Rgbd) -> Any:
    """The camera of a picture as a pinhole without distortion."""
    fx, fy, cx, cy = message.fx, message.fy, message.cx, message.cy
    whole_picture = types.new(
        "sensor_msgs/RegionOfInterest", x_offset=0, y_offset=0, height=0, width=0, do_rectify=False
    )
    return types.new(
        "sensor_msgs/CameraInfo",
        header=types.header(message.t, optical_frame(message.camera)),
        height=message.height,
        width=message.width,
        distortion_model="plumb_bob",
        d=np.zeros(5),
        k=np.array([fx, 0, cx, 0, fy, cy, 0, 0, 1.0]),
        r=np.eye(3).ravel(),
        p=np.array([fx, 0, cx, 0, 0, fy, cy, 0, 0, 0, 1.0, 0]),
        binning_x=0,
        binning_y=0,
        roi=whole_picture,
    )
