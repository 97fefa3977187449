"""Objects that nobody listed, for `python -m bench.grasp --unknown`: drawn sizes, standing, lying, in a crowd.

What manipulation is told of them is measured from points that the head camera would see: rays from its place, the noise
of its depth, hidden parts missing, and perception's own fit of a shape. Only which ray met which object is known from
the simulation, and the kind of what lies and is to be put down upright; both are perception's task and measured in
`bench.perception`.
"""

import math
from collections.abc import Callable
from typing import Any

import mujoco
import numpy as np

from bench.grasp.hand import Bench
from bench.grasp.tools import TOOLS, tool
from common import messages as m
from common import topics
from common.geometry import Array, yaw_quat
from common.rendering import raycast
from common.scene import ObjectSpec, Scene, body_name
from services.camera.sensor import NOISE_AT_1_M
from services.manipulation.config import ManipulationConfig
from services.perception.shapes.measure import Measurement, measure
from services.perception.unlisted import thinned

WIDTH, HEIGHT, FOVY = 480, 360, 62.0
"""A picture of the head camera [px, deg], at three quarters of its resolution."""
DENSITY, LIGHTEST, HEAVIEST = 350.0, 0.03, 0.7
"""Mass of what is drawn: by its bounding box [kg/m3], and its limits [kg]. Chosen: a full carton has 1000, an empty
mug 150; two pads hold 3 kg."""
CROWD = (0.015, 0.05)
"""Gaps [m] between an object in a crowd and its neighbours."""
Draw = Callable[[np.random.Generator], tuple[str, tuple[float, float, float], bool]]
"""Kind that the simulation builds the body of, its size as it stands [m], whether it lies."""


def _sized(kind: str, low: tuple[float, float, float], high: tuple[float, float, float], lies: bool = False) -> Draw:
    def draw(rng: np.random.Generator) -> tuple[str, tuple[float, float, float], bool]:
        x, y, z = (float(rng.uniform(a, b)) for a, b in zip(low, high, strict=True))
        return kind, (x, x if y == 0 else y, z), lies

    return draw


SHAPES: dict[str, Draw] = {
    "cylinder": _sized("can", (0.03, 0, 0.05), (0.074, 0, 0.18)),
    "cylinder lying": _sized("can", (0.03, 0, 0.08), (0.07, 0, 0.18), lies=True),
    "flat cylinder": _sized("can", (0.04, 0, 0.02), (0.072, 0, 0.045)),
    "bottle": _sized("bottle", (0.05, 0, 0.15), (0.073, 0, 0.26)),
    "bottle lying": _sized("bottle", (0.05, 0, 0.15), (0.07, 0, 0.24), lies=True),
    "block": _sized("block", (0.02, 0.02, 0.02), (0.07, 0.07, 0.08)),
    "carton": _sized("box", (0.04, 0.06, 0.09), (0.07, 0.12, 0.2)),
    "carton lying": _sized("box", (0.042, 0.08, 0.12), (0.068, 0.13, 0.19), lies=True),
    "book lying": _sized("block", (0.15, 0.09, 0.018), (0.21, 0.145, 0.045)),
    "book standing": _sized("block", (0.015, 0.1, 0.15), (0.04, 0.16, 0.22)),
    "ball": _sized("ball", (0.04, 0, 0), (0.072, 0, 0)),
    "mug": _sized("mug", (0.062, 0, 0.075), (0.073, 0, 0.11)),
    "bowl": _sized("bowl", (0.11, 0, 0.045), (0.17, 0, 0.07)),
    "plate": _sized("plate", (0.14, 0, 0.018), (0.22, 0, 0.028)),
    "rod": _sized("block", (0.12, 0.018, 0.014), (0.22, 0.035, 0.03)),
}


def _spec(name: str, shape: str, rng: np.random.Generator) -> tuple[ObjectSpec, bool]:
    if shape in TOOLS:
        return tool(name, shape, rng), False
    kind, size, lies = SHAPES[shape](rng)
    if kind == "ball":
        size = (size[0],) * 3
    mass = float(np.clip(DENSITY * math.prod(size), LIGHTEST, HEAVIEST))
    return ObjectSpec(name=name, kind=kind, colour="grey", size=size, mass=mass, rgba=(0.5, 0.5, 0.5, 1.0)), lies


