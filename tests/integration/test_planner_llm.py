"""The language model planner against a chat endpoint on this machine that answers well, badly, late or not at all."""

import importlib
import json
import threading
from collections.abc import Callable, Iterator
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from typing import Any

import msgspec
import pytest

from cli import doctor
from cli.processes.ports import free_port
from common import messages as m
from common import topics
from common.household import load_household
from common.runtime import StartError
from evaluation.site import Site, eventually
from services.planner.config import PlannerConfig
from services.planner.language_model import diagnosis
from services.planner.language_model.endpoint import EVERY, REST, installed, look
from services.planner.service import GRACE, PlannerService
from tests.node import Node

SCENE = load_household("apartment")
MUG = [
    {"action": "find", "object": "red mug", "target": "", "text": ""},
    {"action": "grasp", "object": "red mug", "target": "", "text": ""},
    {"action": "place", "object": "", "target": "desk", "text": ""},
]
GRAMMAR = ["find", "grasp", "return", "release"]
Answer = Callable[[BaseHTTPRequestHandler], None]


def says(content: str) -> Answer:
    """A chat completion with these words."""

    def answer(handler: BaseHTTPRequestHandler) -> None:
        message = {"role": "assistant", "content": content}
        choice = {"index": 0, "finish_reason": "stop", "message": message}
        send(handler, {"id": "c", "object": "chat.completion", "created": 0, "model": "local", "choices": [choice]})

    return answer


def plans(*steps: dict[str, str], detail: str = "") -> Answer:
    return says(json.dumps({"steps": steps, "detail": detail}))


def send(handler: BaseHTTPRequestHandler, body: Any, status: int = 200) -> None:
    data = body if isinstance(body, bytes) else json.dumps(body).encode()
    handler.send_response(status)
    handler.send_header("Content-Type", "application/json")
    handler.send_header("Content-Length", str(len(data)))
    handler.end_headers()
    handler.wfile.write(data)


class Endpoint:
    """Answers the n-th request with the n-th of `answers`, the last one ever after; remembers the requests.

    `models` is what it lists; None: it is not ready. `looks` counts who asked for the list.
    """

    def __init__(self) -> None:
        self.answers: list[Answer] = []
        self.requests: list[dict[str, Any]] = []
        self.models: list[str] | None = ["local"]
        self.looks = 0
        self.page: bytes | None = None
        self.over = threading.Event()
        self.nodes: list[Desk] = []
        endpoint = self

        class Handler(BaseHTTPRequestHandler):
            def do_GET(self) -> None:
                endpoint.looks += 1
                if endpoint.page is not None:
                    send(self, endpoint.page)
                elif endpoint.models is None:
                    send(self, {"error": "loading the model"}, 503)
                else:
                    send(self, {"object": "list", "data": [{"id": name} for name in endpoint.models]})

            def do_POST(self) -> None:
                body = json.loads(self.rfile.read(int(self.headers["Content-Length"])))
                endpoint.requests.append({"path": self.path, "key": self.headers["Authorization"], **body})
                number = min(len(endpoint.requests), len(endpoint.answers)) - 1
                try:
                    endpoint.answers[number](self)
                except (BrokenPipeError, ConnectionResetError):
                    return

            def log_message(self, format: str, *args: object) -> None:
                return

        self._server = ThreadingHTTPServer(("127.0.0.1", 0), Handler)
        self._server.daemon_threads = True
        self.url = f"http://127.0.0.1:{self._server.server_address[1]}/v1"
        self._thread = threading.Thread(target=self._server.serve_forever, args=(0.05,), daemon=True)
        self._thread.start()

    def hangs(self, handler: BaseHTTPRequestHandler) -> None:
        """No answer until the test is over."""
        self.over.wait(30)

    def drips(self, handler: BaseHTTPRequestHandler) -> None:
        """Headers, then a space now and then: each read is in time, the whole never is."""
        handler.send_response(200)
        handler.send_header("Content-Type", "application/json")
        handler.send_header("Content-Length", "100000")
        handler.end_headers()
        while not self.over.wait(0.05):
            handler.wfile.write(b" ")
            handler.wfile.flush()

    def close(self) -> None:
        self.over.set()
        for node in self.nodes:
            node.io.shutdown()
        self._server.shutdown()
        self._server.server_close()
        self._thread.join()


