"""`tidybot places` and `tidybot rules`: what people call the parts of their home, and where things belong."""

import argparse

from cli.errors import CliError, near
from cli.link import Link, add_options, fresh_id, linked
from cli.output import show
from common import messages as m
from common import topics

KINDS = ("room", "surface", "place")
ANSWER = 10.0
"""Time [s] for the brain to answer: a step of it, on a machine that is busy."""


def places(args: argparse.Namespace) -> int:
    with linked(args) as link:
        known = link.present(topics.HOUSEHOLD_PARTS).parts
    lines = [
        f"{p.name:28} {p.kind:8} {p.room:16} {'named by you' if p.given else ''}".rstrip()
        for p in sorted(known, key=lambda p: (KINDS.index(p.kind), p.room, p.name))
    ]
    show(args, known, lines)
    return 0


def edit(args: argparse.Namespace) -> int:
    """Ask the brain for the edit that a subcommand stands for."""
    with linked(args) as link:
        part = _part(link, args.part) if args.part else ""
        wish = m.HouseholdEdit(do=args.do, name=" ".join(args.name), part=part, kind=args.kind, id=fresh_id())
        result = link.ask(topics.HOUSEHOLD_EDIT, wish, topics.HOUSEHOLD_EDITED, ANSWER, "the brain")
        show(args, result, [told(wish, result)])
        return 0 if result.ok else 1


def rules(args: argparse.Namespace) -> int:
    with linked(args) as link:
        known = link.present(topics.HOUSEHOLD_EDITS)
    lines = [f"{rule.things:24} -> {' or '.join(rule.to)}" for rule in known.rules]
    none = 'nobody has told a rule; say "mugs go on the shelf", or `tidybot say "mugs go on the shelf"`'
    show(args, known.rules, lines or [none])
    return 0


def _part(link: Link, wanted: str) -> str:
    """A part's name as the home has it.

    Raises:
        CliError: there is none of that name; with the nearest.
    """
    names = [p.name for p in link.present(topics.HOUSEHOLD_PARTS).parts]
    if wanted not in names:
        raise CliError(f"nothing is called {wanted!r}{near(wanted, names)}; `tidybot places` lists all")
    return wanted


def told(edit: m.HouseholdEdit, result: m.EditResult) -> str:
    """The outcome of an edit in words."""
    if not result.ok:
        return f"not done: {result.detail}"
    match edit.do:
        case "name":
            before = f", which was the {result.part}" if result.part and result.part != result.name else ""
            return f"the {result.kind} is called {result.name}{before}"
        case "forget":
            return f"forgotten: {result.name}"
        case _:
            return f"no longer: {result.name} go to the {result.part}"


def register(commands: "argparse._SubParsersAction[argparse.ArgumentParser]") -> None:
    parser = commands.add_parser("places", help="rooms, surfaces and places: list, name, rename, forget")
    parser.set_defaults(run=places)
    actions = parser.add_subparsers(metavar="ACTION")
    one = actions.add_parser("name", help="name the room that the robot is in, or the surface that it stands before")
    one.add_argument("name", nargs="+", help='what it is called, such as "kitchen" or "desk"')
    one.add_argument("--part", help="the part meant, by its present name")
    one.add_argument("--kind", choices=KINDS, default="", help="where the name does not tell")
    one.set_defaults(do="name")
    two = actions.add_parser("rename", help="give a part another name")
    two.add_argument("part", metavar="old")
    two.add_argument("name", nargs=1, metavar="new")
    two.set_defaults(do="name", kind="")
    three = actions.add_parser("forget", help="forget a name that was given")
    three.add_argument("name", nargs="+")
    three.set_defaults(do="forget", part="", kind="")
    tidying = commands.add_parser("rules", help="where things belong, as people told it: list, forget")
    tidying.set_defaults(run=rules)
    choices = tidying.add_subparsers(metavar="ACTION")
    four = choices.add_parser("forget", help="take a rule back, by its things; without them the newest")
    four.add_argument("name", nargs="*", metavar="things", help='such as "mugs"')
    four.set_defaults(do="forget rule", part="", kind="")
    for each in (one, two, three, four):
        each.set_defaults(run=edit)
    for each in (parser, one, two, three, tidying, four):
        each.add_argument("--json", action="store_true", help="as JSON")
        add_options(each)
