"""Parameters of the planner and of the optional language model."""

from typing import Literal

from common.config import Config


class PlannerConfig(Config, frozen=True):
    """`backend`: "auto" takes the language model while one answers at `llm_url`, else the grammar.

    `llm_tries` answers are asked for within `llm_timeout`; in lockstep they show after `llm_seconds`.

    With `open_vocabulary` a thing that nobody has named is looked for by its words, else only what the household names
    or perception has seen is known. With `guess` what no wording covers is asked about. Times in seconds.
    """

    backend: Literal["auto", "grammar", "llm"] = "auto"
    open_vocabulary: bool = True
    guess: bool = True
    set_down: tuple[str, ...] = ("counter", "table", "shelf")
    max_steps: int = 60
    fresh: float = 5.0
    llm_url: str = "http://127.0.0.1:8081/v1"
    llm_model: str = "local"
    llm_key: str = ""
    llm_options: dict[str, float | int | str | bool] = {}
    llm_timeout: float = 12.0
    llm_tries: int = 2
    llm_seconds: float = 2.0
