"""Baked ambient occlusion: closed forms, and rays traced afresh."""

from __future__ import annotations

import warnings
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from photograd.errors import RangeError, SceneError
from photograd.textures import sample
from photograd.transport import (
    Accumulation,
    Environment,
    Material,
    MeshShape,
    PathOptions,
    PathTracer,
    Scene,
    Texture,
    TextureUse,
    bake_ambient_occlusion,
)
from photograd.transport.occlusion_map import MARGIN, OcclusionBake, continued, texel_points
from photograd.transport.shapes import box, rectangle

from support.bits import same_bits
from tests.transport.scenes import BLACK, GRAY, view

Array = Any
STRIP = ([-0.5, 0, 1.0], [1, 0, 0], [0, 0, -1.0])  # u along x, v along z: 0..1 m from z = 0


def scene_of(*shapes: Any, **more: Any) -> Scene:
    return Scene("s", shapes, {"gray": GRAY, "black": BLACK}, view(32), **more)


def facing_a_wall(height: float) -> Scene:
    """A strip of floor before a wall at z = 0 that ends far away."""
    wall = rectangle("wall", [-50, 0, 0], [100, 0, 0], [0, height, 0], "gray")
    return scene_of(rectangle("floor", *STRIP, "gray"), wall)


def test_a_wall_takes_what_the_closed_form_says() -> None:
    # Of an endless wall of height h at the distance d, (1 - d / sqrt(d^2 + h^2)) / 2 is not sky.
    height = 0.6
    baked = bake_ambient_occlusion(facing_a_wall(height), "floor", (64, 2), spp=1024, seed=1)
    assert baked.values.shape == (64, 2, 1)

    def expected(d: Array) -> Array:
        return 0.5 * (1 + d / np.hypot(d, height))

    # At the centers; v runs from 0 at the wall to 1, and so does z.
    d = (np.arange(64) + 0.5) / 64
    error = np.abs(baked.values[..., 0] - expected(d)[:, None])
    assert error.max() < 0.008  # measured: 0.0046
    # Between them, looked up through uv, from the foot of the wall to the other end.
    v = np.linspace(0, 1, 401)
    uv = np.stack([np.full_like(v, 0.3), v], axis=1).astype(np.float32)
    found = sample(baked.values, uv)[:, 0]
    assert np.abs(found - expected(v)).max() < 0.01  # measured: 0.0069, half a texel from the wall


def test_only_what_is_near_enough_occludes() -> None:
    # An endless ceiling at the height h, seen up to r: (h / r)^2 stays free.
    ceiling = rectangle("ceiling", [-50, 0.5, -50], [100, 0, 0], [0, 0, 100], "gray")
    scene = scene_of(rectangle("floor", *STRIP, "gray"), ceiling)
    for radius, free in ((0.4, 1.0), (0.625, 0.64), (1.0, 0.25), (np.inf, 0.0)):
        baked = bake_ambient_occlusion(scene, "floor", 4, radius=radius, spp=1024, seed=2)
        # The ceiling ends: 1e-4 of the sky is behind it. Rays start 0.5 mm above the floor.
        assert np.abs(baked.values - free).max() < 0.005, radius  # measured: 0.0029


def room(material: str = "gray") -> tuple[Any, ...]:
    """A floor with a box and a wall on it, all of one material, unfolded each."""
    corner = np.array([[0, 0, 0], [0.5, 0, 0], [0.5, 0.4, 0], [0, 0.4, 0]])
    # An open roof of two slopes, whose halves lie apart in its texture.
    roof = np.array(
        [
            [-0.6, 0.5, 0],
            [0.6, 0.5, 0],
            [0.6, 0.9, -0.4],
            [-0.6, 0.9, -0.4],
            [-0.6, 0.5, -0.8],
            [0.6, 0.5, -0.8],
            [0.6, 0.9, -0.4],
            [-0.6, 0.9, -0.4],
        ]
    )
    uv = np.concatenate([corner[:, :2] + [0.1, 0.05], corner[:, :2] + [0.25, 0.55]])
    faces = np.array([[0, 1, 2], [0, 2, 3], [4, 6, 5], [4, 7, 6]])
    return (
        rectangle("floor", [-1, 0, 0.8], [2, 0, 0], [0, 0, -1.6], material),
        rectangle("wall", [-1, 0, -0.8], [2, 0, 0], [0, 1, 0], material),
        box("box", [0.3, 0.2, 0.1], [0.4, 0.4, 0.4], "black", turn=0.4),
        MeshShape("roof", roof, faces, material, uv=uv.astype(np.float32)),
    )


SEEN = view(20, (0.4, 1.5, 3.0), (0.0, 0.35, 0.0))


