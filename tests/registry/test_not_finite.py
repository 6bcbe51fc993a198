"""A rendering that is not finite is an error that names its place, for every representation."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from photograd.errors import Error
from photograd.fields import representations
from photograd.representation import RenderOptions
from photograd.splats import rays as splat_rays
from photograd.splats import splatting as splat

from tests.splat import oracle

GROUPS = [
    (name, group)
    for name, kind in sorted(representations().items())
    for group in sorted(kind.example(seed=1).params)
]


@pytest.mark.parametrize(("name", "group"), GROUPS)
def test_no_representation_returns_what_is_no_number(name: str, group: str) -> None:
    kind, refused = representations()[name], []
    for value in (np.nan, np.inf, -np.inf, 3e38):
        scene = kind.example(seed=1, dtype=np.float32)
        scene.params[group][...] = value
        try:
            with np.errstate(all="ignore"):
                outputs, _ = scene.render(
                    scene.example_batch(seed=1), seed=0, step=0, options=RenderOptions()
                )
        except Error as failure:
            assert "expected finite" in str(failure)  # noqa: PT017
            refused.append(value)
            continue
        for array in vars(outputs).values():
            assert array is None or np.isfinite(array).all(), (value, group)
    assert np.isnan(refused[0])  # infinity may have a meaning: an opaque Gaussian


def test_infinite_harmonics_of_splats_are_reported_with_their_pixel() -> None:
    g, camera = oracle.cloud(8, 1).astype(np.float32), oracle.camera(21, 18, 17.0)
    directions = g.means - camera.position
    signs = np.sign(splat.sh.basis(directions / np.linalg.norm(directions, axis=1)[:, None], 3))
    bright = replace(g, sh=np.float32(1e38) * np.repeat(signs[..., None], 3, 2).astype(np.float32))
    with pytest.raises(Error, match=r"splat.render: color: expected finite .* in pixel \(\d+, \d+"):
        splat.render(bright, camera)
    origins, rays = camera.rays()
    with pytest.raises(Error, match=r"splat_rays.render: color: .* the first in ray \d+ \(a param"):
        splat_rays.render(bright, origins, rays)
