"""Perception on pictures as the robot's camera has them: drawn, wherever a GL library works, with faces and print."""

import os

from common.rendering.backend import best, environment

if not os.environ.get("MUJOCO_GL"):
    # What builds worlds imports MuJoCo before a renderer could choose, and would leave it with cast pictures.
    os.environ |= environment(best())
