"""The soft rasterizer: its own derivatives hold, and they are not those of coverage."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from photograd.errors import RangeError, ShapeError
from photograd.raster import (
    MeshEdges,
    antialias,
    antialias_backward,
    find_crossings,
    polygon_coverage,
    polygon_coverage_backward,
    project,
    rasterize,
    soft_silhouette,
    soft_silhouette_backward,
)
from photograd_course.gradcheck import check_gradient
from photograd_course.optim import Adam

from support.gradient_mutants import check_gradient_mutants
from tests.raster import oracle

SIZE = (10, 11)
FACES = np.array([[0, 1, 2]])
CORNERS = np.array([[2.3, 1.8], [7.6, 3.1], [4.2, 7.4]])


def flat(corners: Any) -> Any:
    """Corners in pixels at a depth of 1."""
    return np.insert(corners, 2, 1.0, axis=1)


def scene(name: str) -> tuple[Any, Any]:
    vertices, faces = oracle.sphere(4, 3) if name == "sphere" else oracle.soup(4, 4)
    return project(vertices, oracle.camera(11, 10, 12.0)), faces


def passes(faces: Any, sigma: float) -> tuple[Callable[..., Any], Callable[..., Any]]:
    def forward(p: dict[str, Any]) -> Any:
        return soft_silhouette(p["positions"], faces, SIZE, sigma)

    def backward(p: dict[str, Any], d: Any) -> dict[str, Any]:
        return {"positions": soft_silhouette_backward(p["positions"], faces, d, sigma)}

    return forward, backward


@pytest.mark.parametrize("name", ["sphere", "soup"])
def test_backward_agrees_with_central_differences(name: str) -> None:
    positions, faces = scene(name)
    report = check_gradient(*passes(faces, 0.8), {"positions": positions}, seed=1)
    assert report, str(report)


def test_backward_is_the_transpose_of_the_derivative() -> None:
    """<g, J v> = <J^T g, v>, with J v by central differences along v."""
    positions, faces = scene("soup")
    forward, backward = passes(faces, 0.8)
    rng = np.random.default_rng(3)
    g, v = rng.uniform(-1, 1, SIZE), rng.uniform(-1, 1, positions.shape)
    h = 1e-6
    ends = [forward({"positions": positions + s * h * v}) for s in (1, -1)]
    along = (g * (ends[0] - ends[1])).sum() / (2 * h)
    assert (backward({"positions": positions}, g)["positions"] * v).sum() == pytest.approx(
        along, rel=1e-6
    )


def test_wrong_gradients_are_noticed() -> None:
    positions, faces = scene("sphere")
    cotangent = np.random.default_rng(2).uniform(-1, 1, SIZE)
    report = check_gradient_mutants(
        *passes(faces, 0.8), {"positions": positions}, cotangent, seed=1, coordinates=8
    )
    assert report, str(report)


def test_one_triangle_in_closed_form() -> None:
    """The center (3.5, 3.5) lies 1.5 pixels from the nearest edge, inside and outside."""
    inner = np.array([[0.0, 5.0], [20.0, 5.0], [0.0, -20.0]])
    outer = np.array([[0.0, 5.0], [20.0, 5.0], [0.0, 30.0]])
    for corners, sign in ((inner, 1), (outer, -1)):
        found = soft_silhouette(flat(corners), FACES, (8, 8), 0.7)[3, 3]
        assert found == pytest.approx(1 / (1 + np.exp(-sign * 1.5**2 / 0.7)))
    twice = soft_silhouette(flat(inner), [[0, 1, 2], [2, 1, 0]], (8, 8), 0.7)[3, 3]
    once = soft_silhouette(flat(inner), FACES, (8, 8), 0.7)[3, 3]
    assert twice == pytest.approx(1 - (1 - once) ** 2)


def test_a_small_blur_is_a_point_sample_and_has_no_derivative() -> None:
    sharp = soft_silhouette(flat(CORNERS), FACES, SIZE, 1e-6)
    covered = rasterize(flat(CORNERS), FACES, SIZE).covered
    np.testing.assert_allclose(sharp, covered, atol=1e-12)
    d = soft_silhouette_backward(flat(CORNERS), FACES, np.ones(SIZE), 1e-6)
    assert np.abs(d).max() < 1e-6


@pytest.mark.parametrize(("sigma", "factor"), [(0.1, 0.640), (1.0, 1.403), (3.0, 1.844)])
def test_the_derivative_of_a_translation_is_off_by_a_factor(sigma: float, factor: float) -> None:
    """A triangle of 14 pixels over a picture whose weight grows by 0.2 a column."""
    ramp = np.tile(np.linspace(-1, 1, 11), (10, 1))
    exact = polygon_coverage_backward(CORNERS, ramp)[:, 0].sum()
    assert exact == pytest.approx(0.2 * polygon_coverage(CORNERS, SIZE).sum(), rel=0.02)
    soft = soft_silhouette_backward(flat(CORNERS), FACES, ramp, sigma)[:, 0].sum()
    assert soft / exact == pytest.approx(factor, abs=2e-3)


def fitted(gradient: Callable[[Any], Any], steps: int = 80) -> Any:
    """Corners (3, 2) after descent from about a pixel beside `CORNERS`."""
    away = np.array([[-0.7, 0.5], [0.6, 0.8], [0.5, -0.9]])
    params = {"corners": CORNERS + away}
    adam = Adam()
    for step in range(steps):
        rate = 0.1 * 0.02 ** (step / steps)
        adam.step(params, {"corners": gradient(params["corners"])}, {"corners": rate})
    return params["corners"]


def area(corners: Any) -> float:
    x, y = corners.T
    return abs(float((x * np.roll(y, -1) - np.roll(x, -1) * y).sum() / 2))


def test_a_recovered_triangle_is_too_small_and_antialiasing_finds_it() -> None:
    """The target is the exact coverage; mean squared error, the same descent."""
    target, edges = polygon_coverage(CORNERS, SIZE), MeshEdges.of(FACES)

    def by_antialiasing(corners: Any) -> Any:
        place = flat(corners)
        visibility = rasterize(place, FACES, SIZE)
        color = visibility.covered[..., None].astype(float)
        crossings = find_crossings(place, FACES, visibility, edges)
        d = 2 * (antialias(color, crossings) - target[..., None])
        return antialias_backward(color, crossings, d, place, edges)[1][:, :2]

    def by_probabilities(corners: Any) -> Any:
        d = 2 * (soft_silhouette(flat(corners), FACES, SIZE, 1.0) - target)
        return soft_silhouette_backward(flat(corners), FACES, d, 1.0)[:, :2]

    found, soft = fitted(by_antialiasing), fitted(by_probabilities)
    assert np.linalg.norm(found - CORNERS, axis=1).max() < 0.2  # measured 0.05
    assert np.linalg.norm(soft - CORNERS, axis=1).min() > 0.8  # measured 1.1
    assert area(found) == pytest.approx(area(CORNERS), rel=0.02)
    assert area(soft) < 0.5 * area(CORNERS)  # measured 0.4: blurred, it looks as large


def test_degenerate_triangles_and_vertices_without_a_face() -> None:
    line = np.array([[2.0, 2, 1], [6, 6, 1], [4, 4, 1], [0, 0, 0]])
    for faces in ([[0, 1, 2]], [[0, 0, 0]], np.zeros((0, 3), int)):
        found = soft_silhouette(line, faces, SIZE, 0.5)
        assert (found <= 0.5).all()
        d = soft_silhouette_backward(line, faces, np.ones(SIZE), 0.5)
        assert np.isfinite(d).all()
        assert not d[3].any()


def test_bad_input_is_named() -> None:
    place = flat(CORNERS)
    with pytest.raises(RangeError, match=r"soft_silhouette: sigma"):
        soft_silhouette(place, FACES, SIZE, 0.0)
    with pytest.raises(RangeError, match=r"soft_silhouette: positions: expected depths above 0"):
        soft_silhouette(-place, FACES, SIZE, 1.0)
    with pytest.raises(RangeError, match=r"soft_silhouette: faces: expected numbers of vertices"):
        soft_silhouette(place, FACES + 1, SIZE, 1.0)
    with pytest.raises(ShapeError, match=r"soft_silhouette_backward: d_silhouette"):
        soft_silhouette_backward(place, FACES, np.zeros(3), 1.0)
