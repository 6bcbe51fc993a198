"""Light tracing through media: closed forms, energy, and the same irradiance as from the camera."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from photograd.lights import DirectionalLight, PointLight, SpotLight
from photograd.transport import (
    BOUNDARY,
    Accumulation,
    DensityGrid,
    Environment,
    IrradianceSensor,
    Material,
    Medium,
    ParticleOptions,
    PathOptions,
    PathTracer,
    PhotonMap,
    Scene,
    emit_particles,
    trace_light,
)
from photograd.transport.shapes import box, rectangle

from support.bits import same_bits
from tests.transport.media_scenes import (
    FOG,
    FROSTED,
    GLASS,
    INK,
    WAX,
    fog_box,
    placed,
    smoke,
    with_interior,
)
from tests.transport.scenes import BLACK, FLOOR, GRAY, view
from tests.transport.test_light_map import AS_SEEN, PARTICLES, below, patch, seen_irradiance
from tests.transport.test_strategies import assert_same_mean

SIGMA = np.array(INK.sigma_t)
LIGHT = PointLight([0.3, 1.2, 0.2], [3.0, 2.5, 2.0])
SPOT = SpotLight([0, 1, 0], [0, -1, 0], [3.0] * 3, 0.8, 1.0)
SUN = DirectionalLight([0.2, 1, 0.1], [2.0, 1.5, 1.0])
CLEAR = Medium([2.0, 3.0, 4.0], 1.0, values={"g": 0.5})


def under(
    medium: Medium, *lights: Any, sky: float | None = 0.2, veil: float | None = None
) -> Scene:
    """Fog upon a floor. The camera that measures hangs within the fog."""
    scene = fog_box(medium, size=4, sky=sky)
    if veil is not None:
        shape = rectangle("veil", [-2, 0.6, 2], [4, 0, 0], [0, 0, -4], "veil")
        material = Material("lambert", {"albedo": [0.6, 0.3, 0.1], "alpha": veil})
        scene = replace(
            scene, shapes=(*scene.shapes, shape), materials={**scene.materials, "veil": material}
        )
    return replace(scene, lights=lights)


SCENES = {
    "fog and a lamp": lambda: under(FOG),
    "smoke in a grid": lambda: under(smoke(), LIGHT),
    "ink": lambda: under(INK, LIGHT),
    "black smoke": lambda: under(replace(smoke(), albedo=None), LIGHT),
    "sun": lambda: under(FOG, DirectionalLight([0.3, 1, 0.2], [2.0, 1.5, 1.0])),
    "fog behind a veil": lambda: under(FOG, LIGHT, veil=0.5),
}


@pytest.mark.parametrize("name", SCENES)
def test_both_ends_agree(name: str) -> None:
    tracer = PathTracer(SCENES[name](), dtype=np.float64)
    # Just above the floor, where no fog is: its box ends 5 cm above.
    seen = seen_irradiance(tracer, below(0.04, 2, 0.5), 0.5, 4096)
    landed = trace_light(tracer, patch(2), PARTICLES, seed=4, options=AS_SEEN)
    assert seen.mean.min() > 0.05
    assert_same_mean(seen, landed, len(SCENES), 0.15)


@pytest.mark.parametrize("material", [GLASS, FROSTED])
def test_both_ends_agree_through_a_body(material: Material) -> None:
    # A slab of wax in glass between a light and the floor: refraction and media together.
    slab = with_interior(box("slab", [0, 0.5, 0], [3, 0.25, 3], "shell"), "wax")
    lamp = rectangle("lamp", [-1, 1.2, -1], [2, 0, 0], [0, 0, 2], "black", [4.0, 3.0, 2.0])
    shapes = (rectangle("floor", *FLOOR, "floor"), slab, lamp)
    materials = {"floor": GRAY, "shell": material, "black": BLACK}
    scene = Scene("slab", shapes, materials, view(4), media={"wax": WAX})
    tracer = PathTracer(scene, dtype=np.float64)
    seen = seen_irradiance(tracer, below(0.3, 2, 0.5), 0.5, 4096)
    landed = trace_light(tracer, patch(2), PARTICLES, seed=4, options=AS_SEEN)
    assert_same_mean(seen, landed, 2, 0.15)


def test_a_sensor_within_a_medium_in_closed_form() -> None:
    # It hangs in the middle of a box of ink, under the sun: E exp(-sigma d), to rounding; half of a
    # meter above it, and half below, where another counts what passes both.
    ink = with_interior(box("ink", [0, 0, 0], [2, 2, 2], BOUNDARY), "ink")
    sun = DirectionalLight([0, 1, 0], [2.0, 3.0, 4.0])
    scene = Scene("ink", (ink,), {}, view(2), None, (sun,), media={"ink": INK})
    tracer = PathTracer(scene, dtype=np.float64)
    for height in (0.5, -0.5, -1.0):
        sensor = IrradianceSensor([-0.5, height, 0.5], [1, 0, 0], [0, 0, -1], 1, 1)
        found = trace_light(tracer, sensor, 1 << 16, seed=1)
        expected = np.array([2.0, 3.0, 4.0]) * np.exp(-SIGMA * (1 - height))
        share = found.mean[0, 0] / expected
        np.testing.assert_allclose(share, share[0], rtol=1e-9)  # all channels by the same flights
        assert abs(share[0] - 1) < 4 * found.standard_error[0, 0, 0] / expected[0]
        assert found.standard_error[0, 0, 0] < 0.02 * expected[0]


def test_a_sensor_within_scattering_media_in_closed_form() -> None:
    # Of light that has not been scattered (one segment): E exp(-sigma d), in fog, and in a grid.
    sun = DirectionalLight([0, 1, 0], [2.0, 3.0, 4.0])
    even = smoke(np.full((3, 4, 5), 0.7), majorant=1.3)
    for medium, sigma in ((FOG, FOG.sigma_t), (even, 0.7 * even.sigma_t)):
        scene = replace(under(medium, sun, sky=None), shapes=(under(medium).shapes[1],))
        tracer = PathTracer(scene, dtype=np.float64)
        sensor = IrradianceSensor([-0.5, 0.55, 0.5], [1, 0, 0], [0, 0, -1], 1, 1)
        found = trace_light(tracer, sensor, 1 << 17, seed=1, options=ParticleOptions(1))
        expected = np.array([2.0, 3.0, 4.0]) * np.exp(-sigma * 0.8)
        error = found.standard_error[0, 0]
        assert (error < 0.02 * expected).all()
        assert (np.abs(found.mean[0, 0] - expected) < 4 * error).all()


def landed_on_walls(medium: Medium, particles: int) -> Any:
    """Watts (3,) that all walls of a closed black room get, over those of a light in the fog."""
    fog = with_interior(box("fog", [0, 0.7, 0], [1.8, 1.3, 1.8], BOUNDARY), "fog")
    walls = box("walls", [0, 1, 0], [4, 4, 4], "black", inward=True)
    light = PointLight([0.2, 0.7, 0.1], [1.0, 2.0, 3.0])
    scene = Scene(
        "room", (fog, walls), {"black": BLACK}, view(2), None, (light,), media={"fog": medium}
    )
    tracer = PathTracer(scene, dtype=np.float64)
    corner, landed = np.array([-2.0, -1.0, -2.0]), np.zeros(3)
    for k in range(3):
        n, x, y = np.roll(4 * np.eye(3), -k, axis=0)
        for wall in (
            IrradianceSensor(corner, x, y, 1, 1),
            IrradianceSensor(corner + n, y, x, 1, 1),
        ):
            found = trace_light(
                tracer, wall, particles, seed=1, options=ParticleOptions(1000, None)
            )
            landed += wall.cell_area * found.mean[0, 0]
    return landed / (4 * np.pi * np.array([1.0, 2.0, 3.0]))


def test_energy_is_kept_to_the_last_particle() -> None:
    # What scatters all and absorbs nothing, alike in all channels: each particle lands once, with
    # what it left with. Those that land within a hair of an edge count on both walls.
    share = landed_on_walls(Medium(3.0, 1.0, values={"g": 0.5}), 4096)
    np.testing.assert_allclose(share, 1, rtol=3e-4)


@pytest.mark.parametrize("grid", [False, True])
def test_energy_is_kept_on_the_mean(grid: bool) -> None:
    # Channels that differ are weighed by what each would have drawn; so are null collisions whose
    # chance was kept away from 0. What single particles carry varies, their mean does not.
    medium = replace(smoke(), albedo=np.ones(3)) if grid else CLEAR
    share = landed_on_walls(medium, 16384)
    # In the even fog the mean over channels is kept by every particle.
    np.testing.assert_allclose(share, 1, atol=0.05)


def test_light_from_infinity_ends_in_a_world_of_fog() -> None:
    sun = DirectionalLight([0, 1, 0], [2.0] * 3)
    shapes = (rectangle("floor", *FLOOR, "floor"),)
    scene = Scene(
        "w", shapes, {"floor": GRAY}, view(2), None, (sun, LIGHT), media={"fog": FOG}, world="fog"
    )
    tracer = PathTracer(scene, dtype=np.float64)
    found = trace_light(tracer, patch(2), 1 << 14, seed=1)
    alone = PathTracer(replace(scene, lights=(LIGHT,)), dtype=np.float64)
    same = trace_light(alone, patch(2), 1 << 14, seed=1)
    assert same.mean.min() > 0
    assert_same_mean(found, same, 2, 1.0)


@pytest.mark.parametrize("light", [SUN, SPOT], ids=["sun", "spot"])
def test_both_ends_agree_in_a_world_with_a_grid(light: Any) -> None:
    # The cloud reaches beyond the disk from which particles of the sun start.
    tall = DensityGrid(
        np.linspace(0.2, 1.0, 60).reshape(3, 4, 5), placed([-2.5, -0.1, -2.5], [5, 2, 5])
    )
    cloud = Medium([0.8, 1.2, 1.6], 0.8, values={"g": 0.3}, density=tall)
    shapes = (rectangle("floor", *FLOOR, "floor"),)
    scene = Scene(
        "w", shapes, {"floor": GRAY}, view(2), None, (light,), media={"cloud": cloud}, world="cloud"
    )
    tracer = PathTracer(scene, dtype=np.float64)
    seen = seen_irradiance(tracer, below(1e-3, 2, 0.5), 0.5, 4096)
    landed = trace_light(tracer, patch(2), 4 * PARTICLES, seed=4, options=AS_SEEN)
    assert seen.mean.min() > 0.02
    assert_same_mean(seen, landed, 3, 0.15)


def test_emission_is_that_without_media() -> None:
    scene = under(FOG, LIGHT)
    bare = replace(scene, shapes=(scene.shapes[0], scene.shapes[2]), media={})
    a = emit_particles(PathTracer(scene), 64, seed=1)
    b = emit_particles(PathTracer(bare), 64, seed=1)
    assert np.abs(a.flux).min() >= 0
    assert a.flux.shape == b.flux.shape == (64, 3)


@pytest.mark.parametrize("name", ["fog and a lamp", "smoke in a grid", "fog behind a veil"])
def test_a_photon_map_sees_what_paths_see(name: str) -> None:
    # From above, through the fog, to the middle of the floor: light that the fog scatters, and
    # light that reaches the floor through it, direct and not.
    scene = replace(SCENES[name](), camera=below(1.4, 2, 0.3))
    tracer = PathTracer(scene, dtype=np.float64)
    options = PathOptions(sampler="independent")
    photons = PhotonMap(tracer, 1 << 17, radius=0.08, seed=1)
    read = photons.render(spp=1024, seed=2, options=options)
    seen = tracer.render(spp=4096, seed=3, options=options)

    def pooled(sums: Accumulation) -> tuple[Any, Any]:
        """(3,) mean of the picture, and its variance."""
        return sums.mean.mean(axis=(0, 1)), (sums.standard_error**2).mean(axis=(0, 1)) / 4

    (a, a_variance), (b, b_variance) = pooled(read), pooled(seen)
    error = np.sqrt(a_variance + b_variance)
    assert (error < 0.05 * b).all()
    # The blur of the map, and its noise, which all samples share.
    assert (np.abs(a - b) < 3 * error + 0.03 * b).all()
    alone = replace(scene, media={}, shapes=tuple(s for s in scene.shapes if s.interior is None))
    clear = PathTracer(alone).render(spp=256, seed=1).mean.mean(axis=(0, 1))
    assert (np.abs(b / clear - 1) > 0.1).any()


def test_photons_pass_boundaries() -> None:
    walls = (box("walls", [0, 1, 0], [4, 4, 4], BOUNDARY), rectangle("floor", *FLOOR, "floor"))
    scene = Scene("b", walls, {"floor": GRAY}, view(2), Environment.constant(1.0))
    bare = replace(scene, shapes=walls[1:])
    for one in (scene, bare):
        photons = PhotonMap(PathTracer(one), 1 << 18, radius=0.4, seed=1)
        found = photons.irradiance(np.zeros((1, 3)), np.array([[0.0, 1, 0]]))
        np.testing.assert_allclose(found, np.pi, rtol=0.1)  # some 2000 photons


@same_bits("light tracing in media")
def light_map() -> list[Any]:
    tracer = PathTracer(under(smoke(), LIGHT), dtype=np.float64)
    sums = trace_light(tracer, patch(3), 10_000, seed=7)
    return [sums.radiance, sums.squares]


def test_parts_add_up() -> None:
    tracer = PathTracer(under(smoke(), LIGHT), dtype=np.float64)
    parts = trace_light(tracer, patch(3), 4096, seed=7)
    trace_light(tracer, patch(3), 10_000 - 4096, seed=7, sums=parts)
    assert parts.mean.min() > 0
    np.testing.assert_allclose(parts.radiance, light_map()[0], rtol=1e-12)
