"""Whether what is asked for is found, and nothing else: `python -m bench.perception.search --suite sizes -n 100`.

Each world of the suites `sizes`, `clutter` and `lying` is looked at from where the brain would have the robot stand,
one viewpoint after the other and nearer to what is in doubt, by perception's own detector, tracker and grounding.
Nothing drives and nothing is grasped: what counts is the answer, which is the wanted object, another one, or none.
Questions are answered by who knows the world, and counted.
"""

import argparse
import math
import sys
from collections import Counter

import numpy as np

from bench.perception.unlisted import SUITES
from bench.perception.views import add_options, take
from common.geometry import Pose2
from common.messages import WorldObject
from common.naming.likeness import LEAST, LIKELY
from common.rendering.renderer import Renderer
from common.viewpoints import viewpoints_of
from evaluation.case import Case
from services.brain.recoveries.look_closer import MOST
from services.brain.recoveries.search import VIEWPOINTS
from services.brain.steps.identify import MOST_ASKED
from services.brain.world import viewpoint_search
from services.brain.world.standing_poses import standing_pose
from services.camera.sensor import StereoCamera
from services.perception.config import PerceptionConfig
from services.perception.detect import ClassicalDetector
from services.perception.grounding import Grounding, as_called, ground, may_be_meant, parsed, possible
from services.perception.tracking.object_tracker import ObjectTracker
from services.perception.views.self_filter import RobotModel
from services.sim.layout import Placement, place_objects
from services.sim.model import own
from services.sim.world import world_mjcf

NEAR = 0.05
"""Distance [m] on the floor plan from the wanted object within which an answer means it."""


