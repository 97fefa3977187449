"""Was it really delivered? Judged by `sim/truth` alone, never by what the robot says."""

from typing import Any

import msgspec


class Verdict(msgspec.Struct):
    delivered: bool
    why: str


class Witness:
    """Watches one object from before the command to after the mission. `delivery`: where it belongs."""

    MOVED = 0.3

    def __init__(self, name: str, delivery: str, before: dict[str, Any]) -> None:
        self._name, self._delivery = name, delivery
        self._start = before["objects"][name]
        self.lifted = False

    def look(self, truth: dict[str, Any]) -> None:
        """A sample on the way."""
        if truth["holding"] == self._name:
            self.lifted = True

    def judge(self, truth: dict[str, Any], later: dict[str, Any]) -> Verdict:
        """After the mission; `later` is a second look that shows the object at rest."""
        name, now = self._name, later["objects"][self._name]
        still = _distance(truth["objects"][name]["position"], now["position"]) < 0.005
        moved = _distance(self._start["position"], now["position"]) > self.MOVED
        faults = [
            text
            for wrong, text in (
                (not self.lifted, "it was never seen in the air between the pads"),
                (later["holding"] == name, "it is still held"),
                (now["touching_gripper"], "it touches the gripper"),
                (now["on"] != self._delivery, f"it is on {now['on'] or 'nothing'}, not on {self._delivery}"),
                (not moved and self._start["on"] != self._delivery, "it did not move"),
                (not still, "it is not at rest"),
            )
            if wrong
        ]
        x, y, z = now["position"]
        where = f"the {name} rests on {now['on'] or 'nothing'} at ({x:.2f}, {y:.2f}, {z:.2f})"
        return Verdict(not faults, "; ".join(faults) or where)


def _distance(a: list[float], b: list[float]) -> float:
    return float(sum((p - q) ** 2 for p, q in zip(a, b, strict=True)) ** 0.5)
