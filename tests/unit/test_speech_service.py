from pathlib import Path

import msgspec
import numpy as np
import pytest

from common import config, topics
from common import messages as m
from common.bus.memory import MemoryIo
from common.household import load_household
from common.language.pattern import PatternError
from common.runtime import StartError
from common.sound import RATE, read_wav
from services.speech.config import SpeechConfig
from services.speech.listen.vad import Endpointer
from services.speech.recognise import token_trie
from services.speech.recognise.grammar import Grammar, vocabulary
from services.speech.recognise.recogniser import patterns
from services.speech.recognise.token_trie import AnyTokens, TokenTrie
from services.speech.service import SpeechService
from services.speech.speak.voice import voice
from tests.node import Node

pytestmark = pytest.mark.long

ROOT = Path(__file__).parents[2]
VOICE = ROOT / "docs" / "audio" / "bring_me_the_red_mug.wav"
SCENE = load_household("apartment")
CONFIG = config.load("speech", SpeechConfig, ROOT / "config", config.overrides({}, ["speech.preload=false"]))


@pytest.fixture(scope="module")
def grammar() -> Grammar:
    return Grammar(CONFIG.commands, vocabulary(SCENE, CONFIG.objects, CONFIG.places, CONFIG.colours))


def test_every_object_and_surface_of_the_scene_can_be_named(grammar: Grammar) -> None:
    for o in SCENE.things:
        for name in (o.name, *o.aliases):
            assert grammar.accepts(f"bring me the {name}")
    for r in SCENE.receptacles:
        assert grammar.accepts(f"put it on the {r.name}")
    assert grammar.accepts("put the apple in the bowl and then come back")


def test_the_wake_word_may_stand_before_a_command_or_alone() -> None:
    config = msgspec.structs.replace(CONFIG, wake=("hey jarvis", "robot"), commands=("go [<where>]", "where = home"))
    grammar = Grammar(patterns(config, "command"), {})
    for said in ("go", "go home", "hey jarvis", "hey jarvis go home", "robot", "robot go"):
        assert grammar.accepts(said)
    assert not any(grammar.accepts(said) for said in ("", "hey", "hey jarvis robot", "go hey jarvis", "home"))


@pytest.mark.parametrize("text", ["", "bring", "bring me the", "the weather is nice", "mug red the me bring", "x"])
def test_what_is_no_command_is_not_accepted(grammar: Grammar, text: str) -> None:
    assert not grammar.accepts(text)


@pytest.mark.parametrize(
    ("patterns", "words"),
    [
        (("(a | b",), "not closed"),
        (("a ] b",), "a closing bracket too many"),
        (("<nothing>",), "nothing defines <nothing>"),
        (("<loop>", "loop = a <loop>"), "contains itself"),
        (("[please]",), "accepts silence"),
        (("a + b",), "is not understood"),
    ],
)
def test_a_bad_pattern_is_named(patterns: tuple[str, ...], words: str) -> None:
    with pytest.raises(PatternError, match=words):
        Grammar(patterns, {})


def test_tokens_that_continue_a_sentence_are_found_whatever_their_case_and_length() -> None:
    grammar = Grammar(("stop it", "go"), {})
    vocabulary = TokenTrie(["<unk>", "<s>", "</s>", " St", "op", " stop", " it", ".", " g", "o", " x"], grammar)
    numbers, states = vocabulary.allowed(grammar.start)
    assert sorted(numbers) == [3, 5, 7, 8]
    after = dict(zip(numbers.tolist(), states, strict=True))
    assert not grammar.is_final(after[5])
    numbers, states = vocabulary.allowed(after[5])
    assert sorted(numbers) == [6, 7]
    assert grammar.is_final(dict(zip(numbers.tolist(), states, strict=True))[6])


