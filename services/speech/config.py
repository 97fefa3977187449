"""Parameters of speech."""

from common.config import Config


class SpeechConfig(Config, frozen=True):
    """What is heard, for how long, and how sure it has to be. Times in seconds."""

    listen_timeout: float = 60.0
    """Time for a command to be heard."""
    accept_score: float = -1.0
    """Log-likelihood ratio per token, of the grammar to the free transcription, above which a command is accepted."""
    ask_score: float = -1.5
    """The same above which it is asked about."""
    guess_score: float = -2.5
    """In place of `ask_score` where the free transcription is less than `certain`."""
    certain: float = 0.7
    """Probability per token of the free transcription, 0 to 1."""
    beam: int = 16
    """Hypotheses of the search [count]."""
    preload: bool = True
    """Load the models at the start rather than when somebody speaks."""
    tempo_weight: float = 1.0
    """How much the tempo of speech weighs between sentences that sound alike."""
    rare: dict[str, float] = {}
    """What a word costs where another sounds alike: natural logarithm of how much rarer it is."""
    end_silence: float = 0.6
    """Silence that ends an utterance."""
    max_utterance: float = 12.0
    """Length of an utterance, at most."""
    typed_memory: float = 30.0
    """How long typed text waits for a listener."""
    recognition_seconds: float = 0.8
    """What recognition takes in lockstep."""
    synthesis_seconds: float = 0.2
    """What synthesis takes in lockstep."""
    wav: str = ""
    """Recording to hear instead of a microphone."""
    microphone: bool = False
    """Listen to the sound card (needs sounddevice and libportaudio2)."""
    speakers: bool = False
    """Speak through the sound card."""
    wake_word: bool = True
    """A command begins with the wake word; else everything said is meant for the robot."""
    wake_threshold: float = 0.1
    """Score of its detector, 0 to 1; lower hears it better, and has it verified where it was not said more often."""
    wake_score: float = -7.0
    """Sum of the detector's log-odds and the log-likelihood ratio of the wake word to what else was transcribed, from
    which on it was said."""
    wake_window: float = 6.0
    """How long after it a command may begin."""
    wake: tuple[str, ...] = ("hey jarvis",)
    """How the words of the detector's model are written."""
    interrupt_pause: float = 0.25
    """Pause after a short utterance at which it is already examined for "stop" and "cancel"."""
    interrupt_longest: float = 1.6
    """How short such an utterance is."""
    interrupt_seconds: float = 0.4
    """What that examination takes in lockstep."""
    commands: tuple[str, ...] = ("[please] (bring | fetch | get | give | hand) me <thing> [please]",)
    """Patterns of the grammar, around those of `common/language/wordings.py` (`<verb>` and `<utterance>`)."""
    objects: tuple[str, ...] = ()
    """Names of objects besides the household's."""
    places: tuple[str, ...] = ()
    """Names of places besides the household's."""
    colours: tuple[str, ...] = ()
    """Colours besides the household's."""
