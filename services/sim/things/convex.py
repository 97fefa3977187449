"""Convex parts of a mesh that nobody gave collision geoms, made once and kept on disk."""

import contextlib
import hashlib
import importlib.util
import io
import os
import resource
import subprocess
import sys
import tempfile
import zipfile
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from common.files import atomic_file
from common.geometry import Array
from services.sim.things import cells
from services.sim.things.cells import Part

THRESHOLD = 0.05
"""Concavity that CoACD leaves: its own default. A cup keeps its inside."""
MOST = 24
"""Parts of one mesh: collisions of more cost more than they are worth to a hand of two fingers."""
FILLED = 0.8
"""Volume of a mesh, by that of its convex hull, below which the hull is not what is looked at. Chosen: a bottle with a
neck fills .75, a banana .7; fingers that close on it would stop in the air."""
EFFORT = {"preprocess_resolution": 30, "resolution": 1000, "mcts_nodes": 8, "mcts_iterations": 30, "mcts_max_depth": 2}
"""How hard CoACD tries: 5 s for a bowl of 768 triangles, by its own defaults 13 s; as many parts."""
LIMIT = 40
"""Processor time [s] that CoACD may take for a mesh. Most take 5 to 20; a vase of 672 triangles was not done after
eight minutes, and as long nothing is heard of the simulation."""
SEAM_DIGITS = 6
"""Decimals [m] of vertices that are one."""
VERSION = "3"


def directory() -> Path:
    """Where parts are kept: TIDYBOT_CACHE_DIR, or below XDG_CACHE_HOME or ~/.cache."""
    if own := os.environ.get("TIDYBOT_CACHE_DIR"):
        return Path(own).expanduser()
    return Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache") / "tidybot"


def parts(vertices: Array, faces: NDArray[np.int64]) -> list[Part]:
    """The parts, from disk if they were made before; by `cells` where CoACD makes none."""
    digest = hashlib.sha256(f"{VERSION} {THRESHOLD} {MOST}".encode() + vertices.tobytes() + faces.tobytes()).hexdigest()
    file = directory() / "convex" / f"{digest[:24]}.npz"
    with contextlib.suppress(OSError, ValueError, KeyError, EOFError, zipfile.BadZipFile):
        return _read(file.read_bytes())
    vertices, faces = _sewn(vertices, faces)
    if importlib.util.find_spec("coacd") is None:
        return cells.parts(vertices, faces, MOST)  # not kept: better ones are to be made once it is installed
    found = _decomposed(vertices, faces) or cells.parts(vertices, faces, MOST)
    _keep(file, found)
    return found


def _decomposed(vertices: Array, faces: NDArray[np.int64]) -> list[Part]:
    """CoACD's parts; none where it fails or does not end: in a process of its own for that."""
    with tempfile.TemporaryDirectory(prefix="tidybot-convex-") as scratch:
        given, made = Path(scratch, "mesh.npz"), Path(scratch, "parts.npz")
        np.savez(given, v0=vertices, f0=faces)
        paths = {"PYTHONPATH": os.pathsep.join(p for p in sys.path if p)}
        line = [sys.executable, "-m", "services.sim.things.convex", str(given), str(made)]
        done = subprocess.run(line, env={**os.environ, **paths}, capture_output=True, check=False)
        return _read(made.read_bytes()) if done.returncode == 0 else []


def main(given: str, made: str) -> int:
    """Decompose the mesh of one file into another, within `LIMIT`."""
    resource.setrlimit(resource.RLIMIT_CPU, (LIMIT, LIMIT))
    coacd = importlib.import_module("coacd")
    coacd.set_log_level("error")
    ((vertices, faces),) = _read(Path(given).read_bytes())
    mesh = coacd.Mesh(vertices, faces)
    found = coacd.run_coacd(mesh, threshold=THRESHOLD, max_convex_hull=MOST, seed=0, **EFFORT)
    Path(made).write_bytes(_packed([(np.asarray(v, np.float64), np.asarray(f, np.int64)) for v, f in found]))
    return os.EX_OK


def _sewn(vertices: Array, faces: NDArray[np.int64]) -> Part:
    """The mesh without the seams of its texture and without triangles of no area, which CoACD takes minutes to mend."""
    corners, index = np.unique(np.round(vertices, SEAM_DIGITS), axis=0, return_inverse=True)
    found = index.ravel()[faces]
    a, b, c = found.T
    return corners, found[(a != b) & (b != c) & (a != c)]


def hollow(vertices: Array, faces: NDArray[np.int64]) -> bool:
    """The convex hull of a closed mesh would fill what is open or bent: a bowl, a mug, a banana."""
    from scipy.spatial import ConvexHull

    a, b, c = (vertices[faces[:, n]] - vertices.mean(axis=0) for n in range(3))
    volume = abs(float(np.einsum("ij,ij->", a, np.cross(b, c)))) / 6
    return volume < FILLED * float(ConvexHull(vertices).volume)


def _read(packed: bytes) -> list[Part]:
    with np.load(io.BytesIO(packed)) as kept:
        return [(kept[f"v{n}"], kept[f"f{n}"]) for n in range(len(kept.files) // 2)]


def _packed(found: list[Part]) -> bytes:
    arrays: dict[str, Any] = {}
    for n, (vertices, faces) in enumerate(found):
        arrays |= {f"v{n}": vertices, f"f{n}": faces}
    packed = io.BytesIO()
    np.savez_compressed(packed, **arrays)
    return packed.getvalue()


def _keep(file: Path, found: list[Part]) -> None:
    """What cannot be kept is made anew the next time."""
    with contextlib.suppress(OSError):
        file.parent.mkdir(parents=True, exist_ok=True)
        atomic_file.replace(file, _packed(found))


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
