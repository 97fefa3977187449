"""`python -m evaluation.node`: a service of the case behind its faulty door, as a process of its own.

Which service is what the supervisor calls this process; the case is in the file that TIDYBOT_EVAL_CASE names.
"""

import os
from pathlib import Path

import msgspec

from common.runtime import main
from evaluation.case import Case
from evaluation.faults import faulty
from evaluation.stack import service_class

CASE = "TIDYBOT_EVAL_CASE"

if __name__ == "__main__":
    found = msgspec.json.decode(Path(os.environ[CASE]).read_bytes(), type=Case)
    main(faulty(service_class(os.environ["SUPERVISOR_PROCESS_NAME"]), found.rules))
