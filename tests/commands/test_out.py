"""--out: what is replaced, what stays, and what is refused before the work."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.commands.conftest import Photograd

SMALL = (
    "--scene",
    "smooth_curves",
    "--views",
    "2",
    "--test-views",
    "1",
    "--size",
    "8",
    "--spp",
    "1",
)


def test_overwriting_a_capture_leaves_a_thesis_alone(photograd: Photograd, tmp_path: Path) -> None:
    thesis = tmp_path / "thesis.tex"
    thesis.write_text("years")
    done = photograd("capture", *SMALL, "--out", tmp_path)
    assert done.code == 1
    assert "expected a new folder, got one with content (choose another" in done.err
    for _ in range(2):
        done = photograd("capture", *SMALL, "--out", tmp_path, "--overwrite")
        assert done.code == 0, done.err
        assert "not ours, left as it is: thesis.tex" in done.err
        assert thesis.read_text() == "years"
    (tmp_path / "capture.json").unlink()
    done = photograd("capture", *SMALL, "--out", tmp_path, "--overwrite")
    assert done.code == 1
    assert "that photograd did not write" in done.err
    assert "capture 1/3" not in done.err  # before anything was rendered


def test_the_folder_one_stands_in_can_hold_a_capture(
    photograd: Photograd, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    for _ in range(2):
        assert photograd("capture", *SMALL, "--out", ".", "--overwrite").code == 0
    assert photograd("info", ".", "--json").result()["train"] == 2
    assert not list(tmp_path.glob(".*"))


@pytest.mark.parametrize("command", ["capture", "fit", "recover", "trace", "compare", "demo"])
@pytest.mark.parametrize(
    ("name", "says"),
    [("", "got an empty one"), ("x" * 300, "got one of 300 characters (shorten it)")],
    ids=["empty", "long"],
)
def test_a_name_that_no_file_can_have_is_refused_before_the_work(
    photograd: Photograd,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    command: str,
    name: str,
    says: str,
) -> None:
    monkeypatch.chdir(tmp_path)
    needed = {
        "fit": ["capture"],
        "recover": ["cornell-box", "--target", "x.exr", "--parameter", "materials.red.albedo"],
        "trace": ["cornell-box"],
    }
    done = photograd(command, *needed.get(command, []), "--out", name)
    assert (done.code, done.out) == (2, "")
    assert says in done.err
    assert done.err.count("\n") == 1
    assert not list(tmp_path.iterdir())


def test_what_a_killed_trace_left_goes_with_the_next(photograd: Photograd, tmp_path: Path) -> None:
    halves = [f".x.{kind}.99999.tmp" for kind in ("exr", "png", "sums.npz")]
    for name in (*halves, ".x.lock", ".x.exr.notes.tmp", ".y.exr.99999.tmp"):
        (tmp_path / name).write_bytes(b"half")
    words = ("trace", "cornell-box", "--size", 8, "--spp", 1, "--out", tmp_path / "x.exr")
    assert photograd(*words).code == 0
    hidden = sorted(path.name for path in tmp_path.glob(".*"))
    assert hidden == [".x.exr.notes.tmp", ".y.exr.99999.tmp"]  # another's, and of another picture
