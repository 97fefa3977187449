"""The GL library that MuJoCo draws with: EGL or OSMesa where one works, else ray casting."""

import os
import subprocess
import sys
from functools import cache

BACKENDS = ("egl", "osmesa", "raycast")
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
    """The backend to use. MuJoCo settles on its GL library when it is first imported: before that `wanted` counts,
    after that only what the environment said then, or ray casting."""
    if "mujoco" in sys.modules:
        given = os.environ.get("MUJOCO_GL", "")
        return given if given in ("egl", "osmesa") and wanted in ("auto", given) else "raycast"
    backend = wanted if wanted != "auto" else best()
    os.environ |= environment(backend)
    return backend


def environment(backend: str) -> dict[str, str]:
    """What tells MuJoCo in a new process to render with a backend."""
    if backend == "raycast":
        return {"MUJOCO_GL": "disable"}
    return {"MUJOCO_GL": backend, "PYOPENGL_PLATFORM": backend}
