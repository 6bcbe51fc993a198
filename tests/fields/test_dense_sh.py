"""The dense grid of harmonics: the sparse one of which nothing is missing."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from photograd.errors import RangeError
from photograd.fields import DenseSh, SparseSh
from photograd.fields.active_voxels import ActiveVoxels
from photograd.representation import Outputs, RenderOptions
from photograd_course.random import uniform


def pair(degree: int, dtype: Any) -> tuple[SparseSh, DenseSh]:
    """A sparse field and the dense one that shows the same.

    What is not active has raw density 0, which relu makes nothing of, and no color, so that the
    dense grid is transparent where the sparse one does not look.
    """
    shape, numbers = (19, 12, 16), 1 + 3 * (degree + 1) ** 2
    index = np.arange(int(np.prod(shape)))
    mask = uniform(1, step=0, pixel=index, sample=0, dimension=0).reshape(shape) < 0.7
    for axis in range(3):  # the half-voxel rim is not active in either
        side = np.moveaxis(mask, axis, 0)
        side[:1] = side[-1:] = False
    mask[6:13] = False
    sparse, every = ActiveVoxels(mask), ActiveVoxels(np.ones(shape, bool))
    index = np.arange(numbers * len(sparse))
    rows = (2 * uniform(2, step=0, pixel=index, sample=0, dimension=0) - 1).reshape(-1, numbers)
    policy = replace(
        SparseSh.example(seed=1).policy, density_activation="relu", density_scale=3.0, dt=0.05
    )

    def field(kind: type[SparseSh], active: ActiveVoxels, rows: Any) -> Any:
        coefficients = np.ascontiguousarray(rows[:, 1:].reshape(len(rows), -1, 3))
        return kind(active, rows[:, 0].astype(dtype), coefficients.astype(dtype), policy)

    full = np.zeros((len(every), numbers))
    i, j, k = sparse.voxels.T
    full[every.rows[i, j, k]] = rows
    return field(SparseSh, sparse, rows), field(DenseSh, every, full)


@pytest.mark.parametrize("degree", [0, 1, 2, 3])
@pytest.mark.parametrize("dtype", [np.float32, np.float64])
@pytest.mark.parametrize("camera", [False, True])  # with it, stages are not fused
def test_dense_is_sparse_on_the_active_set_bit_for_bit(
    degree: int, dtype: Any, camera: bool
) -> None:
    options = RenderOptions(camera_adjoint=camera)
    sparse, dense = pair(degree, dtype)
    batch = sparse.example_batch(seed=3)
    count = len(batch.origins)
    g = np.random.default_rng(4)
    d = Outputs(*(g.normal(size=s).astype(dtype) for s in ((count, 3), count, count)))
    seen = []
    for field in (sparse, dense):
        outputs, context = field.render(batch, seed=0, step=0, options=options)
        seen.append((outputs, field.render_backward(context, d)))
    (a, d_sparse), (b, d_dense) = seen
    assert a.opacity is not None
    assert a.opacity.max() > 0.2
    for name in ("color", "opacity", "depth"):
        assert np.array_equal(getattr(a, name), getattr(b, name))
    i, j, k = sparse.active.voxels.T
    rows = dense.active.rows[i, j, k]
    for name in ("density", "sh"):
        assert np.abs(d_sparse[name]).max() > 1e-3
        assert np.array_equal(d_sparse[name], d_dense[name][rows])
    for name in ("origins", "directions") if camera else ():
        assert np.abs(d_sparse[name]).max() > 1e-3
        assert np.array_equal(d_sparse[name], d_dense[name])
    # The gradient of the background is what the dense grid tells its other voxels.
    others = np.setdiff1d(np.arange(len(dense.active)), rows)
    elsewhere = [d_dense["density"][others].sum(), *d_dense["sh"][others].sum(axis=0).ravel()]
    assert np.abs(sparse.background_gradient).max() > 1e-3
    np.testing.assert_allclose(sparse.background_gradient, elsewhere, rtol=1e-4, atol=1e-5)
    assert not dense.background_gradient.any()


def test_nothing_is_pruned_and_nothing_may_be_missing() -> None:
    field = DenseSh.example(seed=1)
    weight = np.zeros(len(field.active))
    assert field.refine(1, {"weight": weight, "threshold": np.array(0.5)}) is None
    assert field.active.mask.all()
    sparse = SparseSh.example(seed=1)
    with pytest.raises(RangeError, match=r"DenseSh: active: expected all voxels .* missing"):
        DenseSh(sparse.active, *sparse.params.values(), sparse.policy)
    with pytest.raises(RangeError, match="active: expected all voxels"):
        field.load_state(sparse.state())
    assert field.active.mask.all()


def test_a_finer_grid_is_dense_too() -> None:
    field = DenseSh.full(np.array([[-1.0, -0.5, 0.0], [1.0, 1.0, 0.8]]), 10, degree=1)
    fine = field.refined(20)
    assert isinstance(fine, DenseSh)
    assert fine.active.shape == (20, 16, 8)
    assert fine.params["sh"].shape == (20 * 16 * 8, 4, 3)
    assert fine.resampled(fine.params["density"], fine) == pytest.approx(fine.params["density"])
