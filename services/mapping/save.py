"""Saving and resuming a map: grid, pose graph, surfaces, household and the evidence for them, as files."""

import json
from pathlib import Path
from typing import Any, NamedTuple

import msgspec
import numpy as np
from numpy.typing import NDArray
from scipy import ndimage

from common.files.atomic_file import replace
from common.files.map_file import GridMap, write_home
from common.geometry import Array, compose
from common.household import Household
from services.mapping.barriers import Met, glass
from services.mapping.depth import Picture
from services.mapping.grid import RESOLUTION
from services.mapping.mapper import Mapper, Shot
from services.mapping.plan import EndPoints, floor_plan
from services.mapping.pose_graph import Edge, PoseGraph
from services.mapping.scan import Scan
from services.mapping.scan_matching import placed

GRAPH, EVIDENCE = "pose_graph.json", "keyframes.npz"


class SaveError(OSError):
    """The map cannot be written, or an older one not be read; names the file."""


class Saved(NamedTuple):
    """Where the files are, and how many surfaces and bins they have."""

    directory: str
    surfaces: int


def save(directory: Path, name: str, mapper: Mapper) -> Saved:
    """Optimise the pose graph once more and write all files.

    Raises:
        SaveError: the directory cannot be written to.
    """
    if mapper.trajectory.graph.optimise() > 0.0:
        mapper.draw()
    states = mapper.states()
    household = made_household(name, mapper, states)
    try:
        directory.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise SaveError(f"{directory}: {error.strerror}") from None
    part, corner = mapper.grid.known(states)
    grid = GridMap(part, RESOLUTION, corner)
    write_home(directory, grid, household)
    rows = graph_rows(mapper.trajectory.graph, mapper.trajectory.scans, mapper.trajectory.runs)
    if why := replace(directory / GRAPH, msgspec.json.format(msgspec.json.encode(rows), indent=1)):
        raise SaveError(f"{directory / GRAPH}: {why}")
    with (directory / EVIDENCE).open("wb") as file:
        np.savez_compressed(file, **_evidence(mapper))
    return Saved(str(directory), len(household.receptacles))


def made_household(name: str, mapper: Mapper, states: NDArray[np.uint8]) -> Household:
    """The household made from the map as far as it goes."""
    trajectory = mapper.trajectory
    points = [placed(s.points, p) for s, p in zip(trajectory.scans, trajectory.poses, strict=True)]
    eyes = [np.tile(p[:2], (len(s.points), 1)) for s, p in zip(trajectory.scans, trajectory.poses, strict=True)]
    ends, seen_from = np.concatenate(points), np.concatenate(eyes)
    # What has gone since, and who walked through, is on no occupied cell any more.
    grid = mapper.grid
    there = grid.at(ends, ndimage.binary_dilation(grid.walls))
    taken = ndimage.binary_dilation(grid.walls | grid.covered)
    level, low = (rows[grid.at(rows, taken)] for rows in (_seen(mapper, "level"), _low(mapper)))
    lidar = EndPoints(ends[there], seen_from[there])
    return floor_plan(name, lidar, grid, states, level, low, glass(mapper.panes))


def _low(mapper: Mapper) -> Array:
    """Points (n, 3) [map] of what is low; where none was seen standing, as beside a way, those seen driving."""
    standing, driving = _seen(mapper, "low"), _seen(mapper, "low", still=False)
    known = np.zeros(mapper.grid.shape, bool)
    known[mapper.grid.cells(standing[:, :2])] = True
    return np.concatenate([standing, driving[~mapper.grid.at(driving, ndimage.binary_dilation(known, iterations=4))]])


def _seen(mapper: Mapper, layer: str, still: bool = True) -> Array:
    """Points (n, 3) [map] of one layer of all pictures that were taken standing, or not."""
    parts = [np.empty((0, 3))]
    for shot in mapper.shots:
        if shot.still == still:
            base = compose(mapper.trajectory.poses[shot.keyframe], shot.pose)
            parts.append(placed(getattr(shot.picture, layer), base))
    return np.concatenate(parts)


