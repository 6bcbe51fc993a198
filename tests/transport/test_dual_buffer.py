"""Both halves of a loss of squares in one pass: as four passes give it; and where paths go."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from photograd.errors import Error, RangeError, ShapeError
from photograd.transport import Accumulation, Material, PathOptions, PathTracer, Scene, TextureUse
from photograd.transport.accumulation import PAIR_UNIFORM_SHARE, pair_counts
from photograd.transport.builtin import cornell_box
from photograd.transport.inverse import (
    dual_buffer_loss,
    dual_buffer_loss_backward,
    loss_and_gradients,
)
from photograd.transport.metal_room import metal_room

from support.bits import same_bits
from tests.transport.media_scenes import fog_box, smoke
from tests.transport.scenes import any_material, stage
from tests.transport.test_moving_shapes import moving
from tests.transport.test_textures import noise, wall

pytestmark = pytest.mark.usefixtures("core")
PATH = PathOptions(max_depth=4, roulette_from=2)
PAINTED = Material(
    "gltf",
    {"base_color": [0.8, 0.7, 0.6], "metalness": 0.3, "roughness": 0.5},
    textures={"base_color": TextureUse("t")},
)
SCENES = {
    "room": lambda: cornell_box(7),
    "glass": lambda: stage(any_material("glass"), size=7, sky=0.4),
    "texture": lambda: wall(PAINTED, {"t": noise(3, 4)}, 7),
    "mips": lambda: wall(PAINTED, {"t": replace(noise(24, 24), filter="mip")}, 7),
    "fog": lambda: fog_box(size=5),
    "smoke": lambda: fog_box(smoke(), size=5),
    "moving": lambda: moving(7, alpha=True),
}


def wanted(scene: Scene) -> tuple[Any, Any]:
    g = np.random.default_rng(3)
    shape = (scene.camera.height, scene.camera.width, 3)
    return g.random(shape), g.uniform(0.5, 2, shape)


@pytest.mark.parametrize("name", SCENES)
def test_one_pass_is_as_good_as_four(name: str) -> None:
    # 21 samples: packets of sixteen hold those of several pixels, and some are not full.
    tracer = PathTracer(SCENES[name](), dtype=np.float64, allow_incomplete=True)
    target, weight = wanted(tracer.scene)
    given: dict[str, Any] = {"spp": 21, "options": PATH}
    a, b = (tracer.render(seed=seed, **given).mean for seed in (3, 8))
    d_a, d_b = dual_buffer_loss_backward(a, b, target, weight)
    of_a = tracer.render_backward(d_a, seed=3, **given)
    of_b = tracer.render_backward(d_b, seed=8, **given)
    loss, found = loss_and_gradients(tracer, target, weight, seeds=(3, 8), **given)
    assert loss == pytest.approx(dual_buffer_loss(a, b, target, weight), rel=1e-12)
    assert found.keys() == tracer.params.keys()
    for key, value in found.items():
        expected = of_a[key] + of_b[key]
        scale = np.abs(expected).max()
        np.testing.assert_allclose(value, expected, rtol=1e-9, atol=1e-11 * scale, err_msg=key)
    assert sum(np.abs(value).max() > 0 for value in found.values()) >= 2


def test_paths_may_go_where_they_are_needed() -> None:
    # All texels of the room's picture; highlights on the metals hold much of their derivative.
    tracer = PathTracer(metal_room(48))
    target, weight = np.full((48, 48, 3), 0.2), np.ones((48, 48, 3))
    name, count = "textures.picture", 10

    def estimates(spread: str, first: int) -> Any:
        return np.array(
            [
                loss_and_gradients(
                    tracer,
                    target,
                    weight,
                    spp=16,
                    seeds=(first + 2 * k, first + 2 * k + 1),
                    options=PathOptions(max_depth=8),
                    names=[name],
                    spread=spread,
                )[1][name]
                for k in range(count)
            ]
        )

    even, focused = estimates("uniform", 0), estimates("cotangent", 1000)
    variances = [float(found.var(axis=0, ddof=1).sum()) for found in (even, focused)]
    error = np.sqrt(sum(variances) / count)
    assert 2 * error < np.linalg.norm(focused.mean(axis=0))
    # Measured with 16 each: 1.0 and 1.07 times the error.
    assert np.linalg.norm(even.mean(axis=0) - focused.mean(axis=0)) < 1.4 * error
    # Measured with 16 each: 1.9 and 2.2 times.
    assert variances[0] > 1.3 * variances[1]


def test_counts_of_pairs_follow_noise_and_difference() -> None:
    g = np.random.default_rng(3)
    pilot = Accumulation.empty(12, 12)
    for _ in range(4):
        sample = g.uniform(0.0, 1.0, (12, 12, 3))
        sample[:, 6:] = 0.5  # a half without any noise
        pilot.radiance += sample
        pilot.squares += sample**2
        pilot.count += 1
    d = np.ones((12, 12, 3))
    d[:4, :2] = 9.0
    counts = pair_counts(pilot, d, 16, "cotangent")
    assert counts is not None
    assert abs(int(counts.sum()) - 16 * 144) <= 72  # the rounding of each
    assert (counts[:, 9:] == round(PAIR_UNIFORM_SHARE * 16)).all()
    assert counts[:2, 0].min() > 1.3 * counts[8:, :3].max()
    assert counts[8:, :3].min() > counts[0, 11]
    assert pair_counts(pilot, d, 16, "uniform") is None
    assert pair_counts(pilot, 0 * d, 16, "cotangent") is None


@same_bits("dual-buffer loss")
def loss_and_its_gradients() -> list[Any]:
    target, weight = wanted(cornell_box(12))
    loss, found = loss_and_gradients(
        PathTracer(cornell_box(12)),
        target,
        weight,
        spp=8,
        seeds=(9, 10),
        options=PATH,
        spread="cotangent",
    )
    return [loss, *found.values()]


def test_what_is_refused() -> None:
    tracer = PathTracer(cornell_box(4))
    target, weight = wanted(tracer.scene)
    given: dict[str, Any] = {"spp": 4, "seeds": (1, 2)}
    with pytest.raises(ShapeError, match=r"target: expected shape \(4, 4, 3\), got \(3, 4, 3\)"):
        loss_and_gradients(tracer, target[1:], weight, **given)
    with pytest.raises(ShapeError, match=r"weight: expected shape \(4, 4, 3\), got \(4, 4\)"):
        loss_and_gradients(tracer, target, weight[..., 0], **given)
    with pytest.raises(RangeError, match=r"spp: expected a whole number of at least 1, got 0"):
        loss_and_gradients(tracer, target, weight, spp=0, seeds=(1, 2))
    with pytest.raises(RangeError, match=r"spread: expected"):
        loss_and_gradients(tracer, target, weight, spread="steep", **given)
    tracer.params["emission.lamp"][0] = np.inf
    with pytest.raises(Error, match=r"radiance: expected finite values, got .*pixel"):
        loss_and_gradients(tracer, target, weight, **given)
