"""Taking a picture: renders the world as it was during exposure and applies the sensors' models."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from common import messages as m
from common import topics
from common.geometry import matrix_quat, turn_matrix
from common.rendering.renderer import Renderer
from common.robot import calibration
from common.time.lockstep import DT
from services.camera.sensor import Depth, Rgb, StereoCamera, exact

READOUT = 0.030
"""Time from the first row's exposure to the last's [s]; chosen: a rolling shutter at 30 pictures a second."""
AGE = (0.030, 0.060)
"""Least and most that a picture is older than its stamp [s]: read-out, transfer and driver, which nobody accounts for.
Source: latencies of 30 to 60 ms that are measured of USB cameras of the D435's class."""
SLICES = 4
"""Moments of the read-out that are drawn [count]; chosen: 10 ms apart, an exposure in a lit room."""
STILL = 2e-4
"""Motion of a joint or object while a picture is taken [m or rad] that nobody sees: a tenth of a pixel."""
GAP = 0.25
"""States farther apart [s] than this do not say how things moved; chosen: a few of those that are published."""


class Shutter:
    """Takes pictures, in the worker: a renderer for the present model and, unless `seed` is None, sensor models.

    `mounts`: offset [m] and turn [deg] of the calibrated cameras from their drawing.
    """

    def __init__(self, backend: str, seed: int | None, mounts: calibration.Mounts) -> None:
        self._backend, self._mjcf, self._mounts, self._seed = backend, "", mounts, seed
        self._renderer: Renderer | None = None
        self._sensors = {} if seed is None else {c: StereoCamera(seed + i) for i, c in enumerate(topics.PICTURES)}

    def take(self, model: m.SimModel, states: Sequence[m.SimState], request: m.CameraRequest) -> m.Rgbd:
        """Take a picture, stamped with the last of the `states`; the state before it tells how things move.

        Raises:
            ValueError: the state belongs to another model.
        """
        if self._renderer is None or model.mjcf != self._mjcf:
            if self._renderer is not None:
                self._renderer.close()
            self._renderer, self._mjcf = Renderer(model.mjcf, self._backend, model.files), model.mjcf
        renderer, state, width, height = self._renderer, states[-1], request.width, request.height
        renderer.load(state.qpos, state.mocap)
        position, rotation = renderer.optical_pose(request.camera)
        mount = self._mounts.get(request.camera)
        if mount is not None:
            position = position + rotation @ np.array(mount[0])
            rotation = rotation @ turn_matrix(np.radians(mount[1]))
        x, y, z = (float(v) for v in position)
        focal = renderer.focal(request.camera, height)
        sensor = self._sensors.get(request.camera)
        if sensor is None:
            picture = exact(*renderer.rgbd(request.camera, width, height))
        else:
            rgb, depth = self._exposed(renderer, sensor, states, request)
            surfaces = renderer.surfaces(request.camera, depth)
            picture = sensor.expose(rgb, depth, focal, round(state.t / DT), surfaces)
        return m.Rgbd(
            t=state.t,
            id=request.id,
            camera=request.camera,
            width=width,
            height=height,
            fx=focal,
            fy=focal,
            cx=width / 2,
            cy=height / 2,
            position=(x, y, z),
            orientation=matrix_quat(rotation),
            rgb=picture.rgb.tobytes(),
            depth=picture.depth.astype("<u2").tobytes(),
            backend=renderer.backend,
            calibrated=mount is not None,
        )

    def _exposed(
        self, renderer: Renderer, sensor: StereoCamera, states: Sequence[m.SimState], request: m.CameraRequest
    ) -> tuple[Rgb, Depth]:
        """What reaches the sensors: colour row by row while things move, depth at the beginning, all rows at once.

        The renderer is left with the state that the depth is of.
        """
        size = request.camera, request.width, request.height
        age = float(np.random.default_rng([self._seed or 0, round(states[-1].t / DT)]).uniform(*AGE))
        moments = moved(states, age, SLICES)
        rows = exposed(request.height, len(moments))

        def pose(moment: NDArray[np.float64]) -> None:
            renderer.load(moment.tobytes(), states[-1].mocap)
            renderer.move(request.camera, sensor.offset, sensor.turn)

        bands = []
        for moment, band in zip(moments[1:], rows[1:], strict=True):
            pose(moment)
            bands.append(renderer.band(*size, band))
        pose(moments[0])
        rgb, depth = renderer.rgbd(*size)
        return rolling([rgb[slice(*rows[0])], *bands], request.height), depth

    def close(self) -> None:
        if self._renderer is not None:
            self._renderer.close()


def moved(states: Sequence[m.SimState], age: float, count: int) -> list[NDArray[np.float64]]:
    """The positions (nq,) at `count` moments of the read-out that began `age` [s] before the last state; of things at
    rest that state alone."""
    last = np.frombuffer(states[-1].qpos)
    before, gap = states[0], states[-1].t - states[0].t
    if not 0.0 < gap <= GAP or before.epoch != states[-1].epoch or len(before.qpos) != len(states[-1].qpos):
        return [last]
    change = last - np.frombuffer(before.qpos)
    if np.abs(change).max() * age / gap < STILL:
        return [last]
    ages = age - READOUT * np.arange(count) / (count - 1)
    return [last - change * (float(a) / gap) for a in ages]


def exposed(height: int, count: int) -> list[tuple[int, int]]:
    """For each of `count` evenly spaced moments of the read-out the rows that it has a share in, as first and end."""
    last = count - 1
    starts = [-(-k * height // last) for k in range(count)] if last else [0, height]
    return [(starts[max(k - 1, 0)], starts[min(k + 1, last)] if last else height) for k in range(count)]


def rolling(drawn: Sequence[Rgb], height: int) -> Rgb:
    """A picture (h, w, 3) whose rows were exposed one after the other, between evenly spaced moments; `drawn`: of each
    moment the rows that `exposed` says."""
    last = len(drawn) - 1
    if last == 0:
        return drawn[0]
    rows = exposed(height, len(drawn))
    mixed = np.empty((height, *drawn[0].shape[1:]), np.uint8)
    for k in range(last):
        first, end = rows[k + 1][0], rows[k][1]
        # In parts of 256, which fit 16 bits with the level.
        share = (((np.arange(first, end) * last - k * height) * 256) // height).astype(np.uint16)[:, None, None]
        before = drawn[k][first - rows[k][0] : end - rows[k][0]]
        after = drawn[k + 1][first - rows[k + 1][0] : end - rows[k + 1][0]]
        mixed[first:end] = (before * (256 - share) + after * share + 128) >> 8
    return mixed
