"""Parameters of speech."""

from typing import Literal

from common.config import Config


class SpeechConfig(Config, frozen=True):
    """`commands` are the patterns of the grammar; the lists extend the scene's vocabulary. Times in seconds."""

    recogniser: Literal["moonshine", "pocketsphinx"] = "moonshine"
    listen_timeout: float = 60.0
    accept_score: float = -0.7
    ask_score: float = -1.5
    beam: int = 8
    end_silence: float = 0.6
    max_utterance: float = 12.0
    typed_memory: float = 30.0
    recognition_seconds: float = 0.8
    synthesis_seconds: float = 0.2
    wav: str = ""
    microphone: bool = False
    speakers: bool = False
    commands: tuple[str, ...] = ("[please] (bring | fetch | get | give | hand) me <thing> [please]",)
    objects: tuple[str, ...] = ()
    places: tuple[str, ...] = ()
    colours: tuple[str, ...] = ()
