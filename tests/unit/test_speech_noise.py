"""Taking out noise and weighing sentences; without any network."""

from dataclasses import dataclass

import numpy as np
import pytest
from numpy.typing import NDArray

from common import config
from services.speech.config import SpeechConfig
from services.speech.recognise.denoise import noise_power, noise_ratio, reduce_noise
from services.speech.recognise.grammar import Grammar
from services.speech.recognise.moonshine import Decoded, EncodedUtterance, Moonshine
from services.speech.recognise.recogniser import PreparedUtterance, Recogniser, confidence_of, verdict_of
from services.speech.recognise.scoring import CANDIDATES, likeliest, prior_cost, ranked, rescored, time_scaled
from services.speech.recognise.token_trie import BOS, EOS
from tests.support import ROOT

CONFIG = config.load("speech", SpeechConfig, ROOT / "config", {})
RATE = 16000
SPAN = (8000, 24000)


def syllables() -> np.ndarray:
    """Half a second of silence, a second of tone bursts, half a second of silence."""
    t = np.arange(2 * RATE) / RATE
    bursts = np.sin(2 * np.pi * 440 * t) * (np.sin(2 * np.pi * 4 * t) > 0)
    return np.where((t > 0.5) & (t < 1.5), 0.3 * bursts, 0.0).astype(np.float32)


def ratio(sound: np.ndarray, clean: np.ndarray) -> float:
    gain = float(np.dot(sound, clean) / np.dot(clean, clean))
    return 10 * float(np.log10(np.sum((gain * clean) ** 2) / np.sum((sound - gain * clean) ** 2)))


def test_noise_is_reduced_and_what_is_clean_stays() -> None:
    clean = syllables()
    noise = np.random.default_rng(0).normal(0, 0.05, len(clean)).astype(np.float32)
    assert ratio(reduce_noise(clean + noise, SPAN), clean) > ratio(clean + noise, clean) + 5
    assert ratio(reduce_noise(clean, SPAN), clean) > 30
    short = clean[:500]
    assert np.array_equal(reduce_noise(short, (0, 500)), short)


def test_the_noise_is_known_from_the_pauses_or_else_from_the_quietest_moments() -> None:
    rng = np.random.default_rng(1)
    frames = rng.exponential(3.0, (400, 8))
    frames[:100] += 1000.0
    known = noise_power(frames, frames[100:])
    assert np.allclose(known, 3.0, rtol=0.2)
    guessed = noise_power(frames, frames[:0])
    assert np.all((guessed > 2.0) & (guessed < 6.0))


def test_speech_to_noise_is_measured() -> None:
    clean = syllables()
    noise = np.random.default_rng(2).normal(0, 1, len(clean)).astype(np.float32)
    for wanted in (0.0, 10.0, 20.0):
        loud = float(np.mean(clean[SPAN[0] : SPAN[1]] ** 2))
        mixed = clean + noise * np.float32(np.sqrt(loud * 10 ** (-wanted / 10)))
        assert abs(noise_ratio(mixed, SPAN) - wanted) < 1.0
    assert noise_ratio(clean, (0, len(clean))) == float("inf")


def test_a_sentence_that_does_not_fit_its_time_costs_more() -> None:
    long, short = "pick up the blue cup", "yes"
    assert prior_cost(long, 1.25, CONFIG) < 1.0 < 5.0 < prior_cost(short, 1.25, CONFIG)
    assert prior_cost(short, 0.5, CONFIG) < 1.0 < 5.0 < prior_cost(long, 0.5, CONFIG)


def test_rare_words_cost() -> None:
    assert prior_cost("go to my kitchen", 1.1, CONFIG) > prior_cost("go to the kitchen", 1.1, CONFIG)


def test_confidence_falls_with_the_likelihood_ratio() -> None:
    scores = [confidence_of(s, CONFIG) for s in (0.5, 0.0, CONFIG.accept_score, CONFIG.ask_score, -5.0)]
    assert scores[:2] == [1.0, 1.0] and scores[2] == 0.5 and scores[2] > scores[3] > scores[4] > 0.0


