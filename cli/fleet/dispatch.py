"""Dispatch of a command to exactly one robot: offers, withdraws, follows it, and hands it over if a robot is lost."""

import math
import uuid
from collections.abc import Callable, Collection

import numpy as np
from numpy.typing import NDArray
from scipy.sparse.csgraph import dijkstra

from cli.fleet.choice import Candidate, goals, rank
from cli.fleet.robots import Desk, RobotNow
from common import messages as m
from common import topics
from common.approach import ROOM
from common.cells import unpacked
from common.grid_graph import graph_of
from common.mission_log.states import under_way
from common.time.clock import monotonic, sleep

REACH = 0.9
"""How near the base's centre has to come to a thing [m]; chosen: the arm's reach."""
START = 0.4
"""How far from the robot its way may begin [m]; chosen: beside a table it stands in cells that count as too narrow."""
NEIGHBOURS = 1
"""Rows and columns of the longest step of a way [cells]: 8 directions."""
TAKEN = 8.0
"""How long an offer stands [s]; chosen: a robot that reports on its last mission takes one up within three."""
LOST = 6.0
"""Silence from which a robot counts as lost [s]; chosen: three leases of its connection."""
MAPS = 2.5
"""How long maps are waited for [s]; they come once a second."""
POLL = 0.2
"""Time between two looks at the robot that has the command [s]; chosen."""
DETOUR = 1.3
"""How much longer a way is than the straight line, where a robot tells no map; chosen: a flat with doors."""
Tell = Callable[[str], None]


def metres(desk: Desk, robots: list[RobotNow], text: str) -> dict[str, float | None]:
    """The way [m] of each robot that could go to the nearest thing of the command: see `rank`."""
    wanted = goals(text, robots)
    anywhere = [at for known in wanted.values() for at in known.values()]
    going = {r.name: r.pose for r in robots if r.free and r.pose is not None} if anywhere else {}
    maps: dict[str, m.Costmap] = {}
    kept = [desk.listen(n, topics.COSTMAP, lambda one, n=n: maps.update({n: one})) for n in going]
    end = monotonic() + MAPS
    while going.keys() - maps.keys() and monotonic() < end:
        sleep(0.05)
    for subscriber in kept:
        subscriber.undeclare()
    found: dict[str, float | None] = {}
    for name, (x, y, _) in going.items():
        ways = [way(maps.get(name), (x, y), at) for at in wanted[name].values() or anywhere]
        found[name] = min((w for w in ways if w is not None), default=None)
    return found


def way(costmap: m.Costmap | None, start: tuple[float, float], end: tuple[float, float]) -> float | None:
    """Length of the way [m]: by path where there is a map, else guessed from the straight line."""
    if costmap is None:
        return DETOUR * math.dist(start, end)
    return path_length(costmap, start, end)


