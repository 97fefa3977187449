"""The simulated robot as MJCF: TidyBot in primitives, or the same drawn with the official model's meshes."""

import copy
import functools
import xml.etree.ElementTree as ET
from collections.abc import Iterable
from dataclasses import dataclass

from common.robot.model import home_arm
from services.sim import calibrate, robot
from services.sim.menagerie import NAME, RobotError, find

OURS, OFFICIAL = "tidybot", ("official", f"menagerie:{NAME}")
"""What the robot in primitives is called, and what the one with the official meshes is, by either name."""
_SECTIONS = ("default", "contact", "tendon", "equality", "actuator", "custom")


@dataclass(frozen=True)
class Robot:
    """MJCF of a robot: `body` and `assets` go into the world's sections, `rest` after them; `mjcf` is it alone."""

    name: str
    body: str
    assets: str
    rest: str
    mjcf: str
    home: tuple[float, ...]


def own() -> Robot:
    """The robot in primitives."""
    return load_robot(OURS)


_NAMES = frozenset((
    "name", "joint", "joint1", "joint2", "body", "body1", "body2", "site", "geom", "geom1", "geom2", "tendon",
    "tendon1", "tendon2", "target", "objname",
))  # fmt: skip
"""Attributes that hold the name of a part."""


def beside(robot: Robot, name: str) -> tuple[str, str]:
    """`body` and `rest` of a second robot of the same model, with `name/` before the name of each part."""

    def called(text: str) -> ET.Element:
        root = ET.fromstring(f"<parts>{text}</parts>")
        for element in root.iter():
            for attribute in _NAMES & element.attrib.keys():
                element.set(attribute, f"{name}/{element.get(attribute)}")
        return root

    def written(elements: Iterable[ET.Element]) -> str:
        return "".join(ET.tostring(e, encoding="unicode") for e in elements)

    # Defaults and tables are those of the first.
    return written(called(robot.body)), written(e for e in called(robot.rest) if e.tag not in ("default", "custom"))


@functools.cache
def load_robot(name: str) -> Robot:
    """`tidybot`, or `official` (`menagerie:stanford_tidybot` says the same): drawn with that model's meshes.

    Raises:
        RobotError: there is none of that name, or the official files are not on this machine.
    """
    if name not in (OURS, *OFFICIAL):
        raise RobotError(f"robot {name}: expected {OURS} or {OFFICIAL[0]}")
    alone = _measured()
    dressed = copy.deepcopy(alone)
    if name in OFFICIAL:
        from services.sim.skin import dress

        dress(dressed, find())

    def inside(tag: str) -> str:
        return "".join(ET.tostring(e, encoding="unicode") for section in dressed.findall(tag) for e in section)

    rest = "".join(f"<{tag}>{inside(tag)}</{tag}>" for tag in _SECTIONS)
    home = tuple(home_arm(calibrate.load(alone)[0]).tolist())
    return Robot(name, inside("worldbody"), inside("asset"), rest, ET.tostring(alone, encoding="unicode"), home)


@functools.cache
def _measured() -> ET.Element:
    """The model's file with what the gripper's linkage does, measured on it."""
    root = ET.parse(robot.MODEL).getroot()
    calibrate.measure_hand(root)
    return root
