"""The built-in scenes by name."""

from __future__ import annotations

from collections.abc import Callable
from typing import Final, TypeAlias

from photograd_course.checks import require_integer
from photograd_course.suggest import choose_from

from photograd._typed import typed_call
from photograd.errors import SceneError, message
from photograd.scenes.description import SceneDescription
from photograd.scenes.fine_structures import foliage, fur, thin_structures
from photograd.scenes.still_lifes import flat_walls, smooth_curves, textured
from photograd.scenes.terrain_clouds import terrain_clouds
from photograd.scenes.toy_table import toy_table

Builder: TypeAlias = Callable[[int], SceneDescription]
"""seed -> scene; the same seed gives the same bits."""

DEFAULT_SCENE: Final = "toy_table"
"""What the demo shows."""


@typed_call
def scenes() -> dict[str, Builder]:
    """All scenes, the demo's first."""
    return {
        DEFAULT_SCENE: toy_table,
        "thin_structures": thin_structures,
        "textured": textured,
        "terrain_clouds": terrain_clouds,
        "foliage": foliage,
        "smooth_curves": smooth_curves,
        "fur": fur,
        "flat_walls": flat_walls,
    }


@typed_call
def scene(name: str = DEFAULT_SCENE, *, seed: int) -> SceneDescription:
    """Build the scene of this name.

    Args:
        name: a key of `scenes()`.
        seed: 0 .. 2^63 - 1; draws the scene's noise and what of it is left to chance.

    Raises:
        SceneError: no such scene; suggests the nearest.
        RangeError, DtypeError: a bad seed.
    """
    builders = scenes()
    if name not in builders:
        remedy = choose_from(name, builders)
        raise SceneError(message("scene", "name", "a built-in scene", repr(name), remedy))
    require_integer("scene", "seed", seed, least=0, most=2**63 - 1)
    return builders[name](seed)
