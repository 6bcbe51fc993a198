"""The sparse grid as Python sees it: topology as data, refined, pruned and dilated."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from photograd.errors import DtypeError, Error, RangeError, ShapeError
from photograd.fields import SparseSh
from photograd.fields.active_voxels import ActiveVoxels, dilated, resampled_mask
from photograd.representation import Outputs, RayBatch, RenderOptions

BOX = np.array([[-1.0, -0.5, 0.0], [1.0, 1.0, 0.8]])
OPTIONS = RenderOptions()


def spots(seed: int, shape: tuple[int, int, int] = (20, 17, 30), share: float = 0.02) -> Any:
    return np.random.default_rng(seed).random(shape) < share


def test_rows_and_voxels_name_each_other() -> None:
    active = ActiveVoxels(spots(1))
    i, j, k = active.voxels.T
    assert len(active) == active.mask.sum() > 100
    assert np.array_equal(active.rows[i, j, k], np.arange(len(active)))
    assert (active.rows >= 0).sum() == len(active)
    again = ActiveVoxels.of_state(active.state(), "test")
    assert np.array_equal(again.mask, active.mask)


def test_dilation_covers_a_cube_and_finer_masks_keep_their_place() -> None:
    mask = spots(2)
    grown = dilated(mask)
    expected = np.zeros_like(mask)
    for i, j, k in np.argwhere(mask):
        expected[max(i - 1, 0) : i + 2, max(j - 1, 0) : j + 2, max(k - 1, 0) : k + 2] = True
    assert np.array_equal(grown, expected)
    fine = resampled_mask(mask, (40, 34, 60))
    assert np.array_equal(fine, mask.repeat(2, 0).repeat(2, 1).repeat(2, 2))


def test_empty_space_has_the_density_that_was_asked_for() -> None:
    field = SparseSh.full(BOX, 20, finest=80, sigma_t=0.3, dtype=np.float64)
    assert field.params["sh"].shape == (20 * 15 * 8, 9, 3)
    batch = RayBatch(np.array([[-3.0, 0.2, 0.4]]), np.array([[1.0, 0, 0]]), np.zeros(1, np.uint32))
    outputs, _ = field.render(batch, seed=0, step=0, options=OPTIONS)
    assert outputs.opacity is not None
    np.testing.assert_allclose(outputs.opacity, [1 - np.exp(-0.6)], rtol=1e-12)
    # In the half-active cells of the rim color fades to that of no coefficients: measured 0.1832.
    np.testing.assert_allclose(outputs.color[0] / outputs.opacity, [0.1832] * 3, rtol=1e-3)


def test_a_finer_grid_shows_the_same_image() -> None:
    # A field that is linear in space is met exactly by trilinear interpolation; at the rim of the
    # box, where a coarse cell is half active, the two differ, so look at rays through the middle.
    field = SparseSh.full(BOX, 16, finest=32, sigma_t=1.0, dtype=np.float64, steps_per_voxel=1.0)
    at = field.active.voxels / np.array(field.active.shape)
    field.params["density"] += at @ [3.0, 1.0, 2.0]
    field.params["sh"][:, :, 0] += (at @ [1.0, -1.0, 0.5])[:, None]
    fine = field.refined(32, steps_per_voxel=2.0)
    assert fine.resolution == 2 * field.resolution
    assert fine.policy.dt == pytest.approx(field.policy.dt / 4)
    fine.policy = replace(fine.policy, dt=field.policy.dt)
    inside = RenderOptions()
    batch = RayBatch(
        np.array([[0.1, 0.2, 0.4]]), np.array([[0.6, 0.8, 0.0]]), np.zeros(1, np.uint32)
    )
    few = [replace(f.policy, box=((-1, -0.5, 0), (1, 1, 0.8))) for f in (field, fine)]
    assert few[0].box == few[1].box
    a, b = (f.render(batch, seed=0, step=0, options=inside)[0] for f in (field, fine))
    np.testing.assert_allclose(a.color, b.color, rtol=1e-7)  # measured: 7e-9
    rows = field.active.rows[4:10, 4:8, 2:5].ravel()
    up = field.resampled(field.params["density"], fine)
    i, j, k = (2 * field.active.voxels[rows]).T
    quarter = up[fine.active.rows[i, j, k]] + up[fine.active.rows[i + 1, j + 1, k + 1]]
    np.testing.assert_allclose(quarter / 2, field.params["density"][rows], rtol=1e-12)


def test_pruning_keeps_what_weighs_and_its_neighbors() -> None:
    field = SparseSh.example(seed=3)
    before = {name: value.copy() for name, value in field.params.items()}
    old = field.active
    weight = np.random.default_rng(3).random(len(old))
    rows = field.refine(1, {"weight": weight, "threshold": np.array(0.97)})
    assert rows is not None
    heavy = np.zeros(old.shape, bool)
    i, j, k = old.voxels[weight >= 0.97].T
    heavy[i, j, k] = True
    assert np.array_equal(field.active.mask, dilated(heavy))
    kept = rows.source >= 0
    assert 0 < (~kept).sum() < len(kept) < len(old)
    for name, value in field.params.items():
        assert np.array_equal(value[kept], before[name][rows.source[kept]])
    assert (field.params["density"][~kept] == field.background_density).all()
    assert not field.params["sh"][~kept].any()
    assert np.array_equal(field.active.voxels[kept], old.voxels[rows.source[kept]])
    assert field.refine(2, {}) is None


def test_what_wants_density_stays_whatever_it_weighs() -> None:
    field = SparseSh.example(seed=3)
    old, weight = field.active, np.zeros(len(field.active))
    wanted = np.random.default_rng(4).random(len(old)) < 0.02
    mask = np.zeros(old.shape, bool)
    mask[tuple(old.voxels[wanted].T)] = True
    field.refine(1, {"weight": weight, "threshold": np.array(0.5), "wanted": wanted})
    assert np.array_equal(field.active.mask, dilated(mask))


def test_a_rendering_keeps_the_topology_that_it_was_made_with() -> None:
    field = SparseSh.example(seed=4)
    batch = field.example_batch(seed=4)
    d = Outputs(np.ones((24, 3)))
    _, context = field.render(batch, seed=0, step=0, options=OPTIONS)
    expected = field.render_backward(context, d)
    weight = np.linspace(0, 1, len(field.active))
    field.refine(1, {"weight": weight, "threshold": np.array(0.9)})
    late = field.render_backward(context, d)
    assert len(expected["density"]) != len(field.active)
    assert np.abs(expected["sh"]).max() > 0
    for name, value in expected.items():
        assert np.array_equal(late[name], value)


def test_everything_pruned_is_an_error_that_says_what_to_do() -> None:
    field = SparseSh.example(seed=5)
    nothing = {"weight": np.zeros(len(field.active)), "threshold": np.array(0.5)}
    with pytest.raises(Error, match=r"one active voxel or more, got none .*lower the threshold"):
        field.refine(1, nothing)


FIELD = SparseSh.example(seed=1)


@pytest.mark.parametrize(
    ("density", "coefficients", "error", "words"),
    [
        (FIELD.params["density"][1:], FIELD.params["sh"], ShapeError, "density"),
        (FIELD.params["density"], FIELD.params["sh"][1:], ShapeError, "sh"),
        (FIELD.params["density"], FIELD.params["sh"][:, :5], RangeError, "degree 0 to 3.*got 5"),
        (FIELD.params["density"].astype("f4"), FIELD.params["sh"], DtypeError, "sh: .*float32"),
        (FIELD.params["density"] * np.nan, FIELD.params["sh"], Error, "density.*finite"),
        (FIELD.params["density"], FIELD.params["sh"] * np.inf, Error, "sh.*finite"),
    ],
)
def test_bad_values_are_refused(
    density: Any, coefficients: Any, error: type[Exception], words: str
) -> None:
    with pytest.raises(error, match=words):
        SparseSh(FIELD.active, density, coefficients, FIELD.policy)


def test_bad_options_are_refused() -> None:
    with pytest.raises(RangeError, match="degree: expected a whole number in"):
        SparseSh.full(BOX, 8, degree=4)
    with pytest.raises(RangeError, match=r"policy.border: expected 'zero', got 'clamp'"):
        SparseSh(FIELD.active, *FIELD.params.values(), replace(FIELD.policy, border="clamp"))
    with pytest.raises(DtypeError, match="mask"):
        ActiveVoxels(np.ones((4, 4, 4)))
    field = SparseSh.example(seed=1)
    field.params["density"][7] = np.nan
    with pytest.raises(Error, match=r"SparseSh.render: density: expected finite values, got 1"):
        field.render(field.example_batch(seed=1), seed=0, step=0, options=OPTIONS)
