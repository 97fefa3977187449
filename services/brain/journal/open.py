"""Opens the journal and the pictures beside it, as the configuration says."""

from pathlib import Path

from common.bus.port import Io
from services.brain.config import BrainConfig
from services.brain.journal.pictures import Pictures
from services.brain.journal.records import Journal
from services.brain.journal.sqlite import SqliteJournal


def open_journal(config: BrainConfig, io: Io) -> Journal:
    """On disk at the configured path, below the process's state directory; in memory when it has none."""
    path = journal_path(config, io)
    return SqliteJournal(path, io) if path is not None else Journal()


def open_pictures(config: BrainConfig, io: Io) -> Pictures:
    """In the folder `pictures` beside the journal; none are kept where missions are not."""
    path = journal_path(config, io)
    folder = path.parent / "pictures" if path is not None else None
    return Pictures(folder, lambda why: io.count_drop("pictures", why))


def journal_path(config: BrainConfig, io: Io) -> Path | None:
    """Where the journal is to be; None: nowhere on disk."""
    path = Path(config.journal)
    if not config.journal or not (path.is_absolute() or io.state_dir):
        return None
    return (io.state_dir or Path()) / path
