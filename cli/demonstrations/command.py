"""`tidybot record --lerobot DIR`: follows the robot and writes each mission as an episode when it has ended."""

import argparse
import queue
import sys
from typing import Any

from cli.demonstrations.dataset import Dataset
from cli.demonstrations.sampler import Episode, Sampler
from cli.errors import CliError
from cli.link import Link, fresh_id
from common import messages as m
from common import topics
from common.bus import codec, delivery
from common.demonstration import PICTURE_SIZE, PictureTurns
from common.process.host import StopSignal
from common.time.clock import monotonic
from common.topic import Topic

RENEW = 2.0
"""Time [s] after which a picture that did not come is asked for again."""
FOLLOWED: tuple[Topic[Any], ...] = (
    topics.JOINT_STATES, topics.ODOMETRY, topics.ARM_COMMAND, topics.GRIPPER_COMMAND, topics.BRAIN_STATE,
    topics.HEAD_RGBD, topics.WRIST_RGBD,
)  # fmt: skip


def demonstrate(args: argparse.Namespace, link: Link, stop: StopSignal) -> int:
    """Record until Ctrl-C or `--duration`; an episode whose mission has not ended by then is left out.

    Raises:
        CliError: the folder cannot be used, or the disk does not take it.
    """
    dataset = Dataset(args.lerobot, args.fps, dict.fromkeys(args.cameras, PICTURE_SIZE))
    inbox: queue.SimpleQueue[tuple[Topic[Any], bytes]] = queue.SimpleQueue()
    kept = [delivery.subscribe(link.session, topic, _into(inbox, topic)) for topic in FOLLOWED]
    sampler, pictures = Sampler(args.fps, args.cameras), PictureTurns(args.cameras, RENEW)
    _say(f"demonstrations from {link.connect} into {args.lerobot}; Ctrl-C ends it")
    end = monotonic() + args.duration if args.duration else float("inf")
    while not stop.is_set() and monotonic() < end:
        _drain(inbox, sampler, pictures, stop)
        if sampler.recording and (request := pictures.request(monotonic(), fresh_id)) is not None:
            link.send(topics.CAMERA_REQUEST, request)
        for episode in sampler.ended():
            _keep(dataset, episode, args.all)
    for subscriber in kept:
        subscriber.undeclare()
    _say(f"{dataset.episodes} episodes, {dataset.frames} frames in {args.lerobot}")
    return 0


def _into(inbox: "queue.SimpleQueue[tuple[Topic[Any], bytes]]", topic: Topic[Any]) -> Any:
    return lambda sample: inbox.put((topic, sample.payload.to_bytes()))


def _drain(
    inbox: "queue.SimpleQueue[tuple[Topic[Any], bytes]]", sampler: Sampler, pictures: PictureTurns, stop: StopSignal
) -> None:
    """Take what has come; wait a moment when nothing has."""
    if inbox.empty():
        stop.wait(0.01)
    while not inbox.empty():
        topic, payload = inbox.get()
        try:
            message = codec.decode(topic, payload)
        except codec.DecodeError:
            continue
        if isinstance(message, m.Rgbd):
            pictures.came(message)
            if (message.width, message.height) != PICTURE_SIZE:
                continue
        sampler.take(message)


def _keep(dataset: Dataset, episode: Episode, every: bool) -> None:
    if episode.outcome != "delivered" and not every:
        _say(f"left out, {episode.outcome}: {episode.task!r} (--all keeps such missions, too)")
        return
    if not episode.frames:
        _say(f"left out, no pictures came: {episode.task!r}; see `tidybot ps` for the camera")
        return
    try:
        dataset.add(episode)
    except OSError as error:
        raise CliError(f"{dataset.root}: {error}; the episodes written before are kept") from None
    _say(
        f"episode {dataset.episodes - 1}, {episode.outcome}: {episode.task!r}, {len(episode.frames)} frames, "
        f"pictures at most {episode.late:.2f} s off"
    )


def _say(text: str) -> None:
    print(text, file=sys.stderr, flush=True)
