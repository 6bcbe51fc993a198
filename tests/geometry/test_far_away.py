"""Rays and scenes beyond what the tracer takes: refused, or met by nothing, but never the end.

Embree ends the process over such numbers, so that these cases run in one of their own.
"""

from __future__ import annotations

import numpy as np
import pytest
from photograd._compiled import _core
from photograd.errors import RangeError, SceneError
from photograd.geometry.mesh import Bvh, Instance, Mesh

from support.child import answers

BEGIN = """
import numpy as np
from photograd._compiled import _core
from photograd.geometry.mesh import Bvh, Mesh
V = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0]], np.float32)
F = np.array([[0, 1, 2]])

def rays():
    return np.tile(np.float32([0.2, 0.2, -1]), (9, 1)), np.tile(np.float32([0, 0, 1]), (9, 1))

def geometry(matrix=None, closing=None, spheres=()):
    shapes = (0 if matrix is None else 1) + len(spheres)
    rows = [] if matrix is None else [np.asarray(matrix, np.float64)[:3]]
    after = None if closing is None else np.asarray(closing, np.float64)[None, :3].copy()
    return _core.PathGeometry(
        [(V, F.astype(np.uint32), None, None)], np.zeros(len(rows), np.int32),
        np.array(rows).reshape(-1, 3, 4), np.array(spheres, np.float32).reshape(-1, 4),
        np.zeros(shapes, np.int32), np.zeros((shapes, 3)), [], closing_matrices=after)

def scaled(*factors):
    return np.diag([*(factors if len(factors) == 3 else factors * 3), 1.0])

def looks(scene):
    # From points as far away as the core accepts, into the scene, beside it and away from it.
    g = np.random.default_rng(1)
    far = 10.0 ** g.uniform(-20, 14.9, (4000, 1)) * g.choice([-1, 1], (4000, 3))
    way = -far / np.linalg.norm(far, axis=1, keepdims=True)
    free = np.zeros(4000)
    _core.point_occlusion(scene, far, way, np.inf, 1, 0, 16, free)
    return (free < 16).any() and (free == 16).any() and (free >= 0).all()
"""
RAYS = {
    "t_min = -1e-7": "t_min: expected numbers of at least 0, got 1 that are not, the first, "
    "-1e-07, in row 0",
    "t_min = np.full(9, 1, np.float32); t_min[2] = -1": "t_min: expected numbers of at least 0, "
    "got 1 that are not, the first, -1, in row 2",
    "o[3, 1] = 1e20": "origins, directions: expected finite numbers whose sizes add up to at most "
    "1e+18, and directions of some length, got 1 rays that have not, the first in row 3",
    "d[4, 0] = -1e20": "got 1 rays that have not, the first in row 4",
}
SCENES = {
    "geometry(spheres=[[0, -1e18, 0, 1e18]])": "spheres: expected all of the scene within 1e+15 m "
    "of the origin, got 2e+18 m in sphere 0",
    "geometry(scaled(1e16))": "world_from_object: expected all of the scene within 1e+15 m",
    "geometry(scaled(1e-13))": "world_from_object: expected matrices that can be inverted in "
    "float32, got a determinant of 1e-39 in instance 0",
    "geometry(scaled(1e-30, 1e5, 1e5))": "rays from anywhere in the scene stay within Embree's "
    "range, got a scene of 100000 m and a reach of",
    "geometry(np.eye(4), scaled(-1, -1, 1))": "inverted in float32 while the shutter is open",
    "geometry(np.eye(4), scaled(-1, 1, 1))": "got a determinant of 0 in instance 0",
    "Bvh(Mesh(1e16 * V, F))": "vertices: expected all of the scene within 1e+15 m of the origin, "
    "got 1e+16 m in mesh 0",
}
WITHIN = (
    "geometry(scaled(1e11))",
    "geometry(scaled(1e-11))",
    "geometry(scaled(1e-6), scaled(2e-6))",
    "geometry(spheres=[[0, -4e14, 0, 4e14], [0, 0, 1, 1e-20]])",
)


@pytest.fixture(scope="module")
def said() -> dict[str, str]:
    """All that one process says to these cases."""
    begin = "bvh = Bvh(Mesh(V, F)); o, d = rays(); t_min = 0"
    cases = {
        f"{ask}: {change}": f"{begin}\n{change}\nbvh.{ask}(o, d, t_min=t_min)"
        for ask in ("trace", "occluded")
        for change in RAYS
    }
    cases |= {scene: scene for scene in SCENES}
    cases |= {f"looks: {scene}": f"answer = looks({scene})" for scene in WITHIN}
    return answers(BEGIN, cases)


@pytest.mark.parametrize("ask", ["trace", "occluded"])
@pytest.mark.parametrize("change", RAYS)
def test_rays_out_of_range_are_refused(said: dict[str, str], ask: str, change: str) -> None:
    assert said[f"{ask}: {change}"].startswith(f"RangeError: Bvh.{ask}: ")
    assert RAYS[change] in said[f"{ask}: {change}"]


@pytest.mark.parametrize("scene", SCENES)
def test_scenes_out_of_range_are_refused(said: dict[str, str], scene: str) -> None:
    assert said[scene].startswith("SceneError: bvh: ")
    assert SCENES[scene] in said[scene]


@pytest.mark.parametrize("scene", WITHIN)
def test_rays_from_anywhere_are_traced_up_to_the_limit(said: dict[str, str], scene: str) -> None:
    assert said[f"looks: {scene}"] == "True"


def test_distances_that_are_no_numbers_are_refused() -> None:
    bvh = Bvh(Mesh(np.eye(3, dtype=np.float32), np.array([[0, 1, 2]])))
    rays = np.zeros((1, 3)), np.ones((1, 3))
    nan, one = np.array([np.nan]), np.array([1.0])
    for ends, name in (((nan, one), "t_min"), ((one, nan), "t_max")):
        with pytest.raises(RangeError, match=f"occluded: {name}: expected numbers"):
            bvh.core.occluded(*rays, *ends)
    # An interval that ends before it begins holds nothing, a negative one neither.
    assert not bvh.occluded(*rays, t_min=2.0, t_max=1.0).any()
    assert not bvh.occluded(*rays, t_max=-1.0).any()


def test_a_turn_that_keeps_its_sides_is_taken() -> None:
    # A quarter turn while the shutter is open: the determinant falls to a half and rises again.
    turned = np.array([[0.0, -1, 0, 0], [1, 0, 0, 0], [0, 0, 1, 0]])[None]
    triangle = np.eye(3, dtype=np.float32), np.array([[0, 1, 2]], np.uint32), None, None
    lights: list[tuple[object, ...]] = []
    geometry = _core.PathGeometry(
        [triangle],
        np.zeros(1, np.int32),
        np.eye(4)[None, :3].copy(),
        np.zeros((0, 4), np.float32),
        np.zeros(1, np.int32),
        np.zeros((1, 3)),
        lights,
        closing_matrices=turned,
    )
    assert geometry.bvh.occluded(np.ones((1, 3)), -np.ones((1, 3)), np.zeros(1), np.ones(1)).all()


def test_instances_of_the_face_are_checked_too() -> None:
    mesh = Mesh(np.eye(3, dtype=np.float32), np.array([[0, 1, 2]]))
    with pytest.raises(SceneError, match="world_from_object"):
        Bvh([mesh], [Instance(0, 1e-13 * np.eye(4))])
