"""What a command should bring about: things where they belong, and effects of other kinds."""

import msgspec

from judge.effects import Effect, Shown
from judge.evidence import ThingEvidence, Want


class Goal(msgspec.Struct, frozen=True):
    """All that a case has to bring about; an empty goal can never be reached."""

    wants: tuple[Want, ...] = ()
    effects: tuple[Effect, ...] = ()

    @property
    def things(self) -> frozenset[str]:
        """Names in the goal; the objects among them may be moved."""
        return frozenset(n for n in (*(w.thing for w in self.wants), *_named(self.effects)) if n)


def _named(effects: tuple[Effect, ...]) -> list[str]:
    return [name for effect in effects for name in (effect.what, effect.other)]


def shortfall(things: list[ThingEvidence], shown: list[Shown]) -> str:
    """What is missing of a goal, in words; "" when all of it was brought about."""
    if not things and not shown:
        return "nothing was wanted that could be done"
    return "; ".join([*(f"{t.thing}: {t.why}" for t in things if not t.delivered), *(s.why for s in shown if s.why)])
