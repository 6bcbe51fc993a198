"""Light tracing: energy, closed forms, and the same irradiance as from the other end."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from photograd.capture.camera import Camera
from photograd.errors import RangeError, ShapeError
from photograd.lights import DirectionalLight, PointLight
from photograd.transport import (
    Accumulation,
    IrradianceSensor,
    Material,
    ParticleOptions,
    PathOptions,
    PathTracer,
    Scene,
    SphereShape,
    trace_light,
)
from photograd.transport.builtin import cornell_box, furnace_box
from photograd.transport.shapes import rectangle

from support.bits import same_bits
from support.glass_ball import flux_below_ball
from support.light_proofs import polygon_irradiance
from tests.transport.scenes import BLACK, FLOOR, GRAY, LAMP, any_material, bent_floor, stage, view
from tests.transport.test_emission_textures import room
from tests.transport.test_strategies import assert_same_mean

GLASS = Material("glass", {"eta": 1.5, "tint": [0.9, 1.0, 0.95]})
ALL = ParticleOptions(roulette_from=None)
HALF = 0.5  # m, of the square of the floor that is measured
AS_SEEN = ParticleOptions(11, None)  # as far as camera paths of 12 segments look


def below(height: float, size: int, half: float = HALF) -> Camera:
    """Looks straight down from `height` above the floor; its pixels are the cells of `patch`."""
    pose = np.array([[1.0, 0, 0, 0], [0, 0, -1, height], [0, 1, 0, 0], [0, 0, 0, 1]])
    focal = 0.5 * size * height / half
    return Camera(size, size, focal, focal, size / 2, size / 2, pose)


def patch(size: int, half: float = HALF) -> IrradianceSensor:
    """The middle of the floor, cell by cell."""
    return IrradianceSensor([-half, 0, half], [2 * half, 0, 0], [0, 0, -2 * half], size, size)


def seen_irradiance(tracer: PathTracer, camera: Camera, albedo: Any, spp: int) -> Accumulation:
    """Irradiance of a Lambertian floor, from the radiance that a path tracer sees."""
    sums = tracer.render(
        spp=spp,
        seed=3,
        camera=camera,
        options=PathOptions(roulette_from=None, max_depth=12, sampler="independent"),
    )
    scale = np.pi / np.asarray(albedo)
    return Accumulation(sums.radiance * scale, sums.squares * scale**2, sums.count)


def covered(cover: Material, floor: Material = GRAY) -> Scene:
    """A floor under a light, and a sheet between them whose inside is below."""
    shapes = (
        rectangle("floor", *FLOOR, "floor"),
        rectangle("cover", [-2, 0.9, 2], [4, 0, 0], [0, 0, -4], "cover"),
        rectangle("lamp", *LAMP, "black", [4.0, 3.0, 2.0]),
    )
    return Scene("covered", shapes, {"floor": floor, "cover": cover, "black": BLACK}, view(8))


COVERED = {
    "glass": GLASS,
    "thin glass": Material("thin_glass", {"eta": 1.5, "tint": [0.9, 1.0, 0.95]}),
    "rough glass": Material("rough_dielectric", {"eta": 1.5, "roughness": 0.5}),
    "veil": Material("lambert", {"albedo": [0.6, 0.3, 0.1], "alpha": 0.4}),
}
PARTICLES = 1 << 17


@pytest.mark.parametrize("cover", COVERED)
def test_both_ends_agree_through_a_boundary(cover: str) -> None:
    # The floor lies inside of the glass: radiance there is larger by eta^2 = 2.25, power is not.
    tracer = PathTracer(covered(COVERED[cover]), dtype=np.float64)
    seen = seen_irradiance(tracer, below(0.8, 4), 0.5, 2048)
    landed = trace_light(tracer, patch(4), PARTICLES, seed=4, options=AS_SEEN)
    assert seen.mean.min() > 0.1
    assert_same_mean(seen, landed, 5, 0.1)


def test_both_ends_agree_under_a_painted_lamp() -> None:
    tracer = PathTracer(room(triangles=True), dtype=np.float64)
    seen = seen_irradiance(tracer, below(0.8, 4), 0.5, 1024)
    landed = trace_light(tracer, patch(4), PARTICLES, seed=4, options=AS_SEEN)
    assert seen.mean.min() > 0.1
    assert_same_mean(seen, landed, 5, 0.1)


def test_both_ends_agree_in_a_room() -> None:
    scene = cornell_box(8)
    empty = tuple(s for s in scene.shapes if s.name not in ("tall", "short"))
    tracer = PathTracer(Scene("room", empty, scene.materials, scene.camera), dtype=np.float64)
    seen = seen_irradiance(tracer, below(1.9, 4, 1.0), [0.725, 0.71, 0.68], 256)
    landed = trace_light(tracer, patch(4, 1.0), PARTICLES, seed=4, options=AS_SEEN)
    assert_same_mean(seen, landed, 5, 0.1)
    # The red wall, on the left, lights its side of the floor.
    red = landed.mean[:, :, 0] / landed.mean[:, :, 1]
    assert red[:, 0].mean() > 1.05 * red[:, -1].mean()


def test_both_ends_agree_under_bent_normals() -> None:
    # Light from a floor whose shading normals lean by up to 40 degrees, on the ceiling above it.
    bent = bent_floor(8, 40.0)
    ceiling = rectangle("ceiling", [-0.5, 1.2, -0.5], [1, 0, 0], [0, 0, 1], "gray")
    scene = Scene(
        "bent",
        (*bent.shapes, ceiling),
        {**bent.materials, "gray": GRAY},
        view(8),
        lights=(PointLight([0.9, 0.6, 0.3], [3.0, 2.0, 1.0]),),
    )
    tracer = PathTracer(scene, dtype=np.float64)
    upwards = np.array([[1.0, 0, 0, 0], [0, 0, 1, 0.2], [0, -1, 0, 0], [0, 0, 0, 1]])
    camera = Camera(2, 2, 2.0, 2.0, 1.0, 1.0, upwards)
    seen = seen_irradiance(tracer, camera, 0.5, 1 << 14)
    sensor = IrradianceSensor([-0.5, 1.2, -0.5], [1, 0, 0], [0, 0, 1], 2, 2)
    landed = trace_light(tracer, sensor, 1 << 18, seed=4, options=AS_SEEN)
    assert_same_mean(seen, landed, 5, 0.1)


def test_energy_in_a_closed_box() -> None:
    # Every wall returns half of what lands: sum of E A = power (1 + 1/2 + 1/4 ...), to the last
    # particle. Those that land within a hair of an edge count on both walls.
    tracer = PathTracer(furnace_box(4, 0.5, 0.7), dtype=np.float64)
    walls = []
    for k in range(3):
        n, x, y = np.roll(2 * np.eye(3), -k, axis=0)
        walls += [IrradianceSensor([-1.0] * 3, x, y, 1, 1), IrradianceSensor(n - 1.0, y, x, 1, 1)]
    for options, tolerance in ((ParticleOptions(10, None), 3e-4), (ParticleOptions(99, 1), 0.02)):
        landed = sum(
            wall.cell_area * trace_light(tracer, wall, 8192, seed=1, options=options).mean
            for wall in walls
        )
        power = np.pi * 24.0 * 0.7
        whole = power * (1 - 0.5**options.max_depth) / 0.5
        np.testing.assert_allclose(np.asarray(landed).reshape(3), whole, rtol=tolerance)


def test_a_lamp_in_closed_form() -> None:
    tracer = PathTracer(covered(BLACK, BLACK), dtype=np.float64)
    sensor = IrradianceSensor([-0.5, 1.2, 0.5], [1, 0, 0], [0, 0, -1], 3, 3)  # above the cover
    found = trace_light(tracer, sensor, 1 << 18, seed=2, options=ParticleOptions(1))
    corner, u, v = (np.array(edge, float) for edge in LAMP)
    outline = np.stack([corner, corner + v, corner + u + v, corner + u])
    for row in range(3):
        for column in range(3):
            # The mean over a cell, by 5 x 5 points.
            steps = (np.arange(5) + 0.5) / 5
            points = [
                [-0.5 + (column + i) / 3, 1.2, -0.5 + (row + j) / 3] for i in steps for j in steps
            ]
            E = np.mean(
                [
                    abs(polygon_irradiance(outline, np.array(p), np.array([0.0, 1, 0])))
                    for p in points
                ]
            )
            z = (found.mean[row, column, 0] - 4.0 * E) / found.standard_error[row, column, 0]
            assert abs(z) < 4, (row, column)
            assert 4 * found.standard_error[row, column, 0] < 0.05 * 4.0 * E


def ball_under_the_sky(floor: Material = BLACK) -> Scene:
    """A ball of clear glass over a floor, in light from straight above."""
    clear = Material("glass", {"eta": 1.5, "tint": [1.0, 1.0, 1.0]})
    shapes = (
        rectangle("floor", [-0.8, 0, 0.8], [1.6, 0, 0], [0, 0, -1.6], "floor"),
        SphereShape("ball", np.array([0.0, 0.6, 0.0]), 0.4, "glass"),
    )
    light = DirectionalLight([0.0, 1.0, 0.0], [1.0, 2.0, 3.0])
    return Scene("ball", shapes, {"floor": floor, "glass": clear}, view(8), lights=(light,))


def test_the_caustic_of_a_ball_has_the_power_of_theory() -> None:
    tracer = PathTracer(ball_under_the_sky(), dtype=np.float64)
    for half in (0.15, 0.5):
        sensor = patch(8, half)
        found = trace_light(tracer, sensor, 1 << 18, seed=1, options=ALL)
        power = found.mean.sum(axis=(0, 1)) * sensor.cell_area
        theory = flux_below_ball(0.4, 0.6, half)
        np.testing.assert_allclose(power, theory * np.array([1.0, 2.0, 3.0]), rtol=0.01)
    # Without the ball the small square would get 0.09 W: the ball gathers several times that.
    assert flux_below_ball(0.4, 0.6, 0.15) > 3 * 4 * 0.15**2


def traced(seed: int = 7) -> Any:
    tracer = PathTracer(stage(any_material("gltf"), sky=0.4), dtype=np.float64)
    return trace_light(tracer, patch(4), 20_000, seed=seed)


@same_bits("light tracing")
def light_map() -> list[Any]:
    sums = traced()
    return [sums.radiance, sums.squares]


def test_parts_add_up_and_seeds_differ() -> None:
    tracer = PathTracer(stage(any_material("gltf"), sky=0.4), dtype=np.float64)
    parts = trace_light(tracer, patch(4), 4096, seed=7)
    trace_light(tracer, patch(4), 20_000 - 4096, seed=7, sums=parts)
    whole = traced()
    assert whole.mean.min() > 0
    np.testing.assert_allclose(parts.radiance, whole.radiance, rtol=1e-12)
    assert (traced(seed=8).radiance != whole.radiance).any()


def test_mistakes_are_named() -> None:
    tracer = PathTracer(stage(GRAY))
    with pytest.raises(RangeError, match="particles: expected a whole number of at least 1"):
        trace_light(tracer, patch(2), 0, seed=0)
    with pytest.raises(ShapeError, match="sums: expected shape"):
        trace_light(tracer, patch(2), 1, seed=0, sums=Accumulation.empty(3, 2))
    with pytest.raises(RangeError, match="a scene with lights"):
        trace_light(PathTracer(stage(GRAY, lamp=0.0)), patch(2), 1, seed=0)
    with pytest.raises(ShapeError, match="IrradianceSensor: corner"):
        IrradianceSensor([0, 0], [1, 0, 0], [0, 1, 0], 1, 1)
    with pytest.raises(RangeError, match="perpendicular"):
        IrradianceSensor([0, 0, 0], [1, 0, 0], [1, 1, 0], 1, 1)
    with pytest.raises(RangeError, match="perpendicular"):
        IrradianceSensor([0, 0, 0], [0, 0, 0], [0, 1, 0], 1, 1)
    with pytest.raises(RangeError, match="height: expected a whole number of at least 1"):
        IrradianceSensor([0, 0, 0], [1, 0, 0], [0, 1, 0], 0, 1)
    with pytest.raises(RangeError, match="max_depth"):
        ParticleOptions(max_depth=0)
    with pytest.raises(RangeError, match="roulette_from"):
        ParticleOptions(roulette_from=-1)
