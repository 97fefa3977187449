"""`tidybot mcp` as an agent's host uses it: started over stdio or reached over HTTP, by the SDK's own client."""

import io
import json
import subprocess
import sys
from collections.abc import AsyncIterator, Awaitable, Callable
from contextlib import asynccontextmanager
from importlib.util import find_spec
from typing import TYPE_CHECKING, Any

import pytest
from PIL import Image

from cli.processes.ports import free_port
from evaluation.site import eventually
from tests.integration.test_cli_up import Run, run
from tests.support import ROOT

if find_spec("mcp") is None:
    pytest.skip("the extra mcp is not installed", allow_module_level=True)
import anyio

if TYPE_CHECKING:  # takes more than a second to load, which every worker would spend
    from mcp import Client
    from mcp_types import CallToolResult

__all__ = ["run"]


@asynccontextmanager
async def agent(run: Run, *words: str) -> AsyncIterator["Client"]:
    """The SDK's client on a server that it starts itself, as an agent's host does."""
    from mcp import Client, StdioServerParameters

    started = StdioServerParameters(
        command=sys.executable, args=["-m", "cli.main", "mcp", *words], env=run.environ, cwd=ROOT
    )
    async with Client(started) as client:
        yield client


def text_of(result: "CallToolResult") -> str:
    from mcp_types import TextContent

    return " ".join(c.text for c in result.content if isinstance(c, TextContent))


async def called(client: "Client", tool: str, **arguments: Any) -> Any:
    result = await client.call_tool(tool, arguments)
    assert not result.is_error, text_of(result)
    record = result.structured_content
    return record["result"] if record is not None and set(record) == {"result"} else record


async def refused(client: "Client", tool: str, **arguments: Any) -> str:
    result = await client.call_tool(tool, arguments)
    assert result.is_error, text_of(result)
    return text_of(result)


async def read(client: "Client", uri: str) -> str | bytes:
    from mcp_types import BlobResourceContents, TextResourceContents

    content = (await client.read_resource(uri)).contents[0]
    if isinstance(content, TextResourceContents):
        return content.text
    assert isinstance(content, BlobResourceContents)
    import base64

    return base64.b64decode(content.blob)


@pytest.mark.slow
def test_without_a_robot_every_tool_says_so_and_what_is_no_phrase_is_refused(run: Run) -> None:
    async def talk() -> None:
        async with agent(run, "--connect", f"tcp/127.0.0.1:{run.port}") as client:
            tools = {tool.name for tool in (await client.list_tools()).tools}
            assert tools >= {
                "bring", "put", "tidy", "go", "where_is", "what_do_you_see", "say", "ask_person", "status", "explain",
                "stop", "cancel", "answer", "wait", "do",
            }  # fmt: skip
            assert client.instructions and "stop" in client.instructions
            for tool, arguments in (("status", {}), ("stop", {}), ("bring", {"object": "red mug"})):
                assert "nothing answers at" in await refused(client, tool, **arguments)
            assert "printable" in await refused(client, "bring", object="a\x00b")
            assert "printable" in await refused(client, "do", command="  ")
        async with agent(run, "--confirm") as careful:
            assert "answer" not in {tool.name for tool in (await careful.list_tools()).tools}

    anyio.run(talk)


@pytest.fixture
def serving(run: Run) -> Callable[..., tuple[str, Any]]:
    """Start the server over HTTP; its address and the process."""

    def start(token: str = "", host: str = "127.0.0.1") -> tuple[str, Any]:
        port = free_port()
        environ = {**run.environ, "TIDYBOT__DASHBOARD__TOKEN": token} if token else run.environ
        line = [sys.executable, "-m", "cli.main", "mcp", "--http", f"{host}:{port}"]
        log = run.directory.parent / "mcp.log"
        with log.open("wb") as out:
            process = subprocess.Popen(line, env=environ, cwd=ROOT, stdout=subprocess.PIPE, stderr=out, text=True)
        run.opened.append(process)
        eventually(lambda: listens(port), "the server listens")
        return f"http://127.0.0.1:{port}/mcp", log

    return start


def listens(port: int) -> bool:
    import socket

    with socket.socket() as probe:
        return probe.connect_ex(("127.0.0.1", port)) == 0


def test_over_http_only_the_token_opens_the_door(run: Run, serving: Callable[..., tuple[str, Any]]) -> None:
    token = "a-token-that-nobody-guesses"
    url, log = serving(token, "0.0.0.0")
    assert token in log.read_text()

    async def tools(headers: dict[str, str]) -> int:
        import httpx2
        from mcp import Client
        from mcp.client.streamable_http import streamable_http_client

        async with (
            httpx2.AsyncClient(headers=headers) as http,
            Client(streamable_http_client(url, http_client=http)) as client,
        ):
            return len((await client.list_tools()).tools)

    assert anyio.run(tools, {"Authorization": f"Bearer {token}"}) > 10
    for headers in ({}, {"Authorization": "Bearer wrong"}, {"Authorization": f"Basic {token}"}):
        assert status_of(url, headers) == 401
    assert status_of(url, {"Authorization": f"Bearer {token}", "Origin": "http://elsewhere.example"}) == 403


