"""The tables of the journal, and every statement that writes to them."""

MISSIONS_KEPT = 5000
"""Missions on disk (chosen: years of use)."""
MIGRATIONS: tuple[tuple[str, ...], ...] = (
    (
        "create table missions (number integer primary key autoincrement, id text not null unique,"
        " command text not null, started real not null, outcome text, reason text not null default '',"
        " ended real not null default 0, steps integer not null default 0, date real not null)",
        "create table entries (number integer primary key autoincrement, mission text not null, t real not null,"
        " state text not null, cause text not null, evidence text not null, kind text not null)",
        "create index entries_by_mission on entries (mission, number)",
        "create table checkpoint (one integer primary key check (one = 1), body blob not null)",
        "create table boots (number integer primary key autoincrement, date real not null)",
    ),
    ("alter table entries add column picture text not null default ''",),
    tuple(f"alter table missions add column {name} text not null default ''" for name in ("stage", "code", "spoken")),
    ("alter table checkpoint add column format integer not null default 1",),
)
"""Statements that bring a file from version n to n + 1; `PRAGMA user_version` holds n. Only ever appended to."""

FIELDS = "id, command, started, outcome, reason, ended, steps, date, stage, code, spoken"
BEGIN = f"insert or ignore into missions ({FIELDS}) values ({', '.join('?' * len(FIELDS.split()))})"
END = (
    "update missions set command = ?, outcome = ?, reason = ?, ended = ?, steps = ?, stage = ?, code = ?, spoken = ?"
    " where id = ?"
)
ENTRY = "insert into entries (mission, t, state, cause, evidence, kind, picture) values (?, ?, ?, ?, ?, ?, ?)"
CHECKPOINT = "insert or replace into checkpoint (one, body, format) values (1, ?, ?)"
TRIM = (
    f"delete from missions where number <= (select max(number) from missions) - {MISSIONS_KEPT}",
    "delete from entries where mission not in (select id from missions)",
)