def graph_rows(graph: PoseGraph, scans: list[Scan], runs: list[int]) -> dict[str, Any]:
    """The pose graph for others: nodes with which runs began, nodes, edges; poses as x, y, theta [m, m, rad]."""
    nodes = [
        {"id": n, "t": round(s.t, 3), "pose": [round(v, 5) for v in p]}
        for n, (p, s) in enumerate(zip(graph.poses, scans, strict=True))
    ]
    edges = [{"from": e.start, "to": e.end, "pose": [round(v, 5) for v in e.pose], "kind": e.kind} for e in graph.edges]
    return {"frame": "map", "runs": runs, "nodes": nodes, "edges": edges}


def resume(directory: Path, mapper: Mapper) -> None:
    """Load the map in a directory, to go on with it.

    Raises:
        SaveError: a file that is missing or that cannot be read.
    """
    try:
        rows = json.loads((directory / GRAPH).read_text(encoding="utf-8"))
        graph = PoseGraph()
        graph.poses = [tuple(n["pose"]) for n in rows["nodes"]]
        graph.edges = [msgspec.convert((e["from"], e["to"], e["pose"], e["kind"]), Edge) for e in rows["edges"]]
        with np.load(directory / EVIDENCE) as file:
            layers = {k: file[k] for k in file.files}
            scans, shots = _unpacked(layers)
            met = _met(layers)
    except (OSError, ValueError, KeyError, TypeError, msgspec.ValidationError) as error:
        raise SaveError(f"{directory}: no map to go on with: {error}") from None
    if len(scans) != len(graph.poses):
        raise SaveError(f"{directory}: {len(scans)} scans for {len(graph.poses)} keyframes")
    mapper.trajectory.resume(graph, scans, [int(n) for n in rows["runs"]])
    mapper.shots, mapper.met = shots, met
    mapper.draw()


def _evidence(mapper: Mapper) -> dict[str, Any]:
    """Scans and pictures as arrays, joined, with how many rows each has."""
    scans, shots = mapper.trajectory.scans, mapper.shots
    found: dict[str, Any] = {
        "times": np.array([s.t for s in scans]), "lidar": np.array([s.lidar for s in scans]).reshape(-1, 2),
        "at": np.array([s.keyframe for s in shots]), "from": np.array([s.pose for s in shots]).reshape(-1, 3),
        "still": np.array([s.still for s in shots], bool),
        "met_at": np.array([at for at, _ in mapper.met], np.int64),
        "met": np.array([m for _, m in mapper.met]).reshape(-1, 4),
    }  # fmt: skip
    for layer, width in (("points", 2), ("passed", 2)):
        found |= _joined(layer, [getattr(s, layer) for s in scans], width)
    for layer, width in (("floor", 2), ("above", 3), ("level", 3), ("low", 3)):
        found |= _joined(layer, [getattr(s.picture, layer) for s in shots], width)
    return found


def _joined(name: str, parts: list[Array], width: int) -> dict[str, Any]:
    rows = np.concatenate([np.empty((0, width)), *parts]).astype(np.float32)
    return {name: rows, f"{name}_rows": np.array([len(p) for p in parts], np.int64)}


def _split(file: dict[str, Array], name: str) -> list[Array]:
    ends = np.cumsum(file[f"{name}_rows"]).astype(int)
    return [p.astype(np.float64) for p in np.split(file[name], ends[:-1])] if len(ends) else []


def _unpacked(file: dict[str, Array]) -> tuple[list[Scan], list[Shot]]:
    layers = {name: _split(file, name) for name in ("points", "passed", "floor", "above", "level", "low")}
    scans = [
        Scan(float(t), points, passed, (float(x), float(y)))
        for t, (x, y), points, passed in zip(
            file["times"], file["lidar"], layers["points"], layers["passed"], strict=True
        )
    ]
    shots = []
    for n, (at, pose, still) in enumerate(zip(file["at"], file["from"], file["still"], strict=True)):
        picture = Picture(*(layers[name][n] for name in ("floor", "above", "level", "low")))
        shots.append(Shot(int(at), (float(pose[0]), float(pose[1]), float(pose[2])), picture, bool(still)))
    return scans, shots


def _met(file: dict[str, Array]) -> list[tuple[int, Met]]:
    """What held the robot up; a map of an older version has none."""
    rows = zip(file["met_at"], file["met"], strict=True) if "met" in file else ()
    return [(int(at), Met((float(x), float(y)), (float(u), float(v)))) for at, (x, y, u, v) in rows]
