"""The MuJoCo world of a scene: model, state, and the robots in it."""

from collections.abc import Sequence
from typing import Any

import mujoco
import numpy as np
from numpy.typing import NDArray

from common.geometry import Pose2
from common.scene import Obstacle, Scene, body_name
from common.time.lockstep import DT
from services.sim.body import Body
from services.sim.layout import Placement, place_objects
from services.sim.model import Robot, own
from services.sim.obstacles import Obstacles, body_xml
from services.sim.world import world_files, world_mjcf

FINE, COARSE = 5, 2
"""Steps of a tick. 2 ms is half the time constant of the pads' contacts, the longest that MuJoCo takes for them; while
the base drives or stands, touches nothing, and every object sleeps, 5 ms do: the loops of the linkage give way a little
more then, with nothing between the pads."""
NOSLIP = 3
"""Iterations of the pass that takes the creep out of friction, while a robot holds something [count]. Chosen: without
it what the hand holds, with ten times the force that its weight asks for, sinks by 0.5 mm/s and is lost on the way;
with one it still turns slowly. A dozen objects that tumble would cost four times as much with it."""
REST = 1e-5
"""Speed of all joints and objects together [m/s, rad/s] below which the world rests: a hundredth of a millimetre in a
second. Chosen: what the solver leaves when nothing moves is a tenth of it."""
CALM, GLANCE = 10, 10
"""Ticks of rest after which it is not worked out any more, and after how many it is looked at whether it still rests:
what changes the model from outside is felt within 0.1 s."""
SETTLE_TICKS = 50
"""Ticks [10 ms] in which objects come to rest before anything is published."""
HOST = "host"
"""What its guests call the robot whose simulation it is."""
_STATE = mujoco.mjtState.mjSTATE_INTEGRATION
Move = tuple[NDArray[np.float64], NDArray[np.float64]]
"""Set-points (10,) of base and arm at the begin and at the end of a tick."""