def test_more_is_asked_about_where_the_free_transcription_is_doubtful_too() -> None:
    sure, doubtful = CONFIG.certain, CONFIG.certain - 0.01
    assert verdict_of(CONFIG.accept_score, 0.0, CONFIG) == verdict_of(CONFIG.accept_score, 1.0, CONFIG) == "accept"
    assert verdict_of(CONFIG.ask_score, sure, CONFIG) == verdict_of(CONFIG.guess_score, doubtful, CONFIG) == "ask"
    assert verdict_of(CONFIG.guess_score, sure, CONFIG) == "reject"
    assert verdict_of(CONFIG.guess_score - 0.1, doubtful, CONFIG) == "reject"


@dataclass(frozen=True)
class Said:
    text: str
    log_probability: float
    tokens: int = 4


FOUND = [Said("bring me the red glass", -6.0), Said("bring me the red mug", -7.0), Said("go home", -30.0)]
FREE = Said("Bring me the red mask.", -3.0)


def test_what_is_uncertain_is_judged_again_and_may_turn_out_otherwise() -> None:
    asked: list[Said] = []

    def again(sentences: list[Said]) -> list[float]:
        asked.extend(sentences)
        return [-9.0, -6.0, -4.0]

    assert rescored(FOUND, FREE, lambda text: 0.0, again)[:2] == (FOUND[1], -0.5)
    assert asked == [FOUND[0], FOUND[1], FREE]
    assert rescored(FOUND, FREE, lambda text: 5.0 * ("mug" in text), again)[:2] == (FOUND[0], -1.25)


def test_a_command_shares_with_those_that_sound_alike_and_mean_something_else() -> None:
    def share(*rivals: Said) -> float:
        again = [s.log_probability for s in (FOUND[0], *rivals, FREE)]
        return rescored([FOUND[0], *rivals], FREE, lambda text: 0.0, lambda these: again[: len(these)]).share

    alike, same = Said("bring me the red grass", -6.0), Said("bring me a red glass please", -6.0)
    assert share() == 1.0 and share(same) == 1.0
    assert share(alike) == pytest.approx(0.5) and share(alike, same) == pytest.approx(2 / 3)
    assert 0.5 < share(Said(alike.text, -7.0)) < share(Said(alike.text, -9.0)) < 1.0
    sure = Said("bring me the red glass", -5.0)
    assert rescored([FOUND[0], alike], sure, lambda text: 0.0, list).share == pytest.approx(0.5)


def test_of_transcriptions_that_sound_alike_one_that_makes_sense_is_chosen() -> None:
    mud, mug = Said("Where does a mud go?", -4.0), Said("where does a mug go", -4.5)
    spelled = Said("Where does the mug go", -6.0)

    def chosen(*found: Said, cost: float) -> tuple[Said, float]:
        again = [s.log_probability for s in found]
        return likeliest(list(found), again, lambda text: cost * ("mud" in text))[:2]

    assert chosen(mud, mug, cost=0.0)[0] == mud
    assert chosen(mud, mug, cost=1.0)[0] == mug
    assert chosen(mug, cost=0.0) == (mug, 1.0) and chosen(mug, spelled, cost=0.0) == (mug, 1.0)
    assert 0.5 < chosen(mud, mug, cost=1.0)[1] < chosen(mud, mug, spelled, cost=1.0)[1] < chosen(mud, mug, cost=9.0)[1]
    assert likeliest([mud, mug], [-9.0, -4.0], lambda text: 0.0)[0] == mug, "it must hold for both scorings"


def test_alternatives_are_ranked_by_their_share_and_told_apart_by_meaning() -> None:
    worth = [("the mud", -6.0), ("the mug", -5.0), ("a mug please", -4.0), ("", -1.0), ("the moon", -90.0)]
    found = ranked(worth)
    assert [one.text for one in found] == ["a mug please", "the mud"], "neither silence nor what is out of the question"
    assert found[0].score > 0.7 and sum(one.score for one in found) == pytest.approx(1.0, abs=0.01)
    assert ranked([]) == ()


def test_a_choice_tells_how_likely_all_were() -> None:
    again = [-9.0, -6.0, -4.0]
    worth = rescored(FOUND, FREE, lambda text: 0.0, lambda these: again).worth
    assert [said for said, _ in worth] == [FOUND[0], FOUND[1], FREE]
    assert [value for _, value in worth] == [
        (s.log_probability + b) / 2 for (s, _), b in zip(worth, again, strict=True)
    ]


