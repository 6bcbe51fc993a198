"""Densities from .vdb and other volumes: on the file's own lattice, to rounding."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from photograd.errors import IoError, RangeError, SceneError
from photograd.grids.sparse import SparseGrid
from photograd.grids.vdb import read_vdb, write_vdb
from photograd.grids.volumes import read_volume
from photograd.transport import (
    DensityGrid,
    Environment,
    PathTracer,
    Scene,
    read_density,
    read_scene,
)
from photograd.transport.shapes import box

from tests.transport.media_scenes import Medium, pencil, with_interior

TEXT = """
[camera]
position = [0, 0, 5]
look_at = [0, 0, 0]
field_of_view = 1
size = [1, 1]
[environment]
radiance = 1
[media.cloud]
sigma_t = [1, 2, 3]
density = "cloud.vdb"
[[shapes]]
kind = "box"
center = [0, 0, 0]
size = [2, 2, 2]
material = "boundary"
interior = "cloud"
"""


def lookup(density: DensityGrid, points: Any) -> Any:
    """The medium's density at world points (N, 3), written anew: trilinear, clamped, 0 outside."""
    box_from_world = np.linalg.inv(density.world_from_box)
    q = points @ box_from_world[:3, :3].T + box_from_world[:3, 3]
    n = np.array(density.values.shape)
    at = np.clip(q * n - 0.5, 0, n - 1)
    low = np.minimum(at.astype(int), n - 2)
    out = np.zeros(len(points))
    for corner in np.ndindex(2, 2, 2):
        share = np.where(corner, at - low, 1 - (at - low)).prod(axis=1)
        out += share * density.values[tuple((low + corner).T)]
    return np.where(((q >= 0) & (q <= 1)).all(axis=1), out, 0.0)


def turned() -> Any:
    """world_from_index that turns, shears, mirrors and moves."""
    g = np.random.default_rng(2)
    matrix = np.eye(4)
    matrix[:3, :3] = 0.1 * (np.diag([1.0, -1.0, 1.0]) + 0.4 * g.uniform(-1, 1, (3, 3)))
    matrix[:3, 3] = [0.2, -0.3, 0.1]
    return matrix


def spots() -> SparseGrid:
    """A few values with holes between them, not at the origin."""
    g = np.random.default_rng(1)
    values = np.where(g.random((5, 4, 6)) < 0.5, g.uniform(0.1, 2, (5, 4, 6)), 0)
    return SparseGrid.from_dense(
        values.astype(np.float32), origin=(3, -2, 7), world_from_index=turned(), name="spots"
    )


def test_a_turned_and_sheared_lattice_is_taken_as_it_is(tmp_path: Path) -> None:
    grid = spots()
    write_vdb(tmp_path / "a.vdb", [grid])
    density = read_density(tmp_path / "a.vdb")
    lo, hi = grid.statistics.box
    index = np.random.default_rng(3).uniform(lo - 2, hi + 1, (4000, 3))
    world = grid.to_world(index)
    expected = grid.sample(world)[:, 0]  # OpenVDB's own, float32; also where it fades to nothing
    assert (expected > 0).mean() > 0.3
    assert (expected == 0).mean() > 0.1
    np.testing.assert_allclose(lookup(density, world), expected, atol=2e-6)


def test_light_goes_through_it_as_through_the_file(tmp_path: Path) -> None:
    # Along one line: exp(-sigma integral of the density), the integral from the file's own sampler.
    grid = spots()
    write_vdb(tmp_path / "a.vdb", [grid])
    medium = Medium([0.5, 1.0, 2.0], density=read_density(tmp_path / "a.vdb"))
    middle = grid.to_world(grid.statistics.box.mean(axis=0, keepdims=True))[0]
    start = middle + np.array([0.5, 0.3, 2.0])
    hull = with_interior(box("hull", middle.tolist(), [4, 4, 4], "boundary"), "cloud")
    scene = Scene(
        "line",
        (hull,),
        {},
        pencil(start, middle),
        Environment.constant(1.0),
        media={"cloud": medium},
    )
    found = PathTracer(scene, dtype=np.float64).render(spp=1 << 16, seed=1)
    way = middle - start
    t = (np.arange(200_000) + 0.5) / 200_000 * 2  # twice the way to the middle
    integral = grid.sample(start + t[:, None] * way).mean() * 2 * np.linalg.norm(way)
    expected = np.exp(-np.array([0.5, 1.0, 2.0]) * integral)
    assert expected[2] < 0.8
    error = found.standard_error[0, 0]
    assert (error < 0.005).all()
    # Even samples err less than their spread says.
    assert (np.abs(found.mean[0, 0] - expected) < 3 * error).all()


