"""The plan's loss and gradient, and recovering a known texture from samples of it."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from photograd.errors import DtypeError, Error, IoError, RangeError, ShapeError
from photograd.textures import (
    TexturePlan,
    loss_and_gradient,
    recover,
    sample,
    sample_backward,
    stable_learning_rate,
)
from photograd_course.gradcheck import check_gradient

from tests.texture.oracle import corners, noise, points


@pytest.mark.parametrize("channels", [1, 2, 3, 4])
@pytest.mark.parametrize("shape", [(2, 3), (1, 5), (4, 1), (1, 1), (17, 33), (40, 53)])
def test_loss_and_gradient_are_those_of_lookup_and_adjoint(
    shape: tuple[int, int], channels: int
) -> None:
    texture, uv, colors = noise((*shape, channels), 1), points(900, 2), noise((900, channels), 3)
    loss, gradient = loss_and_gradient(texture, uv, colors)
    error = sample(texture, uv) - colors
    assert loss == pytest.approx(np.square(error).mean(), rel=1e-13)
    expected, _ = sample_backward(texture, uv, error * (2 / error.size))
    assert np.abs(expected).max() > 1e-3
    np.testing.assert_allclose(gradient, expected, atol=1e-14)


def test_gradient_agrees_with_central_differences() -> None:
    uv, colors = points(300, 2), noise((300, 3), 3)
    plan = TexturePlan(uv, colors, (6, 5))
    report = check_gradient(
        lambda p: np.array(plan.loss_and_gradient(p["texture"])[0]),
        lambda p, d: {"texture": d * plan.loss_and_gradient(p["texture"])[1]},
        {"texture": noise((6, 5, 3), 1)},
        seed=3,
    )
    assert report, str(report)


def test_a_plan_can_be_used_again_and_clears_what_it_is_lent() -> None:
    uv, colors = points(300, 2), noise((300, 3), 3)
    plan, texture = TexturePlan(uv, colors, (20, 18)), noise((20, 18, 3), 1)
    loss, gradient = plan.loss_and_gradient(texture)
    uv[:], colors[:] = 0, 0  # the plan has its own
    lent = np.full_like(texture, 7)
    again, filled = plan.loss_and_gradient(texture, out=lent)
    assert filled is lent
    assert again == loss
    assert np.array_equal(filled, gradient)


def test_float_agrees_with_double() -> None:
    texture, uv, colors = (
        a.astype(np.float32) for a in (noise((40, 53, 3), 1), points(5000, 2), noise((5000, 3), 3))
    )
    loss, gradient = loss_and_gradient(texture, uv, colors)
    wide_loss, wide = loss_and_gradient(*(a.astype(np.float64) for a in (texture, uv, colors)))
    assert loss == pytest.approx(wide_loss, rel=1e-5)
    assert np.linalg.norm(gradient - wide) <= 1e-4 * np.linalg.norm(wide)


def second_derivative(uv: Any, shape: tuple[int, int], channels: int) -> Any:
    """H of the loss for one channel, (texels, texels), from the lookups' weights."""
    rows = np.zeros((len(uv), shape[0] * shape[1]))
    for (row, column), weight in corners(shape, uv):
        np.add.at(rows, (np.arange(len(uv)), row * shape[1] + column), weight)
    return 2 / (len(uv) * channels) * rows.T @ rows


def test_the_stable_learning_rate_is_that_of_the_largest_eigenvalue() -> None:
    uv, shape = points(400, 2), (7, 5)
    largest = np.linalg.eigvalsh(second_derivative(uv, shape, 3))[-1]
    rate = stable_learning_rate(uv, shape, 3)
    # 100 steps; the second eigenvalue is 0.94 of the first here, 0.94^200 = 4e-6; measured 4e-7.
    assert rate == pytest.approx(0.95 * 2 / largest, rel=1e-5)


def test_descent_converges_below_the_bound_and_diverges_above() -> None:
    truth, uv = noise((7, 5, 3), 1), points(400, 2)
    colors = sample(truth, uv)
    rate = stable_learning_rate(uv, (7, 5), 3)
    below = recover(uv, colors, (7, 5), steps=300)
    assert below.learning_rate == rate
    assert (np.diff(below.losses) < 0).all()
    assert below.losses[-1] < 1e-3 * below.losses[0]
    above = recover(uv, colors, (7, 5), steps=300, learning_rate=1.02 * rate / 0.95)
    assert above.losses[-1] > above.losses[0]
    with (
        pytest.raises(Error, match=r"loss: expected a finite number, got .* learning_rate"),
        np.errstate(over="ignore", invalid="ignore"),
    ):
        recover(uv, colors, (7, 5), steps=300, learning_rate=1e9 * rate)


