"""Files that speech prepares once from installed packages: rebuilt networks and mapped dictionaries.

They lie beside the weights (`common/speech_weights.py`). `python -m services.speech.prepared` works them out
beforehand, as for an image whose files are read-only.
"""

import hashlib
import os
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from importlib.metadata import version
from pathlib import Path

from common import speech_weights

STEM = "speech-"
ENCODER = "encoder.onnx"
"""File of the encoder's network, its matrices packed."""
SOURCES = (
    "recognise/decoder.py", "recognise/decoder_networks.py", "recognise/packed_network.py", "speak/packed_mapping.py",
    "speak/dictionaries.py", "prepared.py",
)  # fmt: skip
"""Modules that determine what the files are."""


@contextmanager
def prepared() -> Iterator[Path]:
    """The folder with the prepared files, as a context; a temporary one where none can be kept.

    Raises:
        WeightsError: the weights are not there, or the files could not be worked out.
    """
    name = STEM + _key()
    for place in _places():
        if (place / name).is_dir() or _kept(place, name):
            yield place / name
            return
    with tempfile.TemporaryDirectory(prefix="tidybot-") as scratch:
        _work_out(Path(scratch))
        yield Path(scratch)


def write(folder: Path) -> None:
    """Work out all files into a folder."""
    from services.speech.recognise import decoder_networks, packed_network
    from services.speech.speak import dictionaries

    weights = speech_weights.folder()
    packed_network.write(weights / "encoder_model.ort", folder / ENCODER)
    decoder_networks.write(weights / "decoder_model_merged.ort", folder)
    dictionaries.write(folder)


def _places() -> list[Path]:
    """Folders for what is kept; none in memory, where it would be no gain."""
    return [p.parent for p in speech_weights.places() if Path(tempfile.gettempdir()) not in p.parents]


def _kept(place: Path, name: str) -> bool:
    """Work the files out into a place where they stay; False where nothing can be written."""
    try:
        place.mkdir(parents=True, exist_ok=True)
        scratch = Path(tempfile.mkdtemp(prefix=STEM, suffix=".part", dir=place))
        scratch.chmod(0o755)  # another user may run the robot than the one who installs it
    except OSError:
        return False
    try:
        _work_out(scratch)
        scratch.rename(place / name)
        _remove_others(place, name)
    except OSError:
        return (place / name).is_dir()  # another process was faster; what it left is as good
    finally:
        shutil.rmtree(scratch, ignore_errors=True)
    return True


def _work_out(folder: Path) -> None:
    """In a process of its own, with which the memory that it takes goes."""
    line = [sys.executable, "-m", "services.speech.prepared", str(folder)]
    done = subprocess.run(line, capture_output=True, text=True, check=False)
    if done.returncode:
        why = (done.stderr.strip() or f"status {done.returncode}").splitlines()[-1]
        raise speech_weights.WeightsError(f"the networks of speech could not be worked out: {why}")


def _remove_others(place: Path, name: str) -> None:
    for folder in place.glob(f"{STEM}*"):
        if folder.name != name and folder.suffix != ".part":
            shutil.rmtree(folder, ignore_errors=True)


def _key() -> str:
    """Differs where the files would: by weights, dictionaries, and our own code."""
    digest = hashlib.sha256(version("hibari-tts").encode())
    for name in speech_weights.FILES:
        digest.update(f"{(speech_weights.folder() / name).stat().st_size} ".encode())
    for source in SOURCES:
        digest.update((Path(__file__).parent / source).read_bytes())
    return digest.hexdigest()[:16]


def main() -> int:
    """Work the files out into the folder of the command line, or where they are looked for."""
    if sys.argv[1:]:
        write(Path(sys.argv[1]))
        return os.EX_OK
    try:
        with prepared() as folder:
            print(folder)
    except speech_weights.WeightsError as error:
        print(f"speech: {error}", file=sys.stderr)
        return os.EX_UNAVAILABLE
    return os.EX_OK


if __name__ == "__main__":
    sys.exit(main())