class Dispatch:
    """A command on its way. `by`: the robot that has it, None while none has.

    `lost`: robots that had it, fell silent, and have not heard yet that another one has taken it over.
    """

    def __init__(self, desk: Desk, text: str, among: Collection[str] = (), tell: Tell = lambda line: None) -> None:
        self._desk, self.text, self._among, self._tell = desk, text, set(among), tell
        self.id = f"fleet-{uuid.uuid4().hex[:12]}"
        self.by: str | None = None
        self.candidates: list[Candidate] = []
        self.outcome: m.MissionOutcome | None = None
        self.lost: list[str] = []
        self._mission = ""
        self._heard = 0.0
        self._silent = False

    # --- giving it to somebody
    def offer(self) -> bool:
        """Offer the command to one robot after the other, the best first, until one has taken it."""
        present = self._desk.names()
        robots = self._desk.look((self._among & present if self._among else present) - set(self.lost))
        self.candidates = rank(robots, goals(self.text, robots), metres(self._desk, robots, self.text))
        for one in self.candidates:
            if one.able and self._taken_by(one.name):
                self.by, self._heard, self._silent = one.name, monotonic(), False
                return True
        return False

    def _taken_by(self, name: str) -> bool:
        desk = self._desk
        command = m.VoiceCommand(text=self.text, id=self.id, confirmed=True, unless_busy=True)
        desk.send(name, topics.VOICE_COMMAND, command)
        end = monotonic() + TAKEN
        while monotonic() < end:
            state = desk.state(name)
            if state is not None and self._ours(state):
                return True
            if state is not None and under_way(state):
                break  # it has begun something else meanwhile
            sleep(POLL)
        self.withdraw(name)
        self._tell(f"{name} did not take it; withdrawn there")
        return False

    def _ours(self, state: m.BrainState) -> bool:
        if state.command_id == self.id and under_way(state):
            self._mission = state.mission_id
            return True
        last = state.last
        # After a restart the brain knows its last mission by its own name alone.
        if last is not None and (last.command_id == self.id or (self._mission and last.id == self._mission)):
            self._mission, self.outcome = last.id, last
            return True
        return False

    def withdraw(self, name: str) -> None:
        """Withdraw the command from a robot, whether it has begun or hears of it later."""
        self._desk.send(name, topics.VOICE_COMMAND, m.VoiceCommand(text="", withdraws=self.id))

    # --- following it
    def follow(self, hand_over: bool) -> bool:
        """Check on the command; True once it has ended.

        A robot that has fallen silent is reported. With `hand_over` another one gets the command; the lost one is told
        when it is back, before it goes on by itself.
        """
        self._recall()
        if self.by is None:
            return not self.offer() and not hand_over
        state = self._desk.state(self.by)
        if state is not None:
            if self._silent:
                self._tell(f"{self.by} is back")
            self._heard, self._silent, self.outcome = monotonic(), False, None
            if not self._ours(state) and not state.mission_id and state.state != "IDLE":
                self._tell(f"{self.by} knows nothing of it any more")
                self.by = None
                return not hand_over
            return self.outcome is not None
        if monotonic() - self._heard > LOST and not self._silent:
            self._silent = True
            self._report_lost(self.by, hand_over)
        return False

    def _report_lost(self, name: str, hand_over: bool) -> None:
        self._tell(f"{name} is lost: no word for {LOST:.0f} s in the middle of {self.text!r}")
        if hand_over:
            self.lost.append(name)
            self.by, self._mission = None, ""
            if self.offer():
                self._tell(f"{self.by} has taken it over: {self.candidates[0].why}")
            else:
                self._tell("nobody else can take it now")
            return
        robots = self._desk.look(self._desk.names() - {name})
        able = [c.name for c in rank(robots, {}, {}) if c.able]
        if able:
            self._tell(f"{', '.join(able)} could take it: --hand-over gives it to the best of them")

    def _recall(self) -> None:
        """Lost robots that are back do not go on with what another one does."""
        if not self.lost:
            return
        present = self._desk.names()
        for name in [n for n in self.lost if n in present]:
            state = self._desk.state(name)
            if state is None:
                continue
            self.withdraw(name)
            if state.command_id != self.id:
                self.lost.remove(name)
                self._tell(f"{name} is back, and leaves it to {self.by or 'the others'}")


# --- how far a robot has to drive, on the map that it drives by. Pure
def free_cells(costmap: m.Costmap) -> NDArray[np.bool_]:
    """Cells (height, width) where the base's centre may be.

    Raises:
        ValueError: the map is not as large as it says.
    """
    return (unpacked(costmap) * (costmap.far / 255.0) >= ROOM).astype(np.bool_)


def path_length(costmap: m.Costmap, start: tuple[float, float], end: tuple[float, float]) -> float | None:
    """Length [m] of the shortest way from `start` to where the arm reaches `end` (x, y) [map]; None where none leads.

    Raises:
        ValueError: as `free_cells`.
    """
    free = free_cells(costmap)
    rows, columns = np.nonzero(free)
    x = costmap.x + (columns + 0.5) * costmap.resolution
    y = costmap.y + (rows + 0.5) * costmap.resolution
    from_start, to_end = np.hypot(x - start[0], y - start[1]), np.hypot(x - end[0], y - end[1])
    near = to_end <= REACH
    if not len(from_start) or from_start.min() > START or not near.any():
        return None
    cells = rows * costmap.width + columns
    first = int(from_start.argmin())
    ways = dijkstra(graph_of(free, costmap.resolution, NEIGHBOURS), directed=False, indices=cells[first])
    shortest = float(ways[cells[near]].min())
    return shortest + float(from_start[first]) if math.isfinite(shortest) else None
