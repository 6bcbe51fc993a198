"""With --json the last line of stdout is the result, and the only line there."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
from photograd_course.cli import emit, note
from photograd_course.errors import DtypeError

RESULT = {
    "psnr": np.float32(20.5),
    "views": np.int64(8),
    "best": float("inf"),
    "nothing": None,
    "file": Path("a") / "b.png",
    "size": np.array([4, 3]),
    "nested": {"ssim": 0.9, "worst": float("-inf"), "none": float("nan")},
    "rows": [{"view": 0, "psnr": 20.0}, {"view": 1, "psnr": 21.0}],
}


def test_json_goes_alone_to_stdout(capsys: pytest.CaptureFixture[str]) -> None:
    emit(RESULT, as_json=True, title="evaluate")
    captured = capsys.readouterr()
    assert captured.out.endswith("}\n")
    assert captured.out.count("\n") == 1
    result = json.loads(captured.out)
    assert list(result) == list(RESULT)
    assert result["psnr"] == 20.5
    assert result["best"] == "inf"
    assert result["nested"] == {"ssim": 0.9, "worst": "-inf", "none": "nan"}
    assert result["file"] == str(Path("a") / "b.png")
    assert result["size"] == [4, 3]
    assert result["rows"] == RESULT["rows"]
    assert "evaluate" in captured.err


def test_without_json_a_table_goes_to_stdout(capsys: pytest.CaptureFixture[str]) -> None:
    emit(RESULT, as_json=False)
    captured = capsys.readouterr()
    assert captured.err == ""
    for part in ("psnr", "20.5", "nested.ssim", "0.9", "none", "4, 3", "view", "21"):
        assert part in captured.out


def test_markup_in_values_is_shown_as_it_is(capsys: pytest.CaptureFixture[str]) -> None:
    emit({"path": "[bold]x[/]"}, as_json=False)
    note("see [red]this[/]\nand that")
    captured = capsys.readouterr()
    assert "[bold]x[/]" in captured.out
    assert captured.err == "see [red]this[/] and that\n"


def test_a_path_longer_than_the_terminal_is_not_broken(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("COLUMNS", "40")
    path = "/".join(["a_folder"] * 12)
    emit({"archive": path, "files": 3}, as_json=False, title="Submission")
    assert capsys.readouterr().out == f"Submission\n  archive    {path}\n  files      3\n"


def test_an_unknown_type_is_named_and_nothing_is_printed(
    capsys: pytest.CaptureFixture[str],
) -> None:
    with pytest.raises(DtypeError, match=r"emit: nested.odd\[1\]: expected .*, got set"):
        emit({"fine": 1, "nested": {"odd": [1, {2}]}}, as_json=True)
    assert capsys.readouterr().out == ""