def picture(n: int) -> Any:
    """(n, n, 3) in [0, 1]: waves, an edge along a circle, and a gradient."""
    v, u = np.meshgrid((np.arange(n) + 0.5) / n, (np.arange(n) + 0.5) / n, indexing="ij")
    disc = (np.hypot(u - 0.4, v - 0.6) < 0.25).astype(float)
    waves = 0.5 + 0.5 * np.sin(20 * u) * np.cos(15 * v)
    return np.stack([0.2 + 0.6 * disc, waves, 0.5 * u + 0.5 * v], axis=-1)


def test_a_known_texture_comes_back() -> None:
    truth = picture(64).astype(np.float32)
    uv = points(20_000, 7, reach=0.0).astype(np.float32)
    found = recover(uv, sample(truth, uv), (64, 64), steps=150)
    seen = ~found.unseen
    assert seen.all()  # of 4096
    error = (found.texture - truth)[seen].astype(np.float64)
    psnr = -10 * np.log10(np.square(error).mean())
    assert psnr > 40, psnr  # measured 74.5; 135 after 600 steps
    assert found.losses[-1] < 1e-5 * found.losses[0]


def test_unseen_texels_keep_their_value_and_are_reported() -> None:
    # Points in the left half alone, between the centers of columns 0 and 7 of 16.
    g = np.random.default_rng(3)
    uv = np.stack([g.uniform(0.5 / 16, 7.5 / 16, 2000), g.uniform(0, 1, 2000)], axis=-1)
    truth = noise((12, 16, 3), 1)
    found = recover(uv, sample(truth, uv), (12, 16), steps=50, start=0.25)
    assert found.unseen.tolist() == [[column > 7 for column in range(16)]] * 12
    assert (found.texture[found.unseen] == 0.25).all()
    assert (found.texture[~found.unseen] != 0.25).all()


def test_bad_input_is_refused() -> None:
    uv, colors = points(10, 1), np.zeros((10, 3))
    with pytest.raises(
        ShapeError, match=r"TexturePlan: colors: expected shape \(N, C\) with N = 10"
    ):
        recover(uv, colors[:9], (4, 4), steps=1)
    with pytest.raises(DtypeError, match="TexturePlan: colors: expected float64 as uv"):
        recover(uv, colors.astype(np.float32), (4, 4), steps=1)
    with pytest.raises(RangeError, match="recover: steps: expected a whole number"):
        recover(uv, colors, (4, 4), steps=0)
    with pytest.raises(RangeError, match="learning_rate: expected a finite number above 0"):
        recover(uv, colors, (4, 4), steps=1, learning_rate=-1.0)
    with pytest.raises(RangeError, match="TexturePlan: uv: expected at least one point, got none"):
        recover(uv[:0], colors[:0], (4, 4), steps=1)
    with pytest.raises(ShapeError, match=r"shape: expected shape \(2,\), got \(3,\)"):
        recover(uv, colors, (4, 4, 3), steps=1)
    with pytest.raises(RangeError, match="got 0 x 4"):
        TexturePlan(uv, colors, (0, 4))
    plan = TexturePlan(uv, colors, (4, 4))
    with pytest.raises(RangeError, match="texture: expected the shape that the plan was made for"):
        plan.loss_and_gradient(np.zeros((4, 5, 3)))
    with pytest.raises(DtypeError, match="loss_and_gradient: texture: expected dtype float64"):
        plan.loss_and_gradient(np.zeros((4, 4, 3), np.float32))


def test_a_stopped_recovery_goes_on_to_the_same_bits(tmp_path: Path) -> None:
    uv, colors = points(300, 2).astype(np.float32), noise((300, 3), 3).astype(np.float32)
    straight = recover(uv, colors, (6, 5), steps=9)
    stopped = iter([False] * 4 + [True] * 9)
    part = recover(uv, colors, (6, 5), steps=9, folder=tmp_path, should_stop=lambda: next(stopped))
    assert len(part.losses) == 4
    with pytest.raises(RangeError, match=r"recover: folder: .* without texture\.npz"):
        recover(uv, colors, (6, 5), steps=9, folder=tmp_path)
    with pytest.raises(RangeError, match=r"recover: resume: expected the points, colors and"):
        recover(uv, 1 - colors, (6, 5), steps=9, folder=tmp_path, resume=True)
    resumed = recover(uv, colors, (6, 5), steps=9, folder=tmp_path, resume=True)
    assert np.array_equal(resumed.texture, straight.texture)
    assert np.array_equal(resumed.losses, straight.losses)
    assert len(straight.losses) == 10
    path = tmp_path / "texture.npz"
    with np.load(path) as archive:
        arrays: dict[str, Any] = {name: archive[name] for name in archive.files}
    for name, value in (("params.texture", arrays["params.texture"][:-1]), ("history", np.ones(3))):
        np.savez(path, **arrays | {name: value})
        with pytest.raises(IoError):
            recover(uv, colors, (6, 5), steps=9, folder=tmp_path, resume=True)
    assert not (tmp_path / ".photograd.lock").exists()
