"""Every command on a tiny capture: what it prints, what it writes, what it promises to scripts."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from photograd._checkpoint import load_checkpoint
from photograd._compiled import _core
from photograd.capture.write import write_blender_capture
from photograd.commands.version_info import describe_core
from photograd.images.read import read_image
from PIL import Image

from tests.commands.conftest import FIT, Photograd
from tests.fit import scene
from tests.fit.test_density_gradient import BOX, ball

EFFECTIVE = {  # of the common options: only those that change what a command does
    "fit": {"--seed", "--threads"},
    "gradients": {"--seed", "--threads"},
    "compare": {"--seed", "--threads"},
    "render": {"--threads"},
    "evaluate": {"--threads"},
    "info": set(),
}


@pytest.mark.parametrize("command", EFFECTIVE)
def test_help_is_complete(photograd: Photograd, command: str) -> None:
    done = photograd(command, "--help")
    assert done.code == 0
    assert f"photograd {command} " in done.out
    for option in ("--json", "--debug"):
        assert option in done.out
    assert {word for word in ("--seed", "--threads") if word in done.out} == EFFECTIVE[command]
    assert f"Example: photograd {command} " in done.out
    assert done.err == ""


def test_fit_tells_people_on_stderr_and_scripts_on_stdout(
    photograd: Photograd, capture_folder: Path, tmp_path: Path
) -> None:
    done = photograd("fit", capture_folder, "--out", tmp_path, *FIT, "--json")
    assert done.code == 0
    assert len(done.out.splitlines()) == 1
    result = done.result()
    assert set(result) >= {"model", "step", "finished", "seconds", "loss"}
    assert result["step"] == 40
    assert result["finished"] is True
    assert 0 < result["loss"] < 0.05
    assert Path(result["model"]) == tmp_path / "model.npz"
    assert load_checkpoint(tmp_path).meta["step"] == 40
    # The conversions of the capture, its split, where the scene is, and the progress.
    for words in ("OpenCV", "+Y up", "12 training views, 4 held out", "box: declared", "PSNR"):
        assert words in done.err
    assert sorted(path.name for path in (tmp_path / "snapshots").iterdir()) == [
        f"step_{step:06d}.npz" for step in (0, 1, 4, 12, 40)
    ]


def test_fit_prints_a_table_without_json(
    photograd: Photograd, capture_folder: Path, tmp_path: Path
) -> None:
    done = photograd("fit", capture_folder, "--out", tmp_path, "--steps", 2, "--resolution", 8)
    assert done.code == 0
    assert "finished" in done.out
    assert "{" not in done.out


def test_the_seed_decides_and_threads_do_not(
    photograd: Photograd, capture_folder: Path, tmp_path: Path
) -> None:
    values = {}
    for name, words in {
        "one thread": ("--seed", 1, "--threads", 1),
        "two threads": ("--seed", 1, "--threads", 2),
        "another seed": ("--seed", 2, "--threads", 1),
    }.items():
        few = ("--steps", 12, "--resolution", 16, "--rays", 256)
        assert photograd("fit", capture_folder, "--out", tmp_path / name, *few, *words).code == 0
        values[name] = load_checkpoint(tmp_path / name).params["values"]
        assert _core.thread_count() == words[3]
    assert np.array_equal(values["one thread"], values["two threads"])
    assert not np.array_equal(values["one thread"], values["another seed"])


def test_evaluate_prints_its_protocol_and_its_numbers(
    photograd: Photograd, capture_folder: Path, model_folder: Path, tmp_path: Path
) -> None:
    strips = tmp_path / "strips.png"
    done = photograd("evaluate", model_folder, capture_folder, "--json", "--out", strips)
    assert done.code == 0
    result = done.result()
    assert set(result) >= {"psnr", "ssim", "views", "protocol", "half_step"}
    assert 0 < result["half_step"]["mean"] < result["half_step"]["largest"] < 0.1
    assert result["half_step"]["views"] == 2
    assert 25 < result["psnr"] < 60
    assert 0.8 < result["ssim"] < 1
    assert [view["name"] for view in result["views"]] == [f"test/test_{k}" for k in range(4)]
    assert result["psnr"] == pytest.approx(np.mean([view["psnr"] for view in result["views"]]))
    for words in ("4 held-out views at 24x24", "white", "sRGB", "rounded to 8 bits"):
        assert words in result["protocol"]
    assert "held-out views" in done.err
    assert "warning" not in done.err
    with Image.open(strips) as picture:
        assert picture.size[0] > 300
    shown = photograd("evaluate", model_folder, capture_folder)
    assert "rounded to 8 bits" in " ".join(shown.out.split())


def test_evaluate_warns_where_the_split_is_another(
    photograd: Photograd, model_folder: Path, tmp_path: Path
) -> None:
    other = scene.write(tmp_path / "fewer", train=5)
    done = photograd("evaluate", model_folder, other, "--json")
    assert done.code == 0
    assert "warning: the model was fitted on another split" in done.err


def test_render_writes_a_gif_or_frames(
    photograd: Photograd, model_folder: Path, tmp_path: Path
) -> None:
    gif = tmp_path / "turn.gif"
    words = ("render", model_folder, "--frames", 5, "--size", 32, "--json")
    done = photograd(*words, "--out", gif)
    assert done.code == 0
    assert done.result() == {"out": str(gif), "frames": 5}
    with Image.open(gif) as picture:
        assert picture.n_frames == 5
        assert picture.size == (32, 32)
    folder = tmp_path / "frames"
    assert photograd(*words, "--out", folder).result()["frames"] == 5
    frames = [read_image(path) for path in sorted(folder.glob("*.png"))]
    assert len(frames) == 5
    # The scene is there, over white, and looks different from every side.
    assert all(frame[..., :3].min() < 0.8 for frame in frames)
    assert all(frame[0, 0].tolist() == [1, 1, 1, 1] for frame in frames)
    assert all(not np.array_equal(frames[0], frame) for frame in frames[1:])
    twice = photograd(*words, "--out", tmp_path / "again.gif")
    assert twice.code == 0
    assert (tmp_path / "again.gif").read_bytes() == gif.read_bytes()


PICTURES = {"gradient_slices", "gradient_projections", "gradient_steps", "curves"}


def test_gradients_draws_the_fit_and_reports_signs(photograd: Photograd, tmp_path: Path) -> None:
    frames = [(view.name, view.camera, view.rgba(), None) for view in ball().train]
    write_blender_capture(tmp_path / "ball", {"train": frames}, aabb=BOX)
    few = ("--steps", 10, "--resolution", 96, "--rays", 256)
    assert photograd("fit", tmp_path / "ball", "--out", tmp_path / "model", *few).code == 0
    words = ("--rays", 1 << 16, "--json", "--out", tmp_path / "pictures")
    done = photograd("gradients", tmp_path / "model", tmp_path / "ball", *words)
    assert done.code == 0
    result = done.result()
    for name in PICTURES:
        with Image.open(result[name]) as picture:
            assert min(picture.size) > 100
    assert {path.stem for path in (tmp_path / "pictures").iterdir()} == PICTURES
    assert result["steps"] == [0, 1, 3, 10]
    assert result["views_of_signs"] == 5  # one of six is held out
    assert result["occupied_negative"] >= 0.95
    assert result["background_positive"] >= 0.95


def test_gradients_says_when_it_cannot_weigh_signs(
    photograd: Photograd, capture_folder: Path, model_folder: Path, tmp_path: Path
) -> None:
    # 8 voxels at the start of the fit: none of them lies wholly inside of a ball.
    words = ("--rays", 2000, "--json", "--out", tmp_path / "deep" / "pictures")
    done = photograd("gradients", model_folder, capture_folder, *words)
    assert done.code == 0
    assert "signs are shown, not weighed" in done.err
    assert "occupied_negative" not in done.result()
    assert {path.stem for path in (tmp_path / "deep" / "pictures").iterdir()} == PICTURES


def test_info_on_a_capture_and_on_a_model(
    photograd: Photograd, capture_folder: Path, model_folder: Path
) -> None:
    found = photograd("info", capture_folder, "--json").result()
    assert found["kind"] == "capture"
    assert found["format"] == "blender"
    assert (found["train"], found["test"], found["val"]) == (12, 4, 0)
    assert found["sizes"] == ["24x24"]
    assert found["alpha"] is True
    assert found["color_space"] == "display"
    np.testing.assert_allclose(found["box"], [[-0.8, -0.6, -0.7], [0.8, 0.6, 0.7]], atol=1e-9)
    assert any("+Y up" in line for line in found["conversions"])
    for place in (model_folder, model_folder / "model.npz"):
        model = photograd("info", place, "--json").result()
        assert model["kind"] == "model"
        assert model["representation"] == "dense_grid"
        assert model["shape"] == [16, 12, 14, 4]
        assert model["step"] == model["steps"] == 40
        assert model["split"] == found["split"]
        assert model["seed"] == 1
        assert model["megabytes"] == pytest.approx(16 * 12 * 14 * 4 * 4 / 1e6)
        assert 15 < model["batch_psnr"] < 50


def test_the_core_describes_itself_for_bug_reports() -> None:
    _core.set_thread_count(1)
    assert describe_core() == {"instruction_set": _core.instruction_set(), "threads": 1}