def test_on_loopback_another_site_s_name_is_refused(serving: Callable[..., tuple[str, Any]]) -> None:
    url, _ = serving()
    assert status_of(url, {"Host": "attacker.example"}) == 403
    assert status_of(url, {"Origin": "http://attacker.example"}) == 403
    assert status_of(url, {}) not in (401, 403)


def status_of(url: str, headers: dict[str, str]) -> int:
    import urllib.error
    import urllib.request

    body = json.dumps({"jsonrpc": "2.0", "id": 1, "method": "ping"}).encode()
    request = urllib.request.Request(url, body, {"Content-Type": "application/json", **headers})
    try:
        with urllib.request.urlopen(request, timeout=20) as answer:
            return int(answer.status)
    except urllib.error.HTTPError as error:
        error.close()
        return int(error.code)


@pytest.mark.slow
@pytest.mark.timeout(600)
def test_an_agent_s_missions_done_refused_asked_and_stopped(run: Run) -> None:
    patient = ("--set", "brain.answer_timeout=3000")
    done = run.detached("--without", "dashboard", "--speed", "max", "--seed", "1", *patient)
    assert done.returncode == 0, done.stderr

    async def talk() -> None:
        async with agent(run) as client:
            await _refusals(client)
            await _delivery(client)
            await _question(client, run)
            await _waiting_and_stop(client)

    anyio.run(talk)


async def _refusals(client: "Client") -> None:
    """What a person would be refused, an agent is, with the same reason; and it is in the journal."""
    reason = await refused(client, "bring", object="banana")
    assert "failed: " in reason and "banana" in reason
    assert "banana" in await called(client, "explain")
    assert "no mission" in await refused(client, "explain", mission="nonsense")
    assert "asks nothing" in await refused(client, "answer", text="yes")


async def _delivery(client: "Client") -> None:
    from mcp_types import ImageContent

    told: list[str] = []

    async def progress(count: float, total: float | None, message: str | None) -> None:
        told.append(message or "")

    result = await client.call_tool("bring", {"object": "the red mug"}, progress_callback=progress)
    assert not result.is_error, text_of(result)
    record = result.structured_content
    assert record is not None and record["outcome"] == "delivered" and "red mug" in record["command"]
    for state in ("NAVIGATING", "GRABBING", "RELEASING"):
        assert any(state in line for line in told), told
    status = await called(client, "status")
    assert status["last"]["id"] == record["mission_id"] and not status["stopped"]
    assert "red mug" in await called(client, "explain", mission=record["mission_id"])
    (mug,) = await called(client, "where_is", object="the red mug")
    assert mug["label"] == "red mug"
    assert await called(client, "where_is", object="banana") == []
    seen = await client.call_tool("what_do_you_see", {})
    (image,) = (c for c in seen.content if isinstance(c, ImageContent))
    assert image.mime_type == "image/jpeg"
    for uri in ("tidybot://camera/wrist", "tidybot://map/picture"):
        picture = await read(client, uri)
        assert isinstance(picture, bytes) and len(set(Image.open(io.BytesIO(picture)).convert("L").tobytes())) > 2
    household = json.loads(await read(client, "tidybot://map"))
    assert household["pose"] and {"counter"} <= {s["name"] for s in household["surfaces"]}
    assert any(o["label"] == "red mug" for o in household["objects"])
    journal = json.loads(await read(client, "tidybot://missions"))
    assert [row["outcome"] for row in journal] == ["failed", "delivered"]


async def _question(client: "Client", run: Run) -> None:
    """The person's answer comes back; nothing else happens."""
    answers: list[Any] = []

    async def ask() -> None:
        answers.append(await called(client, "ask_person", question="Shall I tidy up?", wait=300))

    async with anyio.create_task_group() as group:
        group.start_soon(ask)
        await until(lambda: _state(client, "CONFIRMING"))
        answered = await anyio.to_thread.run_sync(run.command, "say", "no")
        assert answered.returncode == 0, answered.stderr
    assert answers[0]["outcome"] == "delivered" and answers[0]["text"] == "no"


async def _waiting_and_stop(client: "Client") -> None:
    """A call given up leaves the robot to it; `wait` finds it again; `stop` brakes, and no agent releases that."""
    with anyio.CancelScope() as scope:

        async def give_up(count: float, total: float | None, message: str | None) -> None:
            scope.cancel()

        await client.call_tool("go", {"place": "kitchen"}, progress_callback=give_up)
    assert scope.cancelled_caught
    followed = await called(client, "wait")
    assert (followed["outcome"], followed["command"]) == ("delivered", "go to the kitchen")
    short = await called(client, "go", place="bedroom", wait=0)
    assert short["outcome"] == "under_way"
    assert "stopped" in await called(client, "stop", reason="a test")
    status = await called(client, "status")
    assert status["stopped"] and status["stop_reason"] == "a test"
    await until(lambda: _nothing_under_way(client))
    assert "not ready" in await refused(client, "go", place="back")


async def until(holds: Callable[[], Awaitable[bool]]) -> None:
    with anyio.fail_after(60):
        while not await holds():
            await anyio.sleep(0.05)


async def _nothing_under_way(client: "Client") -> bool:
    return (await called(client, "status"))["mission"] is None


async def _state(client: "Client", wanted: str) -> bool:
    return bool((await called(client, "status"))["state"] == wanted)
