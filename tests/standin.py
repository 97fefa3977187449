"""A robot of our own under the names of MuJoCo Menagerie's stanford_tidybot: defaults by class, files for meshes, a
gripper of rotating fingers that a motor of 0..255 closes over a tendon."""

from pathlib import Path

import numpy as np
import trimesh

from services.sim.robot import _LIMITS, _LINKS, _TORQUE

RETRACT = (0.0, -0.34906585, 3.14159265, -2.54818071, 0.0, -0.87266463, 1.57079633)
LENGTH, OPEN = 0.055, 0.575


ASKEW = ((0.23, 0.22, -0.03), (-0.24, 0.22, -0.03), (-0.24, -0.23, -0.03), (0.23, 0.1, 0.03), (-0.24, 0.0, 0.03))
"""Corners [m] of a bumper whose principal axes are not those of its sides."""


def _meshes(folder: Path) -> None:
    """The files that the model names, as STL: corners are not shared, axes are not principal."""
    folder.mkdir(parents=True, exist_ok=True)
    rod = trimesh.creation.cylinder(0.03, 0.12, sections=24)
    rod.apply_transform(trimesh.transformations.rotation_matrix(0.7, (1, 2, 3), (0, 0, 0)))
    made = {"body": trimesh.creation.box((0.5, 0.48, 0.24)), "bumper": trimesh.convex.convex_hull(ASKEW), "rod": rod}
    made["shell"] = trimesh.creation.icosphere(subdivisions=4, radius=0.05)
    for name, mesh in made.items():
        mesh.export(folder / f"{name}.stl")


def _finger(side: str, sign: int) -> str:
    return f"""
<body name="{side}_driver" pos="0 {sign * 0.012} 0.09">
  <joint name="{side}_driver_joint" axis="{sign} 0 0" range="0 {2 * OPEN}" armature="0.005" damping="0.1"/>
  <geom class="hit" type="capsule" size="0.006" mass="0.02"
        fromto="0 0 0 0 {sign * LENGTH * np.sin(OPEN):.6f} {LENGTH * np.cos(OPEN):.6f}"/>
  <body name="{side}_follower" pos="0 {sign * LENGTH * np.sin(OPEN):.6f} {LENGTH * np.cos(OPEN):.6f}">
    <joint name="{side}_follower_joint" axis="{sign} 0 0" range="-1.5 1.5" armature="0.001"/>
    <geom name="{side}_pad1" class="hit" type="box" size="0.011 0.004 0.009" pos="0 {sign * 0.004} 0.0195" mass="0.02"
          condim="4" friction="1 .02 .0005" priority="1" solref=".005 1" solimp=".95 .99 .001"/>
    <geom name="{side}_pad2" class="hit" type="box" size="0.011 0.004 0.009" pos="0 {sign * 0.004} 0.0015" mass="0.02"
          condim="4" friction="1 .02 .0005" priority="1" solref=".005 1" solimp=".95 .99 .001"/>
  </body>
</body>"""


def _arm() -> str:
    inner = f"""
<body name="base" pos="0 0 -0.0615" quat="0 1 0 0">
  <geom class="hit" type="cylinder" size="0.038 0.04" pos="0 0 0.04" mass="0.6"/>
  {_finger("left", 1)}{_finger("right", -1)}
</body>
<camera name="wrist" pos="0.065 0 -0.08" xyaxes="0 1 0 0.98 0 -0.2" fovy="42"/>
<site name="pinch_site" pos="0 0 -0.1815" euler="3.14159265 0 1.5707963"/>"""
    rod = '<geom class="hit" type="mesh" mesh="rod" pos="0 0 -0.1" quat="0.3 0.6 0.1 0.7" mass="0.01"/>'
    for i in reversed(range(7)):
        name, pos, quat, mass, capsule, radius = _LINKS[i]
        limits = f'range="-{_LIMITS[i]} {_LIMITS[i]}"' if _LIMITS[i] else ""
        inner = f"""
<body name="{name}" pos="{pos}" quat="{quat}">
  <joint name="joint_{i + 1}" {limits} armature="0.1" damping="1"/>
  <geom class="see" mesh="shell" quat="0.5 0.1 0.7 0.2"/>
  <geom class="hit" type="capsule" fromto="{capsule}" size="{radius}" mass="{mass}"/>{rod if i == 2 else ""}{inner}
</body>"""
    return f'<body name="gen3/base_link" pos="0 0 0.335">{inner}</body>'


