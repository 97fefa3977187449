"""`tidybot missions`: lists past missions and their outcomes from the brain's journal."""

import argparse
from datetime import datetime
from typing import Any

from cli.link import linked, robot_command
from cli.output import show
from common import topics


def date_of(row: dict[str, Any]) -> str:
    """When a mission began, on the host's calendar."""
    date = float(row.get("date") or 0.0)
    return f"{datetime.fromtimestamp(date).astimezone():%Y-%m-%d %H:%M:%S}" if date else "-"


def listed(rows: list[dict[str, Any]]) -> str:
    """One line a mission: id, begin, outcome, robot seconds it took, command, reason."""
    width = max((len(row["id"]) for row in rows), default=0)
    lines = []
    for row in rows:
        seconds = f"{row['ended'] - row['started']:.1f} s" if row["outcome"] else ""
        reason = f"  ({row['reason']})" if row["reason"] else ""
        outcome = row["outcome"] or "under way"
        lines.append(f"{row['id']:{width}}  {date_of(row)}  {outcome:9}  {seconds:>8}  {row['command']}{reason}")
    return "\n".join(lines)


def missions(args: argparse.Namespace) -> int:
    with linked(args) as link:
        found = link.query(topics.BRAIN_MISSIONS)
    show(args, found, [listed(found) or "no missions yet"])
    return 0


def register(commands: "argparse._SubParsersAction[argparse.ArgumentParser]") -> None:
    robot_command(commands, missions, "all missions and how they ended; `explain` tells of one", json=True)
