"""Views of random layouts from random places before furniture, by the sensor's model."""

import argparse
import math
from typing import NamedTuple

import numpy as np

from common.geometry import Pose2, yaw_matrix
from common.rendering.renderer import Renderer
from common.robot.joints import ARM, BASE
from common.scene import Receptacle, Scene, body_name, load_scene
from services.camera.sensor import StereoCamera
from services.perception.detect import ClassicalDetector
from services.perception.views.view import View
from services.sim.layout import Placement
from services.sim.model import own

RANGE, MARGIN = 3.0, 12
"""Depth [m] up to which, and margin of the picture [px] within which an object must be seen."""


def add_options(parser: argparse.ArgumentParser, pose_noise: float) -> None:
    """Add the options of how views are taken; `pose_noise` [m and rad] unless told."""
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--width", type=int, default=640)
    parser.add_argument("--height", type=int, default=480)
    parser.add_argument("--sensors", choices=("bought", "ideal"), default="bought", help="the camera's (bought)")
    parser.add_argument("--pose-noise", type=float, default=pose_noise, help="of the robot's own pose [m and rad]")
    parser.add_argument("--backend", default="auto", choices=("auto", "egl", "osmesa", "raycast"))


class Looked(NamedTuple):
    """A view, what stands there, and a detector that has been told of that home what its robot is."""

    view: View
    placements: list[Placement]
    detector: ClassicalDetector


def stand(rng: np.random.Generator, scene: Scene, placement: Placement) -> Pose2 | None:
    """A base pose before the furniture of an object, roughly facing it; None when that is in another room."""
    r = scene.receptacle(placement.on)
    assert r is not None
    x, y = _before(rng, r)
    if scene.room_at(x, y) is not scene.room_at(r.center[0], r.center[1]):
        return None
    facing = math.atan2(placement.position[1] - y, placement.position[0] - x)
    return x, y, facing + float(rng.uniform(-0.4, 0.4))


def _before(rng: np.random.Generator, r: Receptacle) -> tuple[float, float]:
    ax, ay = r.approach[int(rng.integers(len(r.approach)))]
    ux, uy = r.outline.direction(ax, ay)
    distance = (r.size[0] if ax else r.size[1]) / 2 + rng.uniform(0.4, 1.6)
    side = rng.uniform(-0.6, 0.6)
    return float(r.center[0] + ux * distance - uy * side), float(r.center[1] + uy * distance + ux * side)


def take(
    renderer: Renderer,
    pose: Pose2,
    args: argparse.Namespace,
    rng: np.random.Generator,
) -> View:
    """The view of the head camera with the base at `pose`, by any camera of the kind."""
    model, data = renderer.model, renderer.data
    for name, value in zip((*BASE, *ARM), (*pose, *own().home), strict=True):
        data.qpos[model.joint(name).qposadr[0]] = value
    renderer.load(data.qpos.copy().tobytes(), b"")
    rgb, depth = renderer.rgbd("head", args.width, args.height)
    focal = renderer.focal("head", args.height)
    if args.sensors == "bought":
        surfaces = renderer.surfaces("head", depth)
        camera = StereoCamera(int(rng.integers(2**32)))
        taken = camera.expose(rgb, depth, focal, int(rng.integers(2**31)), surfaces)
        rgb, depth = taken.rgb, taken.depth / 1000.0
    position, rotation = renderer.optical_pose("head")
    # Where the robot believes to be is a little off.
    x, y, theta = (v + float(rng.normal(0.0, args.pose_noise)) for v in pose)
    turn = yaw_matrix(theta)
    return View(
        rgb=rgb,
        depth=(np.round(np.maximum(depth, 0.0) * 1000) / 1000).astype(np.float32),
        focal=(focal, focal),
        middle=(args.width / 2, args.height / 2),
        position=turn @ position + np.array([x, y, 0.0]),
        rotation=turn @ rotation,
    )


def look_at(
    args: argparse.Namespace,
    renderer: Renderer,
    chosen: Placement,
    placements: list[Placement],
    rng: np.random.Generator,
) -> View | None:
    """A view of an object of a world that is the shipped flat with other objects; None from another room."""
    for p in placements:
        row = renderer.model.joint(body_name(p.spec)).qposadr[0]
        renderer.data.qpos[row : row + 7] = (*p.position, *p.quat)
    pose = stand(rng, load_scene("apartment"), chosen)
    return take(renderer, pose, args, rng) if pose is not None else None


def visible(view: View, placement: Placement) -> bool:
    """True when the object's centre is in the picture, near and not occluded."""
    u, v, z = (float(a) for a in view.project(np.array([placement.position]))[0])
    h, w = view.shape
    if not (MARGIN < u < w - MARGIN and MARGIN < v < h - MARGIN and 0.0 < z < RANGE):
        return False
    return abs(float(view.depth[int(v), int(u)]) - z) < 0.09
