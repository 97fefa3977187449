"""A recording for speech recognition: read and checked, then sent at the pace of robot time."""

from pathlib import Path

import numpy as np

from cli.errors import CliError
from cli.link import Link, Subscription
from common import messages as m
from common import topics
from common.bus import codec, delivery
from common.sound import RATE, AudioError, Samples, read_wav
from common.time.clock import monotonic
from common.time.lockstep import DT

CHUNK = 0.1
"""Length of a piece of sound [s], as microphones give them."""
LEAD_IN, TRAILING = 0.3, 1.5
"""Silence [s] before and after a recording: speech needs the second to know that it was the last word."""
EAR = "ear"
_PERIOD = round(CHUNK / DT)


def recorded(path: Path) -> list[bytes]:
    """The chunks of a WAV file, with silence before and after; raises `CliError` when it cannot be used."""
    try:
        return padded(read_wav(path))
    except AudioError as error:
        raise CliError(str(error)) from None


def padded(samples: Samples) -> list[bytes]:
    """Chunks of 0.1 s with silence before and after, the last one full."""
    quiet = np.zeros(round(LEAD_IN * RATE), np.int16), np.zeros(round(TRAILING * RATE), np.int16)
    whole = np.concatenate((quiet[0], samples, quiet[1]))
    step = round(CHUNK * RATE)
    whole = np.pad(whole, (0, -len(whole) % step))
    return [whole[i : i + step].astype("<i2").tobytes() for i in range(0, len(whole), step)]


class Player:
    """Sends a chunk every 0.1 s of robot time. In lockstep it takes part, so that the simulation waits for it."""

    SILENCE = 10.0
    """Wall time [s] without a tick after which robot time stands still; chosen: a busy machine takes 1 s."""

    def __init__(self, link: Link, chunks: list[bytes]) -> None:
        self._link, self._chunks = link, chunks

    def play(self) -> None:
        """Play all chunks; returns when they are sent.

        Raises:
            CliError: robot time stands still.
        """
        session, token = self._link.session, None
        clock = Subscription(self._link, topics.SIM_CLOCK)
        out = session.declare_publisher(topics.AUDIO_PCM.key, encoding=codec.encoding_of(topics.AUDIO_PCM))
        heard, sent, start = monotonic(), 0, -1
        try:
            while sent < len(self._chunks):
                tick = clock.next(0.5)
                if tick is None:
                    if monotonic() - heard > self.SILENCE:
                        raise CliError("robot time stands still; is the simulation up and running? See `tidybot ps`")
                    continue
                heard = monotonic()
                if start < 0:
                    start = tick.tick - tick.tick % _PERIOD + 2 * _PERIOD
                    if tick.lockstep:
                        token = session.liveliness().declare_token(topics.ALIVE_KEY.format(name=EAR))
                        self._acknowledge(-1)
                while sent < len(self._chunks) and tick.tick >= start + sent * _PERIOD:
                    last = sent == len(self._chunks) - 1
                    at = (start + sent * _PERIOD) * DT
                    chunk = m.AudioChunk(t=at, data=self._chunks[sent], rate=RATE, seq=sent, end=last, addressed=True)
                    stamp = delivery.stamp(tick.tick if tick.lockstep else None)
                    out.put(codec.encode(topics.AUDIO_PCM, chunk), attachment=stamp)
                    sent += 1
                if tick.lockstep and tick.tick % _PERIOD == 0:
                    self._acknowledge(tick.tick)
        finally:
            clock.close()
            if token is not None:
                token.undeclare()

    def _acknowledge(self, tick: int) -> None:
        self._link.send(topics.LOCKSTEP_ACK, m.LockstepAck(name=EAR, tick=tick, period=_PERIOD))
