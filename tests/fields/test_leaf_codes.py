"""Codes at voxels and a shared decoder: densities as in a sparse grid, colors of the network."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from photograd import sh
from photograd._compiled import _core
from photograd.errors import RangeError
from photograd.fields import LeafCodes, SparseSh
from photograd.fields.active_voxels import ActiveVoxels
from photograd.fields.decoded_march import harmonics, harmonics_backward
from photograd.fields.march import checked_rays
from photograd.representation import Outputs, RenderOptions, check_gradients

OPTIONS = RenderOptions()


def look(field: Any, seed: int = 3, options: RenderOptions = OPTIONS) -> Outputs:
    batch = LeafCodes.example(seed=3).example_batch(seed=seed)
    return field.render(batch, seed=0, step=0, options=options)[0]


def test_the_samples_in_cells_with_an_active_voxel_are_found() -> None:
    field = SparseSh.example(seed=3)
    settings = field.policy.settings(0.0)
    batch = field.example_batch(seed=3)
    rays = checked_rays(batch, settings, OPTIONS, np.dtype(np.float64), seed=0, step=0)
    mask = np.zeros(field.active.shape, bool)
    mask[3:6, 2:7, 4:8] = True
    active = ActiveVoxels(mask)
    offset, t, points = _core.visible_samples(active.table, settings, rays)
    lower, upper = field.box
    padded = np.pad(mask, 2)
    expected: list[float] = []
    for o, d, t0, count in zip(*rays, strict=True):
        at = t0 + (np.arange(count) + 0.5) * field.dt
        q = (o + at[:, None] * d - lower) / (upper - lower) * mask.shape - 0.5
        base = np.floor(q).astype(int) + 2
        corners = np.stack(np.meshgrid([0, 1], [0, 1], [0, 1]), axis=-1).reshape(8, 3)
        near = [padded[tuple((base + corner).T)] for corner in corners]
        expected += at[np.any(near, axis=0)].tolist()
    assert 0 < len(expected) < rays[3].sum()
    np.testing.assert_allclose(t, expected, rtol=1e-12)
    assert offset[-1] == len(t) == len(points)


@pytest.mark.parametrize("decode", ["sample", "ray"])
def test_opacity_and_depth_are_those_of_the_sparse_grid(decode: Any) -> None:
    grid = SparseSh.example(seed=3)
    codes = LeafCodes.from_sparse_sh(grid, decode=decode)
    found, known = look(codes), look(grid)
    assert known.opacity is not None
    assert known.opacity.max() > 0.5
    np.testing.assert_allclose(found.opacity, known.opacity, rtol=0, atol=1e-12)
    np.testing.assert_allclose(found.depth, known.depth, rtol=0, atol=1e-12)


def test_equal_codes_have_one_color_wherever_they_are_decoded() -> None:
    field = LeafCodes.example(seed=3)
    field.params["codes"][:] = 0
    directions = field.example_batch(seed=3).directions
    given = np.concatenate([np.zeros((len(directions), 3)), sh.basis(directions, 2)], axis=1)
    raw = field.decoder.forward(field.params["decoder"], given)
    for found in (look(field), look(field.decoded("ray"))):
        expected = np.asarray(found.opacity)[:, None] / (1 + np.exp(-raw))
        np.testing.assert_allclose(found.color, expected, rtol=0, atol=1e-12)


def test_other_codes_have_other_colors_per_sample_and_per_ray() -> None:
    field = LeafCodes.example(seed=3)
    field.params["codes"] *= 5
    assert np.abs(look(field).color - look(field.decoded("ray")).color).max() > 1e-3


@pytest.mark.parametrize("decode", ["sample", "ray"])
def test_gradients_are_right(decode: Any) -> None:
    report = check_gradients(LeafCodes.example(seed=1).decoded(decode), seed=1, camera=True)
    assert report, str(report)


def test_the_stop_discards_less_than_it_says() -> None:
    field = LeafCodes.example(seed=3)
    dense = field._with(density_scale=40.0)
    whole, stopped = look(dense), look(dense, options=RenderOptions(stop=0.05))
    assert 0 < np.abs(whole.color - stopped.color).max() < 0.05


def test_the_harmonics_of_directions_and_their_adjoint() -> None:
    directions = LeafCodes.example(seed=1).example_batch(seed=1).directions
    np.testing.assert_allclose(harmonics(directions), sh.basis(directions, 2), atol=1e-14)
    d_basis = np.random.default_rng(1).standard_normal((len(directions), 9))
    along = np.random.default_rng(2).standard_normal(directions.shape) * 1e-6
    change = harmonics(directions + along) - harmonics(directions - along)
    expected = 0.5 * (change * d_basis).sum()
    found = (harmonics_backward(directions, d_basis) * along).sum()
    np.testing.assert_allclose(found, expected, rtol=1e-6)


def test_baking_comes_closer_with_the_degree() -> None:
    field = LeafCodes.example(seed=3)
    field.params["codes"][:] = field.params["codes"][:1]  # so that only directions matter
    directions = field.example_batch(seed=4).directions
    given = np.concatenate(
        [field.params["codes"][: len(directions)], sh.basis(directions, 2)], axis=1
    )
    truth = field.decoder.forward(field.params["decoder"], given)
    errors = []
    for degree in (0, 1, 2, 3):
        baked = field.baked(degree=degree)
        found = sh.evaluate(baked.params["sh"][: len(directions)], directions)
        errors.append(float(np.abs(found - truth).max()))
        np.testing.assert_array_equal(baked.params["density"], field.params["density"])
    assert errors == sorted(errors, reverse=True)
    assert errors[3] < 0.2 * errors[0]


def test_other_activations_and_the_entry_lattice_are_refused() -> None:
    grid = SparseSh.example(seed=3)
    grid.policy = replace(grid.policy, density_activation="relu")
    with pytest.raises(RangeError, match=r"LeafCodes.from_sparse_sh: field: expected a field with"):
        LeafCodes.from_sparse_sh(grid)
    field = LeafCodes.example(seed=3)._with(lattice="entry")
    with pytest.raises(RangeError, match="camera_adjoint"):
        look(field, options=RenderOptions(camera_adjoint=True))
