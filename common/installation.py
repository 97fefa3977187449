"""Where this software lies: in a checkout, which also takes what it writes, or installed, where it is only read."""

import os
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
"""The folder of the packages: the checkout, or `site-packages`."""
CHECKOUT = (ROOT / "pyproject.toml").exists()
_IN_CHECKOUT = {"config": "config", "audio": "docs/audio"}


def shipped(name: str) -> Path:
    """Files that come with the software: `config` or `audio`, wherever the wheel has put them."""
    return ROOT / _IN_CHECKOUT[name] if CHECKOUT else ROOT / "common" / "shipped" / name


def workspace() -> Path | None:
    """The checkout when it may be written to, for what runs leave there; None: the user's own folders take it."""
    return ROOT if CHECKOUT and os.access(ROOT, os.W_OK) else None
