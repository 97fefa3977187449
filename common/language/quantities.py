"""Numbers and durations in words: `twenty five seconds`, `half a minute`. Pure."""

from common.language.normalise import Words

_ONES = (
    "zero one two three four five six seven eight nine ten eleven twelve thirteen fourteen fifteen sixteen seventeen"
    " eighteen nineteen"
)
_TENS = "twenty thirty forty fifty sixty seventy eighty ninety"
NUMBERS: dict[str, float] = {
    **{word: float(n) for n, word in enumerate(_ONES.split())},
    **{word: 10.0 * n for n, word in enumerate(_TENS.split(), 2)},
    "half": 0.5, "quarter": 0.25, "couple": 2.0, "few": 3.0, "some": 3.0, "hundred": 100.0,
}  # fmt: skip
"""Words for numbers, beside `a`; `a few` is taken for three (chosen)."""
UNITS = {"second": 1.0, "sec": 1.0, "s": 1.0, "moment": 2.0, "minute": 60.0, "min": 60.0, "hour": 3600.0}
"""Seconds of a unit; a moment is two (chosen)."""
LONGEST = 3600.0
"""Longest time that the robot is asked to wait [s] (chosen: for more a person comes back)."""
_BETWEEN = ("a", "an", "of", "and")


def number(words: Words) -> float | None:
    """The number that the words name; None if they name none."""
    said = [w for w in words if w not in _BETWEEN]
    total = 0.0
    for word in said:
        if word.isdigit():
            total += int(word)
        elif word == "hundred" and total:
            total *= 100
        elif word in NUMBERS:
            total += NUMBERS[word]
        else:
            return None
    return total if said else 1.0 if set(words) & {"a", "an"} else None


def duration(words: Words) -> float | None:
    """Seconds that the words name, such as `a minute and a half`; None if they name none."""
    if words[-3:] == ("and", "a", "half") and (whole := duration((*words[:-3],))) is not None:
        return whole + UNITS[_unit(words[-4])] / 2
    unit = _unit(words[-1]) if words else ""
    count = number(words[:-1]) if len(words) > 1 else 1.0
    return None if not unit or count is None else count * UNITS[unit]


def _unit(word: str) -> str:
    return next((form for form in (word, word.removesuffix("s")) if form in UNITS), "")
