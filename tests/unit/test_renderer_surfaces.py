"""Which pixels show what is glossy, from the depth that hides some of it."""

import numpy as np
import pytest

from common.rendering.renderer import Renderer

TIN, BOX = 0.05, 0.02
"""Radius of the glossy ball and half thickness of the box [m]."""


def world(box: str) -> Renderer:
    """A camera that looks along x at a glossy ball, 1 m before it, and a matt box elsewhere."""
    mjcf = f"""<mujoco>
      <asset><material name="tin" specular="1" shininess="1"/></asset>
      <worldbody>
        <camera name="eye" pos="0 0 0" xyaxes="0 -1 0 0 0 1" fovy="45"/>
        <geom type="sphere" size="{TIN}" pos="1 0 0" material="tin"/>
        <geom type="box" size="{BOX} .2 .2" pos="{box}"/>
      </worldbody></mujoco>"""
    renderer = Renderer(mjcf, "raycast")
    renderer.load(renderer.data.qpos.tobytes(), b"")
    return renderer


@pytest.mark.parametrize("box", ["1.5 0 0", "1 0 .3", ".5 .25 .1"], ids=["behind it", "above it", "before half of it"])
def test_gloss_is_where_the_ball_is_seen(box: str) -> None:
    renderer = world(box)
    _, depth = renderer.rgbd("eye", 160, 120)
    found = renderer.surfaces("eye", depth)
    assert found is not None
    glossy, middle = found.gloss > 0.0, slice(45, 75)
    assert glossy.any() and not np.delete(glossy, np.r_[middle], axis=0).any()
    ball = (depth > 1.0 - TIN - 0.005) & (depth < 1.005)
    assert (glossy[middle] == ball[middle]).mean() > 0.98


def test_what_is_wholly_hidden_is_not_drawn_again() -> None:
    renderer = world(".5 0 0")
    _, depth = renderer.rgbd("eye", 160, 120)
    assert renderer.surfaces("eye", depth) is None