def test_moved_and_stretched(tmp_path: Path) -> None:
    write_vdb(tmp_path / "a.vdb", [spots()])
    own = read_density(tmp_path / "a.vdb")
    moved = read_density(tmp_path / "a.vdb", corner=[-1, 0, -2], size=[2, 3, 4])
    np.testing.assert_array_equal(own.values, moved.values)
    # The bounds of all that is active, half a voxel around the outermost: one layer less.
    lo, hi = 1 / np.array(own.values.shape), 1 - 1 / np.array(own.values.shape)
    ends = np.array([np.where(c, hi, lo) for c in np.ndindex(2, 2, 2)])
    corners = ends @ moved.world_from_box[:3, :3].T + moved.world_from_box[:3, 3]
    np.testing.assert_allclose(corners.min(axis=0), [-1, 0, -2], atol=1e-12)
    np.testing.assert_allclose(corners.max(axis=0), [1, 3, 2], atol=1e-12)


def test_a_scene_file_reads_it(tmp_path: Path) -> None:
    other = SparseGrid.from_dense(np.full((3, 3, 3), 0.25, np.float32), name="other")
    write_vdb(tmp_path / "cloud.vdb", [spots(), other])
    (tmp_path / "s.toml").write_text(TEXT)
    first = read_scene(tmp_path / "s.toml").media["cloud"].density
    assert first is not None
    np.testing.assert_array_equal(first.values, read_density(tmp_path / "cloud.vdb").values)
    more = '"cloud.vdb"\ngrid = "other"\ncorner = [-1, -1, -1]\nsize = [2, 2, 2]\nmajorant = 2'
    (tmp_path / "s.toml").write_text(TEXT.replace('"cloud.vdb"', more))
    second = read_scene(tmp_path / "s.toml").media["cloud"].density
    assert second is not None
    assert (second.values.shape, second.values.max(), second.majorant) == ((5, 5, 5), 0.25, 2)
    assert PathTracer(read_scene(tmp_path / "s.toml")).render(spp=4, seed=1).mean.max() < 1


def level_set() -> SparseGrid:
    return SparseGrid.from_dense(np.zeros((2, 2, 2), np.float32), background=0.3, name="ls")


def vectors() -> SparseGrid:
    return SparseGrid.from_dense(np.ones((2, 2, 2, 3), np.float32), name="wind")


@pytest.mark.parametrize(
    ("grids", "old", "new", "text"),
    [
        ([], "", "", r"line 11: media.cloud.density: .*cloud\.vdb.*: expected a file"),
        (
            [spots],
            '"cloud.vdb"',
            '"cloud.vdb"\ngrid = "smoke"',
            r"line 11: media.cloud.density: .*called 'smoke', got 'spots' \(1 channels\)",
        ),
        ([vectors], "", "", r"line 11: .*a grid of scalars, got 'wind' \(3 channels\)"),
        ([level_set], "", "", r"line 11: .*grid 'ls': expected a background of 0"),
        ([spots], '"cloud.vdb"', '"cloud.vdb"\ncorner = [0, 0, 0]', "media.cloud.size: expected"),
        ([spots], '"cloud.vdb"', '"cloud.vdb"\nmajorant = 0.1', r"line 11: .*the majorant 0\.1"),
        ([spots], '"cloud.vdb"', '"cloud.npy"\ngrid = "spots"', "media.cloud.corner: expected"),
    ],
)
def test_what_is_wrong_is_named(tmp_path: Path, grids: Any, old: str, new: str, text: str) -> None:
    if grids:
        write_vdb(tmp_path / "cloud.vdb", [make() for make in grids])
    (tmp_path / "s.toml").write_text(TEXT.replace(old, new) if old else TEXT)
    with pytest.raises(SceneError, match=text):
        read_scene(tmp_path / "s.toml")


