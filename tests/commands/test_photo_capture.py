"""`photograd capture --photos`: what it prints, what it asks for, how it fails."""

from __future__ import annotations

import sys
from pathlib import Path

import pytest
from photograd.capture.sfm import reconstruct
from photograd.commands.capture import beside

from tests.commands.conftest import Photograd
from tests.sfm.fake import FakeEngine, photographs


@pytest.fixture
def source(tmp_path: Path) -> Path:
    return photographs(tmp_path / "trip")


def test_a_folder_of_photographs_becomes_a_capture_beside_it(
    photograd: Photograd, source: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(reconstruct, "open_engine", FakeEngine([6, 6]))
    done = photograd("capture", "--photos", source, "--json")
    assert done.code == 0, done.err
    result = done.result()
    out = source.with_name("trip_capture")
    assert result["out"] == str(out)
    assert (result["photographs"], result["registered"], result["points"]) == (9, 6, 40)
    assert result["reprojection_error_px"] == 0.25
    assert Path(result["picture"]).is_file()
    assert "without a pose: 0006.png, 0007.png, 0008.png" in done.err
    assert "warning: many photographs found no place" in done.err
    for stage in ("features", "matches", "cameras"):
        assert f"{stage} " in done.err
    seen = photograd("info", out, "--json").result()
    assert (seen["kind"], seen["points"]) == ("capture", 40)


def test_the_folder_one_stands_in_has_a_name(source: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(source)
    assert beside(Path()) == source.with_name("trip_capture")
    assert beside(Path("a/b")) == Path("a/b_capture")


def test_options_of_the_other_kind_are_refused(photograd: Photograd, source: Path) -> None:
    for words, says in [
        (("--photos", source, "--views", 5), "--views: has no meaning beside --photos"),
        (("--out", source.with_name("x"), "--pairs", "all"), "--pairs: has no meaning without"),
        (("--photos", source, "--pairs", "some"), "--pairs: one of auto, all, walk"),
        ((), "--out: a scene needs one"),
    ]:
        done = photograd("capture", *words)
        assert done.code == 2
        assert says in done.err
        assert done.err.count("\n") == 1


def test_bad_folders_and_a_missing_package_end_in_one_line(
    photograd: Photograd, source: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(sys.modules, "pycolmap", None)
    done = photograd("capture", "--photos", source)
    assert (done.code, done.out) == (1, "")
    assert done.err.count("\n") == 1
    assert "pip install 'photograd[sfm]'" in done.err
    monkeypatch.setattr(reconstruct, "open_engine", FakeEngine([6, 6]))
    done = photograd("capture", "--photos", source / "none")
    assert done.code == 1
    assert "expected a folder, got none" in done.err
    assert not source.with_name("trip_capture").exists()
