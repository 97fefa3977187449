"""The account of a day: missions by outcome, and the growth of memory and files. Pure."""

import msgspec

SHARE, MEGABYTES = 0.2, 40.0
"""What a process may hold more of at the end than after a fifth of the missions: a share of its memory, and MB."""
DISK = 250.0
"""Most files [MB]: 15 MB of log for each service, pictures, journal and checkpoints."""


class Account(msgspec.Struct):
    """`planned`: missions of the day; `ids`: of all that were accepted; `false`: claims that were not so.

    After each mission: `memory` [MB] of each process that ran, `disk` [MB] of all files.
    """

    planned: int = 0
    ids: dict[str, str] = {}
    outcomes: dict[str, int] = {}
    unheard: int = 0
    false: list[str] = []
    disturbed: list[str] = []
    memory: list[dict[str, float]] = []
    disk: list[float] = []

    def grown(self) -> dict[str, tuple[float, float]]:
        """Memory [MB] of each process after a fifth of the missions and at the end.

        A process that was just being restarted at either is taken where it was next seen before the end, or last.
        """
        fifth = len(self.memory) // 5
        first: dict[str, float] = {}
        last: dict[str, float] = {}
        for sample in self.memory[fifth:]:
            first, last = {**sample, **first}, {**last, **sample}
        return {name: (first[name], mb) for name, mb in last.items()}

    def left_out(self) -> list[str]:
        """The missions and disturbances for which the day was too short."""
        done = sum(self.outcomes.values())
        return [f"{self.planned - done} of {self.planned} missions had no time"] if done < self.planned else []

    def excess(self) -> list[str]:
        """Processes and files that grew beyond their bounds, in words."""
        found = [
            f"{name}: {first:.0f} -> {last:.0f} MB"
            for name, (first, last) in self.grown().items()
            if last > first * (1 + SHARE) + MEGABYTES
        ]
        most = max(self.disk, default=0.0)
        return found + ([f"files of {most:.0f} MB"] if most > DISK else [])

    def lines(self, seconds: float) -> list[str]:
        """The account of so much robot time [s] for people."""
        missions = sum(self.outcomes.values())
        found = [
            f"{seconds / 3600:.2f} h of robot time, {missions} missions: {self.outcomes}; disturbed: {self.disturbed}"
        ]
        if self.disk:
            found.append(f"files: {self.disk[0]:.1f} MB after the first mission, {self.disk[-1]:.1f} MB after the last")
        rows = [f"{name:14}{first:9.0f} {last:9.0f}" for name, (first, last) in self.grown().items()]
        return [*found, f"{'':14}{'a fifth':>9} {'end':>9}  MB", *rows]
