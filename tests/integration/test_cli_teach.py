"""`tidybot teach` and `forget` against a peer that answers for perception."""

import json
import subprocess
import sys
import threading
from collections.abc import Iterator
from pathlib import Path

import pytest
import zenoh

from common import messages as m
from common import topics
from common.bus import codec, delivery
from common.topic import Topic
from evaluation.site import Site, site
from tests.support import ROOT

BOX = m.WorldObject(label="white box", kind="box", colour="white", position=(1.0, 0.0, 1.0))
ANSWERS = {
    "vitamin box": m.TeachResult(goal_id="", ok=True, name="vitamin box", label="white box"),
    "tea": m.TeachResult(
        goal_id="", ok=False, name="tea", code="AMBIGUOUS", detail="it could be the box or the can",
        candidates=["box", "can"],
    ),
}  # fmt: skip


class Perception:
    """Answers each request, after an answer to somebody else's; keeps what it was asked."""

    def __init__(self, session: zenoh.Session) -> None:
        self._session, self.asked = session, list[m.TeachRequest]()
        self._known = [
            self._serve(topics.HOUSEHOLD_NAMES, m.TaughtNames(names=[m.TaughtName(name="pills", kind="box")])),
            self._serve(topics.WORLD_OBJECTS, m.WorldObjects(t=0.0, objects=[BOX])),
            session.declare_subscriber(topics.TEACH.key, self._take),
        ]  # fmt: skip

    def _serve(self, topic: Topic, message: m.Message) -> object:  # type: ignore[type-arg]
        payload = codec.encode(topic, message)
        return self._session.declare_queryable(topic.key, lambda q: q.reply(q.key_expr, payload))

    def _take(self, sample: zenoh.Sample) -> None:
        request = codec.decode(topics.TEACH, sample.payload.to_bytes())
        self.asked.append(request)
        result = ANSWERS.get(request.name, m.TeachResult(goal_id="", ok=True, name=request.name))
        for goal_id in ("somebody else's", request.id):
            answer = codec.decode(topics.TAUGHT, codec.encode(topics.TAUGHT, result))
            answer.goal_id = goal_id
            # Not in the callback's thread, which has to return first.
            threading.Thread(target=delivery.send, args=(self._session, topics.TAUGHT, answer)).start()


@pytest.fixture(scope="module")
def robot(tmp_path_factory: pytest.TempPathFactory) -> Iterator[tuple[Site, Perception]]:
    with site(tmp_path_factory.mktemp("teach")) as opened, opened.session() as session:
        yield opened, Perception(session)


def tidybot(opened: Site, *words: str) -> "subprocess.CompletedProcess[str]":
    return subprocess.run(
        [sys.executable, "-m", "cli.main", *words],
        env=opened.environment(), cwd=ROOT, capture_output=True, text=True, timeout=60, check=False,
    )  # fmt: skip


def test_a_name_is_taught_by_label(robot: tuple[Site, Perception]) -> None:
    done = tidybot(robot[0], "teach", "vitamin", "box", "--label", "white box")
    assert (done.returncode, done.stdout) == (0, "the white box is the vitamin box\n"), done.stderr
    request = robot[1].asked[-1]
    assert (request.name, request.label, request.forget) == ("vitamin box", "white box", False)


def test_a_refusal_says_why_and_what_to_do(robot: tuple[Site, Perception]) -> None:
    done = tidybot(robot[0], "teach", "tea")
    assert done.returncode == 1 and "it could be the box or the can; say which with --label" in done.stdout


def test_an_unknown_label_is_refused_with_those_that_there_are(robot: tuple[Site, Perception]) -> None:
    before = len(robot[1].asked)
    done = tidybot(robot[0], "teach", "tea", "--label", "green can")
    assert done.returncode == 1 and "white box" in done.stderr and len(robot[1].asked) == before


def test_names_are_listed_and_forgotten(robot: tuple[Site, Perception], tmp_path: Path) -> None:
    assert [n["name"] for n in json.loads(tidybot(robot[0], "teach", "--json").stdout)] == ["pills"]
    assert tidybot(robot[0], "forget", "pills").stdout == "forgotten: pills\n" and robot[1].asked[-1].forget
