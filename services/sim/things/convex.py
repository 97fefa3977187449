"""Convex parts of a mesh that nobody gave collision geoms, made once and kept on disk."""

import contextlib
import hashlib
import importlib
import io
import os
import zipfile
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from common.files import atomic_file

Array = NDArray[np.float64]
Part = tuple[Array, NDArray[np.int64]]
THRESHOLD = 0.05
"""Concavity that CoACD leaves: its own default. A cup keeps its inside."""
MOST = 24
"""Parts of one mesh: collisions of more cost more than they are worth to a hand of two fingers."""
FILLED = 0.8
"""Volume of a mesh, by that of its convex hull, below which the hull is not what is looked at. Chosen: a bottle with a
neck fills .75, a banana .7; fingers that close on it would stop in the air."""
EFFORT = {"preprocess_resolution": 30, "resolution": 1000, "mcts_nodes": 8, "mcts_iterations": 30, "mcts_max_depth": 2}
"""How hard CoACD tries: 5 s for a bowl of 768 triangles, by its own defaults 13 s; as many parts."""
SEAM_DIGITS = 6
"""Decimals [m] of vertices that are one."""
VERSION = "2"


def directory() -> Path:
    """Where parts are kept: TIDYBOT_CACHE_DIR, or below XDG_CACHE_HOME or ~/.cache."""
    if own := os.environ.get("TIDYBOT_CACHE_DIR"):
        return Path(own).expanduser()
    return Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache") / "tidybot"


def parts(vertices: Array, faces: NDArray[np.int64]) -> list[Part]:
    """The parts, from disk if they were made before; the convex hull where CoACD is not installed."""
    digest = hashlib.sha256(f"{VERSION} {THRESHOLD} {MOST}".encode() + vertices.tobytes() + faces.tobytes()).hexdigest()
    file = directory() / "convex" / f"{digest[:24]}.npz"
    try:
        with np.load(io.BytesIO(file.read_bytes())) as kept:
            return [(kept[f"v{n}"], kept[f"f{n}"]) for n in range(len(kept.files) // 2)]
    except (OSError, ValueError, KeyError, EOFError, zipfile.BadZipFile):
        pass
    try:
        coacd = importlib.import_module("coacd")
    except ImportError:
        return [_hull(vertices)]
    coacd.set_log_level("error")
    made = coacd.run_coacd(
        coacd.Mesh(*_sewn(vertices, faces)), threshold=THRESHOLD, max_convex_hull=MOST, seed=0, **EFFORT
    )
    found = [(np.asarray(v, np.float64), np.asarray(f, np.int64)) for v, f in made]
    _keep(file, found)
    return found


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


def _keep(file: Path, found: list[Part]) -> None:
    """What cannot be kept is made anew the next time."""
    arrays: dict[str, Any] = {}
    for n, (vertices, faces) in enumerate(found):
        arrays |= {f"v{n}": vertices, f"f{n}": faces}
    packed = io.BytesIO()
    np.savez_compressed(packed, **arrays)
    with contextlib.suppress(OSError):
        file.parent.mkdir(parents=True, exist_ok=True)
        atomic_file.replace(file, packed.getvalue())


def _hull(vertices: Array) -> Part:
    from scipy.spatial import ConvexHull

    hull = ConvexHull(vertices)
    corner = np.full(len(vertices), -1)
    corner[hull.vertices] = np.arange(len(hull.vertices))
    return vertices[hull.vertices], corner[hull.simplices]
