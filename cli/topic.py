"""`tidybot topic list|echo|hz|pub`: look at the bus, and put a message on it."""

import argparse
import queue
import re
import statistics
from collections import defaultdict
from itertools import pairwise
from typing import Any

import msgspec
import zenoh

from cli.errors import CliError, near
from cli.link import Link, known_keys, linked, robot_command
from cli.output import show
from cli.payload import line
from common import messages as m
from common import topics
from common.bus import codec, delivery
from common.time.clock import monotonic, sleep
from common.topic import Topic


def matches(expression: str, key: str) -> bool:
    """Does a key expression with `*` and `**` match a key?"""
    try:
        return bool(zenoh.KeyExpr(expression).includes(zenoh.KeyExpr(key)))
    except zenoh.ZError:
        return False


def check_key(expression: str) -> str:
    """The expression itself, when some key of the project matches it.

    Raises:
        CliError: none does; names the nearest keys.
    """
    keys = known_keys()
    dynamic = topics.HEALTH.of("sim"), topics.ALIVE_KEY.format(name="sim"), topics.LOG.of("sim")
    if topics.type_of(expression) is not None or any(matches(expression, k) for k in (*keys, *dynamic)):
        return expression
    raise CliError(f"no topic {expression!r}{near(expression, keys)}")


def list_topics(args: argparse.Namespace) -> int:
    rows = [
        {
            "key": t.key,
            "type": t.type.__name__,
            "writers": list(t.writers),
            "rate": t.rate,
            "keep": t.keep,
            "latched": t.latched,
            "encoding": "msgpack" if t.binary else "json",
        }
        for t in topics.TABLE
    ]
    lines = [f"{'key':28} {'payload':20} {'written by':22} {'rate':>6} {'keep':6} {'latched':7} encoding"]
    for t, r in zip(topics.TABLE, rows, strict=True):
        rate, latched = f"{t.rate:g}" if t.rate else "event", "yes" if t.latched else ""
        writers = ", ".join(t.writers)
        lines.append(f"{t.key:28} {r['type']:20} {writers:22} {rate:>6} {t.keep:6} {latched:7} {r['encoding']}")
    show(args, rows, [*lines, "and of every service: service/<name>/health, service/<name>/alive (token), log/<name>"])
    return 0


def echo(args: argparse.Namespace) -> int:
    key = check_key(args.key)
    inbox: queue.SimpleQueue[tuple[str, bytes]] = queue.SimpleQueue()
    shown = 0
    with linked(args) as link:
        seen: dict[str, bytes] = {}
        kept = link.session.declare_subscriber(key, lambda s: inbox.put((str(s.key_expr), s.payload.to_bytes())))
        for one, payload in sorted(delivery.fetch(link.session, key, timeout=1.0).items()):
            if topics.type_of(one) is not None:
                seen[one] = payload
                inbox.put((one, payload))
        end = monotonic() + args.timeout if args.timeout else float("inf")
        while monotonic() < end and not (args.count and shown >= args.count):
            try:
                one, payload = inbox.get(timeout=0.2)
            except queue.Empty:
                continue
            print(line(one, payload) if args.json and one == args.key else f"{one}  {line(one, payload)}", flush=True)
            shown += 1
        kept.undeclare()
    if args.timeout and not shown:
        raise CliError(f"nothing on {key} within {args.timeout:g} s")
    return 0


def hz(args: argparse.Namespace) -> int:
    key = check_key(args.key)
    arrivals: dict[str, list[tuple[float, int]]] = defaultdict(list)
    with linked(args) as link:
        kept = link.session.declare_subscriber(
            key, lambda s: arrivals[str(s.key_expr)].append((monotonic(), len(s.payload)))
        )
        rounds = 0
        while not args.count or rounds < args.count:
            sleep(args.window)
            rounds += 1
            taken = {one: arrivals.pop(one) for one in sorted(arrivals)}
            if not taken:
                print(f"{key}: nothing in {args.window:g} s", flush=True)
            for one, stamps in taken.items():
                print(rate_line(one, stamps), flush=True)
        kept.undeclare()
    return 0


