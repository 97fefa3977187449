"""What people say to a robot at work: a question is answered beside the mission, a command waits or takes its place.

And what speech could make nothing of, of a robot at rest.
"""

import msgspec

from common import messages as m
from common import topics
from common.language.indirect import indirect
from common.language.meaning import asks_for
from common.language.normalise import DETERMINERS
from common.language.wording import COURTESIES
from services.brain.language.dialogue import by_wording
from services.brain.language.interjection import Interjection, interjection
from services.brain.mission.context import Context
from services.brain.mission.voice import refused

MAX_QUEUED = 5
"""Commands that wait (chosen: more nobody remembers)."""
ANSWER_WITHIN = 10.0
"""s until a question that the planner has not answered is given up (chosen: far above what an answer takes)."""


class Asides:
    """The questions under way beside a mission, one at a time; the queue is the mission's, so that it is on disk."""

    def __init__(self, ctx: Context) -> None:
        self._ctx = ctx
        self._waiting: m.VoiceCommand | None = None
        self._asked = ""
        self._since = 0.0
        self._unclear = False

    def weigh(self, words: m.VoiceCommand) -> None:
        """Find out whether what speech takes for no command is one for the planner; nothing of it is done unasked."""
        ctx = self._ctx
        if ctx.config.pipeline == "vla" and ctx.state in m.OPEN_STATES and self._waiting is None:
            self._waiting, self._asked, self._since, self._unclear = words, "", ctx.now, True
        else:
            ctx.say(m.NOT_UNDERSTOOD)

    def hear(self, command: m.VoiceCommand) -> Interjection | None:
        """Take what was said while a mission is under way; an interjection that has to interrupt it is given back."""
        if asks_for(command.text, "yes", "no", "continue", *COURTESIES):
            return None
        said = interjection(command.text, self._ctx.mission.command)
        match said.kind:
            case "queue":
                self._queue(command, said.text)
            case "encouragement":
                self.speak("I am at it.")
            case "idle":
                self._ctx.note("not meant for me", command.text)
            case "aside":
                self._waiting, self._asked, self._since, self._unclear = command, "", self._ctx.now, False
            case _:
                return said
        return None

    def step(self) -> None:
        """Send the question once the planner is free; give up after a while."""
        ctx, waiting = self._ctx, self._waiting
        if waiting is None:
            return
        if ctx.now - self._since > ANSWER_WITHIN:
            self._waiting = None
            if self._unclear:
                ctx.say(m.NOT_UNDERSTOOD)
            else:
                self.speak("I cannot answer that now. Please ask me again.")
        elif not self._asked and not ctx.peers.planner.outstanding:
            self._asked = ctx.mission.next_goal()
            request = m.PlanRequest(
                id=self._asked,
                command=waiting.text,
                world=ctx.known_world(),
                history=ctx.history(at_work=not self._unclear),
                alternatives=waiting.alternatives if self._unclear else [],
            )
            ctx.peers.planner.send_only(topics.PLAN_REQUEST, request)

    def answered(self, plan: m.ActionPlan) -> bool:
        """True for the answer to a question of ours: words are spoken, what takes more than words waits its turn."""
        if not self._asked or plan.request_id != self._asked:
            return False
        command, self._waiting, self._asked = self._waiting, None, ""
        if self._unclear:
            self._weighed(command, plan)
        elif command is not None and plan.steps and any(s.action != "say" for s in plan.steps):
            self._queue(command, command.text)
        elif plan.steps:
            self.speak(" ".join(s.text for s in plan.steps))
        else:
            self.speak(refused("answer", plan.detail or "I do not understand it"))
        return True

    def _weighed(self, command: m.VoiceCommand | None, plan: m.ActionPlan) -> None:
        """Ask about the transcription for which there is a plan, or about what the planner takes it for.

        Of words that ask for what cannot be done, such as putting something on what nobody knows, the reason is said.
        """
        ctx = self._ctx
        if command is None or ctx.mission.active or ctx.voice.command is not None:
            return
        if plan.suggestion or plan.steps:
            text = plan.suggestion or command.text
            ctx.voice.command = msgspec.structs.replace(command, text=text, confidence=0.0, alternatives=[])
        elif plan.detail and not plan.detail.startswith(m.SENSELESS):
            self.speak(refused("do", plan.detail))
        else:
            ctx.say(m.NOT_UNDERSTOOD)

    def speak(self, text: str) -> None:
        """Say something beside the mission."""
        ctx = self._ctx
        ctx.note("said aside", text)
        ctx.say(text)

    def _queue(self, command: m.VoiceCommand, text: str) -> None:
        queued = self._ctx.mission.queued
        if len(queued) >= MAX_QUEUED:
            self.speak(f"I have {len(queued)} more things to do already. Please tell me again later.")
            return
        queued.append(msgspec.structs.replace(command, text=text, alternatives=[]))
        when, turned = "next" if len(queued) == 1 else "later", indirect(text)
        self.speak(f"{when.capitalize()} I will {turned}." if turned else f"I will do that {when}: {text}.")

    def replaced(self, text: str) -> None:
        """Say what is done instead of what was under way."""
        thing = by_wording(text)[1]
        if turned := indirect(text):
            self.speak(f"All right, I will {turned} instead.")
        elif thing.split()[:1] and thing.split()[0] in DETERMINERS:
            self.speak(f"All right, {thing} instead.")
        else:
            self.speak("All right, that instead.")
