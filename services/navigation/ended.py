"""The exception that ends a goal, with the status, code and detail that are published."""

from common import messages as m


class Ended(Exception):
    """The goal has ended with this status, code and detail."""

    def __init__(self, status: m.NavStatus, code: str = "", detail: str = "") -> None:
        super().__init__(detail)
        self.status, self.code, self.detail = status, code, detail
