"""A small assignment to break, and verdicts shared by all tests."""

from __future__ import annotations

import shutil
from pathlib import Path

import pytest
from photograd_course.build.new import new_assignment

from .support import Broken


@pytest.fixture(scope="session")
def cache(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Verdicts by content: what several tests judge alike is run once."""
    return tmp_path_factory.mktemp("verdicts")


@pytest.fixture(scope="session")
def scaffold(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """What `course new` writes; read only."""
    return new_assignment("17", "light", tmp_path_factory.mktemp("course"))


@pytest.fixture
def broken(tmp_path: Path, scaffold: Path, cache: Path) -> Broken:
    """A copy of it, to be broken."""
    folder = tmp_path / "course" / scaffold.name
    shutil.copytree(scaffold, folder)
    return Broken(folder, cache)
