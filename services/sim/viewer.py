"""An optional window on the simulation."""

import os
from typing import Any

from common.runtime import StartError
from services.sim.physics import Physics


class Viewer:
    """MuJoCo's passive viewer; needs a display."""

    def __init__(self, physics: Physics) -> None:
        if not (os.environ.get("DISPLAY") or os.environ.get("WAYLAND_DISPLAY")):
            raise StartError("sim.viewer needs a display (DISPLAY is not set); run without --viewer")
        import mujoco.viewer

        self._window: Any = mujoco.viewer.launch_passive(physics.model, physics.data)

    def sync(self) -> None:
        if self._window.is_running():
            self._window.sync()

    def close(self) -> None:
        self._window.close()
