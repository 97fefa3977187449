"""What `python -m services.<name> --help` tells of every parameter."""

import importlib
from pathlib import Path

import pytest

from common import config

ROOT = Path(__file__).resolve().parents[2]
MODULES = ["common.config", *(f"services.{p.parent.name}.config" for p in sorted(ROOT.glob("services/*/config.py")))]


@pytest.mark.parametrize("module", MODULES)
def test_every_parameter_says_what_it_is(module: str) -> None:
    named = vars(importlib.import_module(module)).values()
    kinds = [v for v in named if isinstance(v, type) and issubclass(v, config.Config) and v.__module__ == module]
    parameters = [k for k in kinds if k.__name__.endswith("Config") and k is not config.Config]
    assert parameters
    assert [key for kind in parameters for key, (_, meaning) in config.described(kind).items() if not meaning] == []