def test_other_speech_is_no_command_because_its_transcription_does_not_hold() -> None:
    stop = Said("stop", -13.0, 2)
    free = Said("Let's talk market letter today", -8.0, 7)
    assert rescored([stop], free, lambda text: 0.0, lambda these: [-9.0, -30.0])[:3] == (stop, -2.5, 1.0)
    near = Said("stop", -10.0, 2)
    assert rescored([near], free, lambda text: 0.0, lambda these: [-9.0, -9.0])[:3] == (near, 0.0, 1.0)
    assert rescored([near], free, lambda text: 20.0, lambda these: [-9.0, -9.0])[:3] == (near, -10.0, 1.0)


def test_only_the_best_are_judged_again_and_nothing_where_there_is_no_doubt() -> None:
    many = [Said(f"sentence {k}", -6.0 - k / 10) for k in range(3 * CANDIDATES)]
    sizes: list[int] = []

    def again(sentences: list[Said]) -> list[float]:
        sizes.append(len(sentences))
        return [s.log_probability for s in sentences]

    assert rescored(many, FREE, lambda text: 0.0, again)[0] == many[0]
    assert sizes == [CANDIDATES + 1]
    sure = Said("Bring me the red glass!", -5.0)
    assert rescored(FOUND, sure, lambda text: 0.0, again)[:2] == (FOUND[0], -0.25)
    assert len(sizes) == 1


def test_another_pace_changes_length_and_pitch_alike() -> None:
    t = np.arange(RATE) / RATE
    tone = (0.3 * np.sin(2 * np.pi * 440 * t)).astype(np.float32)
    fast = time_scaled(tone, 16 / 15)
    assert len(fast) == RATE * 15 // 16
    assert abs(float(np.argmax(np.abs(np.fft.rfft(fast)))) * RATE / len(fast) - 440 * 16 / 15) < 2.0
    assert abs(float(np.abs(fast[1000:-1000]).max()) - 0.3) < 0.01
    both = PreparedUtterance(np.stack([tone, np.zeros_like(tone)]), 0.5).time_scaled()
    assert both.shape == (2, RATE * 16 // 15 + 1) and both[0].any() and not both[1].any()
    alone = PreparedUtterance(tone[None], 0.5).time_scaled()
    assert len(alone) == 2 and alone[0].any() and alone[1].any()


TOKENS = ["", "<s>", "</s>", " mug", " "]


class Breath:
    """A decoder that hears a breath rather than a mug, and then nothing."""

    def empty_cache(self, _variants: int) -> None: ...

    def step(self, _heard: object, cache: None, rows: list[int], last: list[int]) -> tuple[NDArray[np.float32], None]:
        likely = {EOS: -0.1} if last != [BOS] else {3: -2.0, 4: -0.5}
        return np.array([[likely.get(k, -30.0) for k in range(len(TOKENS))]] * len(rows), np.float32), cache


def test_silence_is_no_transcription_of_what_was_said() -> None:
    model = Moonshine(None, Breath(), TOKENS, beam=8)  # type: ignore[arg-type]
    found = model.freely(EncodedUtterance({}, 1, 2), lambda text: 0.0, lambda text: 0.0)
    assert [said.text for said in found] == ["mug"]


class Transcriber:
    """A network to which the beginning of what was said sounds likelier than all of it."""

    tokens = TOKENS

    def encode(self, _variants: object) -> None: ...

    def free(self, _heard: None) -> Decoded:
        return Decoded("I can't", -2.0, (3, EOS))

    def best(self, *_: object) -> list[Decoded]:
        return [Decoded("wait", -20.0, (3, EOS))]

    def freely(self, *_: object) -> list[Decoded]:
        return [self.free(None), Decoded("I can't reach the mug on the shelf", -6.0, (3, EOS))]

    def log_probabilities(self, _heard: None, sentences: list[Decoded]) -> list[float]:
        return [said.log_probability for said in sentences]


def test_a_transcription_has_to_fit_the_time_that_was_spoken() -> None:
    grammars, free = {"command": Grammar(("wait",), {})}, lambda text, whole=False: 0.0
    recogniser = Recogniser(CONFIG, Transcriber(), grammars, free, free)  # type: ignore[arg-type]
    for seconds, text in ((0.6, "I can't"), (2.0, "I can't reach the mug on the shelf")):
        heard = PreparedUtterance(np.zeros((1, RATE), np.float32), seconds)
        assert recogniser.recognise(heard, "command").free == text
