"""Rates with their uncertainty. Pure."""

from math import sqrt

Z = 1.959964
"""The standard normal quantile of a two-sided 95 % interval."""


def wilson(good: int, count: int) -> tuple[float, float]:
    """The Wilson score interval of the true share, 95 %; (0, 1) without cases.

    Source: E. B. Wilson, "Probable inference, the law of succession, and statistical inference", JASA 22 (1927).
    """
    if not count:
        return 0.0, 1.0
    share, square = good / count, Z * Z
    centre = (share + square / (2 * count)) / (1 + square / count)
    reach = Z * sqrt(share * (1 - share) / count + square / (4 * count * count)) / (1 + square / count)
    return max(0.0, centre - reach), min(1.0, centre + reach)


def interval(good: int, count: int) -> list[float]:
    """The 95 % interval as a report writes it: two shares, rounded to a tenth of a percent."""
    return [round(bound, 3) for bound in wilson(good, count)]


def percent(good: int, count: int) -> str:
    """`89 to 99 %`, the 95 % interval in words."""
    low, high = wilson(good, count)
    return f"{100 * low:.0f} to {100 * high:.0f} %"


def share(good: int, count: int) -> str:
    """`95 of 100 (89 to 98 %)`: a rate with its 95 % interval, as every table prints it."""
    return f"{good} of {count} ({percent(good, count)})"
