"""Look-up of service classes by name."""

import importlib
from functools import cache
from typing import Any


@cache
def service_class(name: str) -> Any:
    """The class of a service of the table, by its NAME.

    Raises:
        LookupError: the service's module has no such class.
    """
    module = importlib.import_module(f"services.{name}.service")
    for found in vars(module).values():
        if isinstance(found, type) and getattr(found, "NAME", None) == name:
            return found
    raise LookupError(f"services.{name}.service has no class with NAME = {name!r}")
