"""Parameters of speech."""

from common.config import Config


class SpeechConfig(Config, frozen=True):
    """`commands` are the patterns of the grammar, around those of `common/language/wordings.py` (`<verb>` and
    `<utterance>`); the lists extend the household's vocabulary. Times in seconds.

    `accept_score`, `ask_score`: log-likelihood ratios per token above which a command is accepted or asked about;
    `guess_score` in place of `ask_score` where the free transcription has less than `certain` of probability per token.
    `beam`: hypotheses of the search. `tempo_weight` and `rare` (what a word costs, a negative log-probability)
    weigh sentences that sound alike. `wake_threshold`: score 0..1 of the wake word's detector; `wake_score`: sum of its
    log-odds and of the log-likelihood ratio of the wake word to what else was transcribed, from which it was said;
    `wake_window`: how long after it a command may begin. `interrupt_pause`: the pause after a short utterance at which
    it is already examined for "stop" and "cancel"; `interrupt_longest`: how short. `recognition_seconds`,
    `interrupt_seconds`, `synthesis_seconds`: modelled times in lockstep. `typed_memory`: how long typed text waits for
    a listener. `wav`: a recording to hear instead of a microphone. `preload`: load the models at start rather than
    when somebody speaks.
    """

    listen_timeout: float = 60.0
    accept_score: float = -1.0
    ask_score: float = -1.5
    guess_score: float = -2.5
    certain: float = 0.7
    beam: int = 16
    preload: bool = True
    tempo_weight: float = 1.0
    rare: dict[str, float] = {}
    end_silence: float = 0.6
    max_utterance: float = 12.0
    typed_memory: float = 30.0
    recognition_seconds: float = 0.8
    synthesis_seconds: float = 0.2
    wav: str = ""
    microphone: bool = False
    speakers: bool = False
    wake_word: bool = True
    wake_threshold: float = 0.1
    wake_score: float = -7.0
    wake_window: float = 6.0
    wake: tuple[str, ...] = ("hey jarvis",)
    interrupt_pause: float = 0.25
    interrupt_longest: float = 1.6
    interrupt_seconds: float = 0.4
    commands: tuple[str, ...] = ("[please] (bring | fetch | get | give | hand) me <thing> [please]",)
    objects: tuple[str, ...] = ()
    places: tuple[str, ...] = ()
    colours: tuple[str, ...] = ()
