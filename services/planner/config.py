"""Parameters of the planner and of the optional language model."""

from typing import Literal

from common.config import Config


class PlannerConfig(Config, frozen=True):
    """What it understands by itself, and which language model it asks. Times in seconds."""

    backend: Literal["auto", "grammar", "llm"] = "auto"
    """`auto`: the language model while one answers at `llm_url`, else the grammar (in lockstep always); `llm`: asks
    first, and falls back to the grammar; `grammar`: never asks."""
    open_vocabulary: bool = True
    """Look for a thing that nobody has named by its words; else only what the household names or perception has seen
    is known."""
    guess: bool = True
    """Ask about what no wording covers ("Do you mean: ...?"); else it is not understood."""
    set_down: tuple[str, ...] = ("counter", "table", "shelf")
    """Kinds of surfaces, in this order, where a thing is put whose place nobody says."""
    max_steps: int = 60
    """Steps of a plan, at most [count]."""
    fresh: float = 5.0
    """Age up to which a sighting is "here"."""
    llm_url: str = "http://127.0.0.1:8081/v1"
    """Any OpenAI-compatible chat endpoint."""
    llm_model: str = "local"
    """Its model; with `auto` the first that it lists, if none is called so."""
    llm_key: str = ""
    """Its key; belongs into the environment."""
    llm_options: dict[str, float | int | str | bool] = {}
    """Added to each request as they are."""
    llm_timeout: float = 12.0
    """Time for all tries together; below the brain's `planning_timeout`."""
    llm_tries: int = 2
    """Answers asked for: an impossible or malformed plan goes back with the reason [count]."""
    llm_seconds: float = 2.0
    """What an answer takes in lockstep."""
