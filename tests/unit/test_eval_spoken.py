"""Recorded and synthetic voices: what a manifest offers, what a sentence becomes in a room, and bad directories."""

from pathlib import Path

import numpy as np
import pytest

from cli.errors import CliError
from common.sound import RATE
from evaluation.case import Speaker
from evaluation.person import voice
from evaluation.suites.spoken import SENTENCES, read_corpus, spoken
from evaluation.suites.table import cases
from tests.sounds import write_wav

HEAD = "file\ttext\tvoice\tsnr\tkind\n"


def record(directory: Path, voice: str, *sentences: str, snr: str = "clean") -> str:
    """Rows of a manifest; each sentence is a tone as long as it has letters."""
    rows = ""
    for text in sentences:
        name = f"{voice}_{text.replace(' ', '_')}_{snr}.wav"
        write_wav(directory / name, 8000 * np.sin(np.arange(1600 * len(text)) / 5.0))
        rows += f"{name}\t{text}\t{voice}\t{snr}\tcmd\n"
    return rows


@pytest.fixture
def directory(tmp_path: Path) -> Path:
    rows = record(tmp_path, "anna", "bring me the red mug", "yes", "hey jarvis", "go to the kitchen", "sing a song")
    rows += record(tmp_path, "anna", "come here", snr="10") + record(tmp_path, "bert", "come here", "no")
    rows += record(tmp_path, "carl", "tell me a story")
    (tmp_path / "manifest.tsv").write_text(HEAD + rows)
    return tmp_path


def test_a_case_has_one_voice_and_what_it_can_say(directory: Path) -> None:
    found = cases("spoken", 12, 0, voices=directory, snr=7.5)
    assert {c.speaker.name for c in found} == {"anna", "bert"}
    for case in found:
        assert case.command in SENTENCES and case.spoken and case.wake and case.noise == 7.5
        assert case.command in case.speaker.recordings
    anna = [c for c in found if c.speaker.name == "anna"]
    assert {c.command for c in anna} == {"bring me the red mug", "go to the kitchen"}
    assert all({"yes", "hey jarvis"} < c.speaker.recordings.keys() for c in anna)
    assert {c.wants[0].thing for c in anna if c.wants} == {"red mug"}


def test_without_recordings_it_is_the_robots_own_voice() -> None:
    found = [spoken(seed) for seed in range(20)]
    assert len({c.speaker.pace for c in found}) > 3
    assert all(c.wants and c.noise == 20.0 and not c.speaker.recordings and c.speaker.room for c in found)


def test_recordings_are_heard_as_they_are_and_the_wake_word_is_put_before_them() -> None:
    mug, wake = np.full(1600, 50, "<i2"), np.full(800, 30, "<i2")
    speaker = Speaker("anna", {"bring me the red mug": mug.tobytes(), "hey jarvis": wake.tobytes()})
    quiet = round((voice.LEAD + voice.TAIL) * RATE)
    alone = voice.utter("Bring me the red mug!", speaker=speaker)
    assert len(alone) == quiet + 1600 and set(alone.tolist()) == {0, 50}
    both = voice.utter("hey jarvis, bring me the red mug", speaker=speaker)
    assert len(both) == quiet + 800 + 1600 + round(voice.GAP * RATE) and set(both.tolist()) == {0, 30, 50}


def test_a_room_has_the_level_of_noise_that_was_asked_for() -> None:
    tone = (8000 * np.sin(np.arange(32000) / 5.0)).astype("<i2")
    speaker = Speaker("anna", {"yes": tone.tobytes()}, room=True)
    for snr in (0.0, 20.0):
        heard = voice.utter("yes", snr, 3, speaker).astype(float)
        clean = voice.utter("yes", None, 3, speaker).astype(float)
        ratio = 10 * np.log10(np.mean(np.square(tone.astype(float))) / np.mean(np.square(heard - clean)))
        assert ratio == pytest.approx(snr, abs=0.5)
    assert (voice.utter("yes", 10.0, 3, speaker) == voice.utter("yes", 10.0, 3, speaker)).all()
    assert (voice.utter("yes", 10.0, 3, speaker) != voice.utter("yes", 10.0, 4, speaker)).any()


@pytest.mark.parametrize(
    ("manifest", "reason"),
    [
        (None, "No such file"),
        ("nonsense\n1\n", "expected the columns"),
        (HEAD + "a.wav\tsing a song\tanna\tclean\tcmd\n", "no clean recording"),
        (HEAD + "a.wav\tcome here\tanna\tclean\tcmd\n", "a.wav"),
    ],
)
def test_a_directory_that_cannot_be_used_is_named_with_the_reason(
    manifest: str | None, reason: str, tmp_path: Path
) -> None:
    if manifest is not None:
        (tmp_path / "manifest.tsv").write_text(manifest)
    with pytest.raises(CliError, match=reason):
        cases("spoken", 1, 0, voices=tmp_path)


def test_the_corpus_leaves_out_what_the_suite_cannot_judge(directory: Path) -> None:
    assert set(read_corpus(directory).voices) == {"anna", "bert"}
