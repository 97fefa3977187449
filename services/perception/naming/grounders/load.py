"""The grounder that the configuration names."""

from collections.abc import Callable

from common.runtime import StartError
from services.perception.config import PerceptionConfig
from services.perception.naming.grounders.grounder import Grounder, GrounderError


def load_grounder(config: PerceptionConfig) -> Grounder | None:
    """The grounder of the configuration; None for `words`, with which only words, names and print tell.

    Raises:
        StartError: an unknown name, or what it needs is not there; says what to do.
    """
    # Imported here: each needs packages of an extra that others do without.
    loaders: dict[str, Callable[[PerceptionConfig], Grounder]] = {"clip": _clip, "vision": _vision}
    if config.grounder == "words":
        return None
    if config.grounder not in loaders:
        raise StartError(f"perception.grounder = {config.grounder!r}: expected words, clip or vision")
    try:
        return loaders[config.grounder](config)
    except (GrounderError, ImportError, OSError) as error:
        raise StartError(f"perception.grounder = {config.grounder!r}: {error}") from None


def _clip(config: PerceptionConfig) -> Grounder:
    from services.perception.naming.grounders.clip import Clip

    return Clip(config.clip_model, config.clip_least)


def _vision(config: PerceptionConfig) -> Grounder:
    from services.perception.naming.grounders.vision import Vision

    return Vision(config.vision_url, config.vision_model, config.vision_key, config.vision_timeout)
