"""`tidybot record` beside real processes: the file is whole after Ctrl-C, readable after kill -9, and replays."""

import json
import signal
import subprocess
import sys
import time
from pathlib import Path
from typing import Any

import pytest

from common import messages as m
from common import topics
from common.bus import codec, delivery
from common.recording import Recording
from evaluation.site import Site, eventually
from tests.support import ROOT

PATIENCE = 150.0


def tidybot(here: Site, *words: str) -> "subprocess.Popen[str]":
    return subprocess.Popen(
        [sys.executable, "-m", "cli.main", *words],
        env=here.environment(TIDYBOT_RUN_DIR=str(here.log_dir / "run")),
        cwd=ROOT, text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
    )  # fmt: skip


def drive(here: Site, session: Any) -> None:
    """Send the robot somewhere and wait until it is there."""
    delivery.send(session, topics.NAV_GOAL, m.NavGoal(id="m.1", x=-0.4, y=0.3, theta=0.5))

    def arrived() -> bool:
        answers = delivery.fetch(session, topics.NAVIGATION_FEEDBACK.key).values()
        feedback = [codec.decode(topics.NAVIGATION_FEEDBACK, a) for a in answers]
        return any(f.goal_id == "m.1" and f.status == "arrived" for f in feedback)

    eventually(arrived, "the base has arrived", PATIENCE)


def navigation_seen(file: Path) -> bool:
    return any(row.key == topics.ALIVE_KEY.format(name="navigation") for row in Recording(file).rows)


@pytest.mark.timeout(600)
def test_a_recorded_run_is_whole_and_replays_to_the_same_outputs(here: Site) -> None:
    file, killed = here.log_dir / "run.mcap", here.log_dir / "killed.mcap"
    lockstep = {
        "TIDYBOT__RUNTIME__SCENE": "minimal", "TIDYBOT__RUNTIME__LOCKSTEP": "true", "TIDYBOT__SIM__SPEED": "max",
        "TIDYBOT__SIM__WAIT_FOR": '["navigation"]',
    }  # fmt: skip
    recorders = [tidybot(here, "record", "-o", str(path), "--wait", "60") for path in (file, killed)]
    with here.session() as session:
        eventually(lambda: file.exists() and killed.exists(), "both recorders have begun", PATIENCE)
        time.sleep(2.0)  # they subscribe: before the first tick nothing may be missed
        for name in ("sim", "navigation"):
            here.start(f"services.{name}", **lockstep)
        here.wait_alive(session, "sim", "navigation")
        # The goals of a service are recorded once its token is seen.
        eventually(lambda: all(navigation_seen(path) for path in (file, killed)), "both recorders listen", PATIENCE)
        drive(here, session)
        eventually(lambda: len(Recording(killed).rows) > 100, "the one to be killed has written", PATIENCE)
        recorders[1].kill()
        recorders[0].send_signal(signal.SIGINT)
        said = recorders[0].communicate(timeout=PATIENCE)[0]
        recorders[1].communicate()
    assert recorders[0].returncode == 0, said
    whole, torn = Recording(file), Recording(killed)
    assert not whole.torn and whole.facts["run"]["lockstep"] == "true" and "config/navigation.toml" in whole.files
    assert torn.torn and len(torn.rows) > 100
    ticks = [row.tick for row in whole.of("joint_states") if row.tick is not None]
    assert ticks == list(range(ticks[0], ticks[-1] + 1)), "in lockstep no message is lost"
    goals = [json.loads(row.payload)["id"] for row in whole.of("nav_goal")]
    assert goals == ["m.1"]
    settings = ("--set", "runtime.scene=minimal", "--set", "sim.speed=max")
    for service, output in (("navigation", "base/target_pose"), ("sim", "joint_states")):
        replayed = tidybot(here, "replay", str(file), "--service", service, *settings)
        shown = replayed.communicate(timeout=PATIENCE)[0]
        assert replayed.returncode == 0, shown
        assert "differing" not in shown and output in shown and "times within 0 s" in shown
    assert "torn" in tidybot(here, "replay", str(killed), "--info").communicate(timeout=PATIENCE)[0]


@pytest.mark.timeout(300)
def test_without_a_robot_it_says_so(tmp_path: Path) -> None:
    here = Site(tmp_path)
    alone = tidybot(here, "record", "-o", str(tmp_path / "none.mcap"), "--wait", "1")
    said = alone.communicate(timeout=PATIENCE)[0]
    assert alone.returncode == 1 and "start the robot with `tidybot up`" in said and "Traceback" not in said
    assert not (tmp_path / "none.mcap").exists()
