"""Checkpoints: whole or not at all, and refused when damaged."""

from __future__ import annotations

import errno
import json
import os
import resource
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from photograd._checkpoint import Checkpoint, load_checkpoint, save_checkpoint
from photograd.errors import Error, IoError
from photograd.fitting.loop import Fit
from photograd.fitting.model import load_model

from tests.fit import scene


def sample() -> Checkpoint:
    g = np.random.default_rng(1)
    return Checkpoint(
        {"step": 7, "options": {"seed": 3}},
        {"values": g.uniform(size=(3, 4, 5, 4)).astype(np.float32), "background": np.ones(3)},
        {"step/values": np.array(7, np.int64), "mean/values": g.uniform(size=(3, 4))},
        {"occupancy": np.arange(5)},
        np.array([[0, 0.5, 3.0], [1, 0.25, 6.0]]),
    )


@pytest.fixture(scope="module")
def model(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A short fit's folder."""
    folder = tmp_path_factory.mktemp("fit")
    Fit.start(scene.capture(), scene.options(resolution=8, steps=3, rays=64)).run(folder)
    return folder


def test_everything_comes_back(tmp_path: Path) -> None:
    saved = sample()
    save_checkpoint(tmp_path / "model.npz", saved)
    for place in (tmp_path, tmp_path / "model.npz"):
        loaded = load_checkpoint(place)
        assert loaded.meta == {"version": 2, **saved.meta}
        for part in ("params", "optimizer", "state"):
            before, after = getattr(saved, part), getattr(loaded, part)
            assert set(before) == set(after)
            for name, array in before.items():
                assert after[name].dtype == array.dtype
                assert np.array_equal(after[name], array)
        assert np.array_equal(loaded.history, saved.history)
    assert [path.name for path in tmp_path.iterdir()] == ["model.npz"]


def test_a_path_may_be_text(model: Path) -> None:
    expected = load_model(model)
    for place in (str(model), str(model / "model.npz")):
        loaded = load_model(place)
        assert loaded.meta == expected.meta
        assert np.array_equal(loaded.field.params["values"], expected.field.params["values"])


def test_a_missing_one_says_what_to_do(tmp_path: Path) -> None:
    missing = (tmp_path, tmp_path / "nothing", tmp_path / "nothing.npz", str(tmp_path / "nothing"))
    for place in missing:
        with pytest.raises(IoError, match=r"expected a model .*\(run 'photograd fit' first\)"):
            load_checkpoint(place)


@pytest.mark.parametrize("keep", [0.0, 0.1, 0.5, 0.9, 0.999])
def test_a_truncated_one_is_refused(tmp_path: Path, model: Path, keep: float) -> None:
    content = (model / "model.npz").read_bytes()
    (tmp_path / "model.npz").write_bytes(content[: int(keep * len(content))])
    with pytest.raises(IoError, match=r"expected a photograd checkpoint, got .*is damaged"):
        load_checkpoint(tmp_path)


@settings(
    max_examples=150,
    deadline=None,
    derandomize=True,
    suppress_health_check=[HealthCheck.function_scoped_fixture],
)
@given(place=st.floats(0, 1, exclude_max=True), change=st.integers(1, 255), directory=st.booleans())
@pytest.mark.filterwarnings("ignore")  # NumPy and zipfile warn about some damages, which is fine
def test_a_changed_byte_is_refused_or_harmless(
    model: Path, tmp_path: Path, place: float, change: int, directory: bool
) -> None:
    good = (model / "model.npz").read_bytes()
    content = bytearray(good)
    # The directory at the end of the file is what checksums do not protect: half of the changes.
    start = len(good) - 2000 if directory else 0
    content[start + int(place * (len(good) - start))] ^= change
    (tmp_path / "model.npz").write_bytes(content)
    original = load_model(model)
    try:
        loaded = load_model(tmp_path)
    except Error:
        return
    assert np.array_equal(loaded.field.params["values"], original.field.params["values"])


def rewrite(folder: Path, target: Path, change: Any) -> Path:
    with np.load(folder / "model.npz") as archive:
        arrays: dict[str, Any] = {name: archive[name] for name in archive.files}
    change(arrays)
    np.savez(target / "model.npz", **arrays)
    return target


def with_meta(**entries: Any) -> Any:
    def change(arrays: dict[str, Any]) -> None:
        meta = json.loads(str(arrays["meta"])) | entries
        meta = {key: value for key, value in meta.items() if value is not None}
        arrays["meta"] = np.array(json.dumps(meta))

    return change


DAMAGES = {
    "another version": (with_meta(version=99), "expected version 2, got 99"),
    "no policy": (with_meta(policy=None), "of a fit, got .*MarchPolicy: expected an object"),
    "no options": (with_meta(options=None), "FitOptions: expected an object, got None"),
    "unknown option": (with_meta(options={"refine_at": [0, 0], "sharpness": 1}), "sharpness"),
    "bad option": (with_meta(options={"refine_at": [0, 0], "rays": -1}), "rays: expected"),
    "no values": (lambda a: a.pop("params.values"), "missing or unknown values"),
    "text for values": (
        lambda a: a.update({"params.values": np.array("x")}),
        "params.values that is no array of numbers",
    ),
    "flat values": (lambda a: a.update({"params.values": np.zeros(4)}), "values: expected shape"),
    "meta is a list": (lambda a: a.update(meta=np.array("[]")), "no JSON object but list"),
    "meta is no JSON": (lambda a: a.update(meta=np.array("{")), "expected a photograd checkpoint"),
    "no history": (lambda a: a.pop("history"), "history"),
    "flat history": (lambda a: a.update(history=np.zeros(3)), r"a history of shape \(3,\)"),
    "objects": (
        lambda a: a.update({"state.x": np.array([{}], object)}),
        "expected a photograd checkpoint",
    ),
}


@pytest.mark.parametrize("name", DAMAGES)
def test_contents_that_do_not_fit_are_refused(tmp_path: Path, model: Path, name: str) -> None:
    change, words = DAMAGES[name]
    with pytest.raises(Error, match=words):
        load_model(rewrite(model, tmp_path, change))


@pytest.mark.parametrize("key", ["split", "pixels"])
def test_a_model_that_is_no_fit_cannot_be_resumed(tmp_path: Path, model: Path, key: str) -> None:
    rewrite(model, tmp_path, with_meta(**{key: None}))
    with pytest.raises(IoError, match=rf"that of a fit, got one without \['{key}'\]"):
        Fit.resume(scene.capture(), tmp_path)


def test_a_full_disk_keeps_the_old_checkpoint(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    options = scene.options(resolution=8, steps=30, rays=64)
    fit = Fit.start(scene.capture(), options)
    stop_after(fit, tmp_path, 5)
    before = (tmp_path / "model.npz").read_bytes()

    def full(_: int) -> None:
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    with monkeypatch.context() as patch:
        patch.setattr(os, "fsync", full)
        with pytest.raises(IoError, match=r"No space left on device.*the old file is unchanged"):
            fit.run(tmp_path, checkpoint_seconds=0.0)
    assert (tmp_path / "model.npz").read_bytes() == before
    assert [path.name for path in tmp_path.glob(".*")] == []
    # With room again, the fit goes on from there and ends as if nothing had been.
    resumed = Fit.resume(scene.capture(), tmp_path)
    assert resumed.step_number == 5
    resumed.run(tmp_path)
    straight = Fit.start(scene.capture(), options)
    straight.run(tmp_path / "straight")
    assert np.array_equal(resumed.model.params["values"], straight.model.params["values"])


def test_a_file_size_limit_keeps_the_old_checkpoint(tmp_path: Path) -> None:
    # The real thing, without a stand-in: the kernel refuses to let the file grow (EFBIG).
    fit = Fit.start(scene.capture(), scene.options(resolution=8, steps=20, rays=64))
    stop_after(fit, tmp_path, 5)
    before = (tmp_path / "model.npz").read_bytes()
    soft, hard = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (len(before) // 2, hard))
    try:
        with pytest.raises(IoError, match="the old file is unchanged"):
            fit.save(tmp_path)
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, (soft, hard))
    assert (tmp_path / "model.npz").read_bytes() == before
    assert [path.name for path in tmp_path.glob(".*")] == []


def stop_after(fit: Fit, folder: Path, steps: int) -> None:
    fit.run(folder, should_stop=lambda: fit.step_number >= steps)
    assert fit.step_number == steps


def test_a_folder_that_cannot_be_made_is_named(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("in the way")
    fit = Fit.start(scene.capture(), scene.options(resolution=8, steps=2, rays=64))
    with pytest.raises(IoError, match=r"make_folder: folder: expected a folder .*file/model"):
        fit.run(tmp_path / "file" / "model")
    assert fit.step_number == 0
