"""The stages: run in order, gone on with where they were interrupted, refused with reasons."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
from photograd.capture import load_capture
from photograd.capture.capture import Capture
from photograd.capture.sfm.engine import Settings
from photograd.capture.sfm.reconstruct import AGREEING, Report, reconstruct
from photograd.errors import IoError, SceneError
from PIL import Image

from tests.sfm.fake import FakeEngine, photographs

pytestmark = pytest.mark.usefixtures("source")


def run(tmp_path: Path, engine: FakeEngine, **options: object) -> tuple[Capture, Report, list[str]]:
    """A reconstruction in out/ of the photographs in in/, and what was said."""
    lines: list[str] = []
    settings = options.pop("settings", Settings())
    capture, report = reconstruct(
        tmp_path / "in",
        tmp_path / "out",
        settings,
        note=lines.append,
        engine=engine,
        threads=4,
        **options,
    )  # type: ignore[arg-type]
    return capture, report, lines


@pytest.fixture
def source(tmp_path: Path) -> Path:
    return photographs(tmp_path / "in")


def test_photographs_become_a_capture(tmp_path: Path, source: Path) -> None:
    engine = FakeEngine()
    capture, report, _ = run(tmp_path, engine)
    assert report == Report(9, 9, (), cameras=1, models=1, points=40, error=0.25)
    assert engine.calls == ["extract"] * 3 + ["match"] * 2 + ["map"]  # by 4, by 24
    assert engine.groups == [sorted(path.name for path in source.iterdir())]
    assert len(engine.compared) == 36
    assert engine.agreeing == [AGREEING[0]]
    again = load_capture(tmp_path / "out")
    assert (again.format, len(again.train), len(again.test)) == ("colmap", 7, 2)
    assert again.points is not None
    assert again.points.shape == (40, 3)
    assert again.point_colors is not None
    assert capture.split_hash() == again.split_hash()
    with Image.open(tmp_path / "out/cameras.png") as picture:
        pixels = np.asarray(picture.convert("RGB")).astype(int)
    blue = (pixels[..., 2] - pixels[..., 0] > 90).mean()
    orange = (pixels[..., 0] - pixels[..., 2] > 120).mean()
    assert 0 < orange < blue < 0.05


@pytest.mark.parametrize(
    ("stage", "repeated"), [("extract", {"extract": 4}), ("match", {"match": 3}), ("map", {})]
)
def test_what_was_done_is_not_done_again(
    tmp_path: Path, stage: str, repeated: dict[str, int]
) -> None:
    engine = FakeEngine(placed=[8, 8, 8, 8])
    engine.interrupt = stage
    with pytest.raises(KeyboardInterrupt):
        run(tmp_path, engine)
    assert not (tmp_path / "out/cameras.png").exists()
    engine.interrupt = ""
    _, report, lines = run(tmp_path, engine)
    assert f"going on with what {tmp_path / 'out'} holds" in lines
    assert report.registered == 8
    counts = {name: engine.calls.count(name) for name in ("extract", "match")}
    assert counts == {"extract": 3, "match": 2} | repeated  # the one that was cut off, once more
    before = list(engine.calls)
    _, report, _ = run(tmp_path, engine)
    assert report.registered == 8
    assert engine.calls == before


def test_a_lenient_attempt_follows_and_must_be_better(tmp_path: Path) -> None:
    engine = FakeEngine(placed=[5, 8])
    _, report, lines = run(tmp_path, engine)
    assert engine.agreeing == list(AGREEING)
    assert report.registered == 8
    assert report.left_out == ("0008.png",)
    assert "5 of 9 photographs placed; a second attempt asks for half as much" in lines
    assert len(load_capture(tmp_path / "out").views) == 8
    engine = FakeEngine(placed=[6, 6])
    _, report, _ = run(tmp_path, engine, overwrite=True)
    assert report.registered == 6
    assert len(load_capture(tmp_path / "out").views) == 6
    assert not list((tmp_path / "out").glob(".*"))


def test_photographs_that_nothing_connects_are_refused(tmp_path: Path) -> None:
    for placed in ([0, 0], [2, 2]):  # two are a pair, and no reconstruction
        with pytest.raises(SceneError, match=r"9 of which no three could be placed .*overlap"):
            run(tmp_path, FakeEngine(placed), overwrite=True)
    _, report, _ = run(tmp_path, FakeEngine([2, 3]))  # and the features are still there
    assert report.registered == 3


def test_other_photographs_or_settings_need_another_folder(tmp_path: Path, source: Path) -> None:
    run(tmp_path, FakeEngine())
    with pytest.raises(IoError, match="same photographs with the same settings, got another"):
        run(tmp_path, FakeEngine(), settings=Settings(seed=1))
    (source / "0003.png").write_bytes((source / "0004.png").read_bytes())
    with pytest.raises(IoError, match="--overwrite begins anew"):
        run(tmp_path, FakeEngine())
    engine = FakeEngine()
    run(tmp_path, engine, overwrite=True)
    assert engine.calls.count("extract") == 3
    (tmp_path / "out/capture.json").write_text("{")
    with pytest.raises(IoError, match="got another"):
        run(tmp_path, FakeEngine())


def test_what_is_not_ours_is_left_alone(tmp_path: Path, source: Path) -> None:
    (tmp_path / "out").mkdir()
    (tmp_path / "out/thesis.txt").write_text("years")
    with pytest.raises(IoError, match="a new folder, got one with content"):
        run(tmp_path, FakeEngine())
    for _ in range(2):
        _, _, lines = run(tmp_path, FakeEngine(), overwrite=True)
        assert lines[-1] == "not ours, left as it is: thesis.txt"
        (tmp_path / "out/images/scan.png").write_bytes(b"mine")
        _, _, lines = run(tmp_path, FakeEngine(), overwrite=True)
        assert lines[-1] == "not ours, left as it is: images/scan.png, thesis.txt"
        (tmp_path / "out/images/scan.png").unlink()
    assert (tmp_path / "out/thesis.txt").read_text() == "years"
    (tmp_path / "out/capture.json").unlink()  # a model of another hand, as far as we can tell
    with pytest.raises(IoError, match=r"that photograd did not write, got .*move it away"):
        run(tmp_path, FakeEngine(), overwrite=True)
    assert len(load_capture(tmp_path / "out").views) == 9
    for out in (source, tmp_path):
        with pytest.raises(IoError, match="a folder that does not hold the photographs"):
            reconstruct(source, out, Settings(), note=print, overwrite=True, engine=FakeEngine())
    assert len(list(source.iterdir())) == 9


def test_the_state_says_what_went_in(tmp_path: Path) -> None:
    run(tmp_path, FakeEngine())
    state = json.loads((tmp_path / "out/capture.json").read_text())
    assert state["settings"]["seed"] == 0
    assert len(state["photographs"]) == len(state["models"][0]["names"]) == 9
