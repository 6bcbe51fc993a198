"""Fixtures for all tests."""

from __future__ import annotations

from importlib import import_module
from importlib.util import find_spec
from pathlib import Path
from types import ModuleType

import pytest

from support.missing import missing
from support.tree import ROOT


@pytest.fixture(scope="session")
def shared_data() -> Path:
    """Folder of real input data beside the checkout; tests that need it are skipped without it."""
    folder = ROOT.parent / "shared" / "data"
    if not folder.is_dir():
        pytest.skip("real input data (../shared/data) is not here")
    return folder


def pytest_sessionstart() -> None:
    """A core that is there and cannot be imported ends the run: many tests skip without one."""
    if core_is_built():
        import_module("photograd._core")


def core_is_built() -> bool:
    return find_spec("photograd") is not None and find_spec("photograd._core") is not None


@pytest.fixture(scope="session")
def core() -> ModuleType:
    """The compiled core."""
    if not core_is_built():
        missing("the core is not built")
    return import_module("photograd._core")
