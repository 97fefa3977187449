"""Is there a language model at the configured address? One look, and the circuit breaker that decides whom to ask."""

import importlib.util
import urllib.error
import urllib.request

import msgspec

LOOK = 1.0
"""Limit of one look [s]: a server on this machine or network lists its models within milliseconds."""
EVERY = 10.0
"""Robot time between two looks [s]: how late a server that comes or goes is noticed."""
REST = 30.0
"""Robot time for which a model that did not answer is left alone [s]; twice as long each further time."""
LONGEST_REST = 480.0
"""At most [s]: sixteen times REST, so that a machine that slept is found again within minutes."""
MAX_LIST = 1_000_000
"""Bytes of a list of models that are read; a cloud's is some 100 kB."""
MISSING = "the openai package is missing: pip install 'tidybot-zenoh[llm]'"


class Found(msgspec.Struct, frozen=True):
    """What answered: the `models` that it lists, or `why` nobody can be asked."""

    models: tuple[str, ...] = ()
    why: str = ""

    @property
    def good(self) -> bool:
        return not self.why


class _Model(msgspec.Struct):
    id: str


class _Models(msgspec.Struct):
    data: list[_Model]


def installed() -> bool:
    """The client of chat endpoints is there."""
    return importlib.util.find_spec("openai") is not None


def look(url: str, key: str = "", limit: float = LOOK) -> Found:
    """Ask an OpenAI-compatible endpoint for its models; blocks for `limit` seconds at most, name resolution aside."""
    if not url.startswith(("http://", "https://")):
        return Found(why=f"{url} is no http address")
    request = urllib.request.Request(f"{url.rstrip('/')}/models")
    if key:
        request.add_header("Authorization", f"Bearer {key}")
    try:
        with urllib.request.urlopen(request, timeout=limit) as answer:
            models = msgspec.json.decode(answer.read(MAX_LIST), type=_Models).data
    except urllib.error.HTTPError as error:
        error.close()
        return Found(why=f"status {error.code}" + (": set planner.llm_key" if error.code in (401, 403) else ""))
    except msgspec.DecodeError:
        return Found(why="what answers there is no chat endpoint")
    except (OSError, ValueError) as error:
        reason = getattr(error, "reason", error)
        return Found(why=f"nobody answers ({reason})" if str(reason) else "nobody answers")
    return Found(models=tuple(model.id for model in models))


def model_of(wanted: str, found: Found) -> str:
    """The model to ask: the configured one; for the default `local` the first that is listed if none has that name."""
    if wanted == "local" and found.models and wanted not in found.models:
        return found.models[0]
    return wanted


class Breaker:
    """Whether the model may be asked, and when to look for it again. Pure; times in seconds of robot time.

    Closed after a look that found it, open after one that did not, and after an answer that did not come: then it
    rests, longer each time until it has answered again.
    """

    def __init__(self) -> None:
        self.found = Found(why="not looked for yet")
        self._next = float("-inf")
        self._rest = REST

    def due(self, now: float) -> bool:
        """True when it is time to look."""
        return now >= self._next

    def looked(self, found: Found, now: float) -> None:
        """Take what a look has shown."""
        self.found, self._next = found, now + EVERY

    def failed(self, why: str, now: float) -> None:
        """The model did not answer a question."""
        self.found = Found(why=why)
        self._next, self._rest = now + self._rest, min(2 * self._rest, LONGEST_REST)

    def answered(self) -> None:
        """The model has answered a question."""
        self._rest = REST
