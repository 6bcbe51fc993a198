"""A known scene is recovered from its photographs, and the fit's own gradient is right."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from photograd.capture.view import View
from photograd.fields import DenseGrid
from photograd.fitting import FitOptions
from photograd.fitting.evaluate import as_result, evaluate
from photograd.fitting.loop import Fit
from photograd.fitting.model import Model
from photograd.fitting.steps import Background, background_color
from photograd.representation import RayBatch, RenderOptions
from photograd_course.color import srgb_encode
from photograd_course.gradcheck import check_gradient

from support.bits import same_bits
from tests.fit import scene

# T11 at 24 voxels, 200 steps of 1024 rays: over 16 seeds held-out PSNR was 35.7 to 36.2 dB over
# random backgrounds (5th percentile 35.75), over 10 seeds 36.1 to 37.1 dB with a learned one
# (5th percentile 36.17). The gates are 1 dB lower. The mean color of all photographs scores 17 dB.
RECOVERS = {"resolution": 24, "steps": 200, "rays": 1024}
WALL = (0.9, 0.6, 0.3)


def finish(fit: Fit) -> Model:
    while fit.step_number < fit.options.steps:
        fit.step()
    raw = fit.background
    behind = None if raw is None else 1 / (1 + np.exp(-raw.astype(np.float64)))
    return Model(fit.model, behind, fit.options, {}, np.array(fit.history))


def test_a_known_scene_is_recovered() -> None:
    capture = scene.capture()
    fit = Fit.start(capture, scene.options(**RECOVERS))
    first = evaluate(scene.as_model(fit.model), capture.test)
    model = finish(fit)
    result = evaluate(model, capture.test)
    assert first.psnr < 18
    assert result.psnr >= 34.7
    assert result.ssim >= 0.96  # 0.975 at the lowest PSNR seen
    assert as_result(result)["psnr"] == result.psnr
    # The volume too: where the balls are opaque, light is stopped; beside them it passes.
    center, radius, color = scene.BALLS[0]
    origins = np.array([[-3.0, center[1], center[2]], [-3.0, -0.5, 0.6]])
    batch = RayBatch(origins, np.array([[1.0, 0, 0]] * 2), np.arange(2, dtype=np.uint32))
    outputs, _ = model.field.render(batch, seed=0, step=0, options=RenderOptions())
    assert outputs.opacity is not None
    assert outputs.depth is not None
    assert outputs.opacity[0] > 0.99
    assert outputs.opacity[1] < 0.05
    depth = outputs.depth[0] / outputs.opacity[0]
    voxel = 1.6 / 24
    # Measured: 0.38 voxels, and 0.035.
    assert depth == pytest.approx(3 + center[0] - radius, abs=voxel)
    np.testing.assert_allclose(outputs.color[0] / outputs.opacity[0], color, atol=0.05)


def test_64_voxels_are_recovered_from_thirty_photographs_of_100_pixels() -> None:
    # More than 26 dB is asked for; measured: 34.0 with these few rays, 38.2 with three times as
    # many. The nearly empty start scores 17.9 dB.
    cameras = {
        "train": [c for up in (35.0, -10.0) for c in scene.cameras(15, elevation=up, size=100)],
        "test": scene.cameras(4, elevation=15.0, size=100),
    }
    views = {
        split: tuple(View(f"{split}_{k}", c, scene.photograph(c)) for k, c in enumerate(members))
        for split, members in cameras.items()
    }
    capture = replace(scene.capture(), train=views["train"], test=views["test"])
    fit = Fit.start(capture, scene.options(resolution=64, steps=100, rays=1024))
    model = finish(fit)
    assert model.field.shape[:3] == (64, 48, 56)
    assert evaluate(model, capture.test).psnr > 32


def test_photographs_without_alpha_get_a_learned_background() -> None:
    capture = scene.capture(wall=WALL)
    model = finish(Fit.start(capture, scene.options(**RECOVERS)))
    assert model.background is not None
    np.testing.assert_allclose(srgb_encode(model.background), WALL, atol=0.01)
    assert evaluate(model, capture.test).psnr >= 35.1


def test_fixed_backgrounds_stand_behind_every_ray() -> None:
    capture = scene.capture()
    white, black = (
        Fit.start(capture, scene.options(background=kind)) for kind in ("white", "black")
    )
    for fit, color in ((white, [1, 1, 1]), (black, [0, 0, 0])):
        behind = Background(fit.background, fit.background_kind)
        assert background_color(behind, 5, seed=1, step=0).tolist() == color
    assert white.step() != black.step()


@same_bits("fit of a dense grid")
def all_state_of_a_fit(seed: int = 1) -> list[Any]:
    fit = Fit.start(scene.capture(wall=WALL), scene.options(seed=seed))
    finish(fit)
    return [fit.model.params["values"], fit.background, *fit.optimizer.state().values()]


def test_another_seed_gives_another_fit() -> None:
    assert not np.array_equal(all_state_of_a_fit()[0], all_state_of_a_fit(seed=2)[0])


@pytest.mark.parametrize("wall", [None, WALL], ids=["random background", "learned background"])
def test_gradient_of_a_whole_step(wall: Any) -> None:
    # The fit's loss of fixed pixels in double precision, background included: rays, march, both
    # composites, encoding, error.
    fit = Fit.start(scene.capture(wall=wall), scene.options(resolution=8, stop=0.0))
    for _ in range(10):
        fit.step()
    fit.model.params = {"values": fit.model.params["values"].astype(np.float64)}
    start = {"values": fit.model.params["values"].copy()}
    if wall is not None:
        assert fit.background is not None
        start["background"] = fit.background.astype(np.float64)
    chosen = fit.data.draw(200, seed=9, step=0)

    def both(p: dict[str, Any]) -> tuple[float, dict[str, Any]]:
        fit.model.params = {"values": p["values"]}
        fit.background = p.get("background")
        return fit.loss_and_gradients(chosen)

    report = check_gradient(
        lambda p: both(p)[0],
        lambda p, d: {name: d * gradient for name, gradient in both(p)[1].items()},
        start,
        seed=1,
        directions=4,
        coordinates=16,
    )
    assert report, str(report)


def test_refining_keeps_the_image() -> None:
    # Where the coarse field is affine, upsampling is exact; elsewhere it rounds corners off. After
    # 60 steps, over ten seeds, the worst of four views moved by 0.0047 to 0.0055 root mean square
    # (46 to 45 dB): twice that is allowed. One view differs from the next by 0.12.
    capture = scene.capture()
    fit = Fit.start(capture, scene.options(resolution=12))
    finish(fit)
    coarse, fine = fit.model, fit.model.refined(24)
    assert fine.params["values"].shape[0] == 2 * coarse.params["values"].shape[0]
    a, b = (evaluate(scene.as_model(field), capture.test) for field in (coarse, fine))
    moved = [
        np.sqrt(np.mean((p.render - q.render) ** 2)) for p, q in zip(a.views, b.views, strict=True)
    ]
    apart = np.sqrt(np.mean((a.views[0].render - a.views[1].render) ** 2))
    assert 0 < max(moved) < 0.011
    assert apart > 0.1


def test_levels_of_the_schedule() -> None:
    assert FitOptions(resolution=128, steps=1000).levels() == {0: 32, 150: 64, 400: 128}
    assert FitOptions(resolution=16, steps=100).levels() == {0: 8, 15: 8, 40: 16}
    assert FitOptions(resolution=9, steps=100).levels() == {0: 8, 15: 8, 40: 9}
    # So few steps that levels coincide: the finest wins, and is reached.
    assert list(FitOptions(resolution=64, steps=2).levels().values())[-1] == 64


def test_every_level_is_visited() -> None:
    fit = Fit.start(scene.capture(), scene.options(resolution=32, steps=20))
    seen = []
    while fit.step_number < 20:
        fit.step()
        seen.append(max(fit.model.params["values"].shape[:3]))
    assert seen == [8] * 3 + [16] * 5 + [32] * 12
    assert isinstance(fit.model, DenseGrid)
