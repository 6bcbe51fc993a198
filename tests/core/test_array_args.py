"""What the boundary says about arrays that do not fit.

Nothing is converted behind the caller's back.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from photograd._compiled import _core
from photograd_course.errors import DtypeError, RangeError, ShapeError

from tests.render.rays import settings
from tests.splat import oracle


def call(**changes: Any) -> Any:
    arguments: dict[str, Any] = {
        "field": "dense_grid",
        "parameters": np.zeros((4, 4, 4, 4), np.float32),
        "settings": settings(),
    }
    rays = {
        "origins": np.zeros((5, 3), np.float32),
        "directions": np.ones((5, 3), np.float32),
        "t0": np.zeros(5, np.float32),
        "samples": np.zeros(5, np.int32),
    }
    for name, value in changes.items():
        (rays if name in rays else arguments)[name] = value
    return _core.march(**arguments, rays=list(rays.values()))


@pytest.mark.parametrize(
    ("changes", "error", "text"),
    [
        (
            {"t0": np.zeros(4, np.float32)},
            ShapeError,
            r"march: t0: expected shape \(R,\) with R = 5 as in origins, got \(4,\)",
        ),
        (
            {"directions": np.ones((5, 2), np.float32)},
            ShapeError,
            r"directions: expected shape \(R, 3\), got \(5, 2\)",
        ),
        (
            {"directions": np.ones((5, 3))},
            DtypeError,
            "directions: expected dtype float32, got dtype float64",
        ),
        ({"directions": np.ones((3, 5), np.float32).T}, ShapeError, "C-contiguous"),
        ({"samples": np.zeros(5, np.int64)}, DtypeError, "samples: expected dtype int32"),
        ({"parameters": np.zeros((4, 4, 4, 3), np.float32)}, ShapeError, r"\(X, Y, Z, 4\)"),
        ({"parameters": np.zeros((4, 4, 1, 4), np.float32)}, RangeError, "two voxels"),
        ({"parameters": np.zeros((4, 4, 4, 4), np.int32)}, DtypeError, "float32 or float64"),
        ({"field": "dense_gird"}, RangeError, "one of .'dense_grid', 'tiny_network'"),
        (
            {"origins": np.full((5, 3), np.nan, np.float32)},
            RangeError,
            r"march: origins: expected numbers from -1e\+15 to 1e\+15, got 15 that are not, "
            "the first in row 0",
        ),
        (
            {"directions": np.float32([[0, 0, 1]] * 4 + [[0, 1e20, 0]])},
            RangeError,
            "march: directions: .* got 1 that are not, the first in row 4",
        ),
        ({"t0": np.float32([0, 0, np.inf, 0, 0])}, RangeError, "march: t0: .* in row 2"),
        (
            {"samples": np.int32([0, 1, 2, -1, 0])},
            RangeError,
            "march: samples: expected 0 to 262144 samples of a ray, got -1 in row 3",
        ),
        ({"samples": np.full(5, 2**31 - 1, np.int32)}, RangeError, "got 2147483647 in row 0"),
        (
            {"t0": np.zeros(21, np.uint8)[1:].view(np.float32)},
            ShapeError,
            "march: t0: expected an aligned array",
        ),
    ],
)
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
    batch = (*rays, t0, samples)
    out = _core.march("dense_grid", grid, settings(), batch)
    d_grid = np.zeros_like(grid)
    d_grid.flags.writeable = False
    with pytest.raises(RangeError, match="d_parameters: expected a writable array"):
        _core.march_backward("dense_grid", grid, settings(), batch, out, out, d_grid)


@pytest.mark.parametrize(
    "changes",
    [
        {"dt": 0.0},
        {"dt": float("nan")},
        {"dt": float("inf")},
        {"box": [[0, 0, 0], [1, 0, 1]]},
        {"box": [[0, 0, 0], [1, 1, 1e20]]},
        {"box": [[0, 0, 0], [1, 1, 1e-20]]},
        {"stop": -1.0},
        {"stop": float("nan")},
        {"lattice": 2},
        {"quadrature": -1},
        {"border": 2},
        {"color_activation": 5},
        {"density_activation": -1},
        {"density_scale": float("inf")},
    ],
)
def test_settings_are_checked(changes: dict[str, Any]) -> None:
    with pytest.raises(RangeError, match="MarchSettings"):
        settings(**changes)


def test_steps_that_are_too_many_are_refused_where_they_are_placed() -> None:
    rays = np.zeros((2, 3), np.float32), np.float32([[0, 0, 1]] * 2)
    with pytest.raises(RangeError, match="settings: expected a step of which 262144 cross the box"):
        _core.place_samples(settings(dt=1e-300), *rays)


def test_the_backward_pass_needs_the_counts_of_a_rendering() -> None:
    """The records of crossings were written behind the end of their array."""
    cloud = list(oracle.cloud(6, 1, degree=0).arrays().values())
    rays = np.zeros((40, 3)), np.float64([[0, 0, 1]] * 40)
    options, black = _core.RayOptions(0.0, 1.0, 0.0, 0.01), np.zeros(3)
    prepared = _core.prepare_splat_rays(cloud, options, *rays, black)
    image = [np.zeros((40, 3)), np.zeros(40), np.zeros(40)]
    d_image = [np.ones_like(array) for array in image]
    d_cloud = [np.zeros_like(array) for array in cloud]
    with pytest.raises(RangeError, match=r"expected rays that were rendered, .*call render first"):
        prepared.backward(cloud, image, d_image, d_cloud, np.zeros(3))


def ball() -> Any:
    """A scene of one sphere of 1 m around the origin."""
    sphere, none = np.float32([[0, 0, 0, 1]]), np.zeros(0, np.int32)
    return _core.PathGeometry(
        [], none, np.zeros((0, 3, 4)), sphere, np.zeros(1, np.int32), np.zeros((1, 3)), []
    )


CAMERA = (4, 3, 5.0, 5.0, 2.0, 1.5, np.eye(4)[:3].tolist())


@pytest.mark.parametrize(
    ("place", "value", "text"),
    [
        (0, 0, "width, height: expected 1 to 2.28 pixels, got 0 x 3"),
        (1, 2**30, "width, height: expected 1 to 2.28 pixels"),
        (0, 4.5, "width: expected numbers, got <class 'float'>"),
        (2, -1.0, "fx, fy: expected focal lengths above 0 pixels"),
        (3, float("nan"), "fy: expected numbers up to 1e.15 in size, got nan"),
        (6, [[1e20] * 4] * 3, "world_from_camera: expected numbers up to 1e.15"),
        (6, 1.0, "world_from_camera: expected numbers, got <class 'float'>"),
        (slice(0, 7), (), "numbers: expected 7, 9 or 11 of them, got 0"),
    ],
)
def test_cameras_are_checked(place: Any, value: Any, text: str) -> None:
    camera: list[Any] = list(CAMERA)
    camera[place] = value
    free = np.zeros((3, 4))
    with pytest.raises((DtypeError, RangeError, ShapeError), match=f"camera: {text}"):
        _core.ambient_occlusion(ball(), tuple(camera), 1e-3, 1, 0, 1, free)
    _core.ambient_occlusion(ball(), CAMERA, 1e-3, 1, 0, 1, free)
    assert free.all()  # nothing stands within 1 mm of the ball around the camera


@pytest.mark.parametrize(
    ("uses", "emission", "text"),
    [
        ([(0, 0, 0, 3, 0.0, 1.0)], (-1, 0), "uses: expected textures on meshes alone, .* shape 0"),
        ([], (0, 0), "uses: expected textures on meshes alone"),
        ([(0, 2**31 - 1, 0, 3, 0.0, 1.0)], (-1, 0), "uses: expected channels of textures"),
        ([(0, 0, 2**31 - 1, 3, 0.0, 1.0)], (-1, 0), "uses: expected channels of textures"),
        ([], (0, 2**31 - 1), "emission: expected three channels of a texture"),
    ],
)
def test_textures_are_where_the_core_looks_them_up(
    uses: list[Any], emission: tuple[int, int], text: str
) -> None:
    """A sphere has no triangle whose corners a mip map's footprint could be taken from."""
    geometry = ball()
    layouts = [(4, 4, 3, 0, 0, True)]
    with pytest.raises(RangeError, match=text):
        geometry.set_textures(layouts, [uses], [None], [False], [-1.0], [emission])


def test_numbers_of_samples_and_threads_are_checked() -> None:
    with pytest.raises(RangeError, match="set_thread_count: threads: expected 0 to 4096, got -1"):
        _core.set_thread_count(-1)
    with pytest.raises(RangeError, match=r"sobol_words: count: expected at most 2\^26 points"):
        _core.sobol_words(1, 0, 0, np.zeros(3, np.uint32), 0, 2**31)
