"""The committed stub of the core says what the compiled module says."""

from __future__ import annotations

import difflib
import importlib.util
from pathlib import Path
from types import ModuleType

import pytest

from support.tree import ROOT

STUB = ROOT / "python" / "photograd" / "_core.pyi"


def load_tool() -> ModuleType:
    spec = importlib.util.spec_from_file_location("stubs", ROOT / "tools" / "stubs.py")
    assert spec is not None
    assert spec.loader is not None
    tool = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(tool)
    return tool


@pytest.mark.usefixtures("core")
def test_stub_is_current(tmp_path: Path) -> None:
    fresh = load_tool().write_stub(tmp_path).read_text(encoding="utf-8").splitlines()
    committed = STUB.read_text(encoding="utf-8").splitlines()
    drift = list(difflib.unified_diff(committed, fresh, "committed", "compiled", lineterm="", n=1))
    assert drift == [], "run tools/stubs.py and commit the result"


def test_bare_containers_are_spelled_out() -> None:
    tool = load_tool()
    text = "def f(a: tuple, b: list = []) -> dict:\n    x: list[int]\n"
    assert tool.BARE.findall(text) == [(": ", "tuple"), (": ", "list"), ("-> ", "dict")]
