"""The march through a sparse grid of spherical harmonics: value and adjoint."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from photograd._compiled import _core
from photograd_course.gradcheck import (
    check_accumulation,
    check_gradient,
    dot_product_error,
    taylor_slope,
)
from photograd_course.mutants import check_mutants, check_overwriting_mutants

from tests.render import rays as dense_rays
from tests.render.sparse import GROUPS, Scene, march, march_backward, oracle, scene, with_rays

NAMES = ("color", "transmittance", "depth")
CASES: dict[str, dict[str, Any]] = {
    "softplus and sigmoid": {"density_scale": 0.7},
    "relu, offset": {"density_activation": 1, "color_activation": 1, "offset": 0.5},
    "riemann": {"quadrature": "riemann"},
    "identity": {"density_activation": 0, "color_activation": 0},
    "entry lattice": {"lattice": "entry", "density_activation": 3},
    "degree 0": {"degree": 0},
    "degree 1": {"degree": 1},
    "degree 3": {"degree": 3},
}


def problem(s: Scene) -> tuple[Any, Any]:
    """(function, backward) of all three groups, in double and so in the staged form."""

    def function(p: dict[str, Any]) -> dict[str, Any]:
        return dict(zip(NAMES, march(s, p)[:3], strict=True))

    def backward(p: dict[str, Any], d: dict[str, Any]) -> dict[str, Any]:
        return march_backward(s, p, tuple(np.ascontiguousarray(d[n]) for n in NAMES))

    return function, backward


def cotangents(s: Scene, seed: int) -> dict[str, Any]:
    g = np.random.default_rng(seed)
    count = len(s.rays[0])
    return {n: g.uniform(0.5, 1.5, (count, 3) if n == "color" else count) for n in NAMES}


@pytest.mark.parametrize("case", CASES)
def test_the_image_is_that_of_the_oracle(case: str) -> None:
    s = scene(1, **CASES[case])
    expected = oracle(s, s.place)
    for name, value in problem(s)[0](s.place).items():
        assert np.abs(value).max() > 0.02
        np.testing.assert_allclose(value, expected[name].real, rtol=1e-11, atol=1e-13)


@pytest.mark.parametrize("case", CASES)
def test_gradients_by_group(case: str) -> None:
    s = scene(2, **CASES[case])
    report = check_gradient(*problem(s), s.place, seed=2)
    assert report, str(report)


def test_taylor_remainder_falls_quadratically() -> None:
    s = scene(3)
    report = taylor_slope(*problem(s), s.place, seed=3)
    assert report, str(report)


@pytest.mark.parametrize("case", ["softplus and sigmoid", "relu, offset", "degree 3"])
def test_dot_product_with_exact_derivatives(case: str) -> None:
    s = scene(4, **CASES[case])
    step = 1e-30  # nothing is subtracted, so that it may be as small as that

    def derivative(p: dict[str, Any], v: dict[str, Any]) -> dict[str, Any]:
        moved = {name: p[name] + 1j * step * v[name] for name in p}
        return {name: value.imag / step for name, value in oracle(s, moved).items()}

    report = dot_product_error(derivative, problem(s)[1], s.place, seed=4, tolerance=1e-10)
    assert report, str(report)


def test_mutants_die() -> None:
    s = scene(5)
    function, backward = problem(s)
    report = check_mutants(
        lambda b: check_gradient(
            function, b, s.place, seed=5, directions=4, coordinates=8, steps=(1e-4, 1e-5, 1e-6)
        ),
        backward,
        s.place,
        cotangents(s, 5),
    )
    assert report, str(report)
    assert len(report.killed) >= 9


def wrong_gradients(name: str, s: Scene, right: dict[str, Any]) -> Any:
    """Mistakes that have been made: what each would have computed."""
    d = {key: value.copy() for key, value in right.items()}
    if name == "background dropped":
        d["background"][...] = 0
    elif name == "direction of the viewer":  # odd degrees change sign
        d["sh"][:, 1:4] *= -1
    elif name == "no phase":  # Y with odd m negated
        d["sh"][:, [1, 3, 5, 7]] *= -1
    elif name == "channels swapped":
        d["sh"] = np.ascontiguousarray(d["sh"][..., ::-1])
    elif name == "rim dropped":  # voxels beside missing ones
        rows = np.pad(s.active.rows, 1, constant_values=-1)
        i, j, k = s.active.voxels.T + 1
        rim = np.zeros(len(s.active), bool)
        for step in np.ndindex(3, 3, 3):
            rim |= rows[i + step[0] - 1, j + step[1] - 1, k + step[2] - 1] < 0
        assert 0 < rim.sum() < len(rim)
        d["density"][rim] = 0
    elif name == "rows shifted":
        d["density"] = np.roll(d["density"], 1)
    return d


@pytest.mark.parametrize(
    "name",
    [
        "background dropped",
        "direction of the viewer",
        "no phase",
        "channels swapped",
        "rim dropped",
        "rows shifted",
    ],
)
def test_mistakes_are_seen(name: str) -> None:
    s = scene(6, shape=(14, 12, 13), dense=0.995)
    function, backward = problem(s)

    def wrong(p: dict[str, Any], d: dict[str, Any]) -> dict[str, Any]:
        return wrong_gradients(name, s, backward(p, d))

    report = check_gradient(function, backward, s.place, seed=6)
    assert report, str(report)
    report = check_gradient(function, wrong, s.place, seed=6, tolerance=1e-6)
    assert not report
    assert max(group.error for group in report.groups) > 1e-3, str(report)


def test_gradients_are_added_to() -> None:
    s = scene(7)
    d = cotangents(s, 7)

    def accumulate(p: dict[str, Any], d: dict[str, Any], into: dict[str, Any]) -> None:
        march_backward(s, p, tuple(d[n] for n in NAMES), into=into)

    report = check_accumulation(accumulate, s.place, d)
    assert report, str(report)
    report = check_overwriting_mutants(
        lambda a: check_accumulation(a, s.place, d), accumulate, s.place, d
    )
    assert report, str(report)


@pytest.mark.parametrize("degree", [0, 2, 3])
def test_camera_gradient(degree: int) -> None:
    s = scene(8, degree=degree)
    camera = dict(zip(("origins", "directions"), s.rays, strict=True))

    def function(c: dict[str, Any]) -> dict[str, Any]:
        return dict(zip(NAMES, march(with_rays(s, **c), s.place)[:3], strict=True))

    def backward(c: dict[str, Any], d: dict[str, Any]) -> dict[str, Any]:
        found = {key: np.zeros_like(value) for key, value in c.items()}
        d_out = tuple(np.ascontiguousarray(d[n]) for n in NAMES)
        into = (found["origins"], found["directions"])
        march_backward(with_rays(s, **c), s.place, d_out, camera=into)
        return found

    report = check_gradient(function, backward, camera, seed=8, directions=4)
    assert report, str(report)

    def without_harmonics(c: dict[str, Any], d: dict[str, Any]) -> dict[str, Any]:
        found = backward(c, d)
        plain = scene(8, degree=degree)
        plain.place["sh"][:, 1:] = 0
        out = {key: np.zeros_like(value) for key, value in c.items()}
        march_backward(
            with_rays(plain, **c),
            plain.place,
            tuple(np.ascontiguousarray(d[n]) for n in NAMES),
            camera=(out["origins"], out["directions"]),
        )
        return {"origins": found["origins"], "directions": out["directions"]}

    if degree:
        assert not check_gradient(function, without_harmonics, camera, seed=8, directions=4)


def masked_scene() -> tuple[Scene, Any]:
    """A scene whose two outermost layers are not active, and its dense twin of raw zeros there."""
    s = scene(9, degree=0, shape=(13, 12, 14), density_activation=1, count=200)
    mask = s.active.mask.copy()
    for axis in range(3):
        side = np.moveaxis(mask, axis, 0)
        side[:2] = side[-2:] = False
    s = Scene(type(s.active)(mask), s.place, s.rays, s.options)
    g = np.random.default_rng(10)
    n = len(s.active)
    s.place.update(
        density=g.uniform(-0.5, 2.0, n), sh=g.uniform(-3, 3, (n, 1, 3)), background=np.zeros(4)
    )
    dense = np.zeros((*mask.shape, 4))
    i, j, k = s.active.voxels.T
    dense[i, j, k, :3] = s.place["sh"][:, 0] * 0.28209479177387814
    dense[i, j, k, 3] = s.place["density"]
    return s, dense


def test_sparse_is_dense_on_the_active_set_and_the_rest_is_reported() -> None:
    s, grid = masked_scene()
    dense_settings = dense_rays.settings(**s.options, border="zero")
    out = dense_rays.march(grid, dense_settings, s.rays, fused=False)
    mine = march(s, s.place)
    for a, b in zip(mine[:3], out[:3], strict=True):
        np.testing.assert_allclose(a, b, rtol=1e-12, atol=1e-14)
    d = cotangents(s, 11)
    gradients = march_backward(s, s.place, tuple(d[n] for n in NAMES))
    d_grid = dense_rays.march_backward(
        grid, dense_settings, s.rays, out, tuple(d[n] for n in NAMES), fused=False
    )
    i, j, k = s.active.voxels.T
    assert np.abs(gradients["density"]).max() > 0.1
    np.testing.assert_allclose(gradients["density"], d_grid[i, j, k, 3], rtol=1e-9, atol=1e-12)
    color = gradients["sh"][:, 0] / 0.28209479177387814
    np.testing.assert_allclose(color, d_grid[i, j, k, :3], rtol=1e-9, atol=1e-12)
    # What voxels that do not exist would have been told is the background's, to the last bit of it.
    lost = d_grid[~s.active.mask].sum(axis=0)
    assert np.abs(lost).min() > 1e-3
    np.testing.assert_allclose(gradients["background"][0], lost[3], rtol=1e-9)
    np.testing.assert_allclose(
        gradients["background"][1:] / 0.28209479177387814, lost[:3], rtol=1e-9
    )


def test_greatest_weights_are_those_of_all_samples() -> None:
    s = scene(12, dtype=np.float32, count=300, density_scale=4.0)
    most = np.zeros(len(s.active), np.float32)
    parameters, rays = [s.place[g] for g in GROUPS], (*s.rays, *s.samples())
    _core.sparse_sh_weights(s.active.table, parameters, s.settings, rays, most)
    # The derivative of L = sum of w with respect to a voxel's density does not show the largest
    # weight, so test the samples: raise one color at a time and see which samples it reaches.
    t0, samples = s.samples()
    shape = np.array(s.active.shape)
    rows = np.full(shape + 3, -1)
    rows[1:-2, 1:-2, 1:-2] = s.active.rows
    expected = np.zeros(len(s.active))
    for ray, (o, d) in enumerate(zip(*s.rays, strict=True)):
        t = t0[ray] + (np.arange(samples[ray]) + 0.5) * 0.07
        q = ((o + t[:, None] * d + 1) / 2 * shape - 0.5).astype(np.float64)
        base = np.floor(q).astype(int)
        found, weights = [], []
        for corner in np.ndindex(2, 2, 2):
            found.append(rows[tuple((base + corner + 1).T)])
            weights.append(np.prod(np.where(corner, q - base, 1 - (q - base)), axis=1))
        row, w = np.array(found), np.array(weights)
        values = np.where(row >= 0, s.place["density"][row], s.place["background"][0])
        sigma = 4 * np.logaddexp(0, (w * values).sum(axis=0)) * (row >= 0).any(axis=0)
        tau = np.cumsum(sigma * 0.07)
        weight = np.exp(-(tau - sigma * 0.07)) * -np.expm1(-sigma * 0.07)
        here = row >= 0
        np.maximum.at(expected, row[here], (w * weight)[here])
    assert expected.max() > 0.1
    # float32 positions: a sample near a face may weigh 1e-5 elsewhere.
    np.testing.assert_allclose(most, expected, atol=2e-5)
