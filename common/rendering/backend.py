"""The GL library that MuJoCo draws with: EGL or OSMesa where one works, else ray casting."""

import importlib
import os
import subprocess
import sys
from functools import cache
from typing import Any

GL = ("egl", "osmesa")
"""MuJoCo's modules for drawing without a screen, by the name of their library."""
BACKENDS = (*GL, "raycast")
PROBE_SECONDS = 20.0
"""Time [s] for a GL library to show that it works."""
_PROBE = (
    "import mujoco; m = mujoco.MjModel.from_xml_string('<mujoco/>'); d = mujoco.MjData(m); "
    "mujoco.mj_forward(m, d); r = mujoco.Renderer(m, 8, 8); r.update_scene(d); r.render(); r.close()"
)


def works(backend: str) -> bool:
    """True when MuJoCo can render with that GL library; tried in a process of its own, since failures can crash."""
    if backend == "raycast":
        return True
    command = [sys.executable, "-c", _PROBE]
    try:
        return (
            subprocess.run(
                command, env={**os.environ, **environment(backend)}, capture_output=True, timeout=PROBE_SECONDS
            ).returncode
            == 0
        )
    except subprocess.TimeoutExpired:
        return False


@cache
def best() -> str:
    """The best backend of this machine."""
    return next(b for b in BACKENDS if works(b))


def choose(wanted: str) -> str:
    """The backend to use: `wanted`, or for "auto" what MUJOCO_GL says, else the best of this machine.

    A process draws with one GL library: where it has loaded one, another is ray casting instead.
    """
    loaded = next((b for b in GL if f"mujoco.{b}" in sys.modules), "")
    if loaded:
        return loaded if wanted in ("auto", loaded) else "raycast"
    given = os.environ.get("MUJOCO_GL", "")
    if wanted == "auto":
        wanted = given if given in GL else "raycast" if given == "disable" else best()
    if wanted != "raycast" or "mujoco" not in sys.modules:
        os.environ |= environment(wanted)
    return wanted


def context(backend: str, width: int, height: int) -> Any:
    """A GL context of that library, whatever MUJOCO_GL said when MuJoCo was imported."""
    return importlib.import_module(f"mujoco.{backend}").GLContext(width, height)


def environment(backend: str) -> dict[str, str]:
    """What tells MuJoCo in a new process to render with a backend."""
    if backend == "raycast":
        return {"MUJOCO_GL": "disable"}
    return {"MUJOCO_GL": backend, "PYOPENGL_PLATFORM": backend}
