"""The robot as MJCF of primitive geoms: holonomic base, Kinova Gen3 7-DoF arm, Robotiq 2F-85-like gripper.

Link frames, joint limits and torques: Kinova Gen3 user guide (7-DoF, spherical wrist). Masses, gains and contact
parameters follow the measured set that holds objects by friction. The site `pinch` lies between the finger pads
with z along the approach and y along the closing direction.
"""

from math import cos, sin

ARM_JOINTS = tuple(f"joint_{i}" for i in range(1, 8))
JOINT_NAMES = ("base_x", "base_y", "base_yaw", *ARM_JOINTS, "gripper")
HOME_ARM = (0.0, -0.34906585, 3.14159265, -2.54818071, 0.0, -0.87266463, 1.57079633)
STROKE = 0.085
ROBOT_GROUP = 3
HULL_GROUP = 4
"""Geoms that collide but are not to be seen, for bodies with meshes to look at; nobody draws this group."""
ARM_MOUNT = (0.12, 0.0, 0.395)
LIDAR_HEIGHT = 0.2
HEAD_CAMERA = (-0.12, 0.0, 1.30)
HEAD_PITCH = 0.62
HEAD_FOVY = 62.0
WRIST_FOVY = 60.0

_LIMITS = (None, 2.24, None, 2.57, None, 2.09, None)
_TORQUE = (105, 105, 105, 105, 52, 52, 52)
# name, position, quaternion (relative to the previous link), mass, capsule from-to, radius
_LINKS = (
    ("shoulder_link", "0 0 0.15643", "0 1 0 0", 1.377, "0 0 0.02 0 0 -0.10", 0.048),
    ("half_arm_1_link", "0 0.005375 -0.12838", "1 1 0 0", 1.164, "0 0 -0.0064 0 -0.20 -0.0064", 0.046),
    ("half_arm_2_link", "0 -0.21038 -0.006375", "1 -1 0 0", 1.164, "0 0.0064 -0.01 0 0.0064 -0.20", 0.046),
    ("forearm_link", "0 0.006375 -0.21038", "1 1 0 0", 0.930, "0 0 -0.0064 0 -0.19 -0.0064", 0.043),
    ("spherical_wrist_1_link", "0 -0.20843 -0.006375", "1 -1 0 0", 0.678, "0 0 -0.01 0 0 -0.09", 0.040),
    ("spherical_wrist_2_link", "0 0.00017505 -0.10593", "1 1 0 0", 0.678, "0 0 0 0 -0.09 0", 0.040),
    ("bracelet_link", "0 -0.10593 -0.00017505", "1 -1 0 0", 0.500, "0 0 -0.005 0 0 -0.04", 0.040),
)
_COLOURS = ("0.85 0.86 0.88 1", "0.25 0.26 0.28 1")


def _geom(extra: str, mass: float, rgba: str, collide: bool = True) -> str:
    # Robot geoms touch the world and each other, but for the pairs that `contact_xml` excludes.
    flags = 'contype="2" conaffinity="3"' if collide else 'contype="0" conaffinity="0"'
    return f'<geom {extra} mass="{mass}" rgba="{rgba}" group="{ROBOT_GROUP}" {flags}/>'


def _base() -> str:
    parts = [
        _geom('name="chassis" type="box" size="0.25 0.265 0.135" pos="0 0 0.185"', 52, "0.18 0.19 0.22 1"),
        _geom('name="deck" type="box" size="0.24 0.25 0.012" pos="0 0 0.332"', 2, "0.85 0.55 0.12 1"),
        _geom('name="arm_riser" type="cylinder" size="0.07 0.026" pos="0.12 0 0.369"', 2, "0.30 0.31 0.33 1"),
        _geom('name="mast" type="capsule" fromto="-0.17 0 0.34 -0.17 0 1.28" size="0.022"', 2, "0.30 0.31 0.33 1"),
        _geom('name="head" type="box" size="0.035 0.075 0.03" pos="-0.16 0 1.30"', 1, "0.10 0.11 0.13 1"),
        _geom('name="lidar_case" type="cylinder" size="0.04 0.02" pos="0.21 0 0.345"', 1, "0.08 0.08 0.09 1", False),
    ]
    for n, (x, y) in enumerate(((0.17, 0.18), (0.17, -0.18), (-0.17, 0.18), (-0.17, -0.18))):
        extra = f'name="caster_{n}" type="cylinder" size="0.05 0.02" pos="{x} {y} 0.051" euler="1.5708 0 0"'
        parts.append(_geom(extra, 0, "0.05 0.05 0.05 1", False).replace('mass="0"', 'mass="0.2"'))
    return "\n".join(parts)


