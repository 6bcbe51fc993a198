"""The claim about signs is put to as many views as leave voxels to speak of."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from photograd.capture.orbit import orbit_cameras
from photograd.capture.view import View
from photograd.fitting.sign_claim import sign_claim

from tests.fit.test_density_gradient import BOX, ball, photograph, start


def many_views(per_ring: int) -> Any:
    """Views all around, so that each voxel has the ball before or behind it in one of them."""
    cameras = [
        camera
        for elevation in (-80.0, -50.0, -25.0, 0.0, 25.0, 50.0, 80.0)
        for camera in orbit_cameras(BOX, per_ring, size=48, elevation=elevation)
    ]
    views = tuple(View(f"view_{k}", c, photograph(c)) for k, c in enumerate(cameras))
    return replace(ball(), train=views)


def test_few_views_are_all_taken() -> None:
    claim = sign_claim(start(24), ball(), rays=1 << 16, seed=1)
    assert claim is not None
    assert claim.views == claim.all_views == 6
    assert claim.report.holds(0.95), claim.caption()
    assert claim.caption() == claim.report.caption()
    assert claim.d_sigma_t[claim.occupied].sum() < 0


def test_of_many_views_a_part_is_taken_and_told() -> None:
    claim = sign_claim(start(24), many_views(12), rays=1 << 16, seed=1)
    assert claim is not None
    assert claim.views < claim.all_views == 84
    assert claim.report.background_voxels > 0
    assert claim.report.holds(0.95), claim.caption()
    assert claim.caption().startswith(f"Loss of {claim.views} of the 84 training views: more would")


def test_no_claim_without_matter() -> None:
    nothing = replace(
        ball(), train=tuple(replace(v, image=np.zeros_like(v.image)) for v in ball().train)
    )
    assert sign_claim(start(16), nothing, rays=1 << 10, seed=1) is None


def test_the_same_seed_gives_the_same_gradient() -> None:
    one, two, other = (sign_claim(start(16), ball(), rays=1 << 10, seed=s) for s in (1, 1, 2))
    assert one is not None
    assert two is not None
    assert other is not None
    assert np.array_equal(one.d_sigma_t, two.d_sigma_t)
    assert not np.array_equal(one.d_sigma_t, other.d_sigma_t)


@pytest.mark.parametrize("color", [(1.0, 1.0, 1.0), (0.2, 0.3, 0.8)])
def test_a_known_background_may_be_given(color: tuple[float, float, float]) -> None:
    claim = sign_claim(start(16), ball(), rays=1 << 12, seed=1, background=np.array(color))
    assert claim is not None
    assert np.abs(claim.d_sigma_t).max() > 0
