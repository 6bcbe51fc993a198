"""Gaussians that no optimizer should make, and some that it does: never a crash, never a NaN."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from photograd.errors import DtypeError, RangeError, ShapeError
from photograd.splats.splatting import Gaussians, SplatOptions, render, render_backward

from tests.splat import oracle

DEFAULT = SplatOptions()
OPTIONS = {
    "default": DEFAULT,
    "smooth": DEFAULT.smooth(),
    "antialiased": replace(DEFAULT, antialiased=True),
    "sharp": replace(DEFAULT, low_pass=0.0, antialiased=True),
}
CAMERA = oracle.camera(21, 18, 17.0)


def changed(name: str, value: Any) -> Gaussians:
    """Eight lively Gaussians, of which row 3 has `value`."""
    g = oracle.cloud(8, 3)
    getattr(g, name)[3] = value
    return g


def behind(distance: float) -> Any:
    return (CAMERA.world_from_camera @ [0.1, 0.2, distance, 1.0])[:3]


STRANGE = {
    "zero scale": changed("log_scales", -np.inf),
    "flat": changed("log_scales", [-np.inf, -1.0, -1.0]),
    "needle": changed("log_scales", [3.0, -12.0, -12.0]),
    "sub-pixel": changed("log_scales", -12.0),
    "covers the screen": changed("log_scales", 3.0),
    "wider than numbers": changed("log_scales", 600.0),
    "zero quaternion": changed("quats", 0.0),
    "tiny quaternion": changed("quats", [1e-30, 1e-31, 0, 0]),
    "huge quaternion": changed("quats", [1e30, 1e30, 0, 0]),
    "behind": changed("means", behind(-1.0)),
    "in the camera": changed("means", behind(0.0)),
    "just in front": changed("means", behind(0.011)),
    "far away": changed("means", [1e30, 0.0, 0.0]),
    "opaque": changed("opacity_logits", np.inf),
    "absent": changed("opacity_logits", -np.inf),
    "very opaque": changed("opacity_logits", 200.0),
    "dark": changed("sh", -5.0),
}


@pytest.mark.parametrize("dtype", [np.float32, np.float64])
@pytest.mark.parametrize("policy", OPTIONS)
@pytest.mark.parametrize("name", STRANGE)
def test_strange_gaussians_leave_numbers(name: str, policy: str, dtype: Any) -> None:
    with np.errstate(over="ignore"):
        g = STRANGE[name].astype(dtype)
    picture, context = render(g, CAMERA, options=OPTIONS[policy])
    ones = [np.ones_like(array) for array in vars(picture).values()]
    found = render_backward(context, *ones)
    for array in (*vars(picture).values(), found.camera_from_world, found.background):
        assert np.isfinite(array).all()
    for group, array in found.gaussians.items():
        assert np.isfinite(array).all(), group
        assert array.any(), group
    # The seven others are still there.
    rest = Gaussians(**{key: np.delete(array, 3, 0) for key, array in g.arrays().items()})
    assert picture.opacity.max() > 0.3
    if not context.visible[3]:
        np.testing.assert_array_equal(
            picture.color, render(rest, CAMERA, options=OPTIONS[policy])[0].color
        )


@pytest.mark.parametrize("name", ["behind", "in the camera", "wider than numbers", "far away"])
def test_what_cannot_be_drawn_is_culled(name: str) -> None:
    assert not render(STRANGE[name], CAMERA)[1].visible[3]


# An infinite logit is an opacity of 0 or 1, and a scale whose logarithm is -inf is 0.
MEANINGFUL = {("log_scales", -np.inf), ("opacity_logits", -np.inf), ("opacity_logits", np.inf)}
NO_NUMBERS = [
    (name, bad)
    for name in ("means", "log_scales", "quats", "opacity_logits", "sh")
    for bad in (np.nan, np.inf, -np.inf)
    if (name, bad) not in MEANINGFUL
]


@pytest.mark.parametrize(("name", "bad"), NO_NUMBERS)
def test_what_is_no_number_is_refused_with_its_row(name: str, bad: float) -> None:
    with pytest.raises(RangeError, match=rf"splat: {name}: .* row 3"):
        render(changed(name, bad), CAMERA)


WEIRD = np.array([0, 1e-30, -1e-30, 1e30, -1e30, 1e5, -1e5, 600, -600, 88, 0.02, -0.01, 30, -30])


@pytest.mark.parametrize("dtype", [np.float32, np.float64])
def test_weird_numbers_in_any_combination_leave_numbers(dtype: Any) -> None:
    random = np.random.default_rng(1)
    drawn = 0
    for seed in range(30):
        g = oracle.cloud(200, seed, degree=1)
        for name, array in g.arrays().items():
            if name == "sh":
                continue
            where = random.random(array.shape) < 0.3
            array[where] = random.choice(WEIRD, int(where.sum()))
        options = list(OPTIONS.values())[seed % 4]
        picture, context = render(g.astype(dtype), CAMERA, options=options)
        # Colors and depths of 1e30 rightly have derivatives beyond float32: no part of this.
        ones = np.ones_like
        found = render_backward(context, ones(picture.color), ones(picture.opacity))
        drawn += int(context.visible.sum())
        rest = {"view": found.camera_from_world, "background": found.background}
        for name, array in {**vars(picture), **found.gaussians, **rest}.items():
            assert not np.isnan(array).any(), (seed, name)
            # The derivative with respect to a quaternion of length 1e-30 may overflow.
            assert name == "quats" or np.isfinite(array).all(), (seed, name)
    assert drawn > 300


def test_no_gaussians_are_a_picture_of_the_background() -> None:
    g = oracle.cloud(1, 1)
    none = Gaussians(**{name: array[:0] for name, array in g.arrays().items()})
    picture, context = render(none, CAMERA, background=(0.1, 0.2, 0.3))
    assert np.array_equal(picture.color, np.broadcast_to([0.1, 0.2, 0.3], (18, 21, 3)))
    assert not picture.opacity.any()
    found = render_backward(context, np.ones((18, 21, 3)))
    np.testing.assert_allclose(found.background, 18 * 21, rtol=1e-12)


def test_a_hundred_thousand_behind_the_camera_cost_no_pairs() -> None:
    g = oracle.cloud(100_000, 1, degree=0, spread=0.5)
    g.means[:] += behind(-10.0)
    picture, context = render(g.astype(np.float32), CAMERA)
    assert context.prepared.pairs == 0
    assert not picture.opacity.any()


def test_wrong_arrays_are_refused() -> None:
    g = oracle.cloud(4, 1)
    with pytest.raises(ShapeError, match=r"Gaussians: quats: expected shape \(N, 4\) with N = 4"):
        replace(g, quats=g.quats[:3])
    with pytest.raises(DtypeError, match="Gaussians: sh: expected float64"):
        replace(g, sh=g.sh.astype(np.float32))
    with pytest.raises(DtypeError, match="Gaussians: means: expected float32 or float64"):
        replace(g, means=np.zeros((4, 3), int))
    with pytest.raises(RangeError, match="Gaussians: sh: expected 1, 4, 9 or 16"):
        replace(g, sh=g.sh[:, :5])
    with pytest.raises(ShapeError, match="background"):
        render(g, CAMERA, background=(1.0, 1.0))
    with pytest.raises(RangeError, match="background: expected finite"):
        render(g, CAMERA, background=(np.nan, 1.0, 1.0))
    picture, context = render(g, CAMERA)
    with pytest.raises(ShapeError, match="d_color"):
        render_backward(context, picture.color[1:])
    with pytest.raises(DtypeError, match="d_depth"):
        render_backward(context, None, None, picture.depth.astype(np.float32))


@pytest.mark.parametrize(
    "change",
    [
        {"low_pass": -1.0},
        {"alpha_max": 2.0},
        {"alpha_min": np.nan},
        {"near": 0.0},
        {"stop": -1e-3},
        {"clamped_gradient": "maybe"},
    ],
)
def test_options_without_meaning_are_refused(change: dict[str, Any]) -> None:
    (name,) = change
    with pytest.raises(RangeError, match=f"SplatOptions: {name}"):
        replace(DEFAULT, **change)