class UnknownBench(Bench):
    """A drawn object on a table, with neighbours if `crowd`."""

    def __init__(self, scene: Scene, shape: str, seed: int, config: ManipulationConfig, crowd: int) -> None:
        rng = self._rng = np.random.default_rng([seed, 11])
        spec, lies = _spec("thing", shape, rng)
        others = [
            _spec(f"neighbour {n}", str(rng.choice(["cylinder", "block", "carton"])), rng)[0] for n in range(crowd)
        ]
        super().__init__(scene, spec, float(rng.uniform(0.45, 0.76)), seed, config, others=tuple(others), known=False)
        self._specs = [spec, *others]
        self._kinds = {spec.name: spec.kind} if lies else {}
        x, y, z = self.sim.physics.placements[0].position
        self.floor = z - spec.size[2] / 2 - 0.0005
        if lies:
            self._put(spec, (x, y, self.floor + max(spec.size[:2]) / 2 + 0.001), rng.uniform(-math.pi, math.pi), True)
        around = max(spec.size) / 2 if lies else math.hypot(*spec.size[:2]) / 2
        bearings = rng.uniform(-math.pi, math.pi) + np.arange(crowd) * 2 * math.pi / max(crowd, 1)
        for other, bearing in zip(others, bearings, strict=True):
            far = around + math.hypot(*other.size[:2]) / 2 + float(rng.uniform(*CROWD))
            at = (x + far * math.cos(bearing), y + far * math.sin(bearing), self.floor + other.size[2] / 2 + 0.001)
            self._put(other, at, float(rng.uniform(-math.pi, math.pi)))
        self.rest(0.5)

    def _put(self, spec: ObjectSpec, at: tuple[float, float, float], yaw: float, lies: bool = False) -> None:
        physics = self.sim.physics
        start = physics.model.jnt_qposadr[physics.model.body(body_name(spec)).jntadr[0]]
        c, s = math.cos(math.pi / 4), math.sin(math.pi / 4) * float(lies)
        turned = np.empty(4)
        mujoco.mju_mulQuat(turned, np.array(yaw_quat(yaw)), np.array([c if lies else 1.0, 0.0, s, 0.0]))
        physics.data.qpos[start : start + 3], physics.data.qpos[start + 3 : start + 7] = at, turned

    def look(self) -> m.ObjectRef:
        """Measure everything near by, tell it on `world/objects`, and return the object to grasp."""
        physics = self.sim.physics
        model, data = physics.model, physics.data
        mujoco.mj_forward(model, data)
        camera = data.cam("head")
        rays = raycast.directions(camera.xmat.reshape(3, 3), FOVY, WIDTH, HEIGHT)
        distance, geom, _ = raycast.cast(model, data, camera.xpos, rays)
        noisy = distance + self._rng.normal(0.0, 1.0, len(distance)) * NOISE_AT_1_M * distance**2
        points, body = camera.xpos + noisy[:, None] * rays, model.geom_bodyid[geom]
        objects = []
        for spec in self._specs:
            mine = points[(body == model.body(body_name(spec)).id) & (distance > 0)]
            if len(mine) >= 40:
                objects.append(self._measured(spec.name, mine, camera.xpos))
        self.bus.send(topics.WORLD_OBJECTS, m.WorldObjects(t=0.0, objects=objects))
        found = next((o for o in objects if o.label == self.spec.name), None)
        if found is None:
            raise LookupError("hidden from the camera")
        return m.ObjectRef(
            label=found.label, position=found.position, orientation=found.orientation, size=found.size,
            tilt=found.tilt, shape=found.shape, points=found.points, kind=found.kind,
        )  # fmt: skip

    def _measured(self, name: str, points: Array, camera: Array) -> m.WorldObject:
        far = float(np.linalg.norm(points.mean(axis=0) - camera))
        half_pixel = math.radians(FOVY) / HEIGHT / 2
        noise = NOISE_AT_1_M * far**2
        shape: Measurement = measure(points, self.floor, camera, (True, True), half_pixel, noise)
        at = (shape.x, shape.y, self.floor + shape.size[1 if shape.tilt else 2] / 2)
        few = thinned(points) - at
        placed: Any = self.sim.physics.placements[0]
        kind = self._kinds.get(name, "")
        return m.WorldObject(
            label=name, kind=kind, colour="grey", position=at, orientation=yaw_quat(shape.yaw), size=shape.size,
            on=placed.on, tilt=shape.tilt, shape=shape.family, measured=True, spread=shape.spread,
            points=np.round(few * 1000).astype("<i2").tobytes(), seen_at=0.0,
        )  # fmt: skip


def trial(scene: Scene, shape: str, seed: int, config: ManipulationConfig) -> str:
    """`ok`, or the stage and reason of the failure. `shape`: one of SHAPES, with " +N" for N neighbours."""
    name, _, crowd = shape.partition(" +")
    bench = UnknownBench(scene, name, seed, config, int(crowd or 0))
    bench.stand(bench.before_it(np.random.default_rng([seed, 3])))
    try:
        return bench.there_and_back(bench.look())
    except LookupError as hidden:
        return str(hidden)
