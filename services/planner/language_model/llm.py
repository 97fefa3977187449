"""Plans by a language model behind an OpenAI-compatible chat endpoint. Runs in the worker."""

import asyncio
import importlib
from typing import Any

import msgspec

from common.chat import ChatError, Endpoint, NoAnswer, complete
from common.messages import PlanStep, RejectedPlan
from common.time.clock import monotonic
from services.planner.config import PlannerConfig
from services.planner.grammar.vocabulary import Vocabulary
from services.planner.language_model.prompt import Impossible, checked, messages, schema
from services.planner.plan_builder import same
from services.planner.world import World

POLL = 0.05
"""How often a question under way looks whether it was cancelled [s of wall time] (chosen)."""


class Reply(msgspec.Struct):
    """What a model answers; lenient where a server knows no schema."""

    steps: list[PlanStep]
    detail: str = ""


def prepare() -> None:
    """Import the client before the first request needs it: that takes a second or more."""
    importlib.import_module("openai")


class Call:
    """One question under way. `cancelled` may be set from another thread and ends it within POLL seconds."""

    def __init__(self) -> None:
        self.cancelled = False


class Llm:
    """Asks the endpoint of the configuration."""

    def __init__(self, config: PlannerConfig) -> None:
        self._config = config

    def plan(self, command: str, world: World, rejected: list[RejectedPlan], call: Call) -> Reply:
        """A checked plan, or one without steps and with the model's reason.

        A plan that cannot be carried out goes back with the reason, as often as `llm_tries` and `llm_timeout` allow.

        Raises:
            NoAnswer: no answer in time, no connection, an error of the server.
            ChatError: no JSON of the right form, or nothing possible.
        """
        config, vocabulary = self._config, Vocabulary(world, self._config)
        talk, form = messages(command, world, rejected), schema(world)
        end = monotonic() + config.llm_timeout
        wrong = ""
        for _ in range(max(1, config.llm_tries)):
            try:
                said = asyncio.run(self._complete(talk, form, end, call))
            except TimeoutError:
                raise NoAnswer(f"timed out after {wrong}" if wrong else "timed out") from None
            try:
                reply = msgspec.json.decode(said, type=Reply)
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
        raise ChatError(wrong)

    async def _complete(self, talk: list[dict[str, str]], form: dict[str, Any], end: float, call: Call) -> str:
        """The words of the answer; TimeoutError at `end`, whatever has arrived by then."""
        config = self._config
        where = Endpoint(config.llm_url, config.llm_model, config.llm_key, config.llm_timeout, config.llm_options)
        asked = asyncio.ensure_future(complete(where, talk, {"name": "plan", "schema": form, "strict": True}))
        while not asked.done():
            if call.cancelled or monotonic() >= end:
                asked.cancel()
                await asyncio.wait({asked}, timeout=1.0)
                raise TimeoutError
            await asyncio.wait({asked}, timeout=POLL)
        return asked.result()
