"""Options of the scripts that students play with."""

from __future__ import annotations

import re
from pathlib import Path

import pytest
from photograd_course.explore import introduction, option

from support.tree import ROOT


def test_an_option_has_the_type_of_its_default(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("sys.argv", ["explore.py", "--steps", "7", "--file", "8"])
    assert option("steps", 1.5) == 7.0
    assert option("file", "") == "8"
    assert option("other", 3) == 3
    monkeypatch.setattr("sys.argv", ["explore.py", "--steps", "many"])
    with pytest.raises(ValueError, match="many"):
        option("steps", 1)


def test_help_prints_the_head_of_the_script_and_ends_it(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    script = tmp_path / "explore.py"
    script.write_text("# %% [markdown]\n# # A title\n# `--steps` says more.\n\n# %%\n1 / 0\n")
    monkeypatch.setattr("sys.argv", [str(script), "--help"])
    with pytest.raises(SystemExit) as ended:
        option("steps", 1)
    assert not ended.value.code
    assert capsys.readouterr().out == "A title\n`--steps` says more.\n"


@pytest.mark.parametrize("script", sorted(ROOT.glob("assignments/*/explore.py")), ids=str)
def test_the_head_of_a_script_names_all_its_options(script: Path) -> None:
    text = script.read_text("utf-8")
    told = introduction(text)
    asked = set(re.findall(r'option\("([\w-]+)"', text))
    assert {name for name in asked if f"--{name}" not in told} == set()
