"""The journal on disk: what was saved is there after anything that happens to the process, the file or the disk."""

import os
import resource
import sqlite3
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import pytest

from common.bus.memory import MemoryBus, MemoryIo
from common.household import load_household
from services.brain.config import BrainConfig
from services.brain.journal import sqlite
from services.brain.journal.open import open_journal
from services.brain.journal.records import ENTRIES_KEPT, Checkpoint, Entry, Journal, PathNode
from services.brain.journal.sqlite import MIGRATIONS, SqliteJournal
from services.brain.mission.channel import SentGoal
from services.brain.mission.mission import GripperState, Mission, Task
from tests.support import ROOT

SCENE = load_household("apartment")


def io() -> MemoryIo:
    return MemoryIo(MemoryBus(), "brain", (), (), household=SCENE, log_level="error")


@pytest.fixture
def path(tmp_path: Path) -> Iterator[Path]:
    yield tmp_path / "state" / "missions.db"


def opened(path: Path) -> SqliteJournal:
    return SqliteJournal(path, io())


def told(journal: Journal, name: str, notes: int = 3) -> Mission:
    mission = Mission(id=name, command="bring me the red mug", started=10.0, task=Task(item="red mug"))
    journal.begin(mission)
    for n in range(notes):
        journal.note(name, Entry(10.0 + n, "NAVIGATING", f"cause {n}", "evidence", "saw"))
    goal = {"goal": "find red mug", "id": f"{name}.1", "attempt": 1}
    sent = SentGoal("navigation", "brain/navigation_goal", goal, "abc")
    path = [PathNode("mission"), PathNode("do", 0, 2)]
    journal.save(Checkpoint(mission, GripperState(holding="apple"), path, [sent], t=12.0, base=(1.0, 2.0, 3.0)))
    return mission


@pytest.mark.parametrize("kind", ["disk", "memory"])
def test_missions_come_back_as_they_were_told(path: Path, kind: str) -> None:
    journal: Journal = opened(path) if kind == "disk" else Journal()
    mission = told(journal, "m-1")
    mission.goals = 7
    journal.end(mission, "failed", "NO_WAY: blocked", 42.0)
    journal.save(Checkpoint(mission, GripperState()))
    told(journal, "m-2")
    if kind == "disk":
        journal.close()
        journal = opened(path)
    first, second = journal.missions()
    assert (first.id, first.outcome, first.reason, first.ended, first.steps) == (
        "m-1",
        "failed",
        "NO_WAY: blocked",
        42,
        7,
    )
    assert (second.id, second.outcome, second.command) == ("m-2", None, "bring me the red mug")
    assert first.entries == [] and first.date > 1e9
    whole = journal.mission("m-1")
    assert whole is not None and [e.cause for e in whole.entries] == ["cause 0", "cause 1", "cause 2"]
    assert whole.entries[0] == Entry(10.0, "NAVIGATING", "cause 0", "evidence", "saw")
    assert journal.mission("m-3") is None
    last = journal.last()
    assert last is not None and last.id == "m-1"
    left = journal.checkpoint()
    assert left is not None and left.mission.id == "m-2" and left.gripper.holding == "apple"
    assert left.path == [PathNode("mission"), PathNode("do", 0, 2)] and left.base == (1.0, 2.0, 3.0)
    assert left.sent[0].message["goal"] == "find red mug" and left.sent[0].epoch == "abc"


def test_every_process_has_its_number(path: Path) -> None:
    boots = []
    for _ in range(3):
        journal = opened(path)
        boots.append(journal.boot)
        journal.close()
    assert boots == [1, 2, 3]


