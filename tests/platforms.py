"""The lock files on every computer that a robot may have: `python -m tests.platforms`, part of `make check`.

For each Python and architecture, a built wheel of every locked version must exist: nothing is compiled on a robot. The
package index is asked once; later runs answer from uv's cache. Without a network it says so and passes.
"""

import subprocess
import sys
from pathlib import Path

from tests.support import ROOT

LOCKS = ("requirements.lock", "requirements.image.lock")
PYTHONS = ("3.11", "3.12", "3.13", "3.14")
ARCHITECTURES = ("x86_64", "aarch64")
GLIBC = "2_35"
"""Ubuntu 22.04's, on which NVIDIA's JetPack 6 is built; Debian 12 and Raspberry Pi OS have a newer one."""
UNREACHABLE = ("dns error", "error sending request", "Request failed", "client error (Connect)")


def unresolved(lock: Path, python: str, architecture: str) -> str:
    """Why the lock file cannot be installed there from wheels alone, "" when it can.

    Raises:
        ConnectionError: the package index does not answer, and the cache does not know.
    """
    # What uv says of a package that is only missing from its cache differs, and may be that no such version exists.
    said = _resolve(lock, python, architecture, "--offline") and _resolve(lock, python, architecture)
    if any(word in said for word in UNREACHABLE):
        raise ConnectionError(said.splitlines()[0])
    return said


def _resolve(lock: Path, python: str, architecture: str, *options: str) -> str:
    line = [
        str(Path(sys.executable).parent / "uv"), "pip", "compile", "--quiet", "--no-deps", "--only-binary=:all:",
        f"--python-version={python}", f"--python-platform={architecture}-manylinux_{GLIBC}", *options, str(lock),
    ]  # fmt: skip
    done = subprocess.run(line, capture_output=True, text=True, check=False)
    return (done.stderr.strip() or f"uv ended with {done.returncode}") if done.returncode else ""


def main() -> int:
    """Print a line for each platform; the exit status."""
    failed = 0
    for python in PYTHONS:
        for architecture in ARCHITECTURES:
            try:
                why = "\n".join(filter(None, (unresolved(ROOT / lock, python, architecture) for lock in LOCKS)))
            except ConnectionError as error:
                print(f"lock files: not checked, the package index does not answer ({error})")
                return 0
            print(f"lock files: {architecture:8} Python {python:5} {why or 'ok'}")
            failed += bool(why)
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