def test_what_was_walked_of_a_grammar_is_kept_within_bounds(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(token_trie, "STATES", 1)
    grammar = Grammar(("go", "stop"), {})
    trie = TokenTrie(["", "", "", " go", " stop", "?"], grammar)
    first = trie.allowed(grammar.start)
    assert list(first[0]) == [3, 4, 5]
    trie.allowed(grammar.walk(" go"))
    assert len(grammar._steps) < len(" go stop"), "of the first state nothing is kept"
    assert list(trie.allowed(grammar.start)[0]) == [3, 4, 5] and trie.allowed(grammar.start)[1] == first[1]


def test_without_a_grammar_every_written_token_may_follow() -> None:
    free = AnyTokens(["<unk>", "<s>", "</s>", " St", "op", "<0x0A>", "", " caf\u00e9", ".", " g"])
    numbers, states = free.allowed(free.start)
    assert numbers.tolist() == [3, 4, 8, 9] and all(free.is_final(state) for state in states)


def test_an_utterance_ends_after_a_pause_and_not_in_a_short_one() -> None:
    ends = Endpointer(end_silence=0.6, max_utterance=10.0)
    assert not any(ends.push(0.9) for _ in range(10))
    assert not any(ends.push(0.1) for _ in range(10))
    assert not any(ends.push(0.9) for _ in range(5))
    assert [ends.push(0.1) for _ in range(19)].index(True) == 18


def test_clicks_do_not_begin_an_utterance() -> None:
    ends = Endpointer(end_silence=0.6, max_utterance=10.0)
    for _ in range(20):
        ends.push(0.9)
        for _ in range(4):
            ends.push(0.0)
    assert not ends.speaking


class Listener(Node):
    """The service, to which a test talks."""

    def __init__(self, **changes: object) -> None:
        super().__init__(SpeechService, msgspec.structs.replace(CONFIG, **changes), SCENE)

    def ask(self, text: str, goal_id: str = "a.1") -> None:
        self.bus.send(topics.SPEECH_GOAL, m.SpeechGoal(goal=text, id=goal_id))
        self.step()

    def play(self, samples: np.ndarray) -> None:
        for n, start in enumerate(range(0, len(samples), 1600)):
            data = samples[start : start + 1600].tobytes()
            self.bus.send(topics.AUDIO_PCM, m.AudioChunk(t=self.now, data=data, seq=n))
            self.step()

    def result(self) -> m.SpeechResult:
        return self.sent(topics.SPEECH_RESULT)[-1]

    def state(self) -> str:
        return self.last(topics.SPEECH_STATUS).state


def test_a_recorded_command_is_understood_and_noise_is_not() -> None:
    node = Listener()
    node.ask("listen", "a.1")
    assert node.state() == "listening"
    node.play(np.concatenate([np.zeros(RATE // 2, np.int16), read_wav(VOICE), np.zeros(RATE, np.int16)]))
    node.step(1.0)
    heard = node.result()
    assert (heard.text, heard.goal_id) == ("bring me the red mug", "a.1")
    assert heard.confidence > 0.5
    node.ask("listen", "a.2")
    noise = np.random.default_rng(0).normal(0, 3000, RATE * 3).astype(np.int16)
    node.play(noise)
    node.step(2.0)
    assert node.result().goal_id == "a.1", "noise is no speech"


@pytest.mark.slow
def test_the_robot_understands_its_own_voice() -> None:
    node = Listener()
    spoken = node.bus.tap(topics.AUDIO_OUT)
    node.ask("say go to the kitchen", "a.1")
    node.step(5.0)
    chunks = [msgspec.msgpack.decode(p, type=m.AudioChunk) for p in spoken]
    assert chunks[-1].end and [c.seq for c in chunks] == list(range(len(chunks)))
    assert node.state() == "idle"
    node.ask("listen", "a.2")
    audio = np.concatenate([np.frombuffer(c.data, "<i2") for c in chunks])
    node.play(np.concatenate([audio, np.zeros(RATE, np.int16)]))
    node.step(1.0)
    assert node.result().text == "go to the kitchen"


@pytest.mark.parametrize("preload", [True, False])
def test_the_models_are_there_before_the_first_word_where_that_is_wanted(
    preload: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    begun: list[object] = []
    monkeypatch.setattr(MemoryIo, "submit", lambda io, work, *given, seconds=0.0: begun.append(work))
    Listener(preload=preload)
    assert len(begun) == 2 * preload and (voice in begun) is preload


def test_silence_is_an_error_after_the_timeout() -> None:
    node = Listener(listen_timeout=5.0)
    node.ask("listen")
    node.play(np.zeros(RATE * 4, np.int16))
    assert not node.count(topics.SPEECH_RESULT)
    node.step(2.0)
    assert (node.result().text, node.result().code) == ("ERROR", "TIMEOUT")


def test_typed_words_count_and_wait_for_the_next_listen() -> None:
    node = Listener()
    node.bus.put(topics.SPEECH_TEXT, b"Bring me the blue mug!")
    node.step()
    node.ask("listen")
    assert (node.result().text, node.result().confidence) == ("bring me the blue mug", 1.0)
    node.bus.put(topics.SPEECH_TEXT, b"too old")
    node.step(CONFIG.typed_memory + 1)
    node.ask("listen", "a.2")
    assert node.state() == "listening"


def test_cancel_ends_listening_and_an_unknown_goal_is_answered() -> None:
    node = Listener()
    node.ask("listen", "a.1")
    node.ask("cancel", "a.2")
    assert node.state() == "idle" and not node.count(topics.SPEECH_RESULT)
    node.ask("sing", "a.3")
    assert (node.result().text, node.result().code, node.result().goal_id) == ("ERROR", "UNKNOWN_GOAL", "a.3")


def test_the_same_goal_twice_gets_the_same_answer() -> None:
    node = Listener()
    node.bus.put(topics.SPEECH_TEXT, b"stop")
    node.ask("listen")
    node.ask("listen")
    first, second = node.sent(topics.SPEECH_RESULT)
    assert first == second
    assert node.state() == "idle"


def test_odd_audio_is_counted() -> None:
    node = Listener()
    node.ask("listen")
    node.bus.send(topics.AUDIO_PCM, m.AudioChunk(t=0.0, data=b"\x00"))
    node.bus.send(topics.AUDIO_PCM, m.AudioChunk(t=0.0, data=b"\x00\x00", rate=1))
    node.step()
    assert node.io.drops["audio/pcm"] == 2


def test_a_missing_recording_stops_the_start_with_a_reason(tmp_path: Path) -> None:
    with pytest.raises(StartError, match="no such file"):
        Listener(wav=str(tmp_path / "nothing.wav"))
