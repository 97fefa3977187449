"""The robot that the simulation has: our own, or one of MuJoCo Menagerie."""

import copy
import functools
import xml.etree.ElementTree as ET
from dataclasses import dataclass

from common.robot import home_arm
from services.sim import robot
from services.sim.menagerie import PREFIX, RobotError, find, mapping

OURS, OFFICIAL = "tidybot", "official"
_SECTIONS = ("contact", "tendon", "equality", "actuator", "custom")


@dataclass(frozen=True)
class Robot:
    """`body` and `assets` go into the world's own sections, `rest` behind them; `mjcf` is the robot alone."""

    name: str
    body: str
    assets: str
    rest: str
    mjcf: str
    home: tuple[float, ...]


def own() -> Robot:
    rest = f"{robot.contact_xml()}\n{robot.actuators_xml()}\n{robot.equality_xml()}"
    return Robot(OURS, robot.body_xml(), "", rest, robot.robot_mjcf(), robot.HOME_ARM)


@functools.cache
def load_robot(name: str) -> Robot:
    """`tidybot`, `official` (MuJoCo Menagerie's stanford_tidybot), or `menagerie:NAME`.

    Raises:
        RobotError: there is none of that name, or it lacks something.
    """
    if name in ("", OURS):
        return own()
    if name == OFFICIAL:
        return load_robot(f"{PREFIX}stanford_tidybot")
    if not name.startswith(PREFIX):
        raise RobotError(f"robot {name}: expected {OURS}, {OFFICIAL} or {PREFIX}stanford_tidybot")
    from services.sim import calibrate
    from services.sim.adapt import adapted

    label = name.removeprefix(PREFIX)
    names, mapped_in = mapping(label)
    root = adapted(find(label, names.model), names, mapped_in)
    try:
        calibrate.measure_hand(root)
        calibrate.name_deck(root)
        calibrate.exclude_neighbours(root)
        alone = _bare(root)
    except (ValueError, KeyError, StopIteration) as error:
        raise RobotError(
            f"robot {name}: the model does not behave like a base with an arm and a gripper: {error}"
        ) from None

    def inside(tag: str) -> str:
        return "".join(ET.tostring(e, encoding="unicode") for section in root.findall(tag) for e in section)

    rest = "".join(f"<{tag}>{inside(tag)}</{tag}>" for tag in _SECTIONS if root.find(tag) is not None)
    home = tuple(home_arm(calibrate.load(alone)[0]).tolist())
    return Robot(name, inside("worldbody"), inside("asset"), rest, ET.tostring(alone, encoding="unicode"), home)


def _bare(root: ET.Element) -> ET.Element:
    """The robot as those see it who plan: without the meshes that are only to look at."""
    alone = copy.deepcopy(root)
    for body in alone.iter("body"):
        for geom in [g for g in body.findall("geom") if g.get("contype") == "0"]:
            body.remove(geom)
    used = {g.get("mesh") for g in alone.iter("geom")}
    for asset in alone.findall("asset"):
        for mesh in [e for e in asset.findall("mesh") if e.get("name") not in used]:
            asset.remove(mesh)
    return alone