@pytest.fixture
def endpoint(monkeypatch: pytest.MonkeyPatch) -> Iterator[Endpoint]:
    importlib.import_module("openai")  # takes long, and is not what is measured here
    monkeypatch.setenv("NO_PROXY", "127.0.0.1")
    opened = Endpoint()
    try:
        yield opened
    finally:
        opened.close()


class Desk(Node):
    """The service; robot time stands still unless a test moves it."""

    def __init__(self, endpoint: Endpoint, lockstep: bool = False, **changes: Any) -> None:
        config = PlannerConfig(**{"backend": "llm", "llm_url": endpoint.url, "llm_timeout": 100.0, **changes})
        super().__init__(PlannerService, config, SCENE, lockstep=lockstep)
        endpoint.nodes.append(self)

    def request(self, command: str = "bring me the red mug", request_id: str = "m.1", **fields: Any) -> None:
        self.bus.send(topics.PLAN_REQUEST, m.PlanRequest(id=request_id, command=command, **fields))

    def step(self, seconds: float = 0.0, fed: bool = True) -> None:
        self.later(seconds)
        self.run()

    def wait(self, number: int = 1) -> m.ActionPlan:
        def answered() -> bool:
            self.step()
            return self.count(topics.ACTION_PLAN) >= number

        eventually(answered, "a plan", patience=120)
        return self.sent(topics.ACTION_PLAN)[number - 1]

    def ask(self, **fields: Any) -> m.ActionPlan:
        self.request(**fields)
        return self.wait()


def actions(plan: m.ActionPlan) -> list[str]:
    return [s.action for s in plan.steps]


def test_a_good_answer_is_the_plan(endpoint: Endpoint) -> None:
    endpoint.answers = [plans(*MUG)]
    node = Desk(endpoint, llm_key="secret", llm_model="tiny", llm_options={"temperature": 0})
    plan = node.ask(command="desk, the mug must go")
    assert (plan.source, actions(plan), plan.steps[2].target) == ("llm", ["find", "grasp", "place"], "desk")
    request = endpoint.requests[-1]
    assert (request["path"], request["key"], request["model"]) == ("/v1/chat/completions", "Bearer secret", "tiny")
    assert request["temperature"] == 0
    told = json.loads(request["messages"][1]["content"])
    assert told["command"] == "desk, the mug must go" and "desk" in told["receptacles"]


def test_the_schema_asks_for_our_actions_and_names_only(endpoint: Endpoint) -> None:
    endpoint.answers = [plans(*MUG)]
    Desk(endpoint).ask(world=m.KnownWorld(objects=["strange thing"]))
    form = endpoint.requests[0]["response_format"]
    assert form["type"] == "json_schema" and form["json_schema"]["strict"] is True
    schema = form["json_schema"]["schema"]
    step = schema["$defs"]["Step"]
    assert schema["type"] == "object" and schema["additionalProperties"] is False
    assert set(step["required"]) == {"action", "object", "target", "text"}
    assert set(step["properties"]["action"]["enum"]) == {
        "navigate", "find", "grasp", "place", "release", "say", "wait", "return", "teach", "forget",
        "name", "rule",
    }  # fmt: skip
    assert {"red mug", "strange thing", ""} <= set(step["properties"]["object"]["enum"])
    assert "sofa" in step["properties"]["target"]["enum"] and "moon" not in step["properties"]["target"]["enum"]


@pytest.mark.parametrize(
    ("answer", "why"),
    [
        (says("Sure! Here is the plan: find the mug."), "malformed answer"),
        (says(""), "malformed answer"),
        (says('{"steps": "find"}'), "malformed answer"),
        (says('{"plan": []}'), "malformed answer"),
        (plans({"action": "teleport", "object": "red mug"}), "malformed answer: Invalid enum value 'teleport'"),
        (plans({"action": "find", "object": "unicorn"}), "impossible plan: step 1: I know no unicorn"),
        (plans({"action": "find", "object": "sofa"}), "impossible plan: step 1: I know no sofa"),
        (plans({"action": "navigate", "target": "moon"}), "impossible plan: step 1: I know no place 'moon'"),
        (plans(*MUG[:2], *MUG[:2]), "impossible plan: step 4: the hand already holds the red mug"),
        (plans(MUG[1]), "impossible plan: step 1: the red mug must be found"),
        (plans(MUG[2]), "impossible plan: step 1: there is nothing in the hand"),
        (plans(*MUG[:2], {"action": "place", "target": "cloud"}), "impossible plan: step 3: there is no cloud"),
        (plans({"action": "say", "text": " "}), "impossible plan: step 1: there is nothing to say"),
        (plans(*[{"action": "wait"}] * 100), "impossible plan: the plan has 100 steps"),
        (lambda handler: send(handler, {"error": "overloaded"}, 503), "status 503"),
        (lambda handler: send(handler, b"<html>hello</html>"), "no chat completion"),
        (lambda handler: send(handler, {"choices": []}), "no chat completion"),
        (lambda handler: handler.connection.close(), "no connection"),
    ],
)
def test_the_grammar_steps_in_and_says_why(endpoint: Endpoint, answer: Answer, why: str) -> None:
    endpoint.answers = [answer]
    plan = Desk(endpoint).ask()
    assert actions(plan) == GRAMMAR
    assert plan.source.startswith(f"grammar (llm: {why}"), plan.source


