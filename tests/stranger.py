"""Somebody who is not let in: `python -m tests.stranger ENDPOINT TLS_SETTINGS_JSON` prints what was seen, as JSON.

Subscribes to everything, asks for everything, and tries to drive the base.
"""

import json
import sys
import threading
import time

import zenoh

from common import topics

PATIENCE = 4.0


def main() -> None:
    endpoint, tls = sys.argv[1], json.loads(sys.argv[2])
    config = zenoh.Config()
    config.insert_json5("mode", '"client"')
    config.insert_json5("connect/endpoints", json.dumps([endpoint]))
    config.insert_json5("scouting/multicast/enabled", "false")
    if tls:
        config.insert_json5("transport/link/tls", json.dumps(tls))
    seen: list[str] = []
    told = {"opened": False, "error": ""}

    def note(sample: zenoh.Sample) -> None:
        seen.append(str(sample.key_expr))

    def attempt() -> None:
        try:
            with zenoh.open(config) as session:
                told["opened"] = True
                session.declare_subscriber("**", note, allowed_origin=zenoh.Locality.REMOTE)
                session.liveliness().declare_subscriber("**", note, history=True)
                end = time.monotonic() + PATIENCE
                while time.monotonic() < end:
                    session.put(topics.BASE_TARGET.key, json.dumps({"x": 3.0, "y": 1.0, "theta": 0.0}))
                    session.put(topics.ROBOT_STOP.key, "")
                    for key in ("**", topics.SIM_RESET):
                        seen.extend(str(r.ok.key_expr) for r in session.get(key, timeout=0.5) if r.ok is not None)
        except zenoh.ZError as error:
            told["error"] = str(error)

    worker = threading.Thread(target=attempt, daemon=True)
    worker.start()
    worker.join(2 * PATIENCE + 4)
    print(json.dumps({**told, "seen": sorted(set(seen))}), flush=True)


if __name__ == "__main__":
    main()
