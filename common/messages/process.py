"""What every process tells of itself."""

from common.messages.base import Message


class PageStatus(Message):
    """Where the operator's page is."""

    url: str


class Health(Message):
    name: str
    epoch: str
    t: float
    uptime: float
    hz: float
    drops: int
    rss_mb: float
    pid: int
    last_error: str = ""
    by_key: dict[str, int] = {}


class LogRecord(Message):
    t: float
    service: str
    level: str
    event: str
    fields: dict[str, object] = {}
