"""Classic mistakes of a real-time frame, each made in the product, and the proof that sees it."""

from __future__ import annotations

import inspect
from collections.abc import Callable
from dataclasses import dataclass, replace
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from photograd._compiled import _core
from photograd.frame import motion, screen, shadows, transparency
from photograd.raster.visibility import Visibility
from photograd_course.color import srgb_decode, srgb_encode

from tests.frame import (
    test_antialiasing,
    test_fog,
    test_gathering,
    test_lighting,
    test_motion,
    test_pipeline,
    test_shadows,
    test_sky_visibility,
    test_ssao,
)

pytestmark = pytest.mark.usefixtures("core")


def bias_with_the_wrong_sign(*arguments: Any) -> None:
    """Points are moved into the surface before they are compared."""
    wrong = list(arguments)
    wrong[4] = -wrong[4]
    _core.shadow_lookup(*wrong)


class OneFrameOld:
    """Matrices of the call before."""

    def __init__(self, right: Callable[..., Any]) -> None:
        self.right, self.last = right, None

    def __call__(self, camera: Any) -> Any:
        found = self.right(camera)
        stale, self.last = (found if self.last is None else self.last), found
        return stale


def non_linear_depth(call: Any, depth: Any, normals: Any, camera: Any) -> Any:
    """The depth that a GPU stores, far (z - near) / (z (far - near)), taken for meters."""
    near, far = 0.1, 20.0
    stored = far * (1 - near / depth) / (far - near)
    stored[np.isinf(depth)] = np.inf
    return RIGHT_SCREEN(call, 4.0 * stored.astype(np.asarray(depth).dtype), normals, camera)


def of_the_world(vectors: Any, _camera: Any) -> Any:
    """Normals that were not turned to the camera."""
    return vectors


def this_camera_twice(surfaces: Any, _previous: Any, *more: Any) -> Any:
    """The last frame's camera forgotten."""
    return motion.velocity(surfaces, surfaces.camera, *more)


def camera_alone(surfaces: Any, previous: Any, *_more: Any) -> Any:
    """The last poses of shapes forgotten."""
    return motion.velocity(surfaces, previous)


RIGHT_SCREEN = screen.screen_arguments
HELD: dict[tuple[int, int], Visibility] = {}


def without_a_clear(height: int, width: int, *, stencil: int | None = None) -> Visibility:
    """Buffers that still hold what was drawn before."""
    made = CLEARED(height, width, stencil=stencil)
    return HELD.setdefault((height, width), made)


CLEARED = Visibility.cleared


def encoded(layers: Any, behind: Any) -> Any:
    """Blended as displayed, and decoded afterwards."""
    shown = [replace(layer, color=srgb_encode(np.clip(layer.color, 0, 1))) for layer in layers]
    return srgb_decode(BLEND(shown, srgb_encode(np.clip(behind, 0, 1))))


def taken_for_premultiplied(layers: Any, behind: Any) -> Any:
    """Straight colors, not multiplied by alpha."""
    color, clear = np.zeros_like(behind), np.ones((*behind.shape[:2], 1), behind.dtype)
    for layer in layers:
        alpha = layer.alpha[..., None]
        color, clear = color + np.where(alpha > 0, clear * layer.color, 0), clear * (1 - alpha)
    return color + clear * behind


BLEND = transparency.blend_nearest_first


@dataclass(frozen=True)
class Mutant:
    """A wrong formula, where it stands, and the proof that dies of it."""

    where: str
    wrong: Any
    proof: Callable[..., Any]
    arguments: tuple[Any, ...] = ()


SKY = test_sky_visibility.test_nothing_hides_the_sky_from_a_flat_wall
MUTANTS = {
    "sign of the bias": Mutant(
        "photograd.frame.shadows._core",
        SimpleNamespace(shadow_lookup=bias_with_the_wrong_sign),
        test_shadows.test_a_map_of_1024_differs_from_rays_at_one_pixel_of_a_hundred,
        ("point",),
    ),
    "normals of the world, ssao": Mutant(
        "photograd.frame.screen.along_camera_axes",
        of_the_world,
        test_ssao.test_a_flat_wall_does_not_occlude_itself,
    ),
    "normals of the world, horizons": Mutant(
        "photograd.frame.screen.along_camera_axes", of_the_world, SKY, ("horizon",)
    ),
    "normals of the world, rays": Mutant(
        "photograd.frame.screen.along_camera_axes",
        of_the_world,
        test_gathering.test_a_wall_lights_the_floor_as_its_form_factor_says,
    ),
    "gamma before blending": Mutant(
        "photograd.frame._light_passes.blend_nearest_first",
        encoded,
        test_lighting.test_layers_that_cover_in_part_are_peeled_whatever_their_order,
    ),
    "straight for premultiplied alpha": Mutant(
        "photograd.frame._light_passes.blend_nearest_first",
        taken_for_premultiplied,
        test_lighting.test_layers_that_cover_in_part_are_peeled_whatever_their_order,
    ),
    "non-linear depth, ssao": Mutant(
        "photograd.frame.occlusion.screen_arguments",
        non_linear_depth,
        test_ssao.test_a_flat_wall_does_not_occlude_itself,
    ),
    "non-linear depth, horizons": Mutant(
        "photograd.frame.horizon.screen_arguments",
        non_linear_depth,
        test_sky_visibility.test_a_wall_hides_what_its_form_factor_says,
        ("horizon",),
    ),
    "depth for distance in fog": Mutant(
        "photograd.frame.fog.pixel_centers",
        lambda height, width: (np.zeros((height, width)), np.zeros((height, width))),
        test_fog.test_it_is_the_formula_along_each_ray,
    ),
    "missing clear": Mutant(
        "photograd.raster.visibility.Visibility.cleared",
        without_a_clear,
        test_pipeline.test_a_frame_does_not_depend_on_the_one_before,
    ),
    "matrices of the light one frame old": Mutant(
        "photograd.frame.shadows._pixels_from_world",
        OneFrameOld(shadows._pixels_from_world),
        test_shadows.test_a_map_of_1024_differs_from_rays_at_one_pixel_of_a_hundred,
        ("point",),
    ),
    "this camera for the last one, velocity": Mutant(
        "tests.frame.test_motion.velocity",
        this_camera_twice,
        test_motion.test_velocities_are_those_of_both_poses,
    ),
    "this camera for the last one, history": Mutant(
        "tests.frame.test_antialiasing.velocity",
        this_camera_twice,
        test_antialiasing.test_what_has_moved_is_found_and_leaves_no_trail,
    ),
    "last pose of the camera alone": Mutant(
        "photograd.frame._post_passes.velocity",
        camera_alone,
        test_motion.test_a_shape_that_moves_is_found_where_it_was,
    ),
}


@pytest.mark.parametrize("name", MUTANTS)
def test_each_mistake_is_seen(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    mutant = MUTANTS[name]
    HELD.clear()
    monkeypatch.setattr(mutant.where, mutant.wrong)
    assert len(inspect.signature(mutant.proof).parameters) == len(mutant.arguments)
    with pytest.raises(AssertionError):
        mutant.proof(*mutant.arguments)
