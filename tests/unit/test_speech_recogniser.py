"""The recogniser's choice among transcriptions, with a model that says what it is told."""

from typing import cast

import numpy as np

from common.household import load_household
from services.speech.config import SpeechConfig
from services.speech.recognise.moonshine import Decoded, Moonshine
from services.speech.recognise.recogniser import OTHERS, PreparedUtterance, Recogniser, Recognition, grammars


class Model:
    """Hears `texts`, the likeliest first, and none of the grammar's sentences; `scored`: how many at each scoring."""

    tokens = [""] * 3

    def __init__(self, texts: list[str]) -> None:
        self._found = [Decoded(text, -3.0 - k / 10, (5, 2)) for k, text in enumerate(texts)]
        self.scored: list[int] = []

    def encode(self, variants: object) -> object:
        return object()

    def free(self, encoded: object) -> Decoded:
        return self._found[0]

    def freely(self, *_: object) -> list[Decoded]:
        return self._found

    def best(self, *_: object) -> list[Decoded]:
        return [Decoded("stop", -30.0, (5, 2))]

    def log_probabilities(self, encoded: object, sentences: list[Decoded]) -> list[float]:
        self.scored.append(len(sentences))
        return [one.log_probability for one in sentences]


def heard(model: Model) -> Recognition:
    config = SpeechConfig(commands=("stop",))
    recogniser = Recogniser(
        config,
        cast(Moonshine, model),
        grammars(config, load_household("apartment")),
        lambda text: 0.0,
        lambda text, whole: 0.0,
    )
    return recogniser.recognise(PreparedUtterance(np.zeros((1, 16000), np.float32), 1.0), "command")


def test_in_noise_no_more_transcriptions_are_scored_again_than_can_be_right() -> None:
    model = Model([f"bring me the {k} mugs" for k in range(100)])
    found = heard(model)
    assert max(model.scored) <= OTHERS
    assert found.free == "bring me the 0 mugs"
