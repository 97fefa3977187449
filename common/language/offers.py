"""The question between several things, and what it offers. Pure."""

import re
from collections.abc import Sequence

_OFFER = re.compile(r"Do you mean (?P<first>the .+) or (?P<last>the .+)\?")


def which(names: Sequence[str]) -> str:
    """`Do you mean the blue mug, the red mug or the white mug?`."""
    *some, last = [f"the {name}" for name in names]
    return f"Do you mean {', '.join(some)} or {last}?"


def offered(question: str) -> list[str]:
    """The answers that such a question offers; none of one that is answered by yes or no."""
    found = _OFFER.fullmatch(question)
    return [*found["first"].split(", "), found["last"]] if found else []
