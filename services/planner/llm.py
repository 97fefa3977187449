"""Plans by a language model behind an OpenAI-compatible chat endpoint. Runs in the worker."""

import importlib.util
import re
from collections.abc import Callable
from typing import Any

import msgspec

from common.clock import monotonic
from common.messages import PlanStep, RejectedPlan
from services.planner.check import Impossible, checked
from services.planner.config import PlannerConfig
from services.planner.draft import same
from services.planner.prompt import messages, schema
from services.planner.vocabulary import Vocabulary
from services.planner.world import World

_FENCE = re.compile(r"^\s*```(?:json)?\s*(.*?)\s*```\s*$", re.DOTALL)


class Reply(msgspec.Struct):
    """What a model answers; lenient where a server knows no schema."""

    steps: list[PlanStep]
    detail: str = ""


class LlmError(Exception):
    """No usable plan from the model: why, in a few words."""


def installed() -> bool:
    return importlib.util.find_spec("openai") is not None


class Llm:
    """One client; importing it takes a second or more, so that is done in the worker as well."""

    def __init__(self, config: PlannerConfig, clock: Callable[[], float] = monotonic) -> None:
        self._config, self._clock = config, clock
        self._client: Any = None

    def plan(self, command: str, world: World, rejected: list[RejectedPlan]) -> Reply:
        """A checked plan, or one without steps and with the model's reason.

        A plan that cannot be carried out goes back with the reason, as often as `llm_tries` and `llm_timeout` allow.

        Raises:
            LlmError: no answer in time, no connection, no JSON of the right form, or nothing possible.
        """
        config, vocabulary = self._config, Vocabulary(world, self._config)
        talk, form = messages(command, world, config, rejected), schema(world)
        end = self._clock() + config.llm_timeout
        wrong = ""
        for _ in range(max(1, config.llm_tries)):
            left = end - self._clock()
            if left <= 0:
                raise LlmError(f"timed out after {wrong}" if wrong else "timed out")
            said = self._complete(talk, form, left)
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

    def open(self) -> None:
        """Import the client before the first request needs it."""
        import openai

        if self._client is None:
            config = self._config
            self._client = openai.OpenAI(base_url=config.llm_url, api_key=config.llm_key or "none", max_retries=0)

    def _complete(self, talk: list[dict[str, str]], form: dict[str, Any], timeout: float) -> str:
        import openai

        self.open()
        wanted = {"type": "json_schema", "json_schema": {"name": "plan", "schema": form, "strict": True}}
        try:
            answer = self._client.chat.completions.create(
                model=self._config.llm_model,
                messages=talk,
                response_format=wanted,
                extra_body=self._config.llm_options,
                timeout=timeout,
            )
            return answer.choices[0].message.content or ""
        except openai.APITimeoutError:
            raise LlmError("timed out") from None
        except openai.APIStatusError as error:
            raise LlmError(f"status {error.status_code}") from None
        except openai.APIConnectionError:
            raise LlmError("no connection") from None
        except (openai.OpenAIError, ValueError, TypeError, AttributeError, IndexError) as error:
            raise LlmError(f"no chat completion: {type(error).__name__}") from None
