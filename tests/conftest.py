"""Fixtures for all tests."""

from __future__ import annotations

import os
from pathlib import Path
from types import ModuleType

import pytest

from support.tree import ROOT


@pytest.fixture(scope="session")
def shared_data() -> Path:
    """Folder of real input data beside the checkout; tests that need it are skipped without it."""
    folder = ROOT.parent / "shared" / "data"
    if not folder.is_dir():
        pytest.skip("real input data (../shared/data) is not here")
    return folder


@pytest.fixture(scope="session")
def core() -> ModuleType:
    """The compiled core. Where warnings are errors, a missing one is no excuse."""
    try:
        from photograd import _core
    except ImportError as error:
        if os.environ.get("CI") == "true":
            raise
        pytest.skip(f"the core is not built: {error}")
    return _core
