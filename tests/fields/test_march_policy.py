"""What a march refuses when it is described, before a ray is sent or memory is asked for."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from photograd.errors import DtypeError, Error, RangeError, ShapeError
from photograd.fields import DenseGrid, SparseSh
from photograd.fields.march import MOST_SAMPLES, MarchPolicy
from photograd.representation import RenderOptions

BOX = ((-1.0, -1.0, -1.0), (1.0, 1.0, 1.0))
SHORTEST = math.sqrt(12) / MOST_SAMPLES


@pytest.mark.parametrize("dt", [1e-12, 1e-300, 1e-9, 0.999 * SHORTEST, 0.0, -1.0])
def test_a_step_that_takes_too_many_samples_is_refused(dt: float) -> None:
    with pytest.raises(RangeError) as caught:
        MarchPolicy(BOX, dt)
    expected = "MarchPolicy: dt: expected 1.32e-05 m or more, 262,144 samples across the box, got"
    assert str(caught.value).startswith(expected)


@pytest.mark.parametrize("dt", [math.inf, math.nan])
def test_a_step_that_is_not_finite_is_refused(dt: float) -> None:
    with pytest.raises(RangeError, match="MarchPolicy: dt: expected a finite number"):
        MarchPolicy(BOX, dt)


def test_the_shortest_step_gives_as_many_samples() -> None:
    grid = DenseGrid(np.zeros((2, 2, 2, 4)), MarchPolicy(BOX, 1.0001 * SHORTEST))
    batch = grid.example_batch(seed=1)
    corner = type(batch)(
        np.full((1, 3), -3.0), np.full((1, 3), math.sqrt(1 / 3)), np.zeros(1, np.uint32)
    )
    _, context = grid.render(corner, seed=0, step=0, options=RenderOptions())
    assert 0.999 * MOST_SAMPLES < context.sample_count <= MOST_SAMPLES


@pytest.mark.parametrize(
    ("change", "error", "words"),
    [
        ({"lattice": "nonsense"}, RangeError, "lattice: expected one of origin, entry"),
        ({"quadrature": "simpson"}, RangeError, "quadrature: expected one of"),
        ({"border": None}, RangeError, "border: expected one of clamp, zero, got None"),
        ({"density_activation": "typo"}, RangeError, "density_activation: expected one of"),
        ({"color_activation": ["relu"]}, RangeError, "color_activation: expected one of"),
        ({"density_scale": math.nan}, RangeError, "density_scale: expected a finite number"),
        ({"density_scale": "1"}, DtypeError, "density_scale: expected a number, got '1'"),
        ({"dt": True}, DtypeError, "dt: expected a number, got True"),
        ({"box": BOX[::-1]}, RangeError, "box: expected corners, lower below upper"),
        ({"box": (BOX[0], (1.0, math.inf, 1.0))}, RangeError, "box: expected finite"),
        ({"box": BOX[0]}, ShapeError, "box: expected shape (2, 3)"),
    ],
)
def test_a_policy_is_refused_when_it_is_made(
    change: dict[str, Any], error: type[Error], words: str
) -> None:
    with pytest.raises(error) as caught:
        MarchPolicy(**{"box": BOX, "dt": 0.1, **change})
    assert str(caught.value).startswith(f"MarchPolicy: {words}")


@pytest.mark.parametrize("stop", [-1.0, -1e-9, 1.0, math.inf, math.nan])
def test_a_stop_is_a_transmittance(stop: float) -> None:
    with pytest.raises(RangeError, match="RenderOptions: stop: expected a finite number in"):
        RenderOptions(stop=stop)


@pytest.mark.parametrize("resolution", [10**6, 10**30])
def test_a_grid_says_how_much_memory_it_needs(resolution: int) -> None:
    box = np.array(BOX)
    with pytest.raises(RangeError) as caught:
        DenseGrid.empty(box, resolution)
    assert "DenseGrid.empty: resolution: expected room for 1000000" in str(caught.value)
    assert "TiB), got " in str(caught.value)
    assert "(take a lower resolution, or a flatter box)" in str(caught.value)
    with pytest.raises(RangeError, match=r"SparseSh\.full: resolution: .* voxels of degree 3 \("):
        SparseSh.full(box, resolution, degree=3)
    for grid in (DenseGrid.empty(box, 4), SparseSh.full(box, 4)):
        with pytest.raises(RangeError, match=r"refined: resolution: expected room for 1000000"):
            grid.refined(resolution)
        with pytest.raises(RangeError, match="refined: resolution: expected a whole number"):
            grid.refined(1)
