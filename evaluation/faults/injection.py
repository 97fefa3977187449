"""Everything a case injects into a service: faulty messages, and for the simulation faults of physics."""

from typing import Any

from evaluation.case import Case
from evaluation.faults.messages import faulty
from evaluation.faults.physical.faults import with_physical_faults
from evaluation.faults.reports import Reporter


def targets(case: Case) -> set[str]:
    """The services whose class the case replaces."""
    return {r.service for r in case.rules} | ({"sim"} if case.physical else set())


def with_faults(kind: Any, case: Case, report: Reporter) -> Any:
    """The class that runs in place of a service's; the class itself where the case has nothing for it."""
    found = faulty(kind, case.rules, report)
    return with_physical_faults(found, case.physical, report) if kind.NAME == "sim" else found