def test_an_impossible_plan_goes_back_with_the_reason_once(endpoint: Endpoint) -> None:
    endpoint.answers = [plans({"action": "grasp", "object": "sofa"}), plans(*MUG)]
    plan = Desk(endpoint).ask()
    assert plan.source == "llm" and len(endpoint.requests) == 2
    assert "I know no sofa" in endpoint.requests[1]["messages"][-1]["content"]


def test_odd_spellings_become_the_names_of_the_scene(endpoint: Endpoint) -> None:
    endpoint.answers = [
        says(
            '```json\n{"steps": [{"action": "find", "object": "Red_Cup"}, {"action": "grasp", "object": "the red mug"},'
            ' {"action": "navigate", "target": "office"}, {"action": "place", "target": "worktop"}]}\n```'
        )
    ]
    plan = Desk(endpoint).ask()
    assert plan.source == "llm"
    assert [s.object or s.target for s in plan.steps] == ["red mug", "red mug", "study", "counter"]


def test_a_rejected_plan_is_told_and_not_accepted_again(endpoint: Endpoint) -> None:
    steps = [msgspec.convert(s, m.PlanStep) for s in MUG]
    endpoint.answers = [plans(*MUG)]
    plan = Desk(endpoint).ask(rejected=m.RejectedPlan(steps=steps, reason="the desk is full", step=3))
    assert plan.source == "grammar (llm: the rejected plan again: the desk is full)"
    assert actions(plan) == GRAMMAR
    told = json.loads(endpoint.requests[0]["messages"][1]["content"])
    assert told["rejected_plans"][0]["reason"] == "the desk is full"


def test_what_the_model_declines_is_planned_by_the_grammar_if_it_can(endpoint: Endpoint) -> None:
    endpoint.answers = [plans(detail="I am only a small model")]
    plan = Desk(endpoint).ask()
    assert (actions(plan), plan.source) == (GRAMMAR, "grammar (llm: I am only a small model)")
    plan = Desk(endpoint).ask(command="sing a song about mugs")
    assert (plan.steps, plan.source, plan.detail) == ([], "llm", "I am only a small model")


def test_nobody_listens(endpoint: Endpoint) -> None:
    plan = Desk(endpoint, llm_url=f"http://127.0.0.1:{free_port()}/v1").ask()
    assert (actions(plan), plan.source) == (GRAMMAR, "grammar (llm: no connection)")


def test_a_late_answer_is_not_waited_for(endpoint: Endpoint) -> None:
    endpoint.answers = [endpoint.hangs]
    plan = Desk(endpoint, llm_timeout=0.2).ask()
    assert (actions(plan), plan.source) == (GRAMMAR, "grammar (llm: timed out)")


def test_a_dripping_answer_ends_at_the_deadline(endpoint: Endpoint) -> None:
    endpoint.answers = [endpoint.drips, plans(*MUG)]
    node = Desk(endpoint, llm_timeout=0.5)
    assert node.ask().source == "grammar (llm: timed out)"


