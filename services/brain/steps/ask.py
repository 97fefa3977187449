"""Leaves that ask the person something. An answer counts from the first word of the question on."""

from collections.abc import Callable

from py_trees.common import Status

from common import messages as m
from common.language import offers
from services.brain.language.choosing import chosen
from services.brain.language.corrections import answered, corrected
from services.brain.language.dialogue import Reply, reply
from services.brain.mission.channel import Result
from services.brain.mission.context import Context
from services.brain.mission.mission import Failure
from services.brain.steps.hear_speech import HearSpeech
from services.brain.steps.leaf import Say


class AskQuestion(Say):
    """Says the question, not before the pause that a speech failure costs is over; an answer cuts both short."""

    def __init__(self, node_id: str, ctx: Context, text: Callable[[], str]) -> None:
        super().__init__(node_id, ctx, text)
        self._asked = text
        self._asking = False

    def initialise(self) -> None:
        ctx = self.ctx
        self._asking = ctx.now >= ctx.voice.listen_after
        if self._asking:
            ctx.voice.reply = None
            self._ask()
        else:
            ctx.show_state("CONFIRMING", self._asked(), "pause after a speech failure")

    def _ask(self) -> None:
        self._asking = True
        self.ctx.show_state("CONFIRMING", self._asked())
        super().initialise()

    def update(self) -> Status:
        ctx = self.ctx
        if ctx.voice.reply is not None:
            if self._asking:
                ctx.send_only(ctx.peers.speech, "cancel")
            return Status.SUCCESS
        if not self._asking:
            if ctx.now < ctx.voice.listen_after:
                return Status.RUNNING
            self._ask()
        return super().update()


class HearAnswer(HearSpeech):
    """Listens for the answer, unless it came while the question was being said."""

    def __init__(self, node_id: str, ctx: Context) -> None:
        super().__init__(node_id, ctx, ctx.peers.speech, state="CONFIRMING", timeout=ctx.config.answer_timeout)

    def update(self) -> Status:
        given = self.ctx.voice.take_reply()
        if given is None:
            return super().update()
        self.need_not_listen()
        return self.succeed(Result("ok", message=given))

    def succeed(self, result: Result) -> Status:
        assert isinstance(result.message, m.SpeechResult)
        text = result.message.text
        return self.heard(*reply(text, self.asked()), text)

    def asked(self) -> str:
        """The command that was asked about, "" where the question is another one."""
        return ""

    def heard(self, kind: Reply, rest: str, text: str) -> Status:
        """What becomes of an answer, by its kind and what it says besides."""
        raise NotImplementedError

    def fail_with(self, failure: Failure) -> Status:
        """Speech has failed: the same pause before it listens again as in the fetch pipeline."""
        self.pause()
        return super().fail_with(failure)

    def refuse(self, code: str, detail: str, spoken: str) -> Status:
        """Speech has worked, but what was heard is not the answer."""
        return self.ctx.fail("CONFIRMING", code, detail, spoken)


class HearConfirmation(HearAnswer):
    """The person's answer to "did you say"; SUCCESS once the command stands."""

    def step(self) -> str:
        return question(self.ctx)

    def spoken(self) -> str:
        return "I did not hear an answer."

    def asked(self) -> str:
        return self.ctx.mission.command

    def heard(self, kind: Reply, rest: str, text: str) -> Status:
        mission = self.ctx.mission
        self.ctx.note(f"reply: {kind}", text, "heard")
        self.feedback_message = kind
        if kind == "cancel":
            return self.refuse("CANCELLED", "", "All right, I will do nothing.")
        if kind == "yes" and not mission.heard.repeat:
            return Status.SUCCESS
        if kind == "correction":
            mission.command = rest if mission.heard.repeat else corrected(mission.command, rest, self.ctx.io.household)
            mission.heard.repeat = False
        elif kind == "no":
            mission.heard.repeat = True
        return self.refuse("NOT_CONFIRMED", "", "I did not understand what I should do.")


class HearChoice(HearAnswer):
    """Which of several things was meant; SUCCESS once the answer names one of them."""

    def __init__(self, node_id: str, ctx: Context, item: str) -> None:
        super().__init__(node_id, ctx)
        self._item = item

    def step(self) -> str:
        return which(self.ctx)

    def spoken(self) -> str:
        return f"I do not know which {self._item} you mean."

    def heard(self, kind: Reply, rest: str, text: str) -> Status:
        mission, known = self.ctx.mission, self.ctx.objects
        label = None if kind == "cancel" else chosen(text, mission.search.options, known, self.ctx.io.household)
        if label is None and kind in ("no", "cancel"):
            return self.refuse("CANCELLED", "", "All right, I will do nothing.")
        if label is None:
            return self.refuse("NOT_CONFIRMED", text, self.spoken())
        mission.search.chosen[self._item] = label
        named = next((o for o in known if o.label == label), None)
        if named is not None and named.id:
            mission.search.confirmed[self._item] = named.id
        self.ctx.note(f"meant: {label}", text)
        return Status.SUCCESS

    def fail_with(self, failure: Failure) -> Status:
        """Nobody answers: nobody is asked from the next view again."""
        self.ctx.mission.search.unanswered = True
        return super().fail_with(failure)


class HearPerson(HearAnswer):
    """The person's answer to a client's question; it ends the mission, and is its outcome's reason."""

    def step(self) -> str:
        return self.ctx.mission.command

    def spoken(self) -> str:
        return "I did not hear an answer."

    def heard(self, kind: Reply, rest: str, text: str) -> Status:
        if kind == "cancel":
            return self.refuse("CANCELLED", "", "All right.")
        self.ctx.note(f"answered: {text}", self.ctx.mission.command, "heard")
        self.ctx.end_mission("delivered", text)
        self.ctx.show_state("COMPLETED", detail=text)
        return Status.SUCCESS


class HearMeaning(HearAnswer):
    """Whether the suggested command is what was meant; SUCCESS once there is a command to plan anew."""

    def step(self) -> str:
        return meaning(self.ctx)

    def spoken(self) -> str:
        return "I did not hear whether you meant that, so I do nothing."

    def asked(self) -> str:
        return self.ctx.mission.planning.suggestion

    def heard(self, kind: Reply, rest: str, text: str) -> Status:
        mission = self.ctx.mission
        self.ctx.note(f"reply: {kind}", text, "heard")
        planning, mission.failure = mission.planning, None
        if kind == "cancel":
            return self.refuse("CANCELLED", "", "All right, I will do nothing.")
        if kind == "no":
            planning.rejected = m.RejectedPlan(steps=[], reason=planning.rejected.reason if planning.rejected else "")
        else:
            mission.command = (
                planning.suggestion if kind == "yes" else answered(planning.suggestion, rest, self.ctx.io.household)
            )
            planning.rejected = None
        planning.suggestion = ""
        return Status.SUCCESS


def meaning(ctx: Context) -> str:
    """The question about a command that was not understood for sure."""
    return f"Do you mean: {ctx.mission.planning.suggestion}?"


def question(ctx: Context) -> str:
    """The question that confirms a command."""
    return "Please say it again." if ctx.mission.heard.repeat else f"Did you say {ctx.mission.command}?"


def which(ctx: Context) -> str:
    """The question between several things."""
    return offers.which(ctx.mission.search.options)