def _gripper() -> str:
    pad = (
        'type="box" size="0.011 0.004 0.019" condim="4" friction="1 .02 .0005" priority="1" '
        'solref=".005 1" solimp=".95 .99 .001"'
    )
    fingers = []
    for side, sign in (("left", 1), ("right", -1)):
        inner, outer = 0.0425 * sign, (0.0425 + 0.004) * sign
        fingers.append(f"""
<body name="{side}_finger" pos="0 {inner} 0">
  <joint name="{side}_finger" type="slide" axis="0 {-sign} 0" range="0 0.0425" armature=".05" damping="10"/>
  {_geom(f'name="{side}_pad" {pad} pos="0 {outer - inner} 0.145"', 0.04, "0.12 0.12 0.13 1")}
  {
            _geom(
                f'name="{side}_finger_body" type="box" size="0.010 0.006 0.030" pos="0 {0.014 * sign} 0.105"',
                0.08,
                "0.30 0.31 0.33 1",
            )
        }
</body>""")
    return f"""
<body name="gripper" pos="0 0 -0.0615" quat="0 1 0 0">
  {_geom('name="palm" type="cylinder" size="0.038 0.035" pos="0 0 0.035"', 0.45, "0.15 0.15 0.17 1")}
  {_geom('name="knuckles" type="box" size="0.018 0.056 0.010" pos="0 0 0.075"', 0.2, "0.15 0.15 0.17 1")}
  <site name="pinch" pos="0 0 0.145" size="0.004" rgba="1 0 0 0.4" group="4"/>
  <camera name="wrist" pos="0.065 0 0.02" xyaxes="0 1 0 0.98 0 0.2" fovy="{WRIST_FOVY}"/>
  {"".join(fingers)}
</body>"""


def _arm() -> str:
    inner = _gripper()
    for i in reversed(range(7)):
        name, pos, quat, mass, capsule, radius = _LINKS[i]
        limit = _LIMITS[i]
        limits = f'range="-{limit} {limit}" limited="true"' if limit else 'limited="false"'
        armature = 0.1 if i < 4 else 0.05
        geom = _geom(f'name="{name}" type="capsule" fromto="{capsule}" size="{radius}"', mass, _COLOURS[i % 2])
        inner = f"""
<body name="{name}" pos="{pos}" quat="{quat}" gravcomp="1">
  <joint name="joint_{i + 1}" type="hinge" axis="0 0 1" {limits} armature="{armature}" damping="1"/>
  {geom}
  {inner}
</body>"""
    x, y, z = ARM_MOUNT
    column = _geom('name="arm_base" type="cylinder" size="0.046 0.06" pos="0 0 0.06"', 1.7, _COLOURS[1])
    return f'<body name="arm_mount" pos="{x} {y} {z}">{column}{inner}</body>'


def body_xml() -> str:
    """The robot's body tree."""
    hx, hy, hz = HEAD_CAMERA
    s, c = sin(HEAD_PITCH), cos(HEAD_PITCH)
    arm = _arm().replace('<body name="gripper"', '<body name="gripper" gravcomp="1"')
    for side in ("left", "right"):
        arm = arm.replace(f'<body name="{side}_finger"', f'<body name="{side}_finger" gravcomp="1"')
    return f"""
<body name="base" pos="0 0 0">
  <joint name="base_x" type="slide" axis="1 0 0"/>
  <joint name="base_y" type="slide" axis="0 1 0"/>
  <joint name="base_yaw" type="hinge" axis="0 0 1"/>
  {_base()}
  <site name="lidar" pos="0 0 {LIDAR_HEIGHT}" size="0.01" group="4"/>
  <camera name="head" pos="{hx} {hy} {hz}" xyaxes="0 -1 0 {s} 0 {c}" fovy="{HEAD_FOVY}"/>
  {arm}
</body>"""


def actuators_xml() -> str:
    """Position servos of base, arm and gripper, with force limits."""
    rows = [
        '<position name="base_x" joint="base_x" kp="2e5" kv="2e4" forcerange="-800 800"/>',
        '<position name="base_y" joint="base_y" kp="2e5" kv="2e4" forcerange="-800 800"/>',
        '<position name="base_yaw" joint="base_yaw" kp="2e4" kv="2e3" forcerange="-300 300"/>',
    ]
    for i, torque in enumerate(_TORQUE):
        kp, kv = (3000, 110) if i < 4 else (1500, 30)
        rows.append(
            f'<position name="joint_{i + 1}" joint="joint_{i + 1}" kp="{kp}" kv="{kv}" '
            f'forcerange="-{torque} {torque}"/>'
        )
    rows.append(
        '<position name="gripper" joint="left_finger" kp="4000" kv="100" ctrlrange="0 0.0425" forcerange="-80 80"/>'
    )
    return "<actuator>" + "\n".join(rows) + "</actuator>"


def equality_xml() -> str:
    """Both fingers move together."""
    return """<equality>
<joint joint1="left_finger" joint2="right_finger" polycoef="0 1 0 0 0" solref="0.005 1" solimp="0.95 0.99 0.001"/>
</equality>"""


def contact_xml() -> str:
    """Neighbours in the chain, which overlap or nearly touch by design, do not collide."""
    excludes = [("base", "arm_mount"), ("base", "shoulder_link"), ("arm_mount", "shoulder_link")]
    names = [row[0] for row in _LINKS]
    excludes += [(names[i], names[i + 2]) for i in range(5)]
    excludes += [("bracelet_link", "gripper"), ("spherical_wrist_2_link", "gripper"), ("arm_mount", "half_arm_1_link")]
    excludes += [(body, f"{side}_finger") for body in ("gripper", "bracelet_link") for side in ("left", "right")]
    excludes += [("left_finger", "right_finger")]
    rows = "\n".join(f'<exclude body1="{a}" body2="{b}"/>' for a, b in excludes)
    return f"<contact>{rows}</contact>"


def robot_mjcf() -> str:
    """A model of the robot alone, for inverse kinematics and planning."""
    return f"""<mujoco model="tidybot">
<compiler angle="radian" autolimits="true"/>
<worldbody>{body_xml()}</worldbody>
{contact_xml()}
{actuators_xml()}
{equality_xml()}
<keyframe><key name="home" qpos="0 0 0 {" ".join(map(repr, HOME_ARM))} 0 0"/></keyframe>
</mujoco>"""
