"""The names at the door of photograd: each on the page once, and examples that run."""

from __future__ import annotations

import doctest
import inspect
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import photograd
import pytest
from photograd_course.cli import run
from tests.commands.test_trace import SCENE
from tests.fit.mesh_scene import cube, write_obj

from support.tree import ROOT

sys.path.insert(0, str(ROOT / "docs"))
try:
    import api_pages
finally:
    sys.path.pop(0)

pytestmark = pytest.mark.usefixtures("core")

LISTED = [name for names in api_pages.DOOR.values() for name in names.split()]
FUNCTIONS = [name for name in LISTED if inspect.isfunction(getattr(photograd, name))]
MORE = ["density_gradient"]
SECTIONS = ("Args:", "Example:", "Raises:")


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Path]:
    """Where the examples run: photos/, room.toml, view.png, cube.obj."""
    path = tmp_path_factory.mktemp("examples")
    with pytest.MonkeyPatch.context() as patch:
        patch.chdir(path)
        words = ["--scene", "toy_table", "--views", "4", "--test-views", "1", "--size", "16"]
        assert run(["capture", *words, "--spp", "1", "--out", "photos"]) == 0
        (path / "room.toml").write_text(SCENE.replace("gray", "wall"), encoding="utf-8")
        photograd.images.write_png(path / "view.png", np.ones((16, 16, 4), np.float32))
        write_obj(path / "cube.obj", cube())
        yield path


def test_the_page_lists_every_name_once() -> None:
    modules = type(photograd)
    names = [n for n in photograd.__all__ if not isinstance(getattr(photograd, n), modules)]
    assert sorted(LISTED) == sorted(names)


@pytest.mark.parametrize("name", FUNCTIONS)
def test_a_function_describes_its_arguments_and_errors(name: str) -> None:
    function: Any = getattr(photograd, name)
    text = inspect.getdoc(function) or ""
    if inspect.signature(function).parameters:
        assert [section for section in SECTIONS if section not in text] == []
    for parameter in inspect.signature(function).parameters:
        assert f"\n    {parameter}: " in text


@pytest.mark.parametrize("name", [*FUNCTIONS, "PathTracer", *MORE])
def test_the_example_runs(name: str, folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(folder)
    text = inspect.getdoc(getattr(photograd.fitting if name in MORE else photograd, name)) or ""
    names = {"photograd": photograd, "np": np}
    example = doctest.DocTestParser().get_doctest(text, names, name, None, 0)
    assert example.examples
    report: list[str] = []
    failed, _ = doctest.DocTestRunner().run(example, out=report.append)
    assert failed == 0, "".join(report)
