"""The cameras: render an RGB-D image from the streamed state when somebody asks for one."""

from collections import deque
from pathlib import Path

from common import messages as m
from common import topics
from common.bus.port import Io, Job
from common.robot import calibration
from common.runtime import StartError
from services.camera.config import CameraConfig
from services.camera.shutter import Shutter

MAX_WAITING = 8
"""Requests that may wait; chosen: more than are asked for at the same time."""


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
        self._states: deque[m.SimState] = deque(maxlen=2)
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
        state = self._io.latest(topics.SIM_STATE)
        if state is not None and not (self._states and self._states[-1].t == state.t):
            self._states.append(state)
        if self._job is not None and self._job.poll(now):
            self._finish(self._job)
            self._job = None
        if self._job is None and self._waiting:
            self._start(self._waiting.popleft())

    def _start(self, request: m.CameraRequest) -> None:
        model = self._io.latest(topics.SIM_MODEL)
        if model is None or not self._states:
            self._io.count_drop(topics.CAMERA_REQUEST.key, "no picture before the first sim/model and sim/state")
            return
        seconds = self._config.render_seconds
        self._job = self._io.submit(self._shutter.take, model, tuple(self._states), request, seconds=seconds)

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
        self._io.dispose(self._shutter.close)


def _mounts(path: str) -> calibration.Mounts:
    """What a calibration file says; nothing without a path.

    Raises:
        StartError: the file cannot be used.
    """
    try:
        return calibration.read(Path(path).expanduser()) if path else {}
    except calibration.CalibrationError as error:
        raise StartError(f"camera.calibration: {error}") from None
