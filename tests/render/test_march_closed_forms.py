"""The marcher against integrals that can be written down."""

from __future__ import annotations

import numpy as np
import pytest
from photograd._compiled import _core

from tests.render.rays import along_x, bundle, constant_grid, field_grid, march, settings

COLOR = (0.7, 0.4, 0.2)


@pytest.mark.parametrize("dt", [0.5, 0.1, 0.013])
def test_constant_slab_is_exact_for_any_number_of_steps(dt: float) -> None:
    # The alpha form integrates a constant medium exactly over the sampled length.
    sigma_t = 1.3
    color, transmittance, _, _, samples = march(
        constant_grid(sigma_t, COLOR), settings(dt=dt, lattice="entry"), along_x()
    )
    length = samples[0] * dt
    assert length > 1.4
    assert transmittance[0] == pytest.approx(np.exp(-sigma_t * length), rel=1e-12)
    expected = np.array(COLOR) * -np.expm1(-sigma_t * length)
    np.testing.assert_allclose(color[0], expected, rtol=1e-12)


@pytest.mark.parametrize("sigma_t", [1e-3, 1e-1, 1.0, 30.0, 1e4])
def test_weights_and_the_rest_sum_to_one(sigma_t: float) -> None:
    # With color 1 the image is the sum of the weights; 1e-6 is the bound asked for, 1e-12 is met.
    color, transmittance, *_ = march(constant_grid(sigma_t, (1, 1, 1)), settings(), bundle(50, 1))
    np.testing.assert_allclose(color[:, 0] + transmittance, 1.0, atol=1e-12)


def test_two_slabs_split_at_a_lattice_point() -> None:
    # Left half sigma 2, red; right half sigma 0.5, green. The voxels put the jump into one voxel,
    # where trilinear interpolation makes a ramp; the symmetric ramp keeps the optical depth, and
    # blurs color and density together over a voxel: an error of first order in the voxel.
    def halves(x: np.ndarray, _y: np.ndarray, _z: np.ndarray) -> np.ndarray:
        left = 1.0 * (x < 0)
        return np.stack([left, 1 - left, 0 * x, 0.5 + 1.5 * left], -1)

    expected = np.array([1 - np.exp(-2.0), np.exp(-2.0) * (1 - np.exp(-0.5))])
    errors = []
    for n in (16, 32, 64):
        grid = field_grid(halves, n)
        color, transmittance, *_ = march(grid, settings(dt=1 / 512, lattice="entry"), along_x())
        assert transmittance[0] == pytest.approx(np.exp(-2.5), rel=1e-6)
        errors.append(np.abs(color[0, :2] - expected))
    np.testing.assert_allclose(np.log2(np.array(errors[:-1]) / errors[1:]), 1.0, atol=0.1)


def test_gaussian_blob_has_the_optical_depth_of_its_integral() -> None:
    # sigma = a exp(-r^2 / 2 s^2) through the center: tau = a s sqrt(2 pi) (the box cuts at 8 s).
    # Trilinear interpolation of a curve adds h^2 / 12 of its second derivative along the ray, which
    # integrates to nothing, and h^2 / 8 across it, halfway between voxel centers, for two axes:
    # a relative error of (h / s)^2 / 4, of second order in the voxel.
    a, s = 3.0, 0.12
    tau = a * s * np.sqrt(2 * np.pi)
    rays = (np.array([[-3.0, 0.0, 0.0]]), np.array([[1.0, 0.0, 0.0]]))
    errors = []
    for n in (40, 80, 160):
        grid = field_grid(
            lambda x, y, z: np.stack(
                [x * 0 + 1, x * 0, x * 0, a * np.exp(-(x**2 + y**2 + z**2) / (2 * s * s))], -1
            ),
            n,
        )
        _, transmittance, *_ = march(grid, settings(dt=1 / 320), rays)
        errors.append(1 + np.log(transmittance[0]) / tau)
    np.testing.assert_allclose(np.log2(np.array(errors[:-1]) / errors[1:]), 2.0, atol=0.1)
    assert errors[2] == pytest.approx((2 / 160 / s) ** 2 / 4, rel=0.05)


