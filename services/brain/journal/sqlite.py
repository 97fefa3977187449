"""The journal on disk: sqlite in WAL mode, every save one transaction that is on the disk when it returns."""

import sqlite3
from collections import deque
from collections.abc import Callable, Sequence
from contextlib import closing
from pathlib import Path
from typing import Any

import msgspec

from common.bus.port import Io
from common.time.clock import unix_time
from services.brain.journal.records import ENTRIES_KEPT, FORMAT, KEPT, Checkpoint, Entry, Journal, Record
from services.brain.journal.schema import BEGIN, CHECKPOINT, END, ENTRY, FIELDS, MIGRATIONS, TRIM
from services.brain.mission.mission import Mission, Outcome

KEY = "journal"
TRIMMED_EVERY = 100
"""Missions after which old ones are dropped from the file [count]; chosen: two percent of those that are kept."""
WAITING_KEPT = 5000
"""Statements kept while the disk refuses (chosen: ten long missions)."""
_Op = tuple[str, tuple[Any, ...]]


class Unusable(Exception):
    """The file is no journal that this program can read; the message says why."""


class SqliteJournal(Journal):
    """Survives kill and power cut at any moment. A file that cannot be read is moved aside and a new one is begun.

    While the disk refuses (full, gone, read-only) the mission goes on: every refusal is counted, what was refused is
    kept in memory and written with the next save that succeeds.
    """

    def __init__(
        self,
        path: Path,
        io: Io,
        clock: Callable[[], float] = unix_time,
        migrations: Sequence[Sequence[str]] = MIGRATIONS,
    ) -> None:
        super().__init__(clock)
        self.path, self.errors, self.boot = path, 0, 0
        self._io, self._migrations = io, migrations
        self._ended = 0
        self._waiting: deque[_Op] = deque(maxlen=WAITING_KEPT)
        self._db: sqlite3.Connection | None = None
        try:
            self._opened()
        except (sqlite3.Error, OSError, Unusable) as error:
            self._refused(error)
            self.boot = int(clock())  # how many processes had used the file is unknown

    # --- writing
    def begin(self, mission: Mission) -> None:
        super().begin(mission)
        self._waiting.append((BEGIN, _values(self._records[mission.id])))

    def resume(self, mission: Mission) -> None:
        record = self.mission(mission.id)
        if record is None:
            self.begin(mission)
            return
        if record.outcome is not None:
            self._waiting.append((END, (mission.command, None, "", 0.0, mission.goals, "", "", "", mission.id)))
        self.keep(record)
        super().resume(mission)

    def note(self, mission_id: str, entry: Entry) -> bool:
        if room := super().note(mission_id, entry):
            self._waiting.append((ENTRY, _entry(mission_id, entry)))
        return room

    def end(self, mission: Mission, outcome: Outcome, reason: str, t: float) -> None:
        super().end(mission, outcome, reason, t)
        failure = mission.ended_by
        why = failure.stage, failure.code, failure.spoken
        self._waiting.append((END, (mission.command, outcome, reason, t, mission.goals, *why, mission.id)))
        self._ended += 1
        if self._ended % TRIMMED_EVERY == 0:
            self._waiting.extend((statement, ()) for statement in TRIM)

    def save(self, checkpoint: Checkpoint) -> bool:
        checkpoint.date = self._clock()
        body = msgspec.json.encode(checkpoint)
        try:
            db = self._opened()
            db.execute("begin immediate")
            for statement, values in (*self._waiting, (CHECKPOINT, (body, FORMAT))):
                db.execute(statement, values)
            db.execute("commit")
        except (sqlite3.Error, OSError, Unusable) as error:
            self._refused(error)
            return False
        self._waiting.clear()
        return True

    def _refused(self, error: Exception) -> None:
        """Count a failure; start a new file when this one is damaged."""
        self.errors += 1
        self._io.count_drop(KEY, f"{self.path}: {error}")
        code = getattr(error, "sqlite_errorcode", 0) & 0xFF
        if isinstance(error, Unusable) or code in (sqlite3.SQLITE_CORRUPT, sqlite3.SQLITE_NOTADB):
            self._close()
            self._move_aside(str(error))
        elif self._db is not None and self._db.in_transaction:
            try:
                self._db.execute("rollback")
            except sqlite3.Error:
                self._close()

    # --- reading
    def checkpoint(self) -> Checkpoint | None:
        rows = self._rows("select body, format from checkpoint")
        try:
            checkpoint = msgspec.json.decode(rows[0][0], type=Checkpoint) if rows else None
        except (msgspec.DecodeError, UnicodeDecodeError) as error:
            self._io.log.error("the mission under way cannot be read", path=str(self.path), error=str(error))
            return None
        if checkpoint is not None:
            checkpoint.outdated = rows[0][1] != FORMAT
        return checkpoint

    def missions(self) -> list[Record]:
        rows = self._rows(f"select {FIELDS} from missions order by number desc limit ?", KEPT)
        # What the disk has refused, this process still knows.
        found = {**{row[0]: Record(*row) for row in reversed(rows)}, **{r.id: r for r in super().missions()}}
        return list(found.values())

    def mission(self, mission_id: str) -> Record | None:
        own = super().mission(mission_id)
        rows = [] if own else self._rows(f"select {FIELDS} from missions where id = ?", mission_id)
        if not rows:
            return own
        of = "select t, state, cause, evidence, kind, picture from entries where mission = ? order by number limit ?"
        entries = [Entry(*row) for row in self._rows(of, mission_id, ENTRIES_KEPT)]
        return msgspec.structs.replace(Record(*rows[0]), entries=entries)

    def last(self) -> Record | None:
        rows = self._rows(f"select {FIELDS} from missions where outcome is not null order by number desc limit 1")
        return super().last() or (Record(*rows[0]) if rows else None)

    def _rows(self, statement: str, *values: Any) -> list[Any]:
        try:
            return self._opened().execute(statement, values).fetchall()
        except (sqlite3.Error, OSError, Unusable) as error:
            self._refused(error)
            return self._rows_only_read(statement, values)

    def _rows_only_read(self, statement: str, values: tuple[Any, ...]) -> list[Any]:
        """From a file on a disk without room: a single user's index of the log can do without a file."""
        try:
            with closing(sqlite3.connect(f"{self.path.absolute().as_uri()}?mode=rw", timeout=0.2, uri=True)) as db:
                db.execute("pragma locking_mode = exclusive")
                return db.execute(statement, values).fetchall()
        except sqlite3.Error:
            return []

    # --- the file
    def _opened(self) -> sqlite3.Connection:
        """The checked and migrated file; opened again when it was closed, or deleted under us.

        Raises:
            Unusable: damaged, or written by a newer version.
            sqlite3.Error, OSError: the disk refuses.
        """
        if self._db is not None and not self.path.exists():
            self._close()
        if self._db is not None:
            return self._db
        self.path.parent.mkdir(parents=True, exist_ok=True)
        # One brain writes; a second one started by mistake must not hold up the first.
        db = sqlite3.connect(self.path, timeout=0.2, isolation_level=None)
        try:
            db.execute("pragma journal_mode = wal")
            db.execute("pragma synchronous = full")
            health = db.execute("pragma quick_check(1)").fetchone()[0]
            if health != "ok":
                raise Unusable(f"damaged: {health}")
            if self._migrate(db) == 0:
                self._tell_all(db)
            for statement in TRIM:
                db.execute(statement)
            boot = "insert or ignore into boots (number, date) values (?, ?)"
            started = db.execute(boot, (self.boot or None, self._clock())).lastrowid
            self.boot = self.boot or int(started or 1)
        except (sqlite3.Error, OSError, Unusable):
            db.close()
            raise
        self._db = db
        return db

    def _migrate(self, db: sqlite3.Connection) -> int:
        """Bring the file to the newest version; the version it had."""
        version = int(db.execute("pragma user_version").fetchone()[0])
        if version > len(self._migrations):
            raise Unusable(f"version {version} of a newer program; this one knows {len(self._migrations)}")
        for number in range(version, len(self._migrations)):
            db.execute("begin immediate")
            for statement in self._migrations[number]:
                db.execute(statement)
            db.execute(f"pragma user_version = {number + 1}")
            db.execute("commit")
        return version

    def _tell_all(self, db: sqlite3.Connection) -> None:
        """Into a new file: what this process knows."""
        db.execute("begin immediate")
        for record in self._records.values():
            db.execute(BEGIN, _values(record))
            db.executemany(ENTRY, [_entry(record.id, entry) for entry in record.entries])
        db.execute("commit")
        self._waiting.clear()

    def _move_aside(self, reason: str) -> None:
        """Keep the unreadable file for people to look at; the next save begins a new one."""
        stamp = f"unreadable-{int(self._clock())}"
        for suffix in ("-wal", "-shm", ""):
            old = self.path.with_name(self.path.name + suffix)
            try:
                old.rename(self.path.with_name(f"{self.path.name}.{stamp}{suffix}"))
            except FileNotFoundError:
                continue
            except OSError as error:
                self._io.count_drop(KEY, f"{old}: {error}")
                return
        self._io.log.error("journal moved aside", path=f"{self.path}.{stamp}", reason=reason)

    def _close(self) -> None:
        if self._db is not None:
            self._db.close()  # rolls back what was not committed
            self._db = None

    def close(self) -> None:
        self._close()


def _values(r: Record) -> tuple[Any, ...]:
    return msgspec.structs.astuple(r)[: len(FIELDS.split())]


def _entry(mission_id: str, e: Entry) -> tuple[Any, ...]:
    return mission_id, e.t, e.state, e.cause, e.evidence, e.kind, e.picture
