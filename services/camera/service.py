"""The cameras: render an RGB-D image from the streamed state when somebody asks for one."""

from collections import deque
from pathlib import Path

import numpy as np
from scipy.spatial.transform import Rotation

from common import calibration, topics
from common import messages as m
from common.bus.port import Io, Job
from common.geometry import matrix_quat
from common.rendering.renderer import Renderer
from common.runtime import StartError
from common.time.lockstep import DT
from services.camera.config import CameraConfig
from services.camera.sensor import StereoCamera, exact

MAX_WAITING = 8
"""Requests that may wait; chosen: more than are asked for at the same time."""


class Shutter:
    """Lives in the worker: a renderer for the model at hand and, unless `seed` is None, the sensors' models.

    `mounts`: offset [m] and turn [deg] of the calibrated cameras from their drawing.
    """

    def __init__(self, backend: str, seed: int | None, mounts: calibration.Mounts) -> None:
        self._backend, self._mjcf, self._mounts = backend, "", mounts
        self._renderer: Renderer | None = None
        self._sensors = {} if seed is None else {c: StereoCamera(seed + i) for i, c in enumerate(calibration.CAMERAS)}

    def take(self, model: m.SimModel, state: m.SimState, request: m.CameraRequest) -> m.Rgbd:
        """Render one image."""
        if self._renderer is None or model.mjcf != self._mjcf:
            if self._renderer is not None:
                self._renderer.close()
            self._renderer, self._mjcf = Renderer(model.mjcf, self._backend), model.mjcf
        renderer, width, height = self._renderer, request.width, request.height
        renderer.load(state.qpos, state.mocap)
        position, rotation = renderer.optical_pose(request.camera)
        sensor = self._sensors.get(request.camera)
        if sensor is not None:
            renderer.move(request.camera, sensor.offset, sensor.turn)
        rgb, depth = renderer.rgbd(request.camera, width, height)
        mount = self._mounts.get(request.camera)
        if mount is not None:
            position = position + rotation @ np.array(mount[0])
            rotation = rotation @ Rotation.from_rotvec(mount[1], degrees=True).as_matrix()
        x, y, z = (float(v) for v in position)
        focal = renderer.focal(request.camera, height)
        picture = sensor.expose(rgb, depth, focal, round(state.t / DT)) if sensor else exact(rgb, depth)
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

    def close(self) -> None:
        if self._renderer is not None:
            self._renderer.close()


class CameraService:
    """Head and wrist RGB-D cameras, on demand."""

    NAME = "camera"
    HZ = 10
    CONFIG = CameraConfig
    READS, WRITES = topics.subscribed(NAME), topics.published(NAME)

    def __init__(self, config: CameraConfig, io: Io) -> None:
        self._config, self._io = config, io
        seed = int(io.rng.integers(2**32)) if config.sensors == "bought" else None
        self._shutter = Shutter(config.backend, seed, _mounts(config.calibration))
        self._waiting: deque[m.CameraRequest] = deque(maxlen=MAX_WAITING)
        self._job: Job[m.Rgbd] | None = None
        self._rendered = False

    def step(self, now: float) -> None:
        """Take requests, and render one picture at a time in the worker."""
        for request in self._io.take_all(topics.CAMERA_REQUEST):
            if not (0 < request.width <= self._config.max_width and 0 < request.height <= self._config.max_height):
                limit = f"{self._config.max_width} x {self._config.max_height}"
                self._io.count_drop(topics.CAMERA_REQUEST.key, f"{request.width} x {request.height}: up to {limit}")
                continue
            self._waiting.append(request)
        if self._job is not None and self._job.poll(now):
            self._finish(self._job)
            self._job = None
        if self._job is None and self._waiting:
            self._start(self._waiting.popleft())

    def _start(self, request: m.CameraRequest) -> None:
        model, state = self._io.latest(topics.SIM_MODEL), self._io.latest(topics.SIM_STATE)
        if model is None or state is None:
            self._io.count_drop(topics.CAMERA_REQUEST.key, "no picture before the first sim/model and sim/state")
            return
        seconds = self._config.render_seconds
        self._job = self._io.submit(self._shutter.take, model, state, request, seconds=seconds)

    def _finish(self, job: Job[m.Rgbd]) -> None:
        try:
            image = job.result()
        except ValueError as error:
            self._io.count_drop(topics.SIM_STATE.key, str(error))
            return
        if not self._rendered:
            self._rendered = True
            self._io.log.info("rendering", backend=image.backend)
        self._io.publish(topics.HEAD_RGBD if image.camera == "head" else topics.WRIST_RGBD, image)

    def close(self) -> None:
        self._io.submit(self._shutter.close, seconds=0.0)


def _mounts(path: str) -> calibration.Mounts:
    """What a calibration file says; nothing without a path.

    Raises:
        StartError: the file cannot be used.
    """
    try:
        return calibration.read(Path(path).expanduser()) if path else {}
    except calibration.CalibrationError as error:
        raise StartError(f"camera.calibration: {error}") from None
