"""Running cases on this machine: a thread for each lane, results and progress as they come."""

from collections import deque
from collections.abc import Generator
from concurrent.futures import ThreadPoolExecutor
from functools import partial
from queue import SimpleQueue

import msgspec

from evaluation.case import Case, Result
from evaluation.workers.lane import SILENCE, WALL_LIMIT, Lane, LaneClosed, Run, name_of


class Progressed(msgspec.Struct):
    """Progress of a worker's case: robot time [s] and the brain's state."""

    worker: str
    case: Case
    t: float
    state: str


class Repeated(msgspec.Struct):
    """A worker was lost; its case is run again."""

    case: Case
    why: str


Said = Result | Progressed | Repeated


Saying = SimpleQueue[Said | Exception]


def evaluate(
    cases: list[Case], jobs: int, run: Run, limit: float = WALL_LIMIT, silence: float = SILENCE
) -> Generator[Said, None, None]:
    """Results as they come, progress and repeats between them. `limit`, `silence`: wall time [s], see `Lane`."""
    lanes = [Lane(name_of(run), limit, silence) for _ in range(min(max(jobs, 1), len(cases)))]
    waiting, said = deque(cases), Saying()

    def drain(number: int, lane: Lane) -> None:
        try:
            while waiting:
                case = waiting.popleft()
                here, again = partial(_progressed, said, str(number), case), partial(_repeated, said, case)
                said.put(lane.run(case, here, again))
        except (IndexError, LaneClosed):
            pass
        except Exception as error:
            said.put(error)
        finally:
            lane.close()

    with ThreadPoolExecutor(max(1, len(lanes))) as threads:
        try:
            for number, lane in enumerate(lanes):
                threads.submit(drain, number, lane)
            missing = len(cases)
            while missing:
                found = said.get()
                if isinstance(found, Exception):
                    raise found
                missing -= isinstance(found, Result)
                yield found
        finally:
            waiting.clear()
            for lane in lanes:
                threads.submit(lane.close)
            for lane in lanes:
                lane.close()


def _progressed(said: Saying, worker: str, case: Case, t: float, state: str) -> None:
    said.put(Progressed(worker, case, t, state))


def _repeated(said: Saying, case: Case, why: str) -> None:
    said.put(Repeated(case, why))
