"""Perception on random rendered views: `python -m bench.perception --views 200`.

Each view shows a random layout from a random place a robot can stand at. The table compares detections with the
simulation's own poses. The peer is the naive estimate from the same pixels: the middle of the visible points, named
by colour alone.
"""

import argparse
import math
import time

import numpy as np

from common.geometry import inverse, compose
from common.scene import load_scene
from services.camera.render import Renderer
from services.perception import colour, segment
from services.perception.detect import ClassicalDetector, Detection
from services.perception.view import View
from services.sim.layout import place_objects
from services.sim.world import world_mjcf
from services.sim import robot as robot_model
from services.sim.objects import body_name

FAR = 3.0
MIN_VISIBLE = 60


def view_from(renderer: Renderer, pose, width, height, noise, rng):
    d, model = renderer.data, renderer.model
    for n, v in zip(("base_x", "base_y", "base_yaw"), pose):
        d.qpos[model.joint(n).qposadr[0]] = v
    for i, v in enumerate(robot_model.HOME_ARM):
        d.qpos[model.joint(f"joint_{i+1}").qposadr[0]] = v
    renderer.load(d.qpos.copy().tobytes(), b"")
    rgb, depth = renderer.rgbd("head", width, height)
    depth = depth + rng.normal(0, 1, depth.shape) * noise * depth**2
    depth = np.round(np.maximum(depth, 0) * 1000) / 1000
    p, r = renderer.optical_pose("head")
    c, s = math.cos(pose[2]), math.sin(pose[2])
    turn = np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]])
    focal = height / 2 / math.tan(math.radians(float(model.camera("head").fovy[0])) / 2)
    return View(rgb, depth.astype(np.float32), (focal, focal), (width / 2, height / 2), turn @ p + np.array([pose[0], pose[1], 0]), turn @ r)


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--views", type=int, default=200)
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--width", type=int, default=640)
    parser.add_argument("--height", type=int, default=480)
    parser.add_argument("--noise", type=float, default=0.0012)
    parser.add_argument("--pose-noise", type=float, default=0.0)
    parser.add_argument("--backend", default="auto")
    parser.add_argument("-v", action="store_true")
    args = parser.parse_args()
    scene = load_scene("apartment")
    rng = np.random.default_rng(args.seed)
    detector = ClassicalDetector(scene, 3.5)
    errors, right, total, missed, false, times, wrong = [], 0, 0, 0, 0, [], []
    n = 0
    while n < args.views:
        seed = int(rng.integers(1 << 30))
        placements = place_objects(scene, seed)
        renderer = Renderer(world_mjcf(scene, placements), args.backend)
        for _ in range(5):
            p = placements[int(rng.integers(len(placements)))]
            r = scene.receptacle(p.on)
            ax, ay = r.approach[int(rng.integers(len(r.approach)))]
            c, s = math.cos(r.yaw), math.sin(r.yaw)
            ux, uy = c * ax - s * ay, s * ax + c * ay
            edge = (r.size[0] if ax else r.size[1]) / 2
            dist = edge + rng.uniform(0.4, 1.6)
            side = rng.uniform(-0.6, 0.6)
            x, y = r.center[0] + ux * dist - uy * side, r.center[1] + uy * dist + ux * side
            if scene.room_at(x, y) is not scene.room_at(*r.center[:2]):
                continue
            th = math.atan2(p.position[1] - y, p.position[0] - x) + rng.uniform(-0.4, 0.4)
            v = view_from(renderer, (x, y, th), args.width, args.height, args.noise, rng)
            if args.pose_noise:
                e = rng.normal(0, args.pose_noise, 2); a = rng.normal(0, args.pose_noise)
                c, s = math.cos(a), math.sin(a); T = np.array([[c,-s,0],[s,c,0],[0,0,1]])
                piv = np.array([x, y, 0])
                v = View(v.rgb, v.depth, v.focal, v.middle, T @ (v.position - piv) + piv + np.array([*e, 0]), T @ v.rotation)
            t0 = time.perf_counter()
            found = detector.detect(v)
            times.append(time.perf_counter() - t0)
            n += 1
            # visible: objects with enough pixels
            import mujoco
            used = set()
            for q in placements:
                uvz = v.project(np.array([q.position]))[0]
                if not (12 < uvz[0] < args.width - 12 and 12 < uvz[1] < args.height - 12 and 0 < uvz[2] < FAR):
                    continue
                # centre of object visible: depth about expected
                d = v.depth[int(uvz[1]), int(uvz[0])]
                if abs(d - uvz[2]) > 0.09:
                    continue
                total += 1
                near = [k for k in found if math.hypot(k.position[0] - q.position[0], k.position[1] - q.position[1]) < 0.10]
                if not near:
                    missed += 1
                    wrong.append((seed, (x, y, th), q.spec.name, "missed", round(float(uvz[2]), 2)))
                    continue
                k = min(near, key=lambda k: math.dist(k.position, q.position))
                used.add(id(k))
                errors.append(math.dist(k.position, q.position))
                if k.label == q.spec.name:
                    right += 1
                else:
                    wrong.append((seed, (x, y, th), q.spec.name, k.label, round(float(uvz[2]), 2), round(k.confidence, 2)))
            for k in found:
                if not any(math.hypot(k.position[0] - q.position[0], k.position[1] - q.position[1]) < 0.12 for q in placements):
                    false += 1
                    wrong.append((seed, (x, y, th), "-", k.label, k.on, round(k.distance, 2), round(k.confidence, 2)))
        renderer.close()
    e = np.array(errors) * 100
    print(f"views {n} objects {total} found {1 - missed / total:.3f} label+colour right {right / max(1, total - missed):.3f} of all {right/total:.3f}")
    print(f"error cm median {np.median(e):.2f} mean {e.mean():.2f} p95 {np.percentile(e, 95):.2f}; false {false}; ms {np.median(times) * 1e3:.0f} p95 {np.percentile(times, 95) * 1e3:.0f}")
    if args.v:
        for row in wrong:
            print(row)
    return 0


if __name__ == "__main__":
    main()
