"""Physical faults, injected into MuJoCo; each reports from the state of physics whether it took effect.

No message says that they are there: `with_physical_faults` returns a class in the
simulation's place whose every step they follow. No service can reach them: nothing below `services/` imports
`evaluation`.
"""

from typing import Any

from common import topics
from evaluation.case import Case
from evaluation.faults.messages import faulty
from evaluation.faults.physical.fault import Kind, PhysicalFault
from evaluation.faults.physical.injector import Injector
from evaluation.faults.physical.jam import Jam
from evaluation.faults.physical.kidnap import Kidnap
from evaluation.faults.physical.shove import Shove
from evaluation.faults.physical.slip import Slip
from evaluation.faults.physical.unfit import Heavy, InTheWay, Wide
from evaluation.faults.reports import FaultReport, Reporter

INJECTORS: dict[Kind, type[Injector]] = {
    "shove": Shove, "slip": Slip, "jam": Jam, "heavy": Heavy, "wide": Wide, "obstacle": InTheWay,
    "kidnap": Kidnap,
}  # fmt: skip


def with_physical_faults(kind: Any, faults: tuple[PhysicalFault, ...], report: Reporter) -> Any:
    """The simulation's class with the faults in its world; the class itself when there are none."""
    if not faults:
        return kind

    told = topics.BRAIN_STATE

    class WithFaults(kind):  # type: ignore[misc]
        READS = (*kind.READS, told)

        def __init__(self, config: Any, io: Any) -> None:
            for fault in faults:
                io.world = fault.world(io.world)
            super().__init__(config, io)
            self._injectors = [INJECTORS[f.kind](f, self.physics) for f in faults]
            for injector in self._injectors:
                if isinstance(injector, Kidnap):
                    injector.simulation = self
            self._told_io = io

        def step(self, now: float) -> None:
            super().step(now)
            state = self._told_io.latest(told)
            for injector in [i for i in self._injectors if not i.over]:
                if what := injector.step(now, state.state if state is not None else ""):
                    fault = injector.fault.kind
                    self._told_io.log.warning("fault injected", fault=fault, what=what)
                    report(FaultReport(round(now, 2), fault, what))

    WithFaults.__name__ = WithFaults.__qualname__ = f"WithFaults{kind.__name__}"
    return WithFaults


# --- everything a case injects into a service: faulty messages, and for the simulation faults of physics
def targets(case: Case) -> set[str]:
    """The services whose class the case replaces."""
    return {r.service for r in case.rules} | ({"sim"} if case.physical else set())


def with_faults(kind: Any, case: Case, report: Reporter) -> Any:
    """The class that runs in place of a service's; the class itself where the case has nothing for it."""
    found = faulty(kind, case.rules, report)
    return with_physical_faults(found, case.physical, report) if kind.NAME == "sim" else found
