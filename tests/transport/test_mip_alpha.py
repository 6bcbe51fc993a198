"""Alpha with mipmaps in paths: derivatives with respect to texels of all levels."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from photograd.transport import PathTracer, Scene, TextureUse
from photograd_course.gradcheck import check_gradient

from support.gradient_mutants import check_gradient_mutants
from tests.transport.test_adjoint import proof
from tests.transport.test_alpha import checker, gray, shade
from tests.transport.test_derivative import check
from tests.transport.test_mip_textures import filtered
from tests.transport.test_textures import wall

VEIL = gray(0.9, textures={"alpha": TextureUse("t")})
pytestmark = pytest.mark.usefixtures("core")


def scenes() -> list[Scene]:
    """An occluder before a uniform sky, and one before a floor, which it shadows as well."""
    return [
        filtered(wall(VEIL, {"t": checker()}, 6)),
        filtered(shade(VEIL, textures={"t": checker()})),
    ]


@pytest.mark.parametrize("number", [0, 1])
def test_texels_of_alpha_have_derivatives_through_all_levels(number: int) -> None:
    scene = scenes()[number]
    points = {"t": replace(scene.textures["t"], filter="bilinear")}
    one, other = (
        PathTracer(s, dtype=np.float64).render(spp=3, seed=1).mean
        for s in (scene, replace(scene, textures=points))
    )
    assert np.abs(one - other).max() > 0.01  # levels do count here
    function, backward, start = proof(scene)
    assert np.abs(backward(start, np.ones_like(one))["textures.t"]).max() > 0
    report = check_gradient(function, backward, start, seed=2, coordinates=5, directions=5)
    assert report, str(report)
    check(scene)


def test_wrong_gradients_die() -> None:
    function, backward, start = proof(filtered(wall(VEIL, {"t": checker()}, 3), 8))
    d = 0.2 + np.random.default_rng(5).random((3, 3, 3))
    deaths = check_gradient_mutants(
        function, backward, start, d, seed=4, coordinates=2, directions=1
    )
    assert deaths, str(deaths)
