"""PocketSphinx with a JSGF grammar: the light fallback recogniser. It hears commands in other speech too: confirm."""

from collections.abc import Sequence

import numpy as np

from common.household import Household
from common.runtime import StartError
from services.speech.config import SpeechConfig
from services.speech.recognise.grammar import vocabulary
from services.speech.recognise.recogniser import PreparedUtterance, Recognition, Scope, patterns


def jsgf(config: SpeechConfig, household: Household, scope: Scope = "command", names: Sequence[str] = ()) -> str:
    """The patterns of a scope as a JSGF grammar."""
    parts = vocabulary(household, (*config.objects, *names), config.places, config.colours)
    sentences = []
    for line in patterns(config, scope):
        name, equals, pattern = line.partition("=")
        if equals and name.strip().isidentifier():
            parts.setdefault(name.strip(), []).append(pattern.strip())
        else:
            sentences.append(line)
    rules = [f"<{name}> = {' | '.join(dict.fromkeys(rows))};" for name, rows in parts.items()]
    return "\n".join(["#JSGF V1.0;", "grammar commands;", f"public <sentence> = {' | '.join(sentences)};", *rules])


class SphinxRecogniser:
    """Loads the model that ships in the `pocketsphinx` wheel."""

    def __init__(self, config: SpeechConfig, household: Household) -> None:
        try:
            from pocketsphinx import Decoder
        except ImportError:
            raise StartError('speech.recogniser = "pocketsphinx" needs: pip install pocketsphinx') from None
        self._config = config
        self._decoder = Decoder(lm=None, loglevel="FATAL")
        self.learn(household, ())

    def learn(self, household: Household, names: Sequence[str]) -> None:
        scopes: tuple[Scope, ...] = ("command", "woken", "interrupt")
        for scope in scopes:
            said: Scope = "interrupt" if scope == "interrupt" else "command"
            self._decoder.add_jsgf_string(scope, jsgf(self._config, household, said, names))

    def recognise(self, utterance: PreparedUtterance, scope: Scope, detected: float = 0.0) -> Recognition:
        self._decoder.activate_search(scope)
        self._decoder.start_utt()
        self._decoder.process_raw((utterance.variants[0] * 32000).astype(np.int16).tobytes(), full_utt=True)
        self._decoder.end_utt()
        found = self._decoder.hyp()
        if found is None or not found.hypstr:
            return Recognition("", "reject", 0.0)
        return Recognition(found.hypstr, "accept", 0.6, found.hypstr)
