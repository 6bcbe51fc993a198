"""No bias of a tenth of a percent, in either sampler, in any number that a path draws.

Each scene has a radiance that is known in closed form, depends on one of the numbers of a vertex
(the point in the pixel, the choice of a light, the point on it, the direction, the lobe, roulette,
opacity) and varies little from path to path, so that a million paths know it to 0.02 %.

Power: a bias of 0.1 % is five standard errors or more, and the threshold is 3.5: it is seen with a
probability of 0.93 or more, in each scene. Of 140 choices of seeds one gives a false alarm in one
of the 14 tests. The random words themselves are in tests/sampling/test_words.py.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
import pytest
from photograd.bsdf.specular import registry
from photograd.lights import PointLight
from photograd.transport import Environment, Material, PathOptions, PathTracer, Scene
from photograd.transport.builtin import camera_at, furnace_box
from photograd.transport.shapes import Shape, rectangle

from tests.transport.scenes import BLACK, FLOOR, GRAY, LAMP
from tests.transport.test_closed_forms import polygon_irradiance

pytestmark = pytest.mark.usefixtures("core")
POINT, EYE, UP = np.array([0.5, 0.0, 0.3]), np.array([0.5, 1.0, 2.5]), np.array([0.0, 1.0, 0.0])
SLOPE = Environment([1.5] * 3, [1.0] * 3, [0.5] * 3)  # 1 + y / 2 from the direction (x, y, z)
SEEDS, ERROR, LIMIT, ROUNDING = 64, 2e-4, 3.5, 1e-6


@dataclass(frozen=True)
class Known:
    """A scene seen through a pencil of rays, and its radiance."""

    scene: Scene
    radiance: float
    options: PathOptions
    spp: int


def pencil(*shapes: Shape, material: Material, size: int = 8, **more: object) -> Scene:
    """From EYE to POINT, 0.01 degrees wide."""
    camera = camera_at(EYE, POINT, 0.01, size, size)
    materials = {"own": material, "black": BLACK}
    return Scene("pencil", shapes, materials, camera, **more)  # type: ignore[arg-type]


def point_in_pixel() -> Known:
    # One pixel, half of which sees a light of 1.4, half a sky of 1; the eye is in the edge's plane.
    side = rectangle("side", [0.5, -5, 0.3], [5, 0, 0], [0, 10, 0], "own", [1.4] * 3)
    camera = camera_at(EYE, POINT, 20.0, 1, 1)
    scene = Scene("edge", (side,), {"own": BLACK}, camera, Environment.constant(1.0))
    return Known(scene, 1.2, PathOptions(max_depth=1), 1 << 14)


def opacity() -> Known:
    # A card that returns 0.6 of a sky of 1 covers half of that sky.
    half = Material("lambert", {"albedo": [0.6] * 3, "alpha": 0.5})
    card = rectangle("card", *FLOOR, "own")
    scene = pencil(card, material=half, environment=Environment.constant(1.0))
    return Known(scene, 0.8, PathOptions("bsdf", roulette_from=None), 512)


def choice_of_a_light() -> Known:
    # Of three lights of one power, from different distances.
    lights = tuple(PointLight(POINT + r * UP, [1.0] * 3) for r in (1.0, 1.1, 1.25))
    floor = rectangle("floor", *FLOOR, "own")
    irradiance = sum(1 / r**2 for r in (1.0, 1.1, 1.25))
    scene = pencil(floor, material=GRAY, lights=lights)
    return Known(scene, 0.5 * irradiance / np.pi, PathOptions(max_depth=2), 448)


def point_on_a_light() -> Known:
    corner, u, v = (np.array(x, float) for x in LAMP)
    corners = [corner, corner + u, corner + u + v, corner + v]
    shapes = rectangle("floor", *FLOOR, "own"), rectangle("light", *LAMP, "black", [4.0] * 3)
    radiance = 0.5 * 4 * polygon_irradiance(corners, POINT, UP) / np.pi
    scene = pencil(*shapes, material=GRAY)
    return Known(scene, radiance, PathOptions("light", max_depth=2), 256)


def direction() -> Known:
    # E = pi (1 + n_y / 3) of a plane with the normal n under 1 + y / 2, in all directions.
    tilted = rectangle("floor", POINT - [2, 2, -2], [4, 0, 0], [0, 4, -4], "own")
    scene = pencil(tilted, material=GRAY, environment=SLOPE)
    return Known(scene, 0.5 * (1 + np.sqrt(0.5) / 3), PathOptions("bsdf", max_depth=2), 256)


def lobe() -> Known:
    # A pane that lies flat: mirrored rays see 1 + c / 2, those that pass 1 - c / 2.
    pane = Material("thin_glass", {"eta": 2.5, "tint": [1.0] * 3})
    wo = (EYE - POINT) / np.linalg.norm(EYE - POINT)
    c = float(wo[1])
    local = np.array([[np.sqrt(1 - c * c), 0.0, c]])
    _, weight = registry()["thin_glass"].lobes(pane.values, local)
    scene = pencil(rectangle("floor", *FLOOR, "own"), material=pane, environment=SLOPE)
    radiance = float(weight[0, 0, 0] * (1 + c / 2) + weight[0, 1, 0] * (1 - c / 2))
    return Known(scene, radiance, PathOptions(max_depth=2), 448)


def roulette() -> Known:
    options = PathOptions("bsdf", max_depth=100, roulette_from=1)
    return Known(furnace_box(8, 0.2, 1.0), 1 / 0.8, options, 448)


KNOWN = (point_in_pixel, opacity, choice_of_a_light, point_on_a_light, direction, lobe, roulette)


@pytest.mark.parametrize("sampler", ["independent", "sobol"])
@pytest.mark.parametrize("make", KNOWN, ids=lambda make: make.__name__)
def test_a_bias_of_a_tenth_of_a_percent_would_be_seen(
    make: Callable[[], Known], sampler: str
) -> None:
    known = make()
    tracer = PathTracer(known.scene, dtype=np.float64)
    options = replace(known.options, sampler=sampler)
    spp = known.spp if sampler == "independent" else known.spp // 4  # whose means err less
    pictures = [tracer.render(spp=spp, seed=seed, options=options) for seed in range(SEEDS)]
    means = np.array([picture.mean[..., 0].mean() for picture in pictures])
    error = float(means.std(ddof=1)) / np.sqrt(SEEDS) / known.radiance
    assert error < ERROR  # 0.1 % is five of these
    gap = abs(means.mean() / known.radiance - 1)
    assert gap < LIMIT * error + ROUNDING