def test_grids_that_are_no_densities(tmp_path: Path) -> None:
    empty = SparseGrid.from_dense(np.zeros((2, 2, 2), np.float32), name="none")
    below = SparseGrid.from_dense(np.full((2, 2, 2), -0.5, np.float32), name="below")
    for grid, text in (
        (empty, "grid 'none': expected active voxels"),
        (below, r"grid 'below': expected densities of at least 0, got -0\.5"),
    ):
        write_vdb(tmp_path / "a.vdb", [grid])
        with pytest.raises(RangeError, match=text):
            read_density(tmp_path / "a.vdb")
    with pytest.raises(RangeError, match=r"of the box that a \.npy fills"):
        read_density(tmp_path / "a.npy")
    with pytest.raises(IoError, match="expected a file, got none"):
        read_density(tmp_path / "a.npy", corner=[0, 0, 0], size=[1, 1, 1])


def test_more_than_there_is_room_for_is_refused_before_it_is_taken(tmp_path: Path) -> None:
    # Two voxels a million apart along each axis: few bytes in the file, 1e18 voxels as a box.
    grid = SparseGrid.from_dense(np.zeros((2, 2, 2), np.float32), name="far")
    grid.activate(np.array([(0, 0, 0), (10**6,) * 3], np.int32), np.ones((2, 1), np.float32))
    write_vdb(tmp_path / "cloud.vdb", [grid])
    (tmp_path / "s.toml").write_text(TEXT)
    text = r"line 11: media.cloud.density: .*grid 'far', 1000003 x .* TiB"
    with pytest.raises(SceneError, match=text):
        read_scene(tmp_path / "s.toml")
    near = SparseGrid.from_dense(np.zeros((2, 2, 2), np.float32), name="near")
    near.activate(np.array([(0, 0, 0), (99,) * 3], np.int32), np.ones((2, 1), np.float32))
    write_vdb(tmp_path / "a.vdb", [near])
    with pytest.raises(RangeError, match=r"102 x 102 x 102 voxels in a medium \(20\.2 MiB"):
        read_density(tmp_path / "a.vdb", memory_limit=20_000_000)


def test_a_real_cloud(shared_data: Path, tmp_path: Path) -> None:
    path = shared_data / "volumes" / "houdini_dragon_small_fog.vdb"
    grid = read_vdb(path).grid("density")
    density = read_density(path, grid="density")
    assert density.values.shape == (72, 51, 33)
    world = grid.to_world(np.random.default_rng(1).uniform((15, 0, 34), (87, 51, 67), (5000, 3)))
    np.testing.assert_allclose(lookup(density, world), grid.sample(world)[:, 0], atol=2e-6)
    lines = f'"{path}"\ncorner = [-1, -1, -1]\nsize = [2, 2, 2]'
    text = TEXT.replace('"cloud.vdb"', lines).replace("[1, 2, 3]", "8\nalbedo = 0.9")
    (tmp_path / "s.toml").write_text(text.replace("field_of_view = 1\n", "field_of_view = 30\n"))
    found = PathTracer(read_scene(tmp_path / "s.toml")).render(spp=64, seed=1).mean[0, 0]
    assert (found > 0.2).all()
    assert (found < 0.98).all()


def test_a_volume_of_a_simulation(shared_data: Path) -> None:
    path = shared_data / "volumes" / "lajolla_smoke.vol"
    volume, density = read_volume(path), read_density(path)
    np.testing.assert_array_equal(density.values, volume.density)
    middle = volume.world_from_index @ [64, 63.5, 24, 1]
    expected = volume.density[64, 63:65, 24].mean()
    np.testing.assert_allclose(lookup(density, middle[None, :3]), expected, rtol=1e-5)
