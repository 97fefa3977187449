"""A mission as a film: the recorded world rendered from behind the robot's shoulder, with captions.

The camera's renderer draws it, without any GL library if need be. Films are animated WebP or GIF by Pillow, or MP4
where PyAV is installed.
"""

import importlib
import sys
from bisect import bisect_right
from collections.abc import Iterator
from fractions import Fraction
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from PIL import Image, ImageDraw, ImageFont

from cli.errors import CliError
from common import codec, topics
from common.recording import Recording

WIDTH, HEIGHT = 480, 360
RATE, FASTER, LONGEST = 10.0, 4.0, 300
"""Pictures a second, robot seconds a second, pictures in all (longer missions run faster)."""
BAR = 40
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


def frames(recording: Recording, record: dict[str, Any], begin: float, end: float) -> Iterator[Picture]:
    """Captioned pictures (HEIGHT + BAR, WIDTH, 3) at equal distances of robot time."""
    models = recording.of(topics.SIM_MODEL.key)
    rows = [row for row in recording.of(topics.SIM_STATE.key) if not row.junk]
    times = [row.t for row in rows]
    end = min(end, times[-1]) if times else begin
    if not models or end <= begin:
        raise CliError(f"{recording.path}: no sim/model and sim/state in it, so there is nothing to film")
    render = importlib.import_module("services.camera.render")
    model = codec.decode(topics.SIM_MODEL, models[-1].payload)
    renderer = render.Renderer(model.mjcf, "auto")
    looking = importlib.import_module("services.camera.outlook")
    pace = max(FASTER / RATE, (end - begin) / LONGEST)
    azimuth = 225.0
    try:
        for n in range(int((end - begin) / pace) + 1):
            t = begin + n * pace
            state = codec.decode(topics.SIM_STATE, rows[max(0, bisect_right(times, t) - 1)].payload)
            renderer.load(state.qpos, state.mocap)
            view = looking.outlook(renderer, azimuth)
            azimuth = view.azimuth
            picture = renderer.picture(view, WIDTH, HEIGHT)
            yield captioned(picture, *caption(record, t), t - float(record["started"]))
            if sys.stderr.isatty():
                print(f"\r\033[K  {t - begin:.0f} of {end - begin:.0f} s", end="", file=sys.stderr, flush=True)
    except ValueError as error:
        raise CliError(f"{recording.path}: {error}") from None
    finally:
        renderer.close()
        if sys.stderr.isatty():
            print("\r\033[K", end="", file=sys.stderr)


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
