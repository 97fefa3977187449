"""Writes how the mission stands to the journal, whenever that has changed."""

import msgspec
from py_trees.behaviour import Behaviour

from common import topics
from common.bus.port import Io
from common.time.clock import unix_time
from services.brain.journal.records import Checkpoint, Journal, PathNode
from services.brain.mission.mission import GripperState, Mission
from services.brain.mission.peers import Peers
from services.brain.tree.path import path_to

SAVE_AGAIN = 1.0
"""s of robot time before what the disk has refused is tried again (chosen: rarely enough to cost nothing)."""


class Checkpoints:
    """`at`: the node at work; `resumes`: times the mission was resumed since it last advanced."""

    def __init__(self, journal: Journal, io: Io, peers: Peers, run: str) -> None:
        self._journal, self._io, self._peers, self._run = journal, io, peers, run
        self.at: Behaviour | None = None
        self.resumes = 0
        self._path: list[PathNode] = []
        self._saved = self._refused = b""
        self._again_at = 0.0

    def save(
        self, mission: Mission, gripper: GripperState, suspended: Checkpoint | None, now: float, closed: bool = False
    ) -> None:
        """Put the mission on disk if it has changed; `now` is robot time [s], `closed`: the process ends in order."""
        state = self._standing(mission, gripper, suspended, closed)
        body = msgspec.json.encode(state)
        if body == self._saved or (body == self._refused and now < self._again_at and not closed):
            return
        self._stamp(state, now)
        if self._journal.save(state):
            self._saved = body
        else:
            self._refused, self._again_at = body, now + SAVE_AGAIN

    def frozen(self, mission: Mission, gripper: GripperState, suspended: Checkpoint | None, now: float) -> Checkpoint:
        """A copy of how the mission stands that nothing changes any more."""
        state = self._standing(mission, gripper, suspended, False)
        self._stamp(state, now)
        state.date = unix_time()
        return msgspec.json.decode(msgspec.json.encode(state), type=Checkpoint)

    def resumed_at(self, node: Behaviour, resumes: int) -> None:
        """The mission goes on at this node, resumed that many times without having advanced."""
        self.at, self._path, self.resumes = node, path_to(node), resumes

    def _standing(
        self, mission: Mission, gripper: GripperState, suspended: Checkpoint | None, closed: bool
    ) -> Checkpoint:
        path = path_to(self.at) if self.at is not None else []
        if path != self._path:
            self._path, self.resumes = path, 0
        return Checkpoint(
            mission=mission,
            gripper=msgspec.structs.replace(gripper, empty_since=None),
            path=path,
            sent=[sent for channel in self._peers.all if (sent := channel.outstanding_goal())],
            run=self._run,
            closed=closed,
            resumes=self.resumes,
            suspended=suspended,
        )

    def _stamp(self, state: Checkpoint, now: float) -> None:
        """When and where: alone they are no change worth writing."""
        pose = self._io.latest(topics.POSE)
        state.t, state.base = now, (pose.x, pose.y, pose.theta) if pose else None