@pytest.fixture(scope="module")
def maps() -> dict[str, Any]:
    scene = replace(scene_of(*room()), camera=SEEN)
    return {
        name: bake_ambient_occlusion(scene, name, 96, spp=256, seed=3)
        for name in ("floor", "wall", "roof")
    }


def looked_up(maps: dict[str, Any], keep: Any = None) -> Array:
    """The maps as the renderer shows them: shapes that shine by them, seen directly."""
    shapes = [
        replace(s, emission=np.ones(3), emission_texture=TextureUse(s.name))
        if s.name in maps
        else s
        for s in room()
    ]
    wide = {name: replace(t, values=np.repeat(t.values, 3, axis=2)) for name, t in maps.items()}
    scene = replace(scene_of(*shapes, textures=wide), camera=SEEN)
    picture = PathTracer(scene).render(spp=256, seed=5, options=PathOptions(max_depth=1)).mean
    return picture[..., 0] if keep is None else picture[keep][..., 0]


@pytest.fixture(scope="module")
def traced() -> tuple[Array, Array]:
    """Occlusion traced to the camera, and the pixels that show nothing but baked surfaces."""
    scene = replace(scene_of(*room()), camera=SEEN)
    tracer = PathTracer(scene)
    sums = Accumulation.empty(20, 20)
    tracer.add_occlusion(sums, 16384, seed=4)
    ones = {name: np.ones((1, 1, 1)) for name in ("floor", "wall", "roof")}
    lit = looked_up({name: Texture(values) for name, values in ones.items()})
    return sums.mean[..., 0], lit > 1 - 1e-6


def test_a_map_looked_up_is_what_rays_find(
    maps: dict[str, Any], traced: tuple[Array, Array]
) -> None:
    truth, keep = traced
    assert keep.sum() > 100
    assert truth[keep].min() < 0.3
    error = np.abs(looked_up(maps) - truth)[keep]
    assert error.mean() < 0.004  # measured: 0.0022, of which most is the noise of both
    assert np.quantile(error, 0.95) < 0.01  # measured: 0.0058
    assert error.max() < 0.015  # measured: 0.0088, at the foot of the box


def test_lookups_at_the_edge_of_a_chart_see_nothing_else(
    maps: dict[str, Any], traced: tuple[Array, Array]
) -> None:
    mesh = next(s for s in room() if s.name == "roof")
    points = texel_points(mesh, 96, 96)
    known, values = points.covered, maps["roof"].values[..., 0]
    assert 0.3 < known.mean() < 0.6
    # Along the edges of both charts, where two of four texels lie outside.
    corners = np.asarray(mesh.uv)[mesh.faces[[0, 0, 2, 2], [0, 1, 0, 2]]].reshape(2, 2, 2)
    t = np.linspace(0, 1, 200)[:, None]
    edge = np.concatenate([a + t * (b - a) for a, b in corners]).astype(np.float32)
    inner = edge + np.array([0, 1 / 64], np.float32)
    here, inside = (sample(maps["roof"].values, uv)[:, 0] for uv in (edge, inner))
    assert np.abs(here - inside).max() < 0.04  # measured: 0.020
    bare = np.where(known, values, 0.0)[..., None].astype(np.float32)
    assert np.abs(sample(bare, edge)[:, 0] - inside).min() > 0.08  # without what goes on around
    # And so in the picture.
    truth, keep = traced
    dark = {**maps, "roof": replace(maps["roof"], values=bare)}
    assert np.abs(looked_up(dark) - truth)[keep].max() > 0.05


def test_values_go_on_around_what_is_known() -> None:
    values, known = np.zeros((5, 40)), np.zeros((5, 40), bool)
    values[2, 3], values[2, 4], known[2, 3:5] = 1.0, 3.0, True
    found = continued(values, known)
    assert found[2, 3] == 1
    assert found[2, 2] == found[1, 2] == 1
    assert found[1, 3] == found[3, 4] == 2
    assert found[2, 5] == 3
    np.testing.assert_allclose(found[:, 4 + MARGIN + 1 :], 2)  # the mean of all
    assert 2 < found[2, 4 + MARGIN] <= 3
    np.testing.assert_array_equal(values[2, :3], 0)  # the arguments stay


