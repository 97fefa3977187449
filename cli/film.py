"""A mission as a film: the recorded world rendered from behind the robot's shoulder, with captions.

The camera's renderer draws it, without any GL library if need be. Films are animated WebP or GIF by Pillow, or MP4
where PyAV is installed.
"""

import base64
import importlib
import io
import sys
from bisect import bisect_right
from collections.abc import Iterator
from fractions import Fraction
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from PIL import Image, ImageDraw, ImageFont

from cli.errors import CliError
from common import topics
from common.bus import codec
from common.recording import Recording

WIDTH, HEIGHT = 480, 360
RATE, FASTER, LONGEST = 10.0, 4.0, 300
"""Pictures a second, robot seconds a second, pictures in all (longer missions run faster)."""
BAR = 40
KEY_FRAMES, KEY_SIZE = 8, (320, 220)
Picture = NDArray[np.uint8]


def make(recording: Recording, record: dict[str, Any], target: Path, begin: float, end: float) -> None:
    """Render from `begin` to `end` [s of robot time] into `target`.

    Raises:
        CliError: the recording has no physics, or PyAV is wanted and not there.
    """
    if target.suffix == ".mp4":
        _mp4(target, frames(recording, record, begin, end))
        return
    pictures = [Image.fromarray(p) for p in frames(recording, record, begin, end)]
    options = {"quality": 70, "method": 2} if target.suffix == ".webp" else {"optimize": True}
    pictures[0].save(target, save_all=True, append_images=pictures[1:], duration=round(1000 / RATE), loop=0, **options)


class Scenery:
    """The recorded world, drawn at any time.

    Raises:
        CliError: the recording has no physics.
    """

    def __init__(self, recording: Recording) -> None:
        models = recording.of(topics.SIM_MODEL.key)
        self._path = recording.path
        self._rows = [row for row in recording.of(topics.SIM_STATE.key) if not row.junk]
        self.times = [row.t for row in self._rows]
        if not models or not self._rows:
            raise CliError(f"{recording.path}: no sim/model and sim/state in it, so there is nothing to see")
        render = importlib.import_module("services.camera.render")
        self._renderer = render.Renderer(codec.decode(topics.SIM_MODEL, models[-1].payload).mjcf, "auto")
        self._outlook = importlib.import_module("services.camera.outlook").outlook
        self._azimuth = 225.0

    def at(self, t: float, width: int, height: int) -> Picture:
        """The robot from a side that is free, (height, width, 3)."""
        row = self._rows[max(0, bisect_right(self.times, t) - 1)]
        try:
            state = codec.decode(topics.SIM_STATE, row.payload)
            self._renderer.load(state.qpos, state.mocap)
        except (ValueError, codec.DecodeError) as error:
            raise CliError(f"{self._path}: {error}") from None
        view = self._outlook(self._renderer, self._azimuth)
        self._azimuth = view.azimuth
        picture: Picture = self._renderer.picture(view, width, height)
        return picture

    def close(self) -> None:
        self._renderer.close()


def frames(recording: Recording, record: dict[str, Any], begin: float, end: float) -> Iterator[Picture]:
    """Captioned pictures (HEIGHT + BAR, WIDTH, 3) at equal distances of robot time."""
    scenery = Scenery(recording)
    try:
        begin, end = max(begin, scenery.times[0]), min(end, scenery.times[-1])
        pace = max(FASTER / RATE, (end - begin) / LONGEST)
        for n in range(max(0, int((end - begin) / pace)) + 1):
            t = begin + n * pace
            yield captioned(scenery.at(t, WIDTH, HEIGHT), *caption(record, t), t - float(record["started"]))
            if sys.stderr.isatty():
                print(f"\r\033[K  {t - begin:.0f} of {end - begin:.0f} s", end="", file=sys.stderr, flush=True)
    finally:
        scenery.close()
        if sys.stderr.isatty():
            print("\r\033[K", end="", file=sys.stderr)


def key_frames(recording: Recording, record: dict[str, Any]) -> list[tuple[float, str, str]]:
    """(seconds since the mission began, caption, JPEG in base64) at the end of each state and at each fault."""
    entries = record["entries"]
    changes = [(a, b) for a, b in pairwise(entries) if a["state"] != b["state"] or b["kind"] == "failed"]
    moments = [(b["t"], b["cause"] if b["kind"] == "failed" else f"{a['state']} ends") for a, b in changes]
    moments.append((float(record["until"]), str(record["outcome"] or "the recording ends")))
    step = max(1, -(-len(moments) // KEY_FRAMES))
    scenery, found = Scenery(recording), []
    try:
        for t, words in moments[::-step][::-1]:
            file = io.BytesIO()
            Image.fromarray(scenery.at(t, *KEY_SIZE)).save(file, "JPEG", quality=80)
            shown = base64.b64encode(file.getvalue()).decode("ascii")
            found.append((t - float(record["started"]), words, shown))
    finally:
        scenery.close()
    return found


def caption(record: dict[str, Any], t: float) -> tuple[str, str]:
    """The mission's state at `t`, and the last thing worth telling."""
    past = [entry for entry in record["entries"] if entry["t"] <= t]
    state = str(past[-1]["state"]) if past else ""
    told = next((entry["cause"] for entry in reversed(past) if entry["kind"] != "state"), "")
    return state, str(told)


def captioned(picture: Picture, state: str, told: str, t: float) -> Picture:
    canvas = Image.new("RGB", (picture.shape[1], picture.shape[0] + BAR), (22, 24, 28))
    canvas.paste(Image.fromarray(picture), (0, 0))
    pen, y = ImageDraw.Draw(canvas), picture.shape[0] + 3
    pen.text((8, y), f"{max(t, 0.0):5.1f} s  {state}", fill=(255, 214, 10), font=ImageFont.load_default(15))
    pen.text((8, y + 20), told[:80], fill=(222, 226, 230), font=ImageFont.load_default(12))
    return np.asarray(canvas)


def _mp4(target: Path, pictures: Iterator[Picture]) -> None:
    try:
        av: Any = importlib.import_module("av")
    except ImportError:
        raise CliError("MP4 needs PyAV: `pip install av`; .webp and .gif need nothing") from None
    with av.open(str(target), "w") as container:
        stream = container.add_stream("libx264", rate=Fraction(RATE).limit_denominator(100))
        stream.width, stream.height, stream.pix_fmt = WIDTH, HEIGHT + BAR, "yuv420p"
        stream.options = {"crf": "26", "preset": "veryfast"}
        for picture in pictures:
            for packet in stream.encode(av.VideoFrame.from_ndarray(np.ascontiguousarray(picture), format="rgb24")):
                container.mux(packet)
        for packet in stream.encode():
            container.mux(packet)
