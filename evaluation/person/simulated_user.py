"""A person with a wish: says it, listens to what the robot says, and answers its questions.

Pure: sentences of the robot in, sentences of the person out. They know nothing of the bus.
"""

import re
from typing import Literal

from common.scene import Scene
from judge.words import plain

Manner = Literal["correct", "reject", "silent", "agree"]
PATIENCE = 6
"""Answers that the user gives to one command; chosen: more than the robot may ask."""
CORRECTIONS = ("no, the {}", "no, I said the {}", "the {}")
"""Who was not understood says it in other words."""
_HEARD = re.compile(r"^did you say,?\s*(.+?)\??$", re.IGNORECASE)
_AGAIN = re.compile(r"say (?:it|that) again|please repeat|did not (?:hear|understand|catch)|pardon|what did you", re.I)
_IDENTITY = re.compile(r"is (?:that|this) the .+\?$", re.IGNORECASE)
_WHICH = re.compile(r"^(?:which\b|do you mean|the .+ or the .+\?)", re.IGNORECASE)


class SimulatedUser:
    """Wants `command` done with `thing`, by the world's name; `called` are the person's words for it, if others.

    Manners: `correct` a wrong question ("no, the <words>"), `reject` it with "no" and repeat when asked, keep `silent`,
    or `agree` to anything.
    """

    def __init__(self, command: str, thing: str, scene: Scene, manner: Manner = "correct", called: str = "") -> None:
        self._command, self._thing, self._scene, self._manner = command, thing, scene, manner
        self._words = called or thing
        self.answers = 0

    def set_goal(self, command: str, thing: str = "") -> None:
        """Note what was said, and meant, from now on; without a `thing` the one that was wanted before."""
        self._command, self.answers = command, 0
        if thing:
            self._thing = self._words = thing

    def answer(self, sentence: str, about: str = "") -> str:
        """What to say to a sentence of the robot's; "" for nothing. `about`: the object that it shows while it asks."""
        if self._manner == "silent" or self.answers >= PATIENCE:
            return ""
        reply = self._reply(sentence.strip(), about)
        self.answers += bool(reply)
        return reply

    def _reply(self, sentence: str, about: str) -> str:
        if heard := _HEARD.match(sentence):
            if self._manner == "agree" or self._same(heard[1]):
                return "yes"
            if self._manner == "correct" and self._only_the_thing_differs(heard[1]):
                return CORRECTIONS[self.answers % len(CORRECTIONS)].format(self._words)
            return "no"
        if _AGAIN.search(sentence):
            return self._command
        if _IDENTITY.search(sentence) and self._thing:
            return "yes" if self._manner == "agree" or about == self._thing else "no"
        if _WHICH.match(sentence) and self._thing:
            return f"the {self._words}"
        return ""

    def _same(self, heard: str) -> bool:
        return self._canonical(heard) == self._canonical(self._command)

    def _canonical(self, text: str) -> str:
        """A sentence with aliases of objects replaced by their names."""
        words = plain(text)
        for spec in self._scene.objects:
            for alias in sorted(spec.aliases, key=len, reverse=True):
                if " " in alias:
                    words = re.sub(rf"\b{re.escape(plain(alias))}\b", plain(spec.name), words)
        return words

    def _only_the_thing_differs(self, heard: str) -> bool:
        """The robot understood what to do, but with another object."""
        if not self._thing:
            return False
        pattern = re.escape(self._canonical(self._command)).replace(re.escape(plain(self._words)), "(.+)", 1)
        found = re.fullmatch(pattern, self._canonical(heard))
        names = {plain(n) for o in self._scene.objects for n in (o.name, *o.aliases)}
        return found is not None and bool(found.groups()) and found[1] in names