def write(root: Path, without: str = "", file: str = "tidybot.xml") -> Path:
    """The model below a MENAGERIE_ROOT; `without` is a piece of its text that is left out."""
    folder = root / "stanford_tidybot"
    _meshes(folder / "assets")
    actuators = "".join(
        f'<position class="strong" name="joint_{i + 1}" joint="joint_{i + 1}" forcerange="-{t} {t}"/>'
        for i, t in enumerate(_TORQUE)
    )
    wheels = "".join(f'<position name="joint_{n}" joint="joint_{n}" kp="2e5" kv="2e4"/>' for n in ("x", "y"))
    home = " ".join(map(str, (0, 0, 0, *RETRACT, 0, 0, 0, 0)))
    other = " ".join(map(str, (0, 0, 0, 0, 0.26, 3.14159265, -2.27, 0, 0.96, 1.57, 0, 0, 0, 0)))
    text = f"""<mujoco model="tidybot">
<compiler angle="radian" meshdir="assets"/>
<option integrator="implicitfast" cone="elliptic" impratio="10"/>
<default>
  <site size="0.001"/>
  <default class="see"><geom type="mesh" contype="0" conaffinity="0" group="2"/></default>
  <default class="hit"><geom group="3"/></default>
  <default class="strong"><position kp="3000" kv="110"/></default>
</default>
<asset><material name="grey" rgba="0.6 0.6 0.6 1"/>
  <mesh file="rod.stl"/><mesh file="shell.stl"/><mesh file="bumper.stl"/><mesh file="body.stl"/></asset>
<worldbody>
  <body name="base_link">
    <inertial pos="0 0 0.1" mass="60" diaginertia="1 1 1"/>
    <joint name="joint_x" type="slide" axis="1 0 0"/>
    <joint name="joint_y" type="slide" axis="0 1 0"/>
    <joint name="joint_th"/>
    <geom class="see" mesh="bumper" pos="0 0 0.04"/>
    <geom class="see" mesh="body" pos="0 0 0.2" material="grey"/>
    <geom class="hit" type="mesh" mesh="bumper" pos="0 0 0.04"/>
    <geom class="hit" type="mesh" mesh="body" pos="0 0 0.2"/>
    <camera name="base" pos="0.26 0 0.3"/>
    {_arm()}
  </body>
</worldbody>
<tendon><fixed name="split">
  <joint joint="right_driver_joint" coef="0.5"/><joint joint="left_driver_joint" coef="0.5"/>
</fixed></tendon>
<equality>
  <joint joint1="right_driver_joint" joint2="left_driver_joint" solref="0.005 1" solimp="0.95 0.99 0.001"/>
  <joint joint1="left_follower_joint" joint2="left_driver_joint" polycoef="0 -1 0 0 0" solref="0.005 1"/>
  <joint joint1="right_follower_joint" joint2="right_driver_joint" polycoef="0 -1 0 0 0" solref="0.005 1"/>
</equality>
<actuator>
  {wheels}<position name="joint_th" joint="joint_th" kp="2e4" kv="2e3"/>{actuators}
  <general name="fingers_actuator" tendon="split" forcerange="-4 4" ctrlrange="0 255" biastype="affine"
           gainprm="0.3137 0 0" biasprm="0 -100 -10"/>
</actuator>
<keyframe><key name="home" qpos="{other}"/><key name="retract" qpos="{home}"/></keyframe>
</mujoco>"""
    assert without in text
    (folder / file).write_text(text.replace(without, "") if without else text)
    (folder / "scene.xml").write_text('<mujoco><include file="tidybot.xml"/></mujoco>')
    return root
