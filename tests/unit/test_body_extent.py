"""How low what stands, leans or lies reaches: on a corner, an edge or a wall, not on its bounding box."""

from typing import Any

import mujoco
import pytest

from common.body_extent import lowest

CORNERS = "-.1 0 0  .1 0 0  0 .1 0  0 -.1 0  0 0 .2"


@pytest.mark.parametrize(
    ("shape", "degrees", "reach"),
    [
        ('type="box" size=".1 .02 .03"', 0, 0.03), ('type="box" size=".1 .02 .03"', 30, 0.076),
        ('type="cylinder" size=".05 .1"', 30, 0.1116), ('type="cylinder" size=".05 .1"', 90, 0.05),
        ('type="sphere" size=".04"', 30, 0.04), ('type="capsule" size=".02 .1"', 30, 0.1066),
        ('type="ellipsoid" size=".03 .04 .1"', 90, 0.03),
    ],
)  # fmt: skip
def test_every_shape_reaches_as_low_as_it_does(shape: str, degrees: int, reach: float) -> None:
    model, data = posed(f"<geom {shape}/>", degrees)
    assert 1.0 - lowest(model, data, 1) == pytest.approx(reach, abs=1e-4)


def test_a_mesh_reaches_as_low_as_its_corners_and_what_is_only_looked_at_does_not_count() -> None:
    asset = f'<asset><mesh name="roof" vertex="{CORNERS}"/></asset>'
    looked_at = '<geom type="sphere" size=".5" contype="0" conaffinity="0"/>'
    model, data = posed(f'<geom type="mesh" mesh="roof"/>{looked_at}', 180, asset)
    corners = data.geom_xpos[0] + model.mesh_vert @ data.geom_xmat[0].reshape(3, 3).T
    assert lowest(model, data, 1) == pytest.approx(float(corners[:, 2].min())) == pytest.approx(0.8, abs=1e-6)


def posed(geoms: str, degrees: int, asset: str = "") -> tuple[Any, Any]:
    body = f'<body pos="0 0 1" euler="0 {degrees} 0"><freejoint/>{geoms}</body>'
    model = mujoco.MjModel.from_xml_string(f"<mujoco>{asset}<worldbody>{body}</worldbody></mujoco>")
    data = mujoco.MjData(model)
    mujoco.mj_kinematics(model, data)
    return model, data
