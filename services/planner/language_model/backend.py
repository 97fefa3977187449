"""Who plans: the grammar, the language model, or whichever of the two is there."""

import msgspec

from common import messages as m
from common import topics
from common.bus.port import Io, Job
from common.runtime import StartError
from services.planner.config import PlannerConfig
from services.planner.language_model.endpoint import MISSING, Breaker, Found, installed, look, model_of
from services.planner.language_model.llm import Llm, prepare

LOOK_SECONDS = 0.2
"""Modelled time of a look in lockstep [s]; none is made there with `auto`, see `Backend`."""
IN_LOCKSTEP = "in lockstep a seed repeats, which no model does; planner.backend = llm asks one all the same"


def find(url: str, key: str) -> Found:
    """A look at the endpoint, and the client ready for the first question. Runs in the worker."""
    found = look(url, key)
    if found.good:
        prepare()
    return found


class Backend:
    """`llm` is the model to ask now, None while the grammar plans.

    With `backend = "auto"` the worker looks for the endpoint now and then, so that a request never waits for nobody.
    In lockstep it stays with the grammar: a seed repeats to the last bit there, whatever else runs on the machine.

    Raises:
        StartError: `backend = "llm"` without the client's package.
    """

    def __init__(self, config: PlannerConfig, io: Io) -> None:
        self._config, self._io = config, io
        self._breaker = Breaker()
        self._look: Job[Found] | None = None
        self._model = ""
        self._shown: m.PlannerStatus | None = None
        self.llm: Llm | None = None
        if config.backend == "llm":
            if not installed():
                raise StartError(f"planner.backend = llm: {MISSING}")
            io.submit(prepare)
            self._take_on(config.llm_model, "")
        elif config.backend == "grammar":
            self._show("planner.backend = grammar")
        elif io.lockstep:
            self._show(IN_LOCKSTEP)
        elif not installed():
            self._show(MISSING)
        else:
            self._show(self._breaker.found.why)
        self._looks = config.backend == "auto" and not io.lockstep and installed()

    def step(self, now: float, idle: bool) -> None:
        """Look for the endpoint when that is due; `idle`: no question is under way in the one worker."""
        if self._look is not None and self._look.poll(now):
            self._breaker.looked(self._look.result(), now)
            self._look = None
            self._choose()
        elif self._looks and idle and self._look is None and self._breaker.due(now):
            config = self._config
            self._look = self._io.submit(find, config.llm_url, config.llm_key, seconds=LOOK_SECONDS)

    def failed(self, why: str, now: float) -> None:
        """The model gave no answer."""
        if self._looks:
            self._breaker.failed(why, now)
            self._choose()

    def answered(self) -> None:
        """The model gave an answer, good or bad."""
        self._breaker.answered()

    def _choose(self) -> None:
        found = self._breaker.found
        if not found.good:
            self.llm = None
            self._show(found.why)
            return
        model = model_of(self._config.llm_model, found)
        if self.llm is None or model != self._model:
            self._take_on(model, f"one of {len(found.models)}" if len(found.models) > 1 else "")

    def _take_on(self, model: str, detail: str) -> None:
        self._model = model
        self.llm = Llm(msgspec.structs.replace(self._config, llm_model=model))
        self._show(detail)

    def _show(self, detail: str) -> None:
        """On `planner/status` and in the log, once for each change."""
        backend: m.PlannerBackend = "llm" if self.llm is not None else "grammar"
        model, url = self._model if self.llm is not None else "", self._config.llm_url
        status = m.PlannerStatus(backend=backend, model=model, url=url, detail=detail)
        if status != self._shown:
            self._shown = status
            self._io.publish(topics.PLANNER_STATUS, status)
            self._io.log.info(f"plans by {backend}", model=model, url=url, detail=detail)