def smooth(x: np.ndarray, y: np.ndarray, z: np.ndarray) -> np.ndarray:
    return np.stack(
        [0.5 + 0.3 * x, 0.5 - 0.2 * y, 0.4 + 0.1 * z, 1.5 + 0.7 * x + 0.3 * y - 0.4 * z], -1
    )


@pytest.mark.parametrize(("quadrature", "order"), [("alpha", 2.0), ("riemann", 1.0)])
def test_order_of_convergence(quadrature: str, order: float) -> None:
    # An affine field is reproduced exactly by the grid, so only the quadrature errs. T8: within
    # 0.15. The ray runs between voxel centers (x from -0.8 to 0.8), where nothing is clamped, and
    # its samples are placed by hand: N steps over exactly 1.6 m.
    grid = field_grid(smooth, 8)
    origins, directions = np.array([[-0.8, 0.1, -0.2]]), np.array([[1.0, 0.0, 0.0]])

    def run(steps: int) -> np.ndarray:
        s = settings(dt=1.6 / steps, quadrature=quadrature)
        count = np.array([steps], np.int32)
        t0 = np.zeros(1)
        return _core.march("dense_grid", grid, s, (origins, directions, t0, count))[0][0]

    reference = run(40960)
    errors = [np.abs(run(steps) - reference).max() for steps in (40, 80, 160)]
    assert min(errors) > 1e-7
    slopes = np.log2(np.array(errors[:-1]) / errors[1:])
    np.testing.assert_allclose(slopes, order, atol=0.15)


def test_lecture_sum_without_the_step_grows_with_resolution() -> None:
    # The Riemann form keeps the step: halving it changes little. Without it the sum doubles.
    grid = constant_grid(0.8, (1, 1, 1))
    coarse, fine = (
        march(grid, settings(dt=dt, quadrature="riemann"), along_x())[0][0, 0]
        for dt in (0.02, 0.01)
    )
    assert fine == pytest.approx(coarse, rel=0.02)
    assert (fine / 0.01) / (coarse / 0.02) == pytest.approx(2.0, rel=0.02)


def test_lattice_from_the_origin_does_not_depend_on_the_box() -> None:
    small = settings(box=[[-0.5, -1, -1], [0.5, 1, 1]])
    large = settings()
    rays = bundle(40, 3)
    for t0, samples in (march(constant_grid(1, COLOR), s, rays)[3:] for s in (small, large)):
        hit = samples > 0
        assert hit.sum() > 20
        first = t0[hit] / 0.05
        np.testing.assert_allclose(first, np.rint(first), atol=1e-9)


def test_zero_border_fades_and_clamp_continues() -> None:
    grid = constant_grid(1.0, COLOR, n=4)
    rays = (np.array([[-3.0, 0.95, 0.0]]), np.array([[1.0, 0.0, 0.0]]))
    clamp = march(grid, settings(border="clamp"), rays)[1][0]
    zero = march(grid, settings(border="zero"), rays)[1][0]
    # y = 0.95 lies 0.4 voxels behind the last center: the zero border keeps a weight of 0.6 there.
    assert clamp == pytest.approx(np.exp(-2.0), rel=1e-9)
    assert np.log(zero) / np.log(clamp) == pytest.approx(0.6 * (3 + 2 * 0.375) / 4, rel=0.03)


def test_rays_that_miss_are_empty() -> None:
    rays = (np.array([[-3.0, 5.0, 0.0], [3.0, 0.0, 0.0]]), np.array([[1.0, 0, 0], [1.0, 0, 0]]))
    color, transmittance, depth, _, samples = march(constant_grid(5.0, COLOR), settings(), rays)
    assert samples.tolist() == [0, 0]
    assert not color.any()
    assert not depth.any()
    assert transmittance.tolist() == [1.0, 1.0]
