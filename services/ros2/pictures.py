"""A picture of the robot as ROS messages: colour, depth and the camera's parameters."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from common import messages as m
from common.robot.frames import optical_frame
from common.robot.pictures import colours, millimetres, pinhole
from services.ros2.types import Types


def _picture(types: Types, message: m.Rgbd, encoding: str, pixels: NDArray[Any]) -> Any:
    return types.new(
        "sensor_msgs/Image",
        header=types.header(message.t, optical_frame(message.camera)),
        height=message.height,
        width=message.width,
        encoding=encoding,
        is_bigendian=0,
        step=pixels.strides[0],
        data=pixels.view(np.uint8).ravel(),
    )


def image(types: Types, message: m.Rgbd) -> Any:
    """The colours of a picture; raises `PictureError`."""
    return _picture(types, message, "rgb8", colours(message))


def depth(types: Types, message: m.Rgbd) -> Any:
    """Depth of a picture in millimetres, 0 where nothing is seen (REP 118); raises `PictureError`."""
    return _picture(types, message, "16UC1", millimetres(message))


def camera_info(types: Types, message: m.Rgbd) -> Any:
    """The camera of a picture as a pinhole without distortion."""
    matrix, projection = pinhole(message)
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
        k=np.array(matrix),
        r=np.eye(3).ravel(),
        p=np.array(projection),
        binning_x=0,
        binning_y=0,
        roi=whole_picture,
    )
