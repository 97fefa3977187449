"""Faults of messages, drawn by a seed: dropped, doubled, delayed, reordered or altered.

They sit between a service object and its `Io`, so the same rule does the same thing over memory and over Zenoh.
"""

from collections import Counter
from typing import Any, Literal

import msgspec
import numpy as np

from common import messages as m
from common import topics
from common.topic import Topic
from evaluation.faults.reports import FaultReport, Reporter, ignore

Kind = Literal["drop", "duplicate", "delay", "reorder", "edit"]


class Rule(msgspec.Struct, frozen=True, kw_only=True):
    """The fault of the messages that `service` publishes on `key`.

    Of those between robot times `start` and `until` whose fields equal `match`, the first `skip` pass, the next
    `count` are hit with probability `chance`. `delay` holds them for `seconds`; `reorder` lets the next one overtake;
    `edit` replaces `fields`. With a `state` it holds only while the brain says that it is in it.
    """

    service: str
    key: str
    kind: Kind
    skip: int = 0
    count: int = 1
    chance: float = 1.0
    seconds: float = 1.0
    start: float = 0.0
    until: float = 1e9
    state: str = ""
    match: dict[str, Any] = {}
    fields: dict[str, Any] = {}

    def applies(self, message: m.Message, now: float) -> bool:
        if not self.start <= now <= self.until:
            return False
        return all(getattr(message, name, None) == value for name, value in self.match.items())


class FaultyIo:
    """An `Io` whose `publish` obeys the rules; everything else is the real one's."""

    def __init__(self, io: Any, rules: tuple[Rule, ...], report: Reporter = ignore) -> None:
        self._io, self._rules, self._report = io, rules, report
        self._rng = np.random.default_rng([io.seed, 13])
        self._seen: Counter[int] = Counter()
        self._hits: Counter[int] = Counter()
        self._late: list[tuple[float, Topic[Any], m.Message]] = []
        self._overtaken: dict[str, tuple[Topic[Any], m.Message]] = {}
        self._now = 0.0
        self.state = ""

    def __getattr__(self, name: str) -> Any:
        return getattr(self._io, name)

    def release(self, now: float) -> None:
        """Send the delayed messages that are due."""
        self._now = now
        due = [row for row in self._late if row[0] <= now]
        self._late = [row for row in self._late if row[0] > now]
        for _, topic, message in due:
            self._io.publish(topic, message)

    def publish(self, topic: Topic[Any], message: m.Message) -> None:
        if isinstance(message, m.BrainState):
            self.state = message.state
        rule = self._rule(topic, message)
        overtaken = self._overtaken.pop(topic.key, None)
        match rule.kind if rule else "":
            case "":
                self._io.publish(topic, message)
            case "drop":
                pass
            case "duplicate":
                self._io.publish(topic, message)
                self._io.publish(topic, message)
            case "delay":
                assert rule is not None
                self._late.append((self._now + rule.seconds, topic, message))
            case "reorder":
                self._overtaken[topic.key] = topic, message
            case "edit":
                assert rule is not None
                self._io.publish(topic, _edited(message, rule))
        if overtaken is not None:
            self._io.publish(*overtaken)

    def _rule(self, topic: Topic[Any], message: m.Message) -> Rule | None:
        for number, rule in enumerate(self._rules):
            if rule.key != topic.key or (rule.state and rule.state != self.state):
                continue
            if not rule.applies(message, self._now):
                continue
            self._seen[number] += 1
            if self._seen[number] <= rule.skip or self._hits[number] >= rule.count:
                continue
            if rule.kind == "edit" and _edited(message, rule) == message:
                # It said so by itself: nothing is injected.
                continue
            if rule.chance >= 1.0 or self._rng.random() < rule.chance:
                self._hits[number] += 1
                self._io.log.warning("fault injected", key=topic.key, kind=rule.kind)
                self._report(FaultReport(round(self._now, 2), rule.kind, f"{topic.key}, message {self._seen[number]}"))
                return rule
        return None


def _edited(message: m.Message, rule: Rule) -> m.Message:
    return msgspec.convert({**msgspec.to_builtins(message), **rule.fields}, type(message))


def faulty(kind: Any, rules: tuple[Rule, ...], report: Reporter = ignore) -> Any:
    """The service class with an io that applies the rules which name it; the class itself when none does."""
    mine = tuple(r for r in rules if r.service == kind.NAME)
    if not mine:
        return kind

    told = topics.BRAIN_STATE
    listens = any(r.state for r in mine) and told not in kind.WRITES

    class Faulty(kind):  # type: ignore[misc]
        READS = (*kind.READS, told) if listens and told not in kind.READS else kind.READS

        def __init__(self, config: Any, io: Any) -> None:
            self.faulty_io = FaultyIo(io, mine, report)
            super().__init__(config, self.faulty_io)

        def step(self, now: float) -> None:
            self.faulty_io.release(now)
            state = self.faulty_io.latest(told) if listens else None
            self.faulty_io.state = state.state if state is not None else self.faulty_io.state
            super().step(now)

    Faulty.__name__ = Faulty.__qualname__ = f"Faulty{kind.__name__}"
    return Faulty
