"""`tidybot fleet radio`: the robot's router thins what crosses the link, and nothing that stays on the robot."""

import json
import time
from contextlib import ExitStack
from pathlib import Path

import pytest
import zenoh
from zenoh import handlers

from cli.errors import CliError
from cli.fleet.radio import router_config, thinning
from cli.processes.ports import free_port
from common import topics
from common.bus.session import CONFIGS
from evaluation.site import eventually

SECONDS = 2.0
"""Time of the stream [s], at some 100 Hz."""


def opened(stack: ExitStack, config: zenoh.Config) -> zenoh.Session:
    return stack.enter_context(zenoh.open(config))


def listening(config: zenoh.Config, endpoint: str) -> zenoh.Config:
    config.insert_json5("listen/endpoints", json.dumps([endpoint]))
    return config


def client(stack: ExitStack, endpoint: str) -> zenoh.Session:
    config = zenoh.Config.from_file(str(CONFIGS / "client.json5"))
    config.insert_json5("connect/endpoints", json.dumps([endpoint]))
    return opened(stack, config)


def test_the_link_is_thinned_and_the_robot_itself_is_not(tmp_path: Path) -> None:
    region, socket = f"tcp/127.0.0.1:{free_port()}", f"unixsock-stream/{tmp_path}/r.sock"
    counts = {"region joint_states": 0, "region brain/state": 0, "robot joint_states": 0, "robot brain/state": 0}
    with ExitStack() as stack:
        opened(stack, listening(zenoh.Config.from_file(str(CONFIGS / "router.json5")), region))
        (tmp_path / "radio.json5").write_text(router_config([region]))
        opened(stack, listening(zenoh.Config.from_file(str(tmp_path / "radio.json5")), socket))
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


def test_streams_are_thinned_and_what_must_not_be_lost_is_not() -> None:
    (item,) = thinning(2.0)
    rates = {rule["key_expr"].removeprefix("**/"): rule["freq"] for rule in item["rules"]}
    assert set(rates) == {t.key for t in topics.TABLE if t.keep == "latest" or t in topics.CLOCKS}
    assert rates[topics.SCAN.key] == 2.0 and rates[topics.COSTMAP.key] == 1.0, "never more than there is"
    assert not {topics.VOICE_COMMAND.key, topics.ROBOT_STOP.key, topics.BRAIN_STATE.key} & set(rates)
    assert item["flows"] == ["egress"] and "unixsock-stream" not in item["link_protocols"]
    for hz in (0.0, -1.0, float("nan")):
        with pytest.raises(CliError):
            router_config([], hz)
