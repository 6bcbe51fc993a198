"""What the boundary says about arrays that do not fit.

Nothing is converted behind the caller's back.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from photograd.core import _core
from photograd_course.errors import DtypeError, RangeError, ShapeError

from tests.render.rays import settings


def call(**changes: Any) -> Any:
    arguments: dict[str, Any] = {
        "field": "dense_grid", "parameters": np.zeros((4, 4, 4, 4), np.float32),
        "settings": settings(), "origins": np.zeros((5, 3), np.float32),
        "directions": np.ones((5, 3), np.float32), "t0": np.zeros(5, np.float32),
        "samples": np.zeros(5, np.int32),
    }  # fmt: skip
    arguments.update(changes)
    return _core.march(**arguments)


@pytest.mark.parametrize(
    ("changes", "error", "text"),
    [
        ({"t0": np.zeros(4, np.float32)}, ShapeError,
         r"march: t0: expected shape \(R,\) with R = 5 as in origins, got \(4,\)"),
        ({"directions": np.ones((5, 2), np.float32)}, ShapeError,
         r"directions: expected shape \(R, 3\), got \(5, 2\)"),
        ({"directions": np.ones((5, 3))}, DtypeError,
         "directions: expected dtype float32, got dtype float64"),
        ({"directions": np.ones((3, 5), np.float32).T}, ShapeError, "C-contiguous"),
        ({"samples": np.zeros(5, np.int64)}, DtypeError, "samples: expected dtype int32"),
        ({"parameters": np.zeros((4, 4, 4, 3), np.float32)}, ShapeError, r"\(X, Y, Z, 4\)"),
        ({"parameters": np.zeros((4, 4, 1, 4), np.float32)}, RangeError, "two voxels"),
        ({"parameters": np.zeros((4, 4, 4, 4), np.int32)}, DtypeError, "float32 or float64"),
        ({"field": "dense_gird"}, RangeError, "dense_grid or tiny_network"),
    ],
)  # fmt: skip
def test_each_wrong_array_is_named(changes: Any, error: type[Exception], text: str) -> None:
    with pytest.raises(error, match=text):
        call(**changes)


def test_errors_are_also_the_builtins_that_people_catch() -> None:
    with pytest.raises(ValueError, match="t0"):
        call(t0=np.zeros(4, np.float32))
    with pytest.raises(TypeError, match="samples"):
        call(samples=np.zeros(5, np.int64))


def test_gradients_are_not_written_into_a_read_only_array() -> None:
    grid = np.zeros((4, 4, 4, 4), np.float32)
    rays = np.zeros((5, 3), np.float32), np.ones((5, 3), np.float32)
    t0, samples = np.zeros(5, np.float32), np.zeros(5, np.int32)
    out = _core.march("dense_grid", grid, settings(), *rays, t0, samples)
    d_grid = np.zeros_like(grid)
    d_grid.flags.writeable = False
    with pytest.raises(RangeError, match="d_parameters: expected a writable array"):
        _core.march_backward("dense_grid", grid, settings(), *rays, t0, samples, *out, *out, d_grid)


@pytest.mark.parametrize(
    "changes", [{"dt": 0.0}, {"dt": float("nan")}, {"box": [[0, 0, 0], [1, 0, 1]]}]
)
def test_settings_are_checked(changes: dict[str, Any]) -> None:
    with pytest.raises(RangeError, match="MarchSettings"):
        settings(**changes)
