"""Media against results that are known in closed form, or to any accuracy."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from photograd.lights import DirectionalLight, PointLight
from photograd.transport import (
    BOUNDARY,
    VACUUM,
    DensityGrid,
    Environment,
    Medium,
    PathOptions,
    PathTracer,
    Scene,
    SphereShape,
)
from photograd.transport.shapes import box, rectangle

from tests.transport.media_scenes import GLASS, INK, ball_of, pencil, placed, with_interior
from tests.transport.scenes import BLACK, GRAY

SIGMA = np.array(INK.sigma_t)
PATHS = PathOptions("bsdf", max_depth=4000, sampler="independent")


def slab(
    medium: Medium,
    thickness: float,
    camera: Any,
    *lights: Any,
    sky: float = 1.0,
    width: float = 2.0,
) -> Scene:
    """A box, z = -thickness to 0, of a medium behind a mere boundary."""
    shape = box("slab", [0, 0, -thickness / 2], [width, width, thickness], BOUNDARY)
    return Scene(
        "slab",
        (with_interior(shape, "inside"),),
        {},
        camera,
        Environment.constant(sky),
        lights,
        media={"inside": medium},
    )


@pytest.mark.parametrize(("dtype", "error"), [(np.float32, 2e-6), (np.float64, 1e-9)])
def test_beer_and_lambert(dtype: Any, error: float) -> None:
    # A medium that only absorbs: no chance in it. Straight, and at 60 degrees.
    for x, length in ((0.0, 0.75), (3**0.5, 1.5)):  # the box has corners that a float can hold
        camera = pencil((x, 0.1, 1.0), (0.0, 0.1, 0.0))
        found = PathTracer(slab(INK, 0.75, camera, width=8.0), dtype=dtype).render(spp=4, seed=1)
        np.testing.assert_allclose(found.mean[0, 0], np.exp(-SIGMA * length), rtol=error)


def test_media_within_one_another() -> None:
    # A ball of ink with an empty ball in it, in a ball of glass-clear nothing: shapes in shapes.
    balls = (
        SphereShape("ink", np.zeros(3), 1.0, BOUNDARY, interior="ink"),
        SphereShape("hole", np.array([0, 0, 0.25]), 0.5, BOUNDARY, interior=VACUUM),
        SphereShape("drop", np.array([0, 0, 0.25]), 0.25, BOUNDARY, interior="dark"),
    )
    media = {"ink": INK, "dark": Medium(2 * SIGMA)}
    sky = Environment.constant(1.0)
    inside = 1.0 * SIGMA + 0.5 * 2 * SIGMA  # 2 m, less a hole of 1 m; a drop of 0.5 m
    for start, depth in ((3.0, inside), (0.25, 0.25 * SIGMA + 0.25 * 2 * SIGMA)):
        camera = pencil((0, 0, start), (0, 0, start + (-1 if start == 3 else 1)))
        scene = Scene("b", balls, {}, camera, sky, media=media)
        found = PathTracer(scene, dtype=np.float64).render(spp=2, seed=1)
        np.testing.assert_allclose(found.mean[0, 0], np.exp(-depth), rtol=1e-9)


def test_glass_in_fog_holds_none() -> None:
    # A camera in the middle of a clear ball of glass looks out; around it is ink without end, and
    # at 3 m a shining wall. The glass scales by eta^2 (1 - F).
    wall = rectangle("wall", [-9, -9, -3], [18, 0, 0], [0, 18, 0], "black", [1, 1, 1])
    ball = SphereShape("ball", np.zeros(3), 1.0, "glass")
    materials = {"glass": GLASS, "black": BLACK}
    camera = pencil((0, 0, 0), (0, 0, -1))
    scene = Scene("g", (wall, ball), materials, camera, media={"ink": INK}, world="ink")
    options = PathOptions(max_depth=2, sampler="independent")
    found = PathTracer(scene, dtype=np.float64).render(spp=4000, seed=1, options=options)
    F = (0.4 / 2.4) ** 2
    expected = np.exp(-2 * SIGMA) * 1.4**2 * (1 - F)
    np.testing.assert_allclose(found.mean[0, 0], expected, rtol=4 * np.sqrt(F / 4000))


@pytest.mark.parametrize("shell", [None, GLASS])
@pytest.mark.parametrize("sigma", [3.0, (2.0, 4.0, 8.0)])
def test_furnace(shell: Any, sigma: Any) -> None:
    # An albedo of 1 under an even sky: what scatters loses nothing, so the ball cannot be seen.
    medium = Medium(sigma, 1.0, values={"g": 0.5})
    options = replace(PATHS, roulette_from=None)
    found = PathTracer(ball_of(medium, shell)).render(spp=400, seed=2, options=options)
    if shell is None and isinstance(sigma, float):  # one channel is as good as all: no variance
        np.testing.assert_allclose(found.mean, 1.0, rtol=1e-4)
        return
    error = np.sqrt((found.standard_error**2).sum(axis=(0, 1))) / 64
    assert (error < 0.01).all()
    assert (np.abs(found.mean.mean(axis=(0, 1)) - 1) < 4 * error).all()


@pytest.mark.parametrize("phase", ["henyey_greenstein", "cornette_shanks"])
def test_single_scattering_of_sunlight(phase: str) -> None:
    # Rays side by side come from straight above, the camera looks along z at the depth h:
    # L = integral of sigma_s exp(-sigma_t (s + h)) p(0) E ds = albedo p E exp(-sigma_t h) (1 - T).
    g, h, thickness = 0.3, 0.25, 0.7
    albedo = np.array([0.9, 0.5, 0.2])
    medium = Medium(SIGMA, albedo, phase, {"g": g})
    camera = pencil((0, 1.0 - h, 1), (0, 1.0 - h, 0))
    scene = slab(medium, thickness, camera, DirectionalLight([0, 1, 0], [2, 2, 2]), sky=0.0)
    options = PathOptions(max_depth=2, sampler="independent")
    found = PathTracer(scene, dtype=np.float64).render(spp=20000, seed=3, options=options)
    p = {
        "henyey_greenstein": (1 - g * g) / (4 * np.pi * (1 + g * g) ** 1.5),
        "cornette_shanks": 3 * (1 - g * g) / (8 * np.pi * (2 + g * g) * (1 + g * g) ** 1.5),
    }[phase]
    expected = albedo * p * 2 * np.exp(-SIGMA * h) * (1 - np.exp(-SIGMA * thickness))
    error = found.standard_error[0, 0]
    assert (error < 0.02 * expected).all()
    assert (np.abs(found.mean[0, 0] - expected) < 4 * error).all()


def test_single_scattering_of_a_point_light() -> None:
    # World fog, a black wall behind: by quadrature along the ray.
    light, intensity = np.array([0.6, 0.5, -1.0]), 3.0
    wall = rectangle("wall", [-9, -9, -2], [18, 0, 0], [0, 18, 0], "black")
    medium = Medium(SIGMA, 0.6, values={"g": -0.4})
    scene = Scene(
        "p",
        (wall,),
        {"black": BLACK},
        pencil((0, 0, 0), (0, 0, -1)),
        lights=(PointLight(light, [intensity] * 3),),
        media={"fog": medium},
        world="fog",
    )
    options = PathOptions(max_depth=2, sampler="independent")
    found = PathTracer(scene, dtype=np.float64).render(spp=20000, seed=4, options=options)
    s = (np.arange(20000) + 0.5) / 10000
    way = light - np.stack([0 * s, 0 * s, -s], axis=-1)
    r = np.linalg.norm(way, axis=-1)
    cosine, g = -way[:, 2] / r, -0.4
    p = (1 - g * g) / (4 * np.pi * (1 + g * g - 2 * g * cosine) ** 1.5)
    lost = np.exp(-(s + r)[:, None] * SIGMA)
    expected = (0.6 * SIGMA * lost * (p * intensity / r**2)[:, None]).sum(axis=0) / 10000
    error = found.standard_error[0, 0]
    assert (error < 0.02 * expected).all()
    assert (np.abs(found.mean[0, 0] - expected) < 4 * error).all()


def h_function(albedo: float, mu: float) -> float:
    """Chandrasekhar's H for isotropic scattering, by iterating [Chandrasekhar1960, Ch. V]:
    1 / H(mu) = sqrt(1 - a) + a / 2 integral_0^1 m H(m) / (m + mu) dm.
    """
    nodes, weights = np.polynomial.legendre.leggauss(64)
    m, w = 0.5 * (nodes + 1), 0.5 * weights
    H = np.ones_like(m)

    def inverse(at: Any) -> Any:
        return np.sqrt(1 - albedo) + 0.5 * albedo * (w * m * H / (m + at[:, None])).sum(axis=-1)

    for _ in range(2000):
        H = 0.5 * (H + 1 / inverse(m))
    return float(1 / inverse(np.array([mu]))[0])


def test_h_function() -> None:
    # [Chandrasekhar1960, Table XI]: H(1) = 2.9078 where nothing is absorbed.
    assert h_function(1.0, 1.0) == pytest.approx(2.9078, abs=2e-4)


@pytest.mark.parametrize("mu", [1.0, 0.4])
def test_albedo_of_a_half_space(mu: float) -> None:
    # Under an even sky of 1, what a half space sends towards mu is its plane albedo for light from
    # there: 1 - H(mu) sqrt(1 - a), all orders of scattering included. 30 m are without end here.
    albedos = np.array([0.5, 0.8, 0.95])
    medium = Medium(1.0, albedos)
    x = 5 * np.sqrt(1 - mu * mu) / mu
    scene = slab(medium, 60.0, pencil((x, 0, 5), (0, 0, 0)), width=4000.0)
    found = PathTracer(scene, dtype=np.float64).render(spp=20000, seed=5, options=PATHS)
    expected = np.array([1 - h_function(a, mu) * np.sqrt(1 - a) for a in albedos])
    assert expected[2] > 0.4
    error = found.standard_error[0, 0]
    np.testing.assert_allclose(found.mean[0, 0], expected, rtol=0.02)
    assert (np.abs(found.mean[0, 0] - expected) < 4 * error).all()


@pytest.mark.parametrize("loose", [1.0, 3.0])
def test_an_even_grid_is_an_even_medium(loose: float) -> None:
    from tests.transport.test_strategies import assert_same_mean

    even = Medium([2.0, 3.0, 4.0], 0.8, values={"g": 0.4})
    grid = DensityGrid(np.full((2, 3, 4), 0.5), placed([-2, -2, -2], [4, 4, 4]), 0.5 * loose)
    uneven = replace(even, sigma_t=2 * np.asarray(even.sigma_t), density=grid)
    lights = (DirectionalLight([0.3, 1, 0.5], [2.0, 2.0, 2.0]),)
    options = PathOptions(max_depth=12, roulette_from=None, sampler="independent")
    a, b = (
        PathTracer(ball_of(medium, lights=lights, sky=0.3)).render(
            spp=500, seed=seed, options=options
        )
        for seed, medium in enumerate((even, uneven))
    )
    assert_same_mean(a, b, 2, 0.05)


def test_absorption_in_a_grid() -> None:
    # exp(-integral of sigma_t rho), rho trilinear in the layers' middles: by ratio tracking.
    layers = np.array([0.2, 1.0, 0.6, 0.0])
    values = np.broadcast_to(layers, (2, 2, 4)).copy()
    grid = DensityGrid(values, placed([-1, -1, -0.8], [2, 2, 0.8]))
    medium = Medium(SIGMA, density=grid)
    found = PathTracer(slab(medium, 0.8, pencil((0, 0, 1), (0, 0, 0))), dtype=np.float64).render(
        spp=20000, seed=6, options=PATHS
    )
    z = (np.arange(8000) + 0.5) / 8000
    rho = np.interp(z, [0.125, 0.375, 0.625, 0.875], layers).mean()
    expected = np.exp(-SIGMA * 0.8 * rho)
    error = found.standard_error[0, 0]
    assert (error < 0.01 * expected).all()
    assert (np.abs(found.mean[0, 0] - expected) < 4 * error).all()


def test_both_walks_draw_surfaces_alike() -> None:
    # A boundary within an opaque ball takes the other walk: the same picture.
    from tests.transport.scenes import stage

    plain = stage(GRAY, sky=0.4)
    aside = SphereShape("aside", np.array([0.0, 0.5, 0.0]), 0.1, BOUNDARY)
    walked = replace(plain, shapes=(*plain.shapes, aside))
    options = PathOptions(max_depth=5)
    a, b = (
        PathTracer(scene, dtype=np.float64).render(spp=8, seed=7, options=options).mean
        for scene in (plain, walked)
    )
    assert a.mean() > 0.1
    np.testing.assert_allclose(a, b, rtol=1e-9)
