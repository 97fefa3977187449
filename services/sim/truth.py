"""Ground truth of the world, answered on `sim/truth` for evaluators and tests; read by no service."""

from typing import Any

import msgspec

from common.body_extent import lowest
from common.support import support
from services.sim.body import Body
from services.sim.physics import Physics


def touching(physics: Physics, body: Body | None = None) -> tuple[dict[str, set[int]], dict[str, bool]]:
    """For each object the geoms of the robot that touch it, and whether anything else does."""
    body = body or physics
    by_body = {number: name for name, number in physics.bodies.items()}
    robot: dict[str, set[int]] = {name: set() for name in physics.bodies}
    other = dict.fromkeys(physics.bodies, False)
    geom_body = physics.model.geom_bodyid
    for a, b in physics.data.contact.geom[: physics.data.ncon]:
        for one, two in ((int(a), int(b)), (int(b), int(a))):
            name = by_body.get(int(geom_body[one]))
            if name is None:
                continue
            if int(geom_body[two]) in body.robot_bodies:
                robot[name].add(two)
            else:
                other[name] = True
    return robot, other


def holding(physics: Physics, body: Body | None = None) -> str | None:
    """The object that both pads touch and nothing else supports; None for an empty hand."""
    body = body or physics
    robot, other = touching(physics, body)
    left, right = body.pads
    return next((n for n, geoms in robot.items() if left & geoms and right & geoms and not other[n]), None)


def report(physics: Physics, t: float, epoch: str, body: Body | None = None) -> dict[str, Any]:
    """The answer of `sim/truth`; `body`: of which robot, the simulation's own if None."""
    data, scene, body = physics.data, physics.scene, body or physics
    robot, _ = touching(physics, body)
    held = holding(physics, body)
    found: dict[str, Any] = {}
    for p in physics.placements:
        number = physics.bodies[p.spec.name]
        x, y, z = (float(v) for v in data.xpos[number])
        gripper = {g for g in robot[p.spec.name] if int(physics.model.geom_bodyid[g]) in body.gripper_bodies}
        found[p.spec.name] = {
            "kind": p.spec.kind,
            "colour": p.spec.colour,
            "position": [x, y, z],
            "quaternion": [float(v) for v in data.xquat[number]],
            "on": "" if held == p.spec.name else support(scene, x, y, lowest(physics.model, data, number)),
            "touching_gripper": bool(gripper),
        }
    regions = {
        r.name: {"kind": r.kind, "center": list(r.center), "size": list(r.size), "yaw": r.yaw, "depth": r.depth}
        for r in scene.receptacles
    }
    base = [float(v) for v in data.qpos[body.qpos_at[:3]]]
    return {
        "t": t,
        "epoch": epoch,
        "base": base,
        "holding": held,
        "objects": found,
        "goal_regions": regions,
        "obstacles": physics.obstacles.report(data),
        "contacts": [msgspec.to_builtins(t) for t in body.contacts.touches],
    }
