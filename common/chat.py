"""One answer of a language model behind an OpenAI-compatible chat endpoint, asked for as JSON of a given form."""

import re
from typing import Any, NamedTuple

CONNECT = 2.0
"""Limit for the connection [s]: it takes milliseconds, and who is not there is not waited for."""
_FENCE = re.compile(r"^\s*```(?:json)?\s*(.*?)\s*```\s*$", re.DOTALL)


class ChatError(Exception):
    """The endpoint gave no usable answer; the message says why in a few words."""


class NoAnswer(ChatError):
    """The endpoint could not be reached or reported an error of its own, so that there is no answer to speak of."""


class Endpoint(NamedTuple):
    """Where to ask, which model, and how long to wait for the answer [s]; `options`: more fields of the request."""

    url: str
    model: str
    key: str
    timeout: float
    options: dict[str, Any] | None = None


async def complete(where: Endpoint, talk: list[dict[str, Any]], form: dict[str, Any]) -> str:
    """The JSON that the model says to `talk`, without a fence around it; `form`: `name`, `schema` and perhaps `strict`.

    Raises:
        TimeoutError: not in time.
        NoAnswer: no connection, or an error of the server.
        ChatError: what answers is no chat endpoint.
    """
    import openai  # an extra, which takes a second to load

    patience = openai.Timeout(where.timeout, connect=min(CONNECT, where.timeout))
    wanted: Any = {"type": "json_schema", "json_schema": form}
    asked: Any = talk
    try:
        async with openai.AsyncOpenAI(
            base_url=where.url, api_key=where.key or "none", max_retries=0, timeout=patience
        ) as client:
            answer = await client.chat.completions.create(
                model=where.model, messages=asked, response_format=wanted, extra_body=where.options
            )
        return _FENCE.sub(r"\1", answer.choices[0].message.content or "")
    except openai.APITimeoutError:
        raise TimeoutError from None
    except openai.APIStatusError as error:
        raise NoAnswer(f"status {error.status_code}") from None
    except openai.APIConnectionError:
        raise NoAnswer("no connection") from None
    except (openai.OpenAIError, ValueError, TypeError, AttributeError, IndexError) as error:
        raise ChatError(f"no chat completion: {type(error).__name__}") from None
