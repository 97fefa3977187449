"""`tidybot teach` and `forget`: names for things, beside what perception calls them."""

import argparse

from cli.errors import CliError
from cli.link import Link, fresh_id, linked, robot_command
from cli.output import show
from common import messages as m
from common import topics

ANSWER = 20.0
"""Time [s] for perception to look at the thing and to answer: three pictures at a tenth of real time."""


def teach(args: argparse.Namespace) -> int:
    name = " ".join(args.name)
    with linked(args) as link:
        if not name:
            return _list(link, args)
        label = _label(link, args.label) if args.label else ""
        return _ask(link, m.TeachRequest(name=name, id=fresh_id(), label=label), args)


def forget(args: argparse.Namespace) -> int:
    with linked(args) as link:
        return _ask(link, m.TeachRequest(name=" ".join(args.name), id=fresh_id(), forget=True), args)


def _label(link: Link, wanted: str) -> str:
    """The label as perception has it.

    Raises:
        CliError: it knows no such thing; with the labels that it knows.
    """
    world = link.latest(topics.WORLD_OBJECTS)
    labels = sorted(o.label for o in world.objects) if world is not None else []
    if wanted not in labels:
        raise CliError(f"perception knows no {wanted!r}, but: {', '.join(labels) or 'nothing so far'}")
    return wanted


def _ask(link: Link, request: m.TeachRequest, args: argparse.Namespace) -> int:
    result = link.ask(topics.TEACH, request, topics.TAUGHT, ANSWER, "perception")
    done = f"forgotten: {result.name}" if request.forget else f"the {result.label} is the {result.name}"
    show(args, result, [done if result.ok else f"not done: {result.detail}{_remedy(result)}"])
    return 0 if result.ok else 1


def _remedy(result: m.TeachResult) -> str:
    match result.code:
        case "AMBIGUOUS":
            return "; say which with --label"
        case "NOT_SEEN":
            return "; put it on something within 2 m in front of the robot, or name it with --label"
        case "UNKNOWN_NAME":
            return "; `tidybot teach` lists the names"
        case _:
            return ""


def _list(link: Link, args: argparse.Namespace) -> int:
    known = link.present(topics.HOUSEHOLD_NAMES).names
    lines = [
        f"{o.name:24} {o.colour} {o.kind}, {' x '.join(f'{v * 100:.0f}' for v in o.size)} cm, {o.views} views"
        for o in known
    ]
    show(args, known, lines or ['no names so far; put a thing before the robot and `tidybot teach "vitamin box"`'])
    return 0


def register(commands: "argparse._SubParsersAction[argparse.ArgumentParser]") -> None:
    parser = robot_command(
        commands, teach, "give the thing before the robot a name; without a name list them", json=True
    )
    parser.add_argument("name", nargs="*", help='what it is called, such as "vitamin box"')
    parser.add_argument("--label", help="the thing meant, as `tidybot topic echo world/objects` names it")
    parser = robot_command(commands, forget, "forget a taught name", json=True)
    parser.add_argument("name", nargs="+")