def test_a_map_is_the_direct_light_of_an_even_sky() -> None:
    # So light that is traced must not be multiplied by it: the shadow would be counted twice.
    scene = replace(facing_a_wall(0.5), environment=Environment.constant(2.0))
    baked = bake_ambient_occlusion(scene, "floor", 32, spp=1024, seed=6)
    lamb = {"gray": Material("lambert", {"albedo": [0.8, 0.4, 0.2]})}
    above = view(8, (0.0, 3.0, 0.51), (0.0, 0.0, 0.5))
    tracer = PathTracer(replace(scene, materials=scene.materials | lamb, camera=above))
    sums = tracer.render(spp=4096, seed=7, options=PathOptions(max_depth=2))
    # Where the camera looks: row by row from the wall.
    open_sky = Accumulation.empty(8, 8)
    tracer.add_occlusion(open_sky, 4096, seed=8)
    seen = open_sky.mean[3:5, 3:5, :1]
    np.testing.assert_allclose(sums.mean[3:5, 3:5], 2.0 * seen * [0.8, 0.4, 0.2], rtol=0.02)
    assert baked.values[15:17].mean() == pytest.approx(float(seen.mean()), abs=0.02)
    assert float(seen.mean()) < 0.9


@same_bits("ambient occlusion")
def occlusion(seed: int = 9) -> list[Any]:
    return [bake_ambient_occlusion(scene_of(*room()), "floor", 24, spp=48, seed=seed).values]


def test_passes_add_up_and_seeds_differ() -> None:
    (whole,) = occlusion()
    assert 0.1 < whole.mean() < 0.99
    bake = OcclusionBake(scene_of(*room()), "floor", 24, seed=9)
    for spp in (16, 32):
        bake.add_samples(spp)
    np.testing.assert_array_equal(bake.texture().values, whole)
    assert (occlusion(seed=10)[0] != whole).any()


def test_a_mesh_that_is_placed_is_baked_where_it_stands() -> None:
    scene = facing_a_wall(0.6)
    floor = scene.shapes[0]
    assert isinstance(floor, MeshShape)
    turn = np.array([[0, 0, 0.5, 0.25], [0, 0.5, 0, 0], [-0.5, 0, 0, 0.5], [0, 0, 0, 1.0]])
    back = np.linalg.inv(turn)
    moved = floor.vertices @ back[:3, :3].T.astype(np.float32) + back[:3, 3].astype(np.float32)
    placed = replace(floor, vertices=moved, instances=(turn,))
    one = bake_ambient_occlusion(scene, "floor", 8, spp=64, seed=11).values
    other = bake_ambient_occlusion(
        replace(scene, shapes=(placed, scene.shapes[1])), "floor", 8, spp=64, seed=11
    ).values
    assert np.ptp(one) > 0.2
    assert np.abs(one - other).max() < 0.02


def test_what_cannot_be_baked_is_refused() -> None:
    scene = facing_a_wall(1.0)
    floor = scene.shapes[0]
    assert isinstance(floor, MeshShape)
    with pytest.raises(SceneError, match="did you mean 'floor'"):
        bake_ambient_occlusion(scene, "flor", 8, seed=1)

    def bake(**changed: Any) -> Any:
        return bake_ambient_occlusion(
            replace(scene, shapes=(replace(floor, **changed), scene.shapes[1])), "floor", 8, seed=1
        )

    assert floor.uv is not None
    with pytest.raises(SceneError, match=r"floor\.uv: expected texture coordinates, got none"):
        bake(uv=None)
    with pytest.raises(SceneError, match=r"0\.\.1, got 0 to 2"):
        bake(uv=2 * floor.uv)
    with pytest.raises(SceneError, match=r"2 instances"):
        bake(instances=(np.eye(4), np.eye(4)))
    with pytest.raises(SceneError, match=r"cover a texel's center, got none of 8 x 8"):
        bake(uv=0.001 * floor.uv)
    with pytest.raises(RangeError, match="radius"):
        bake_ambient_occlusion(scene, "floor", 8, radius=0.0, seed=1)
    with pytest.raises(RangeError, match="resolution"):
        bake_ambient_occlusion(scene, "floor", 0, seed=1)
    with pytest.raises(RangeError, match="spp"):
        bake_ambient_occlusion(scene, "floor", 8, spp=0, seed=1)
    with pytest.raises(RangeError, match="spp"):
        OcclusionBake(scene, "floor", 8, seed=1).texture()


def test_a_mesh_that_lies_on_itself_is_told() -> None:
    scene = facing_a_wall(1.0)
    floor = scene.shapes[0]
    assert isinstance(floor, MeshShape)
    assert floor.uv is not None
    folded = replace(floor, uv=floor.uv[[0, 1, 2, 1]])
    with pytest.warns(UserWarning, match=r"floor: .* texels show more than one place"):
        bake_ambient_occlusion(
            replace(scene, shapes=(folded, scene.shapes[1])), "floor", 8, spp=1, seed=1
        )
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        bake_ambient_occlusion(scene, "floor", 8, spp=1, seed=1)
