"""What is no mesh and what is no ray is refused with one sentence that names it."""

from __future__ import annotations

import re
from typing import Any

import numpy as np
import pytest
from photograd.errors import DtypeError, Error, RangeError, SceneError, ShapeError
from photograd.geometry.mesh import Bvh, Hits, Instance, Mesh, drop_degenerate

from .shapes import bumpy_sphere, random_rays

VERTICES, FACES = bumpy_sphere(8, 12)


def with_row(array: Any, row: int, value: Any) -> Any:
    changed = np.array(array)
    changed[row] = value
    return changed


def build(vertices: Any = VERTICES, faces: Any = FACES, uv: Any = None, **options: Any) -> Bvh:
    return Bvh(Mesh(vertices, faces, uv), **options)


FLAT = with_row(FACES, 5, [3, 3, 4])
CASES: dict[str, tuple[type[Error], str, dict[str, Any]]] = {
    "nan": (
        SceneError,
        "vertices.*nan in vertex 7 of mesh 0",
        {"vertices": with_row(VERTICES, 7, np.nan)},
    ),
    "far vertex": (
        SceneError,
        "faces.*below 86, got 99 in triangle 4 of mesh 0",
        {"faces": with_row(FACES, 4, [0, 99, 1])},
    ),
    "flat": (SceneError, "1 without, the first is triangle 5 .*drop_degenerate", {"faces": FLAT}),
    "no face": (SceneError, "at least one triangle", {"faces": np.zeros((0, 3), int)}),
    "negative": (
        RangeError,
        r"Mesh: faces: expected numbers in .*, got \[ 0 -1  2\] in row 3",
        {"faces": with_row(FACES.astype(int), 3, [0, -1, 2])},
    ),
    "float faces": (DtypeError, "faces: expected integer", {"faces": FACES.astype(float)}),
    "quads": (ShapeError, "faces: expected shape", {"faces": FACES[:8].reshape(-1, 4)}),
    "planar": (ShapeError, "vertices: expected shape", {"vertices": VERTICES[:, :2]}),
    "uv rows": (ShapeError, "uv: expected shape", {"uv": np.zeros((5, 2))}),
    "uv nan": (SceneError, "uv.*at vertex 0", {"uv": np.full((len(VERTICES), 2), np.nan)}),
    "mesh number": (SceneError, "instances.*below 1, got 2", {"instances": [Instance(2)]}),
    "no instance": (SceneError, "at least one", {"instances": []}),
    "singular": (
        SceneError,
        "invertible.*instance 0",
        {"instances": [Instance(0, np.zeros((3, 4)))]},
    ),
    "matrix": (ShapeError, r"shape \(3, 4\)", {"instances": [Instance(0, np.eye(3))]}),
}


@pytest.mark.parametrize("case", CASES)
def test_bad_mesh(case: str) -> None:
    kind, text, changes = CASES[case]
    with pytest.raises(kind) as caught:
        build(**changes)
    assert re.search(text, str(caught.value)), str(caught.value)


def test_dropping_flat_triangles_heals_the_mesh() -> None:
    kept = drop_degenerate(VERTICES, FLAT)
    np.testing.assert_array_equal(kept, np.delete(FLAT, 5, axis=0))
    build(faces=kept)


@pytest.mark.parametrize("value", [np.nan, np.inf, 0.0])
@pytest.mark.parametrize("method", ["trace", "occluded"])
def test_rays_that_are_none_are_counted(method: str, value: float) -> None:
    origins, directions = random_rays(1000, seed=1)
    directions[[17, 900]] = value
    with pytest.raises(RangeError, match="2 rays that have not, the first in row 17"):
        getattr(build(), method)(origins, directions)


def test_ray_arrays_must_fit() -> None:
    bvh = build()
    o, d = random_rays(10, seed=2)
    bad: list[tuple[type[Error], tuple[Any, ...]]] = [
        (DtypeError, (o.astype(int), d)),
        (DtypeError, (o, d.astype("f4"))),
        (ShapeError, (o[:5], d)),
        (ShapeError, (o[:, :2], d[:, :2])),
        (ShapeError, (o, d, np.zeros(3))),
        (DtypeError, (o, d, np.zeros(10, "f4"))),
        (RangeError, (o, d, np.nan)),
    ]
    for kind, arguments in bad:
        with pytest.raises(kind):
            bvh.trace(*arguments)
    np.testing.assert_array_equal(bvh.trace(o.tolist(), d).t, bvh.trace(o, d).t)
    no_triangle = np.full(10, 10**6, np.int32)
    hits = Hits(o[:, 0], no_triangle, np.zeros(10, np.int32), o[:, :2])
    with pytest.raises(RangeError, match="numbers from trace, got 1000000, 0 in row 0"):
        bvh.surface_points(o, d, hits)
