"""Plans by a language model behind an OpenAI-compatible chat endpoint. Runs in the worker."""

import asyncio
import importlib
import re
from collections.abc import Callable
from typing import Any

import msgspec

from common.messages import PlanStep, RejectedPlan
from common.time.clock import monotonic
from services.planner.config import PlannerConfig
from services.planner.grammar.vocabulary import Vocabulary
from services.planner.language_model.prompt import Impossible, checked, messages, schema
from services.planner.plan_builder import same
from services.planner.world import World

POLL = 0.05
"""How often a question under way looks whether it was cancelled [s of wall time] (chosen)."""
CONNECT = 1.0
"""Limit for the connection [s of wall time], as for a look at the endpoint."""
_FENCE = re.compile(r"^\s*```(?:json)?\s*(.*?)\s*```\s*$", re.DOTALL)


class Reply(msgspec.Struct):
    """What a model answers; lenient where a server knows no schema."""

    steps: list[PlanStep]
    detail: str = ""


class LlmError(Exception):
    """No usable plan from the model: why, in a few words."""


class NoAnswer(LlmError):
    """Nobody was there, or not in time; other errors are about what was answered."""


def prepare() -> None:
    """Import the client before the first request needs it: that takes a second or more."""
    importlib.import_module("openai")


class Call:
    """One question under way. `cancelled` may be set from another thread and ends it within POLL seconds."""

    def __init__(self) -> None:
        self.cancelled = False


class Llm:
    """Asks the endpoint of the configuration."""

    def __init__(self, config: PlannerConfig, clock: Callable[[], float] = monotonic) -> None:
        self._config, self._clock = config, clock

    def plan(self, command: str, world: World, rejected: list[RejectedPlan], call: Call) -> Reply:
        """A checked plan, or one without steps and with the model's reason.

        A plan that cannot be carried out goes back with the reason, as often as `llm_tries` and `llm_timeout` allow.

        Raises:
            NoAnswer: no answer in time, no connection, an error of the server.
            LlmError: no JSON of the right form, or nothing possible.
        """
        config, vocabulary = self._config, Vocabulary(world, self._config)
        talk, form = messages(command, world, rejected), schema(world)
        end = self._clock() + config.llm_timeout
        wrong = ""
        for _ in range(max(1, config.llm_tries)):
            try:
                said = asyncio.run(self._complete(talk, form, end, call))
            except TimeoutError:
                raise NoAnswer(f"timed out after {wrong}" if wrong else "timed out") from None
            try:
                reply = msgspec.json.decode(_FENCE.sub(r"\1", said), type=Reply)
                reply.steps = checked(reply.steps, world, vocabulary, config.max_steps)
            except (msgspec.DecodeError, UnicodeDecodeError) as error:
                wrong = f"malformed answer: {error}"
            except Impossible as impossible:
                wrong = f"impossible plan: {impossible}"
            else:
                again = next((r for r in rejected if reply.steps and same(reply.steps, r.steps)), None)
                if again is None:
                    return reply
                wrong = f"the rejected plan again: {again.reason}"
            talk = [*talk, {"role": "assistant", "content": said}, {"role": "user", "content": f"No: {wrong}"}]
        raise LlmError(wrong)

    async def _complete(self, talk: list[dict[str, str]], form: dict[str, Any], end: float, call: Call) -> str:
        """The words of the answer; TimeoutError at `end`, whatever has arrived by then."""
        asked = asyncio.ensure_future(self._ask(talk, form))
        while not asked.done():
            if call.cancelled or self._clock() >= end:
                asked.cancel()
                await asyncio.wait({asked}, timeout=1.0)
                raise TimeoutError
            await asyncio.wait({asked}, timeout=POLL)
        return asked.result()

    async def _ask(self, talk: list[dict[str, str]], form: dict[str, Any]) -> str:
        import openai

        config = self._config
        # Who is not there is not waited for: a connection takes milliseconds, an answer may take long.
        patience = openai.Timeout(config.llm_timeout, connect=min(CONNECT, config.llm_timeout))
        wanted: Any = {"type": "json_schema", "json_schema": {"name": "plan", "schema": form, "strict": True}}
        asked: Any = talk
        try:
            async with openai.AsyncOpenAI(
                base_url=config.llm_url, api_key=config.llm_key or "none", max_retries=0, timeout=patience
            ) as client:
                answer = await client.chat.completions.create(
                    model=config.llm_model, messages=asked, response_format=wanted, extra_body=config.llm_options
                )
            return answer.choices[0].message.content or ""
        except openai.APITimeoutError:
            raise TimeoutError from None
        except openai.APIStatusError as error:
            raise NoAnswer(f"status {error.status_code}") from None
        except openai.APIConnectionError:
            raise NoAnswer("no connection") from None
        except (openai.OpenAIError, ValueError, TypeError, AttributeError, IndexError) as error:
            raise LlmError(f"no chat completion: {type(error).__name__}") from None
