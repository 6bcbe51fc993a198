"""Plugins made on the spot: real modules behind real entry points."""

from __future__ import annotations

import itertools
from collections.abc import Callable
from importlib.metadata import EntryPoint
from pathlib import Path
from textwrap import dedent

import pytest

MakePlugin = Callable[..., EntryPoint]
_numbers = itertools.count()


@pytest.fixture
def make_plugin(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> MakePlugin:
    """Turn source code with a function ``register`` into an entry point."""
    monkeypatch.syspath_prepend(str(tmp_path))

    def make(source: str, name: str = "extra", attribute: str = "register") -> EntryPoint:
        module = f"photograd_test_plugin_{next(_numbers)}"
        (tmp_path / f"{module}.py").write_text(dedent(source))
        return EntryPoint(name, f"{module}:{attribute}", "photograd.commands")

    return make
