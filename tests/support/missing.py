"""What a test needs and this machine lacks."""

from __future__ import annotations

import os
import sys
from importlib import import_module
from importlib.util import find_spec
from types import ModuleType
from typing import NoReturn

import pytest

EVERYTHING = "PHOTOGRAD_EVERYTHING"  # the environment variable of `./run test --all`


def missing(reason: str, *, by_choice: bool = False) -> NoReturn:
    """Skip the test; fail it where everything has to be there.

    That is in continuous integration, and under `./run test --all`. What is installed by choice,
    or depends on what the machine permits, has to be there under the latter only.
    """
    if os.environ.get(EVERYTHING) == "true":
        pytest.fail(f"{reason} (under --all everything has to be there)")
    if os.environ.get("CI") == "true" and not by_choice:
        pytest.fail(f"{reason} (continuous integration has to have it)")
    pytest.skip(reason, allow_module_level=True)


def need_module(name: str, *, by_choice: bool = False) -> ModuleType:
    """An installed module, or a test that is skipped or fails."""
    try:
        return import_module(name)
    except ImportError:
        missing(f"{name} is not installed", by_choice=by_choice)


def need_installed(name: str) -> None:
    """A module that is there by choice, not imported: what it says then is not the test's."""
    if name not in sys.modules and find_spec(name) is None:
        missing(f"{name} is not installed", by_choice=True)