def rate_line(key: str, stamps: list[tuple[float, int]]) -> str:
    """`key  99.8 Hz  period mean 10.0 ms, max 12.1, sd 0.4  40.1 kB/s`."""
    gaps = [1000 * (b[0] - a[0]) for a, b in pairwise(stamps)]
    if not gaps or stamps[-1][0] <= stamps[0][0]:
        return f"{key}  {len(stamps)} message{'s' if len(stamps) > 1 else ''}"
    span = stamps[-1][0] - stamps[0][0]
    volume = sum(size for _, size in stamps[1:]) / span / 1000
    mean, spread = statistics.fmean(gaps), statistics.pstdev(gaps)
    return (
        f"{key}  {len(gaps) / span:.1f} Hz  period mean {mean:.1f} ms, max {max(gaps):.1f}, sd {spread:.1f}  "
        f"{volume:.1f} kB/s"
    )


def pub(args: argparse.Namespace) -> int:
    key = check_key(args.key)
    if key not in topics.BY_KEY:
        raise CliError(f"{key!r} is not one topic to publish on{near(key, known_keys())}")
    topic = topics.BY_KEY[key]
    message = compose(topic, args.value)
    with linked(args) as link:
        for number in range(args.count):
            if number:
                sleep(1 / args.rate)
            link.send(topic, message)
        _note(link)
    print(f"{key}  {line(key, codec.encode(topic, message))}")
    return 0


def _note(link: Link) -> None:
    """Let the message leave before the session closes: the answer comes back after it has gone out."""
    delivery.fetch(link.session, topics.HEALTH.key, timeout=1.0)


def compose(topic: Topic[Any], words: list[str]) -> m.Message:
    """A message from a JSON object, `field=value` words, or bare text where the topic takes text.

    Raises:
        CliError: an unknown field, a wrong type, or a missing field.
    """
    names = [f.name for f in msgspec.structs.fields(topic.type)]
    text = " ".join(words)
    pairs = [re.fullmatch(r"(\w+)=(.*)", w, re.DOTALL) for w in words]
    try:
        if text.lstrip().startswith("{"):
            values = msgspec.json.decode(text, type=dict[str, Any])
        elif words and all(pairs) and (not topic.text or any(p and p[1] in names for p in pairs)):
            values = {p[1]: _value(p[2]) for p in pairs if p}
        elif topic.text:
            decoded: m.Message = codec.decode(topic, text.encode())
            return decoded
        else:
            raise CliError(f"{topic.key} takes a JSON object or field=value ...; fields: {', '.join(names)}")
        for name in values:
            if name not in names:
                raise CliError(f"{topic.key} has no field {name!r}{near(name, names)}")
        message: m.Message = msgspec.convert(values, topic.type, strict=False)
        return message
    except (msgspec.DecodeError, codec.DecodeError) as error:
        raise CliError(f"{topic.key} carries {topic.type.__name__}: {error}; fields: {', '.join(names)}") from None


def _value(text: str) -> Any:
    try:
        return msgspec.json.decode(text)
    except msgspec.DecodeError:
        return text


def positive(text: str) -> float:
    value = float(text)
    if value <= 0:
        raise ValueError
    return value


def register(commands: "argparse._SubParsersAction[argparse.ArgumentParser]") -> None:
    parser = commands.add_parser("topic", help="look at the bus: list, echo, hz, pub")
    actions = parser.add_subparsers(required=True, metavar="ACTION")
    one = actions.add_parser("list", help="every topic with payload, writers and rate")
    one.add_argument("--json", action="store_true", help="as JSON")
    one.set_defaults(run=list_topics)
    one = robot_command(actions, echo, "print what is and comes on a key; wildcards: 'brain/**'")
    one.add_argument("key")
    one.add_argument("--count", "-n", type=int, default=0, help="end after so many messages")
    one.add_argument("--timeout", type=float, default=0.0, metavar="S", help="end after so many seconds")
    one.add_argument("--json", action="store_true", help="the payload alone, without the key")
    one = robot_command(actions, hz, "rate, period and volume of a key")
    one.add_argument("key")
    one.add_argument("--window", type=positive, default=2.0, metavar="S", help="seconds a line (default %(default)s)")
    one.add_argument("--count", "-n", type=int, default=0, help="end after so many lines")
    one = robot_command(actions, pub, "publish: JSON, field=value ..., or bare text")
    one.add_argument("key")
    one.add_argument("value", nargs="+")
    one.add_argument("--count", "-n", type=int, default=1)
    one.add_argument("--rate", type=positive, default=10.0, metavar="HZ", help="with --count (default %(default)s)")
