"""`python -m cli.healthcheck <name>`: exit 0 when that service shows its liveliness token; for containers.

Ten of these run every few seconds, so it imports no more than the bus.
"""

import os
import sys

from common import topics
from common.bus.session import BusError, default_connect, open_session

PATIENCE = 3.0
"""Time [s] for the router's answer; below the limit of the compose file's health checks."""


def main() -> int:
    if len(sys.argv) != 2:
        print("usage: python -m cli.healthcheck <service>|router", file=sys.stderr)
        return 2
    name = sys.argv[1]
    try:
        connect = os.environ.get("TIDYBOT_CONNECT") or default_connect()
        with open_session(connect, os.environ.get("TIDYBOT_NAMESPACE", ""), name=name) as session:
            tokens = session.liveliness().get(topics.ALIVE_KEY.format(name="*"), timeout=PATIENCE)
            alive = {str(token.ok.key_expr).split("/")[1] for token in tokens if token.ok is not None}
    except BusError as error:
        print(error, file=sys.stderr)
        return 1
    if name == "router" or name in alive:
        return 0
    print(f"{name} shows no token; alive: {', '.join(sorted(alive)) or 'nobody'}", file=sys.stderr)
    return 1


if __name__ == "__main__":
    sys.exit(main())