def test_a_long_life_does_not_grow_the_file(path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    kept = (sqlite.TRIM[0].replace("5000", "5"), sqlite.TRIM[1])
    monkeypatch.setattr(sqlite, "TRIM", kept)
    monkeypatch.setattr(sqlite, "TRIMMED_EVERY", 10)
    journal = opened(path)
    for n in range(20):
        mission = Mission(id=f"m-{n}", command="bring me the red mug")
        journal.begin(mission)
        journal.note(mission.id, Entry(float(n), "NAVIGATING", "on the way"))
        journal.end(mission, "delivered", "", float(n))
        assert journal.save(Checkpoint(mission, GripperState()))
    with sqlite3.connect(path) as db:
        assert [row[0] for row in db.execute("select id from missions")] == [f"m-{n}" for n in range(15, 20)]
        assert db.execute("select count(*) from entries").fetchone() == (5,)


def test_a_timeline_is_bounded(path: Path) -> None:
    journal = opened(path)
    told(journal, "m-1", notes=ENTRIES_KEPT + 50)
    journal.close()
    record = opened(path).mission("m-1")
    assert record is not None and len(record.entries) == ENTRIES_KEPT


WRITER = """
import os, sys
from pathlib import Path
from tests.unit.test_brain_store import SqliteJournal, io, told
journal = SqliteJournal(Path(sys.argv[1]), io())
for n in range(10000):
    told(journal, f"m-{n}")
    os.write(1, f"{n}\\n".encode())
"""


def test_what_was_acknowledged_survives_sigkill(path: Path) -> None:
    for _ in range(3):
        path.unlink(missing_ok=True)
        with subprocess.Popen([sys.executable, "-c", WRITER, str(path)], stdout=subprocess.PIPE, cwd=ROOT) as process:
            assert process.stdout is not None
            for _ in range(25):
                process.stdout.readline()
            process.kill()
            acknowledged = 24 + len(process.stdout.read().splitlines())
        journal = opened(path)
        assert journal.errors == 0
        left = journal.checkpoint()
        assert left is not None and int(left.mission.id[2:]) >= acknowledged
        record = journal.mission(f"m-{acknowledged}")
        assert record is not None and len(record.entries) == 3
        journal.close()


@pytest.mark.parametrize("lost", [1, 17, 500, 4096, 9000, 20000])
def test_a_torn_tail_costs_the_last_transactions_only(path: Path, tmp_path: Path, lost: int) -> None:
    journal = opened(path)
    for n in range(20):
        told(journal, f"m-{n}")
    # What a power cut leaves: the log as far as it had come to the disk.
    torn = tmp_path / "torn" / "missions.db"
    torn.parent.mkdir()
    torn.write_bytes(path.read_bytes())
    wal = path.with_name("missions.db-wal").read_bytes()
    torn.with_name("missions.db-wal").write_bytes(wal[:-lost])
    journal.close()
    again = opened(torn)
    names = [record.id for record in again.missions()]
    assert names == [f"m-{n}" for n in range(len(names))] and 0 < len(names) <= 20
    left = again.checkpoint()
    assert left is not None and left.mission.id == names[-1] and again.errors == 0
    assert not list(torn.parent.glob("*unreadable*"))
    told(again, "m-new")
    assert again.missions()[-1].id == "m-new" and again.errors == 0


def overwrite(path: Path, offset: int, length: int) -> None:
    raw = bytearray(path.read_bytes())
    raw[offset : offset + length] = b"\xa5" * length
    path.write_bytes(raw)


@contextmanager
def no_room() -> Iterator[None]:
    """No file of this process may grow, as on a full disk."""
    soft, hard = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (0, hard))
    try:
        yield
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, (soft, hard))


def outside(path: Path, statement: str) -> list[Any]:
    """Rows of a statement that another program executes on the file."""
    db = sqlite3.connect(path)
    try:
        rows = db.execute(statement).fetchall()
        db.commit()
        return rows
    finally:
        db.close()


@pytest.mark.parametrize("offset", [0, 100, 4096, 12288])
def test_a_damaged_file_is_moved_aside_and_a_new_one_begun(path: Path, offset: int) -> None:
    journal = opened(path)
    for n in range(30):
        told(journal, f"m-{n}")
    journal.close()
    overwrite(path, offset, 4000)
    one = io()
    again = SqliteJournal(path, one)
    told(again, "m-new")
    assert [record.id for record in again.missions()] == ["m-new"]
    assert again.errors == 1 and one.drops["journal"] == 1
    aside = [p for p in path.parent.glob("missions.db.unreadable-*") if not p.name.endswith(("-wal", "-shm"))]
    assert len(aside) == 1 and aside[0].stat().st_size > 4096
    # Ids of the lost file do not come again.
    assert again.boot > 1e9
    again.close()
    assert opened(path).checkpoint() is not None


def test_a_file_damaged_while_open_loses_nothing_of_the_mission_under_way(path: Path) -> None:
    journal = opened(path)
    mission = told(journal, "m-1")
    assert journal._db is not None
    journal._db.execute("pragma wal_checkpoint(truncate)")
    overwrite(path, 0, 16000)
    journal._db.execute("pragma shrink_memory")
    for n in range(10):
        journal.note("m-1", Entry(20.0 + n, "GRABBING", f"later {n}"))
        journal.save(Checkpoint(mission, GripperState(holding="red mug")))
    assert journal.errors >= 1
    journal.close()
    again = opened(path)
    record, left = again.mission("m-1"), again.checkpoint()
    assert record is not None and record.entries[-1].cause == "later 9" and len(record.entries) == 13
    assert left is not None and left.gripper.holding == "red mug"


def test_a_file_of_a_newer_program_is_not_touched(path: Path) -> None:
    journal = opened(path)
    told(journal, "m-1")
    journal.close()
    outside(path, f"pragma user_version = {len(MIGRATIONS) + 1}")
    again = opened(path)
    assert again.missions() == [] and again.errors == 1
    aside = next(p for p in path.parent.glob("missions.db.unreadable-*") if not p.name.endswith(("-wal", "-shm")))
    with sqlite3.connect(aside) as kept:
        assert kept.execute("select id from missions").fetchall() == [("m-1",)]
    kept.close()


def test_an_older_file_is_brought_up_to_date(path: Path) -> None:
    journal = opened(path)
    told(journal, "m-1")
    journal.close()
    newer = (*MIGRATIONS, ("alter table missions add column mood text not null default 'good'",))
    again = SqliteJournal(path, io(), migrations=newer)
    assert again.errors == 0 and [record.id for record in again.missions()] == ["m-1"]
    told(again, "m-2")
    assert again.errors == 0
    again.close()
    assert outside(path, "select mood from missions") == [("good",), ("good",)]
    assert outside(path, "pragma user_version") == [(len(newer),)]