class Search:
    """One case: the robot's belief, and where it has looked from."""

    def __init__(self, case: Case, args: argparse.Namespace) -> None:
        assert case.scene is not None and case.household is not None
        self.case, self.household, self._args = case, case.household, args
        self.placements: list[Placement] = place_objects(case.scene, case.seed)
        self._renderer = Renderer(world_mjcf(case.scene, self.placements), args.backend)
        self._rng = np.random.default_rng(case.seed)
        self._camera = StereoCamera(case.seed)
        self._robot = RobotModel(own().mjcf)
        self._robot.pose(np.array(own().home), 0.085)
        config = PerceptionConfig()
        self._detector = ClassicalDetector(case.household, config.max_range)
        self._tracker = ObjectTracker(case.household, config.gone_after, config.min_confidence)
        self._t = 0.0
        home = case.scene.home
        self.pose: Pose2 = (home.x, home.y, home.theta)
        self.looked_from: list[Pose2] = []
        self.inspected: set[str] = set()
        self.rejected: set[str] = set()
        self.questions = 0

    @property
    def wanted(self) -> Placement:
        return next(p for p in self.placements if p.spec.name == self.case.thing)

    def look(self) -> tuple[Grounding, list[str]]:
        """Two pictures from here, and what the words mean then; and labels of what is in doubt."""
        result = Grounding(None)
        for _ in range(2):
            self._t += 1.0
            view = take(self._renderer, self.pose, self._args, self._rng, self._camera)
            seen = self._tracker.update(view, self._detector.detect(view, self._robot.mask(view, self.pose)), self._t)
            doubtful = self._tracker.doubtful()
            objects = [as_called(o) if o.id in doubtful else o for o in self._tracker.objects()]
            objects = [o for o in objects if o.id not in self.rejected]
            result = ground(self.case.thing, objects, self.household, self.pose, {})
            if (result.found is not None and result.found.id in seen) or result.candidates:
                break
        unsure = may_be_meant(self.case.thing, self._tracker.objects(), doubtful, self.household, self.pose)
        return result, [label for label in unsure if label not in self.inspected]

    def known(self, label: str) -> WorldObject | None:
        return next((o for o in self._tracker.objects() if o.label == label), None)

    def objects(self) -> list[WorldObject]:
        return self._tracker.objects()

    def ask(self, least: float) -> Grounding | None:
        """Ask about what may be meant; the answer is the truth. None when nothing was the wanted one."""
        objects = {o.id: o for o in self.objects() if o.id not in self.rejected}
        phrase = parsed(self.case.thing, self.household, {})
        for maybe in possible(phrase, list(objects.values()), self.household):
            if maybe.likeness < least or len(self.rejected) >= MOST_ASKED:
                break
            self.questions += 1
            if self._is(objects[maybe.id], self.wanted):
                return Grounding(objects[maybe.id])
            self.rejected.add(maybe.id)
        return None

    def around(self) -> Grounding:
        """Look here, nearer to what is in doubt, and from the next viewpoint, until there is an answer."""
        result = self._search()
        return result if result.found is not None else self.ask(LEAST) or result

    def _search(self) -> Grounding:
        viewpoints = viewpoints_of(self.household, None)
        result = self._closer()
        for attempt, count in enumerate(VIEWPOINTS):
            for _ in range(count):
                if result.found is not None:
                    return result
                self.looked_from.append(self.pose)
                if attempt:
                    target = viewpoint_search.elsewhere(self.household, viewpoints, self.pose, self.looked_from)
                else:
                    target = viewpoint_search.turn(viewpoints, self.pose, self.looked_from)
                if target is None:
                    break
                self.looked_from.append(target)
                self.pose = target
                result = self._closer()
        return result

    def _closer(self) -> Grounding:
        result, unsure = self.look()
        for _ in range(MOST):
            if result.found is not None or result.candidates or not unsure:
                break
            self.inspected.add(unsure[0])
            target = self.known(unsure[0])
            if target is None:
                break
            self.pose = standing_pose(self.household, (target.position[0], target.position[1]), self.pose)
            result, unsure = self.look()
        return result if result.found is not None else self.ask(LIKELY) or result

    def outcome(self, result: Grounding) -> str:
        if result.found is None:
            return "none"
        return "right" if self._is(result.found, self.wanted) else "wrong"

    def _is(self, o: WorldObject, p: Placement) -> bool:
        return math.dist(o.position[:2], p.position[:2]) < NEAR

    def story(self, result: Grounding) -> str:
        """What was wanted, what was answered, and what is believed of the wanted one."""
        there = [o for o in self.objects() if self._is(o, self.wanted)]
        told = "; ".join(_told(o) for o in there) or "nothing there"
        size = " x ".join(f"{v * 1000:.0f}" for v in self.wanted.spec.size)
        answer = _told(result.found) if result.found else result.reason
        return f"{self.case.thing} ({size} mm on {self.wanted.on}) is believed: {told} | answer: {answer}"

    def close(self) -> None:
        self._renderer.close()


def _told(o: WorldObject) -> str:
    size = " x ".join(f"{v * 1000:.0f}" for v in o.size)
    return f"{o.label} ({size} mm; {'/'.join(o.kinds)}; {'/'.join(o.colours)}; {o.confidence:.2f})"


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--suite", choices=SUITES, default="sizes")
    parser.add_argument("-n", "--worlds", type=int, default=50)
    add_options(parser, pose_noise=0.006)
    args = parser.parse_args()
    counts: Counter[str] = Counter()
    questions = 0
    for seed in range(args.seed, args.seed + args.worlds):
        search = Search(SUITES[args.suite](seed), args)
        result = search.around()
        outcome = search.outcome(result)
        counts[outcome] += 1
        questions += search.questions
        if outcome != "right":
            print(f"{seed} {outcome}: {search.story(result)}", flush=True)
        search.close()
    print(f"{args.worlds} worlds of {args.suite}:", ", ".join(f"{n} {name}" for name, n in counts.most_common()))
    print(f"questions whether something is the one: {questions / max(1, args.worlds):.2f} a world")
    return 0


if __name__ == "__main__":
    sys.exit(main())
