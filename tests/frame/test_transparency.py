"""Surfaces that cover in part: exactly, sorted by shapes, and in any order, beside one another."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from photograd.frame import (
    FrameOptions,
    FrameScene,
    Layer,
    ShadowSettings,
    blend_nearest_first,
    blend_weighted,
    frame_graph,
)
from photograd.transport import Material, Scene
from photograd.transport.shapes import rectangle

from tests.frame import scenes

pytestmark = pytest.mark.usefixtures("core")
BEHIND = np.random.default_rng(0).uniform(0, 1, (6, 7, 3))
COLORS = {"red": [0.8, 0.1, 0.1], "green": [0.1, 0.7, 0.1], "blue": [0.1, 0.1, 0.8]}


def layers(count: int) -> list[Layer]:
    """The nearest first; some pixels of each show nothing."""
    g = np.random.default_rng(count)
    found = []
    for k in range(count):
        shown = g.uniform(size=(6, 7)) < 0.8
        depth = np.where(shown, 1.0 + k + 0.5 * g.uniform(size=(6, 7)), np.inf)
        alpha = np.where(shown, g.uniform(0.2, 0.8, (6, 7)), 0.0)
        found.append(Layer(depth, g.uniform(0, 1, (6, 7, 3)), alpha))
    return found


def test_nearest_first_is_the_over_operator_from_behind() -> None:
    expected = BEHIND
    for layer in reversed(layers(4)):
        part = layer.alpha[..., None]
        expected = part * layer.color + (1 - part) * expected
    np.testing.assert_allclose(blend_nearest_first(layers(4), BEHIND), expected, rtol=1e-13)
    np.testing.assert_array_equal(blend_nearest_first([], BEHIND), BEHIND)


def test_weights_do_not_ask_for_an_order() -> None:
    found = blend_weighted(layers(4), BEHIND, 2.0)
    for order in ([3, 2, 1, 0], [1, 3, 0, 2]):
        again = blend_weighted([layers(4)[k] for k in order], BEHIND, 2.0)
        np.testing.assert_allclose(again, found, rtol=1e-12)
    exact = blend_nearest_first([layers(4)[k] for k in (3, 2, 1, 0)], BEHIND)
    assert np.abs(exact - blend_nearest_first(layers(4), BEHIND)).max() > 0.1  # which that does


def test_one_layer_is_blended_exactly_and_so_is_one_color() -> None:
    exact = blend_nearest_first(layers(1), BEHIND)
    np.testing.assert_allclose(blend_weighted(layers(1), BEHIND, 2.0), exact, rtol=1e-12)
    gray = [replace(layer, color=np.full((6, 7, 3), 0.3)) for layer in layers(4)]
    exact = blend_nearest_first(gray, BEHIND)
    np.testing.assert_allclose(blend_weighted(gray, BEHIND, 2.0), exact, rtol=1e-12)


def sheets(order: list[str], alpha: float = 0.5) -> Scene:
    """Squares that face the camera, one behind another; `order` lists them, it places none."""
    shapes = [scenes.floor()]
    for name in order:
        z = 0.4 - 0.3 * list(COLORS).index(name)
        side = [-1.0, -0.2, z], [2.0, 0.0, 0.0], [0.0, 2.0, 0.0]
        shapes.append(rectangle(name, *side, name, [0, 0, 0]))
    materials = {
        name: Material("lambert", {"albedo": color, "alpha": alpha})
        for name, color in COLORS.items()
    }
    scene = scenes.room(scenes.LIGHTS["directional"])
    return replace(scene, shapes=tuple(shapes), materials={"gray": scenes.GRAY, **materials})


def drawn(scene: Scene, **options: Any) -> Any:
    chosen = FrameOptions(sky_directions=0, shadows=ShadowSettings(size=128), **options)
    graph = frame_graph(FrameScene(scene, dtype=np.float64), chosen)
    return graph.run({"camera": scene.camera}, ["radiance"])["radiance"]


def test_sorted_by_shapes_is_exact_where_they_do_not_cross() -> None:
    exact = drawn(sheets(["red", "green", "blue"]))
    for order in (["red", "green", "blue"], ["blue", "red", "green"]):
        found = drawn(sheets(order), transparency="sorted")
        np.testing.assert_allclose(found, exact, rtol=1e-12, atol=1e-15)


def test_weights_are_near_and_the_same_for_any_order_of_shapes() -> None:
    exact = drawn(sheets(["red", "green", "blue"]))
    pictures = [
        drawn(sheets(order), transparency="weighted")
        for order in (["red", "green", "blue"], ["blue", "red", "green"])
    ]
    np.testing.assert_allclose(pictures[0], pictures[1], rtol=1e-12)
    without = drawn(sheets([]))
    change = np.sqrt(np.mean((exact - without) ** 2))
    error = np.sqrt(np.mean((pictures[0] - exact) ** 2))
    assert 0 < error < 0.15 * change


def test_sheets_that_cross_are_wrong_when_sorted_and_right_when_peeled() -> None:
    scene = sheets(["red", "blue"])
    turned = rectangle("blue", [-1, -0.2, 1.4], [2, 0, -2.0], [0, 2.0, 0], "blue", [0, 0, 0])
    scene = replace(scene, shapes=(*scene.shapes[:2], turned))
    swapped = replace(scene, shapes=(scene.shapes[0], scene.shapes[2], scene.shapes[1]))
    np.testing.assert_array_equal(drawn(scene), drawn(swapped))
    assert np.abs(drawn(scene, transparency="sorted") - drawn(scene)).max() > 0.03


def test_layers_look_alike_over_forward_and_deferred_shading() -> None:
    scene = sheets(["red", "blue"])
    np.testing.assert_allclose(drawn(scene, shading="forward"), drawn(scene), atol=1e-12)
