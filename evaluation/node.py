"""`python -m evaluation.node`: a service with the case's faults injected, as a process of its own.

Which service is what the supervisor calls this process; the case is in the file that TIDYBOT_EVAL_CASE names, and what
the faults did is appended to `FAULT_REPORTS` beside it.
"""

import os
from pathlib import Path

import msgspec

from common.runtime import main
from evaluation.case import Case
from evaluation.faults.physical.faults import with_faults
from evaluation.faults.reports import FaultReportFile
from evaluation.registry import service_class

CASE = "TIDYBOT_EVAL_CASE"
FAULT_REPORTS = "fault_reports"

if __name__ == "__main__":
    path = Path(os.environ[CASE])
    case = msgspec.json.decode(path.read_bytes(), type=Case)
    report = FaultReportFile(path.with_name(FAULT_REPORTS)).report
    main(with_faults(service_class(os.environ["SUPERVISOR_PROCESS_NAME"]), case, report))
