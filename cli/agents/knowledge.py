"""Queries of an agent about the robot: pictures, objects, the map, its state. Each function asks the bus once."""

from typing import Any

import numpy as np

from cli.errors import CliError
from cli.link import Link, Subscription
from cli.missions.explain import mission_record, told
from cli.missions.say import status_record
from cli.payload import fields
from cli.processes.supervision import settings_of_run
from common import config, topics
from common import messages as m
from common.cells import unpacked
from common.household import Household, load_household
from common.rendering.encode import jpeg, png
from common.robot.pictures import colours
from common.scene import SceneError

PICTURE_SIZE = (640, 480)
"""Width and height [pixels] of a picture."""
PICTURE_LIMIT = 10.0
"""Time [s] for the camera to answer; chosen: far above the slowest, which casts rays."""
MAP_LIMIT = 3.0
"""Time [s] for the costmap, which comes at 1 Hz."""
JPEG_QUALITY = 85
"""Of pictures for agents [1 to 95]; chosen: print on a label can still be read."""


def picture(link: Link, camera: m.CameraName) -> bytes:
    """A fresh picture of one camera as JPEG.

    Raises:
        CliError: the camera does not answer.
    """
    return jpeg(colours(link.picture(camera, *PICTURE_SIZE, PICTURE_LIMIT)), JPEG_QUALITY)


def objects(link: Link) -> list[dict[str, Any]]:
    """The objects that the robot remembers, the last seen first: where, how sure, how many seconds ago.

    Raises:
        CliError: perception does not answer.
    """
    world, pose = link.present(topics.WORLD_OBJECTS), link.latest(topics.POSE)
    now = max(world.t, pose.t if pose is not None else 0.0)
    return [
        {
            "label": o.label, "kind": o.kind, "colour": o.colour, "names": o.names, "text": o.text, "on": o.on,
            "held": o.held, "position": [round(v, 3) for v in o.position], "size": [round(v, 3) for v in o.size],
            "confidence": round(o.confidence, 2), "seconds_ago": round(max(0.0, now - o.seen_at), 1),
        }
        for o in sorted(world.objects, key=lambda o: -o.seen_at)
    ]  # fmt: skip


def whereabouts(link: Link, words: str) -> list[dict[str, Any]]:
    """The remembered objects that all words of a phrase fit: by label, kind, colour, taught name or print."""
    wanted = set(words.lower().split())
    found = []
    for one in objects(link):
        said = " ".join([one["label"], one["kind"], one["colour"], one["text"], *one["names"]]).lower().split()
        if wanted <= set(said):
            found.append(one)
    return found


def household(link: Link) -> dict[str, Any]:
    """The map in words: rooms, places and surfaces [m, frame map], the robot's pose, what was seen where."""
    home, pose = _told(link), link.latest(topics.POSE)
    record: dict[str, Any] = {
        "pose": None if pose is None else {"x": pose.x, "y": pose.y, "theta": pose.theta},
        "objects": objects(link),
    }
    if home is not None:
        record["rooms"] = [{"name": r.name, "low": list(r.low), "high": list(r.high), "yaw": r.yaw} for r in home.rooms]
        record["places"] = [{"name": p.name, "x": p.x, "y": p.y} for p in home.places]
        record["surfaces"] = [
            {"name": r.name, "aliases": list(r.aliases), "center": list(r.center)} for r in home.receptacles
        ]
    return record


def map_picture(link: Link) -> bytes:
    """The costmap as PNG, north up: white is room for the base's centre, black is not; the robot is red.

    Raises:
        CliError: navigation does not publish one, or what it publishes is none.
    """
    seen = Subscription(link, topics.COSTMAP).next(MAP_LIMIT)
    if seen is None:
        raise CliError("navigation publishes no costmap; see `tidybot ps`")
    try:
        cells = unpacked(seen)
    except ValueError as error:
        raise CliError(f"{topics.COSTMAP.key}: {error}") from None
    shown = np.repeat(cells[:, :, None], 3, axis=2)
    pose = link.latest(topics.POSE)
    if pose is not None:
        row, column = (int((v - o) / seen.resolution) for v, o in ((pose.y, seen.y), (pose.x, seen.x)))
        shown[max(0, row - 2) : row + 3, max(0, column - 2) : column + 3] = (255, 0, 0)
    return png(shown[::-1])


def status(link: Link) -> dict[str, Any]:
    """The robot's state: what it does, how the last mission ended, whether its brake is on.

    Raises:
        CliError: the brain does not answer.
    """
    state = link.present(topics.BRAIN_STATE)
    sim = link.latest(topics.SIM_STATUS)
    return {
        **status_record(state, link.latest(topics.SYSTEM_STATUS)),
        "stopped": sim is not None and sim.state == "stopped",
        "stop_reason": sim.detail if sim is not None and sim.state == "stopped" else "",
    }


def explanation(link: Link, mission: str) -> str:
    """A mission's timeline: what was heard, planned, seen and done, and why it failed."""
    return told(mission_record(link, mission))


def missions(link: Link) -> list[dict[str, Any]]:
    """Every mission of the journal, the oldest first."""
    rows: list[dict[str, Any]] = fields(link.query(topics.BRAIN_MISSIONS))
    return rows


def _told(link: Link) -> Household | None:
    """What the robot was told of its home, None when that is not known on this machine."""
    running = link.latest(topics.SIM_STATUS)
    try:
        settings = settings_of_run()
        changes = config.overrides(settings, ())
        shared = config.load("runtime", config.RuntimeConfig, config.config_dir(), changes)
        chosen = any(f"{config.PREFIX}RUNTIME__{name}" in settings for name in ("SCENE", "HOUSEHOLD"))
        ours = chosen or (running is not None and running.scene == shared.world_file)
        return load_household(shared.household_file) if ours else None
    except (config.ConfigError, SceneError):
        return None
