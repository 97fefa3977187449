"""docs/DEPLOY.md, "How many": the robot's router thins what crosses the link, and nothing that stays on the robot."""

import json
import re
import time
from contextlib import ExitStack
from pathlib import Path

import zenoh
from zenoh import handlers

from common.bus.session import CONFIGS
from tests.support import ROOT, eventually, free_port

SECONDS = 2.0
"""Time of the stream [s], at some 100 Hz."""


def opened(stack: ExitStack, config: zenoh.Config) -> zenoh.Session:
    return stack.enter_context(zenoh.open(config))


def router(stack: ExitStack, listen: list[str], connect: list[str], more: str = "") -> None:
    text = (CONFIGS / "router.json5").read_text().rstrip().removesuffix("}")
    own = f"listen: {{ endpoints: {json.dumps(listen)} }}, connect: {{ endpoints: {json.dumps(connect)} }},"
    opened(stack, zenoh.Config.from_json5(f"{text} {own} {more} }}"))


def client(stack: ExitStack, endpoint: str) -> zenoh.Session:
    config = zenoh.Config.from_file(str(CONFIGS / "client.json5"))
    config.insert_json5("connect/endpoints", json.dumps([endpoint]))
    return opened(stack, config)


def test_the_link_is_thinned_and_the_robot_itself_is_not(tmp_path: Path) -> None:
    page = (ROOT / "docs" / "DEPLOY.md").read_text()
    (thinning,) = re.findall(r"```json5\n(downsampling: .*?)```", page, re.DOTALL)
    region, socket = f"tcp/127.0.0.1:{free_port()}", f"unixsock-stream/{tmp_path}/r.sock"
    counts = {"region joint_states": 0, "region brain/state": 0, "robot joint_states": 0, "robot brain/state": 0}
    with ExitStack() as stack:
        router(stack, [region], [])
        router(stack, [socket], [region], thinning)
        speaker, inside, outside = client(stack, socket), client(stack, socket), client(stack, region)

        def count(who: str, session: zenoh.Session, key: str) -> None:
            def note(sample: zenoh.Sample) -> None:
                counts[f"{who} {key}"] += 1

            session.declare_subscriber(f"*/{key}", handlers.Callback(note, indirect=False))

        for key in ("joint_states", "brain/state"):
            count("robot", inside, key)
            count("region", outside, key)

        def all_listen() -> bool:
            for key in ("joint_states", "brain/state"):
                speaker.put(f"bot/{key}", b"x")
            return all(counts.values())

        eventually(all_listen, "everybody listens")
        counts |= dict.fromkeys(counts, 0)
        sent, end = 0, time.monotonic() + SECONDS
        while time.monotonic() < end:
            sent += 1
            for key in ("joint_states", "brain/state"):
                speaker.put(f"bot/{key}", b"x")
            time.sleep(0.01)
        eventually(lambda: counts["region brain/state"] >= sent, "all of it has arrived")
        eventually(lambda: counts["robot joint_states"] >= sent, "all of it has arrived")
    assert 0 < counts["region joint_states"] < sent / 2
    assert counts["robot joint_states"] >= sent
