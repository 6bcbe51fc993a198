"""Codes that are blended like colors and decoded once a pixel: gradients, start, bake."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from photograd import sh
from photograd.errors import RangeError
from photograd.fields import GaussianCodes
from photograd.fields.coded_splats import CodedSplatsPolicy, triples
from photograd.fields.decoded_march import harmonics
from photograd.representation import Outputs, RenderOptions, check_gradients
from photograd.splats.files import read_gaussians
from photograd.splats.model import GaussianScene


def look(field: Any, seed: int = 3) -> Outputs:
    batch = GaussianScene.example(seed=3).example_batch(seed=seed)
    return field.render(batch, seed=0, step=0, options=RenderOptions())[0]


@pytest.mark.parametrize("features", [3, 6])
def test_gradients_are_right(features: int) -> None:
    field = GaussianCodes.example(seed=1)
    if features == 6:
        scene = GaussianScene.example(seed=1)
        policy = {"width": 5, "depth": 1, "hidden": "softplus"}
        field = GaussianCodes.from_gaussians(scene, seed=2, features=6, **policy)
        field.params["codes"] *= 0.5
        field.params["decoder"] += 0.1
    report = check_gradients(field, seed=1, camera=True)
    assert report, str(report)


def test_at_the_start_it_shows_the_constant_colors() -> None:
    scene = GaussianScene.example(seed=3)
    scene.params["sh_rest"][:] = 0
    found, known = look(GaussianCodes.from_gaussians(scene)), look(scene)
    for name, values in vars(known).items():
        np.testing.assert_allclose(getattr(found, name), values, rtol=0, atol=1e-12)


def test_equal_codes_are_decoded_alike_whatever_the_opacity() -> None:
    field = GaussianCodes.example(seed=3)
    field.params["codes"][:] = field.params["codes"][:1]
    batch = field.example_batch(seed=3)
    out = look(field)
    assert out.opacity is not None
    _, directions = batch.camera.rays()
    code = np.maximum(0, 0.5 + sh.Y_0 * field.params["codes"][0])
    given = np.concatenate([np.tile(code, (len(directions), 1)), harmonics(directions)], axis=1)
    added = field.policy.decoder().forward(field.params["decoder"], given)
    plain = GaussianCodes(field.params, extent=1.0, policy=field.policy)
    plain.params = {**plain.params, "decoder": np.zeros_like(plain.params["decoder"])}
    seen = out.opacity > 1e-2
    expected = (look(plain).color + out.opacity[:, None] * added)[seen]
    np.testing.assert_allclose(out.color[seen], expected, rtol=0, atol=1e-4)


def test_baking_comes_closer_with_the_degree(tmp_path: Path) -> None:
    field = GaussianCodes.example(seed=3)
    field.params["codes"][:] = field.params["codes"][:1]  # so that only directions matter
    field.params["colors"][:] += 2  # clear of the clamp of Gaussians' colors
    own = look(field).color
    errors = [float(np.abs(look(field.baked(degree=n)).color - own).max()) for n in (0, 1, 2, 3)]
    assert errors == sorted(errors, reverse=True)
    assert errors[3] < 0.3 * errors[0]
    notes = field.export(tmp_path / "baked.ply", None)
    assert "harmonics of degree 3" in notes[-1]
    assert " dB from the decoded ones in 4 views" in notes[-1]
    assert len(read_gaussians(tmp_path / "baked.ply").gaussians) == field.resolution


def test_each_triple_is_a_blend_of_its_own() -> None:
    scene = GaussianScene.example(seed=1)
    field = GaussianCodes.from_gaussians(scene, features=9)
    assert [triple.shape for triple in triples(field.params)] == [(11, 1, 3)] * 4
    with pytest.raises(RangeError, match="features: expected a multiple of 3, got 4"):
        CodedSplatsPolicy(features=4)


def test_the_state_is_the_extent() -> None:
    field = GaussianCodes.example(seed=1)
    field.load_state({"extent": np.array(2.0)})
    assert field.extent == 2.0
    with pytest.raises(RangeError, match="state: expected extent alone"):
        field.load_state({})
