"""`tidybot explain ID`: one mission as a timeline: what was heard, planned, seen and done, and why it failed."""

import argparse
import textwrap
from pathlib import Path
from typing import Any

from cli.errors import CliError, near
from cli.link import Link, linked, robot_command
from cli.missions.journal import date_of
from cli.output import show
from common import topics

WIDTH = 118
"""Columns of the timeline."""
WORDS = {"failed": "FAILED", "state": ""}
"""What stands before an entry, where that is not its kind; transitions carry their state instead."""


def told(record: dict[str, Any]) -> str:
    """The timeline: seconds since the mission began, state, what happened and the evidence for it."""
    lines = [f"mission {record['id']}: {record['command']!r}, begun {date_of(record)}", ""]
    began = record["started"]
    state = ""
    for entry in record["entries"]:
        shown = entry["state"] if entry["state"] != state else ""
        state = entry["state"]
        word = WORDS.get(entry["kind"], entry["kind"])
        cause = entry["cause"] if entry["cause"] != state else ""
        text = f"{word}: {cause}" if word and not cause.startswith(f"{word}: ") else cause
        shown_by = f"picture {entry['picture']}" if entry.get("picture") else ""
        text = " - ".join(part for part in (text, entry["evidence"], shown_by) if part)
        head = f"{max(0.0, entry['t'] - began):8.1f} s  {shown:11}  "
        lines += textwrap.wrap(text, WIDTH, initial_indent=head, subsequent_indent=" " * len(head)) or [head.rstrip()]
    lines.append("")
    if record["outcome"]:
        reason = f": {record['reason']}" if record["reason"] else ""
        lines.append(f"{record['outcome']} after {record['ended'] - began:.1f} s, {record['steps']} goals{reason}")
    else:
        lines.append("under way")
    return "\n".join(lines)


def pictures(link: Link, record: dict[str, Any]) -> list[tuple[float, str, str]]:
    """Pictures that the mission rests on: seconds since it began, caption, JPEG in base64."""
    found = []
    for entry in record["entries"]:
        name = entry.get("picture")
        jpeg = link.query(topics.BRAIN_MISSIONS, {"picture": name}) if name else None
        if jpeg:
            found.append((max(0.0, entry["t"] - record["started"]), entry["evidence"], str(jpeg)))
    return found


def mission_record(link: Link, mission_id: str) -> dict[str, Any]:
    """A mission as the brain's journal tells it.

    Raises:
        CliError: the brain does not answer, or knows no such mission.
    """
    record: dict[str, Any] | None = link.query(topics.BRAIN_MISSIONS, {"id": mission_id})
    if record is not None:
        return record
    known = [row["id"] for row in link.query(topics.BRAIN_MISSIONS)]
    if not known:
        raise CliError("there has been no mission yet")
    raise CliError(f"no mission {mission_id!r}{near(mission_id, known)}; `tidybot missions` lists all")


def explain(args: argparse.Namespace) -> int:
    with linked(args) as link:
        record = mission_record(link, args.id)
        seen = pictures(link, record) if args.html else []
    if args.html:
        # Jinja2 is not for every command to load.
        from common.mission_log.timeline import page

        try:
            args.html.write_text(page(record, seen), encoding="utf-8")
        except OSError as error:
            raise CliError(f"{args.html}: {error.strerror}") from None
        print(args.html)
        return 0
    show(args, record, [told(record)])
    return 0


def register(commands: "argparse._SubParsersAction[argparse.ArgumentParser]") -> None:
    parser = robot_command(commands, explain, "one mission as a timeline, and why it failed", json=True)
    parser.add_argument("id", nargs="?", default="last", help="a mission's id, or last (the default)")
    parser.add_argument("--html", type=Path, metavar="FILE", help="write the timeline as a picture, one HTML file")
