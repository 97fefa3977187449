"""Key frames of a mission: the recorded world as a free camera beside the robot sees it when each state ends."""

import base64
from bisect import bisect_right
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import NDArray

from cli.errors import CliError
from common import topics
from common.bus import codec
from common.recording import Recording
from common.rendering.encode import jpeg
from common.rendering.free_camera import free_view
from common.rendering.renderer import Renderer

MOST = 8
"""Key frames of one mission; chosen: two rows of the page."""
SIZE = 320, 220
"""Width and height [px]."""
AZIMUTH = 225.0
"""Where the camera looks from at first [deg]: behind the robot's right shoulder as it starts."""
QUALITY = 80
"""Of the JPEG [percent]; chosen: no blocks to be seen at this size."""


class RecordedWorld:
    """The recorded simulation, which can be rendered at any time.

    Raises:
        CliError: the recording has no physics.
    """

    def __init__(self, recording: Recording) -> None:
        models = recording.of(topics.SIM_MODEL.key)
        self._path = recording.path
        self._rows = [row for row in recording.of(topics.SIM_STATE.key) if not row.junk]
        self._times = [row.t for row in self._rows]
        if not models or not self._rows:
            raise CliError(f"{recording.path}: no sim/model and sim/state in it, so there is nothing to see")
        described = codec.decode(topics.SIM_MODEL, models[-1].payload)
        self._renderer = Renderer(described.mjcf, "auto", described.files)
        self._azimuth = AZIMUTH

    def at(self, t: float, width: int, height: int) -> NDArray[np.uint8]:
        """RGB (height, width, 3) of the robot at robot time `t` [s], from a side that is free."""
        row = self._rows[max(0, bisect_right(self._times, t) - 1)]
        try:
            state = codec.decode(topics.SIM_STATE, row.payload)
            self._renderer.load(state.qpos, state.mocap)
        except (ValueError, codec.DecodeError) as error:
            raise CliError(f"{self._path}: {error}") from None
        view = free_view(self._renderer, self._azimuth)
        self._azimuth = view.azimuth
        return self._renderer.picture(view, width, height)

    def close(self) -> None:
        self._renderer.close()


def key_frames(recording: Recording, record: dict[str, Any]) -> list[tuple[float, str, str]]:
    """(seconds since the mission began, caption, JPEG in base64) at the end of each state and at each fault.

    Raises:
        CliError: the recording has no physics, or what it has cannot be drawn.
    """
    entries = record["entries"]
    changes = [(a, b) for a, b in pairwise(entries) if a["state"] != b["state"] or b["kind"] == "failed"]
    moments = [(b["t"], b["cause"] if b["kind"] == "failed" else f"{a['state']} ends") for a, b in changes]
    moments.append((float(record["until"]), str(record["outcome"] or "the recording ends")))
    step = max(1, -(-len(moments) // MOST))
    world, found = RecordedWorld(recording), []
    try:
        for t, words in moments[::-step][::-1]:
            shown = base64.b64encode(jpeg(world.at(t, *SIZE), QUALITY)).decode("ascii")
            found.append((t - float(record["started"]), words, shown))
    finally:
        world.close()
    return found
