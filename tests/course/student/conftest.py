"""A student's semester in the small course."""

from __future__ import annotations

from pathlib import Path

import pytest
from photograd_course.build.kits import ENVIRONMENT

from .small_course import Semester, make_course


@pytest.fixture
def semester(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> Semester:
    """An empty folder, in which commands of the small course are given."""
    course = make_course(tmp_path / "assignments")
    home = tmp_path / "semester"
    home.mkdir()
    monkeypatch.setenv(ENVIRONMENT, str(course))
    monkeypatch.setenv("COLUMNS", "200")
    monkeypatch.chdir(home)
    return Semester(home, course, capsys)
