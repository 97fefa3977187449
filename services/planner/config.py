"""Parameters of the planner: where things go, words beyond the household's, and the optional language model."""

from typing import Literal

from common.config import Config


class Rule(Config, frozen=True):
    """Things of these kinds and colours (empty: any) go to the first of `to` in the household: a name or a kind."""

    to: tuple[str, ...]
    kinds: tuple[str, ...] = ()
    colours: tuple[str, ...] = ()


class PlannerConfig(Config, frozen=True):
    """`backend`: "auto" takes the language model while one answers at `llm_url`, else the grammar.

    `llm_tries` answers are asked for within `llm_timeout`; in lockstep they show after `llm_seconds`.

    `tidy` and `throw` are tried in order; `groups` are words for several kinds, `mass` those of them
    that mean all there is; `needs` say what helps somebody who is "thirsty". With `open_vocabulary` a thing that
    nobody has named is looked for by its words, else only what the scene names or perception has seen is known.
    Times in seconds."""

    backend: Literal["auto", "grammar", "llm"] = "auto"
    tidy: tuple[Rule, ...] = ()
    throw: tuple[Rule, ...] = ()
    groups: dict[str, tuple[str, ...]] = {}
    mass: tuple[str, ...] = ()
    colours: dict[str, str] = {}
    needs: dict[str, str] = {}
    open_vocabulary: bool = True
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
