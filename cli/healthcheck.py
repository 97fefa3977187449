"""`python -m cli.healthcheck <name>`: exit 0 when that service answers on the bus; for containers."""

import os
import sys

from cli.link import Link
from common import bus, topics


def main() -> int:
    if len(sys.argv) != 2:
        print("usage: python -m cli.healthcheck <service>|router", file=sys.stderr)
        return 2
    name = sys.argv[1]
    try:
        connect = os.environ.get("TIDYBOT_CONNECT") or bus.default_connect()
        with bus.session(connect, os.environ.get("TIDYBOT_NAMESPACE", ""), name=name) as session:
            if name == "router" or bus.fetch(session, topics.HEALTH_KEY.format(name=name)):
                return 0
            others = ", ".join(sorted(Link(session, connect).alive())) or "nobody"
    except bus.BusError as error:
        print(error, file=sys.stderr)
        return 1
    print(f"{name} does not answer; alive: {others}", file=sys.stderr)
    return 1


if __name__ == "__main__":
    sys.exit(main())