def test_a_migration_cut_short_is_done_again(path: Path) -> None:
    opened(path).close()
    broken = (*MIGRATIONS, ("alter table missions add column mood text", "this is no statement"))
    assert SqliteJournal(path, io(), migrations=broken).errors > 0
    whole = (*MIGRATIONS, ("alter table missions add column mood text",))
    again = SqliteJournal(path, io(), migrations=whole)
    told(again, "m-1")
    assert again.errors == 0 and len(again.missions()) == 1


def test_a_full_disk_is_counted_and_made_up_for(path: Path) -> None:
    one = io()
    journal = SqliteJournal(path, one)
    mission = told(journal, "m-1")
    with no_room():
        for n in range(50):
            journal.note("m-1", Entry(20.0 + n, "RETURNING", f"long {n}", "x" * 500))
            journal.save(Checkpoint(mission, GripperState()))
    assert journal.errors > 40 and one.drops["journal"] == journal.errors
    record = journal.mission("m-1")
    assert record is not None and len(record.entries) == 53
    refused = journal.errors
    journal.save(Checkpoint(mission, GripperState(holding="red mug")))
    assert journal.errors == refused
    journal.close()
    again = opened(path)
    record, left = again.mission("m-1"), again.checkpoint()
    assert record is not None and [e.cause for e in record.entries[3:]] == [f"long {n}" for n in range(50)]
    assert left is not None and left.gripper.holding == "red mug"


def test_without_a_place_on_disk_the_mission_goes_on(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("not a folder")
    journal = opened(tmp_path / "file" / "missions.db")
    mission = told(journal, "m-1")
    journal.end(mission, "delivered", "", 30.0)
    journal.save(Checkpoint(mission, GripperState()))
    assert [(r.id, r.outcome) for r in journal.missions()] == [("m-1", "delivered")]
    assert journal.errors >= 2 and journal.boot > 1e9
    (tmp_path / "file").unlink()
    journal.save(Checkpoint(mission, GripperState()))
    journal.close()
    assert [(r.id, r.outcome) for r in opened(tmp_path / "file" / "missions.db").missions()] == [("m-1", "delivered")]


def test_a_deleted_file_is_written_again(path: Path) -> None:
    journal = opened(path)
    mission = told(journal, "m-1")
    for file in path.parent.iterdir():
        file.unlink()
    journal.note("m-1", Entry(20.0, "RETURNING", "later"))
    journal.save(Checkpoint(mission, GripperState()))
    journal.close()
    record = opened(path).mission("m-1")
    assert record is not None and [e.cause for e in record.entries] == ["cause 0", "cause 1", "cause 2", "later"]


def test_a_second_brain_on_the_same_file_does_not_hold_up_the_first(path: Path) -> None:
    first, second = opened(path), opened(path)
    writer = sqlite3.connect(path, isolation_level=None)
    writer.execute("begin immediate")
    mission = told(first, "m-1")
    assert first.errors == 1 and first.missions()[0].id == "m-1"
    writer.execute("rollback")
    writer.close()
    first.save(Checkpoint(mission, GripperState()))
    assert first.errors == 1 and [r.id for r in second.missions()] == ["m-1"]


def test_where_the_journal_is_kept(tmp_path: Path) -> None:
    one = io()
    assert type(open_journal(BrainConfig(), one)) is Journal
    one.state_dir = tmp_path
    journal = open_journal(BrainConfig(), one)
    assert isinstance(journal, SqliteJournal) and journal.path == tmp_path / "missions.db"
    assert type(open_journal(BrainConfig(journal=""), one)) is Journal
    one.state_dir = None
    journal = open_journal(BrainConfig(journal=str(tmp_path / "other.db")), one)
    assert isinstance(journal, SqliteJournal) and (tmp_path / "other.db").exists()


def test_what_a_killed_brain_left_is_read_from_a_disk_without_room(path: Path) -> None:
    """To open the file for writing takes room, to know where the mission stands must not."""
    script = (
        "import os, sys; from pathlib import Path; from tests.unit.test_brain_store import *\n"
        "told(opened(Path(sys.argv[1])), 'm-1'); os.kill(os.getpid(), 9)"
    )
    done = subprocess.run([sys.executable, "-c", script, str(path)], cwd=ROOT, env={**os.environ, "PYTHONPATH": "."})
    assert done.returncode == -9
    with no_room():
        journal = SqliteJournal(path, io())
        left, missions = journal.checkpoint(), journal.missions()
        refused = journal.save(Checkpoint(Mission("m-1"), GripperState()))
    assert left is not None and left.mission.id == "m-1" and [r.id for r in missions] == ["m-1"]
    assert not refused and journal.errors > 0
    assert journal.save(Checkpoint(left.mission, GripperState(holding="red mug")))
    journal.close()
    again = opened(path).checkpoint()
    assert again is not None and again.gripper.holding == "red mug"