def test_a_blocked_worker_does_not_hold_up_the_answer(endpoint: Endpoint, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("services.planner.language_model.backend.prepare", lambda: endpoint.over.wait(30))
    endpoint.answers = [plans(*MUG)]
    node = Desk(endpoint, llm_timeout=5.0)
    node.request()
    node.step()
    node.step(5.0)
    assert not node.count(topics.ACTION_PLAN)
    node.step(GRACE + 0.1)
    assert node.wait().source == "grammar (llm: timed out)"
    assert not endpoint.requests


def test_a_newer_request_replaces_the_older_and_does_not_wait_for_it(endpoint: Endpoint) -> None:
    endpoint.answers = [endpoint.hangs, plans(*MUG)]
    node = Desk(endpoint)
    node.request()
    node.step()
    eventually(lambda: endpoint.requests, "the request is under way")
    node.request("bring me the apple", "m.2")
    plan = node.wait()
    assert (plan.request_id, plan.source) == ("m.2", "llm")
    assert node.count(topics.ACTION_PLAN) == 1


def test_the_end_of_the_process_does_not_wait_for_an_answer(endpoint: Endpoint) -> None:
    endpoint.answers = [endpoint.hangs]
    node = Desk(endpoint)
    node.request()
    node.step()
    eventually(lambda: endpoint.requests, "the request is under way")
    node.service.close()
    free = node.io.submit(lambda: True)
    eventually(lambda: free.poll(node.now), "the one worker has let go of the question", patience=10)


def test_a_look_comes_before_the_model_is_asked(endpoint: Endpoint) -> None:
    endpoint.answers = [plans(*MUG)]
    node = Desk(endpoint)
    node.request("tidy up the table", done=[])
    look = node.wait()
    assert look.again and look.steps[0].target == "living table" and not endpoint.requests
    node.request("tidy up the table", "m.2", done=look.steps)
    assert node.wait(2).source == "llm"


def test_the_same_request_twice_is_asked_once(endpoint: Endpoint) -> None:
    endpoint.answers = [plans(*MUG)]
    node = Desk(endpoint)
    node.request()
    node.step()
    node.request()
    assert node.wait().source == "llm"
    node.request()
    assert node.wait(2) == node.wait(1)
    assert len(endpoint.requests) == 1


def test_in_lockstep_the_answer_comes_at_its_tick(endpoint: Endpoint) -> None:
    endpoint.answers = [plans(*MUG)]
    node = Desk(endpoint, lockstep=True, llm_seconds=0.5)
    node.request()
    for _ in range(5):
        node.step(0.1)
        assert not node.count(topics.ACTION_PLAN)
    node.step(0.1)
    assert node.sent(topics.ACTION_PLAN)[0].source == "llm"


def plans_by(node: Desk, backend: str) -> m.PlannerStatus:
    """Let the worker look until the planner says that this one plans."""

    def found() -> bool:
        node.step(EVERY / 2)
        return node.last(topics.PLANNER_STATUS).backend == backend

    eventually(found, f"plans by {backend}", patience=120)
    return node.last(topics.PLANNER_STATUS)


def at_once(node: Desk, request_id: str) -> m.ActionPlan:
    """The plan that the very step of its request has published."""
    before = node.count(topics.ACTION_PLAN)
    node.request(request_id=request_id)
    node.step()
    assert node.count(topics.ACTION_PLAN) == before + 1
    return node.sent(topics.ACTION_PLAN)[-1]


def test_by_itself_it_takes_the_model_while_there_is_one(endpoint: Endpoint) -> None:
    endpoint.answers, endpoint.models = [plans(*MUG)], None
    node = Desk(endpoint, backend="auto")
    assert at_once(node, "m.1").source == "grammar"
    eventually(lambda: endpoint.looks, "it looks for the endpoint")
    assert at_once(node, "m.2").source == "grammar"
    endpoint.models = ["llama3.2:3b", "qwen2.5:7b"]
    there = plans_by(node, "llm")
    assert (there.model, there.url, there.detail) == ("llama3.2:3b", endpoint.url, "one of 2")
    node.request(request_id="m.3")
    assert node.wait(3).source == "llm" and endpoint.requests[0]["model"] == "llama3.2:3b"
    endpoint.models = None
    assert plans_by(node, "grammar").detail == "status 503"
    assert at_once(node, "m.4").source == "grammar"
    endpoint.models = ["local"]
    assert plans_by(node, "llm").model == "local"


def test_by_itself_it_waits_for_nobody(endpoint: Endpoint) -> None:
    node = Desk(endpoint, backend="auto", llm_url=f"http://127.0.0.1:{free_port()}/v1")
    detail = lambda: node.last(topics.PLANNER_STATUS).detail  # noqa: E731
    eventually(lambda: (node.step(), "nobody answers" in detail())[1], "it has looked")
    assert at_once(node, "m.1").source == "grammar"


def test_a_model_that_did_not_answer_is_left_alone_for_longer_and_longer(endpoint: Endpoint) -> None:
    endpoint.answers = [endpoint.hangs, endpoint.hangs, plans(*MUG)]
    # Long enough for a busy machine to have sent the question that is given up.
    node = Desk(endpoint, backend="auto", llm_timeout=2.0)
    for number, rest in ((1, REST), (2, 2 * REST)):
        plans_by(node, "llm")
        asked, answered = len(endpoint.requests), node.count(topics.ACTION_PLAN)
        node.request(request_id=f"m.{number}")
        assert node.wait(answered + 1).source == "grammar (llm: timed out)"
        looks, failed = endpoint.looks, node.now
        while node.now < failed + rest - 2 * EVERY:
            node.step(EVERY)
            assert at_once(node, f"m.{number}.{node.now}").source == "grammar"
        assert (endpoint.looks, len(endpoint.requests)) == (looks, asked + 1)
    plans_by(node, "llm")
    node.request(request_id="m.3")
    assert node.wait(node.count(topics.ACTION_PLAN) + 1).source == "llm"


def test_in_lockstep_and_without_the_client_it_does_not_look(
    endpoint: Endpoint, monkeypatch: pytest.MonkeyPatch
) -> None:
    steady = Desk(endpoint, backend="auto", lockstep=True)
    monkeypatch.setattr("services.planner.language_model.backend.installed", lambda: False)
    lacking = Desk(endpoint, backend="auto")
    for node in (steady, lacking):
        node.step(2 * EVERY)
        assert at_once(node, "m.1").source == "grammar"
    assert endpoint.looks == 0
    assert "seed" in steady.last(topics.PLANNER_STATUS).detail
    assert "pip install" in lacking.last(topics.PLANNER_STATUS).detail


@pytest.mark.parametrize("answer", [b"<html>hello</html>", b'{"models": []}', b""])
def test_what_else_may_listen_there_is_no_endpoint(endpoint: Endpoint, answer: bytes) -> None:
    endpoint.page = answer
    assert "no chat endpoint" in look(endpoint.url).why
    assert "no http address" in look("file:///etc/passwd").why


def test_doctor_says_what_it_found(endpoint: Endpoint, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("TIDYBOT__PLANNER__LLM_URL", endpoint.url)
    endpoint.models = ["llama3.2:3b", "qwen2.5:7b"]
    (found,) = doctor.language_model()
    assert found.level == "ok" and "llama3.2:3b plans (of llama3.2:3b, qwen2.5:7b)" in found.state
    monkeypatch.setenv("TIDYBOT__PLANNER__LLM_MODEL", "mistral")
    (found,) = doctor.language_model()
    assert found.level == "note" and found.fix.endswith("LLM_MODEL=llama3.2:3b")
    endpoint.models = None
    monkeypatch.setattr(diagnosis, "OLLAMA", f"http://127.0.0.1:{free_port()}/v1")
    silent = diagnosis.diagnose()
    assert silent.level == "note" and "status 503; the grammar plans" in silent.state


def test_the_real_process_finds_and_asks_the_endpoint(endpoint: Endpoint, here: Site) -> None:
    endpoint.answers = [plans(*MUG)]
    here.start(
        "services.planner", TIDYBOT_CLOCK="wall", TIDYBOT__PLANNER__LLM_URL=endpoint.url,
        TIDYBOT__PLANNER__LLM_TIMEOUT="100",
    )  # fmt: skip
    with here.session() as session:
        here.wait_alive(session, "planner")

        def shown() -> str:
            replies = list(session.get("planner/status", timeout=2.0))
            return str(json.loads(replies[0].ok.payload.to_bytes())["backend"]) if replies and replies[0].ok else ""

        eventually(lambda: shown() == "llm", "the planner has found the model", patience=120)
        heard: list[dict[str, Any]] = []
        kept = session.declare_subscriber("action_plan", lambda s: heard.append(json.loads(s.payload.to_string())))
        session.put("plan_request", json.dumps({"id": "m.1", "command": "bring me the red mug"}))
        eventually(lambda: heard, "a plan", patience=120)
        kept.undeclare()
    assert (heard[0]["request_id"], heard[0]["source"]) == ("m.1", "llm")


def test_without_the_client_the_service_says_what_to_install(
    endpoint: Endpoint, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("services.planner.language_model.backend.installed", lambda: False)
    with pytest.raises(StartError, match=r"tidybot-zenoh\[llm\]"):
        Desk(endpoint)
    assert installed()
