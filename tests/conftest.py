"""Fixtures for all tests; which of them wait, and which run only where all are asked for."""

from __future__ import annotations

import os
import signal
import sys
from importlib import import_module
from importlib.util import find_spec
from pathlib import Path
from types import ModuleType

import pytest
from tools.pools import COSTS, NO_BYTECODE, WAITING

from support.missing import missing
from support.tree import ROOT


def pytest_addoption(parser: pytest.Parser) -> None:
    parser.addoption("--exhaustive", action="store_true", help="tests with this mark run too")


def pytest_configure(config: pytest.Config) -> None:
    if COSTS in os.environ:
        from support.costs import Costs

        config.pluginmanager.register(Costs(Path(os.environ[COSTS])))
    # Under nohup SIGHUP is ignored, and processes that tests start would inherit that. A handler
    # of our own lets this process go on, and gives them the default.
    if hasattr(signal, "SIGHUP") and signal.getsignal(signal.SIGHUP) is signal.SIG_IGN:
        signal.signal(signal.SIGHUP, lambda *_: None)


def pytest_collection_modifyitems(config: pytest.Config, items: list[pytest.Item]) -> None:
    """Mark what waits, and leave out what is exhaustive."""
    for item in items:
        if any(item.path.is_relative_to(ROOT / folder) for folder in WAITING):
            item.add_marker("waits")
    if not config.getoption("--exhaustive"):
        left_out = [item for item in items if item.get_closest_marker("exhaustive")]
        if left_out:
            config.hook.pytest_deselected(items=left_out)
            items[:] = [item for item in items if not item.get_closest_marker("exhaustive")]


def pytest_collection_finish() -> None:
    """From here on no bytecode: tests write a module twice in one second, and import it twice."""
    sys.dont_write_bytecode = True
    os.environ[NO_BYTECODE] = "1"


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
