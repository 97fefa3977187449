"""Hostile payloads thrown at services that run as processes, and what becomes of these."""

import time
from collections import Counter
from collections.abc import Callable, Sequence
from typing import Any

from bench.fuzz.payloads import Payloads
from cli.link import Link
from cli.processes.ports import free_port
from cli.processes.services import SERVICES
from common import messages as m
from common import topics
from common.bus import codec, delivery
from common.topic import Topic
from evaluation.site import Site, eventually
from evaluation.stack import service_class

BURST = 100
"""Payloads between two looks at the process."""
START_LIMIT = 300.0
"""Time [s] for a process to start on a busy machine."""
# What is well-formed here is a lie nobody can tell from the truth; only what is malformed must be refused.
TRUSTED = {t.key for t in (*topics.CLOCKS, topics.LOCKSTEP_ACK)}
QUERIES = (topics.SIM_TRUTH, topics.SIM_RESET, topics.SIM_SNAPSHOT, topics.BRAIN_MISSIONS)
CALM = {"TIDYBOT__BRAIN__ENABLE_CONFIRMATION": "false", "TIDYBOT__RUNTIME__LOG_LEVEL": "warning"}
PATIENCE = 600.0
"""For the mission after the storm [s]; chosen: many times what it takes."""


class Storm:
    """Services as processes of a `Site`, and what is thrown at them."""

    def __init__(self, here: Site, session: Any, names: Sequence[str], seed: int) -> None:
        self.here, self.session, self.names = here, session, tuple(names)
        self.payloads = Payloads(seed)
        kinds = [service_class(name) for name in names]
        self.topics: list[Topic[Any]] = sorted({t for k in kinds for t in k.READS}, key=lambda t: t.key)
        self.topics += [topics.BY_KEY[key] for key in sorted(TRUSTED)]
        self.sent: Counter[str] = Counter()
        self.processes: dict[str, Any] = {}

    def start(self, **settings: str) -> None:
        """Start every service and wait until it is alive."""
        extra = {**CALM, "TIDYBOT__DASHBOARD__PORT": str(free_port()), **settings}
        extra["TIDYBOT_STATE_DIR"] = str(self.here.log_dir / "state")
        for service in SERVICES:
            if service.name in self.names:
                self.processes[service.name] = self.here.start(service.module, **extra)
        for name in self.names:
            key = topics.ALIVE_KEY.format(name=name)
            eventually(lambda key=key: list(self.session.liveliness().get(key)), f"{name} is alive", START_LIMIT)

    def learn(self) -> None:
        """Take what the robot says now as examples to vary."""
        for topic in self.topics:
            for payload in delivery.fetch(self.session, topic.key, timeout=0.3).values() if topic.latched else ():
                try:
                    self.payloads.learn(topic, codec.decode(topic, payload))
                except codec.DecodeError:
                    continue

    def throw(self, number: int, rate: float, watch: Callable[[int], None] = lambda sent: None) -> None:
        """`number` payloads, about `rate` a second; `watch` is called after every burst.

        Raises:
            AssertionError: a process has died.
        """
        rng, began = self.payloads.rng, time.monotonic()
        for sent in range(0, number, BURST):
            for _ in range(min(BURST, number - sent)):
                topic = rng.choice(self.topics)
                self._put(topic.key, self._hostile(topic))
            if rng.random() < 0.05:
                self._ask(rng.choice(QUERIES), self._hostile(topics.OBJECT_QUERY))
            self.check_alive()
            watch(sent + BURST)
            ahead = (sent + BURST) / rate - (time.monotonic() - began)
            if ahead > 0:
                time.sleep(ahead)

    def _hostile(self, topic: Topic[Any]) -> bytes:
        make = self.payloads
        if topic.key not in TRUSTED:
            return make.of(topic)
        while True:
            payload = make.of(topic)
            try:
                codec.decode(topic, payload)
            except codec.DecodeError:
                return payload

    def _put(self, key: str, payload: bytes) -> None:
        self.session.put(key, payload)
        self.sent[key] += 1

    def _ask(self, key: str, payload: bytes) -> None:
        for _ in self.session.get(key, payload=payload, timeout=1.0):
            pass
        self.sent[key] += 1

    # --- afterwards
    def check_alive(self) -> None:
        dead = [name for name, process in self.processes.items() if process.poll() is not None]
        assert not dead, f"died: {', '.join(dead)}\n" + "\n".join(self.tail(name) for name in dead)

    def tail(self, name: str) -> str:
        module = next(s.module for s in SERVICES if s.name == name)
        return self.here.log(module)[-3000:]

    def settle(self) -> dict[str, m.Health]:
        """The health of all, newer than the last payload.

        Raises:
            AssertionError: a process no longer tells its health.
        """
        link = Link(self.session, self.here.connect)
        before = {n: h.uptime for n, h in link.health().items()}

        def newer() -> dict[str, m.Health] | None:
            now = link.health()
            fresh = all(n in now and now[n].uptime > before.get(n, 0.0) + 2.0 for n in self.names)
            return now if fresh else None

        return eventually(newer, "every process still tells its health", patience=120.0) or {}

    def troubles(self) -> list[str]:
        """Stack traces in the logs; the guard around `step` logs one for every error it catches."""
        found = []
        for name in self.names:
            module = next(s.module for s in SERVICES if s.name == name)
            lines = self.here.log(module).splitlines()
            found += [f"{name}: {x[:400]}" for x in lines if "Traceback" in x or "panicked" in x]
        return found

    def recover(self) -> None:
        """Undo what well-formed commands have done: a stopped robot, a pause, a world in disorder."""
        delivery.fetch(self.session, topics.SIM_PAUSE, b'{"paused": false}', timeout=5.0)
        delivery.fetch(self.session, topics.SIM_RESET, b'{"seed": 1}', timeout=30.0)
        delivery.send(self.session, topics.VOICE_COMMAND, m.VoiceCommand(text="cancel", id="calm"))
        delivery.send(self.session, topics.ROBOT_RESUME, m.RobotResume(source="fuzz"))

    def fetch(self, item: str) -> str:
        """Ask for an item: `delivered`, `failed`, `cancelled`, or why there is no outcome."""
        wanted = m.VoiceCommand(text=f"bring me the {item}", id="after-the-storm", confirmed=True)
        end, asked = time.monotonic() + PATIENCE, 0.0
        state, before = m.BrainState(state="IDLE"), None
        while time.monotonic() < end:
            for payload in delivery.fetch(self.session, topics.BRAIN_STATE.key).values():
                state = codec.decode(topics.BRAIN_STATE, payload)
            last = state.last
            if asked and last is not None and last != before and last.command == wanted.text:
                return f"{last.outcome} {last.reason}".strip()
            waiting = state.state in ("WAITING", "LISTENING") and time.monotonic() - asked > 10.0
            if waiting:
                asked, before = time.monotonic(), last
                delivery.send(self.session, topics.VOICE_COMMAND, wanted)
            time.sleep(0.5)
        known = f"{state.state} {state.command!r} {state.step} {state.detail}"
        return f"no outcome in {PATIENCE:.0f} s; last seen {known}"