class Physics(Body):
    """A world with its robot; `advance` simulates 10 ms, at 500 Hz or, while nothing but bases move, at 200 Hz.

    `guests` are other robots with where they start; each is told of the world in a description (`mjcfs`) of its own,
    in which its own parts bear their own names. While nothing moves and nothing is told to, every tenth tick alone is
    worked out.
    """

    def __init__(
        self,
        scene: Scene,
        seed: int,
        obstacles: tuple[Obstacle, ...] = (),
        robot: Robot | None = None,
        guests: Sequence[tuple[str, Pose2]] = (),
    ) -> None:
        self.scene, self.seed = scene, seed
        robot = robot or own()
        self.placements: list[Placement] = place_objects(scene, seed)
        mocap, names = "".join(map(body_xml, obstacles)), [HOST, *(name for name, _ in guests)]
        self.mjcfs = [
            world_mjcf(scene, self.placements, mocap, robot, [*names[:n], "", *names[n + 1 :]])
            for n in range(len(names))
        ]
        self.mjcf = self.mjcfs[0]
        self.files = world_files(scene, self.placements)
        model: Any = mujoco.MjModel.from_xml_string(self.mjcf, self.files)
        model.opt.enableflags |= mujoco.mjtEnableBit.mjENBL_SLEEP
        data = mujoco.MjData(model)
        self.bodies = {p.spec.name: model.body(body_name(p.spec)).id for p in self.placements}
        super().__init__(model, model, data, robot, self.bodies)
        self.guests = [
            Body(mujoco.MjModel.from_xml_string(mjcf, self.files), model, data, robot, self.bodies)
            for mjcf in self.mjcfs[1:]
        ]
        self._starts = [(scene.home.x, scene.home.y, scene.home.theta), *(pose for _, pose in guests)]
        self.obstacles = Obstacles(obstacles, self.model, [w.footprint for w in scene.walls] + scene.footprints)
        # What the world rests under: set-points, how hard they are held, and where obstacles are.
        self._causes = data.ctrl, model.actuator_forcerange, data.mocap_pos
        self._rested_under: list[bytes] = []
        self._speeds, self._options = data.qvel, model.opt
        self._steps, self._calm = FINE, 0
        self.reset()

    @property
    def robots(self) -> list[Body]:
        """The bodies of all robots, this one's first."""
        return [self, *self.guests]

    def reset(self) -> None:
        """Set the world to its beginning: objects by the seed's layout, robots at their starts, everything at rest."""
        mujoco.mj_resetData(self.model, self.data)
        self._grips, self._options.noslip_iterations = False, 0
        self._steps, self._options.timestep, self._calm = FINE, DT / FINE, 0
        for robot, pose in zip(self.robots, self._starts, strict=True):
            robot.at_home(pose)
        for p in self.placements:
            at = self.model.joint(body_name(p.spec)).qposadr[0]
            self.data.qpos[at : at + 3] = p.position
            self.data.qpos[at + 3 : at + 7] = p.quat
        mujoco.mj_step(self.model, self.data, SETTLE_TICKS * FINE)
        for robot in self.robots:
            robot.fingers.hold()
            robot.contacts.forget()
        self._look_for_grips()
        self.obstacles.reset()

    def reseed(self, seed: int) -> None:
        """Lay the objects out anew in the same world."""
        self.seed, self.placements = seed, place_objects(self.scene, seed)
        self.reset()

    def advance(
        self, start: NDArray[np.float64], end: NDArray[np.float64], now: float = 0.0, guests: Sequence[Move] = ()
    ) -> None:
        """Simulate 10 ms from `now` [s] as the set-points (10,) of base and arm move from `start` to `end`, and those
        of the guests as told."""
        model, data = self.model, self.data
        moves = [(self, start, end - start), *((r, a, b - a) for r, (a, b) in zip(self.guests, guests, strict=True))]
        for robot, _, _ in moves:
            robot.fingers.advance()
        # The velocity that is fed forward changes evenly too, as a controller of 1 kHz has it: in a step of 10 ms the
        # servos would jerk, and the hand, where it touches something, knock on it with 40 N.
        aims = [(robot.ctrl, begin + (1.0 + robot.lead) * change) for robot, begin, change in moves]
        ways = [(ctrl, aim, aim - ctrl) for ctrl, aim in aims if (ctrl != aim).any()]
        rests = self._rests() and not ways
        steps = self._steps if rests else COARSE if self._alone(moves) else FINE
        if steps != self._steps:
            self._steps, self._options.timestep = steps, DT / steps
        for number in range(1, steps + 1):
            for ctrl, aim, way in ways:
                ctrl[:] = aim - way * ((steps - number) / steps)
            if not rests:
                mujoco.mj_step(model, data)
            if data.ncon:
                for robot, _, _ in moves:
                    robot.contacts.step(data, now + number * DT / steps)
            if not rests:
                self._take_out_creep()

    def _look_for_grips(self) -> None:
        """Have friction as the contacts of a state ask for that no step has led to."""
        for robot in self.robots:
            robot.contacts.look(self.data)
        self._take_out_creep()

    def _take_out_creep(self) -> None:
        """Have the next step's friction free of creep if a robot holds something."""
        grips = self.data.ncon > 0 and any(robot.contacts.grips for robot in self.robots)
        if grips != self._grips:
            self._grips, self._options.noslip_iterations = grips, NOSLIP if grips else 0

    def _rests(self) -> bool:
        """True when nothing has moved for CALM ticks, no input has changed, and no check, every GLANCE, is due."""
        under = [cause.tobytes() for cause in self._causes]  # compared as bytes: they are short
        same, self._rested_under = under == self._rested_under, under
        self._calm = self._calm + 1 if same and float(self._speeds @ self._speeds) < REST**2 else 0
        return self._calm > CALM and self._calm % GLANCE != 0

    def _alone(self, moves: Sequence[tuple[Body, NDArray[np.float64], NDArray[np.float64]]]) -> bool:
        """True while the robots touch nothing, nothing but they is awake, and arms and fingers rest."""
        data = self.data
        if data.ntree_awake > len(moves) or data.ncon:
            return False
        return all(robot.arm_rests(change) for robot, _, change in moves)

    def snapshot(self) -> NDArray[np.float64]:
        """MuJoCo's full integration state."""
        state = np.empty(mujoco.mj_stateSize(self.model, _STATE))
        mujoco.mj_getState(self.model, self.data, state, _STATE)
        return state

    def restore(self, state: NDArray[np.float64]) -> None:
        """Set the state to a snapshot of the same model."""
        mujoco.mj_setState(self.model, self.data, state, _STATE)
        self._calm = 0
        for robot in self.robots:
            robot.fingers.hold()
        mujoco.mj_forward(self.model, self.data)
        self._look_for_grips()
