"""Derivatives of what rays see, by everything, in double: differences, Taylor, mutants."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from photograd.splats.rays import RayOptions, render, render_backward
from photograd.splats.splatting import Gaussians
from photograd_course.gradcheck import check_gradient, taylor_slope

from support.gradient_mutants import check_gradient_mutants
from tests.splat import oracle, ray_oracle

SMOOTH = RayOptions().smooth()
BEHIND = np.array([0.2, 0.5, 0.9])


class Scene:
    """Gaussians, background and rays as groups of parameters, in the form the checks take."""

    def __init__(self, g: Gaussians, rays: int, options: RayOptions = SMOOTH) -> None:
        self.options = options
        origins, directions = ray_oracle.rays(rays, 3)
        self.place = {
            **g.arrays(),
            "background": BEHIND.copy(),
            "origins": origins,
            "directions": directions,
        }

    def rendered(self, p: dict[str, Any]) -> Any:
        g = Gaussians(p["means"], p["log_scales"], p["quats"], p["opacity_logits"], p["sh"])
        return render(
            g, p["origins"], p["directions"], background=p["background"], options=self.options
        )

    def forward(self, p: dict[str, Any]) -> dict[str, Any]:
        return dict(vars(self.rendered(p)[0]))

    def backward(self, p: dict[str, Any], d: dict[str, Any]) -> dict[str, Any]:
        _, context = self.rendered(p)
        found = render_backward(context, d["color"], d["opacity"], d["depth"], rays=True)
        return {
            **found.gaussians,
            "background": found.background,
            "origins": found.origins,
            "directions": found.directions,
        }


SCENES = {
    "degree 3": (oracle.cloud(12, 1), 60),
    "degree 0": (oracle.cloud(12, 2, degree=0), 60),
    "more than a list holds": (oracle.cloud(70, 3, degree=1, size=-1.0), 15),
}


@pytest.mark.parametrize("name", SCENES)
def test_every_group_agrees_with_differences(name: str) -> None:
    scene = Scene(*SCENES[name])
    report = check_gradient(scene.forward, scene.backward, scene.place, seed=3, coordinates=16)
    assert report, str(report)


def test_taylor_remainder_falls_quadratically() -> None:
    scene = Scene(*SCENES["degree 3"])
    report = taylor_slope(scene.forward, scene.backward, scene.place, seed=4)
    assert report, str(report)


def test_automatic_mutants_die() -> None:
    scene = Scene(oracle.cloud(4, 4, degree=1), 12)
    shapes = scene.forward(scene.place)
    g = np.random.default_rng(5)
    d = {name: g.uniform(0.5, 1.5, array.shape) for name, array in shapes.items()}
    report = check_gradient_mutants(
        scene.forward,
        scene.backward,
        scene.place,
        d,
        seed=6,
        coordinates=6,
        directions=4,
        steps=(1e-4, 1e-5, 1e-6),
    )
    assert report, str(report)


def test_gradients_with_cutoffs_are_those_of_what_is_left() -> None:
    # Away from the discontinuities the derivative exists: small steps cross none of them here.
    scene = Scene(*SCENES["degree 3"], RayOptions())
    report = check_gradient(
        scene.forward,
        scene.backward,
        scene.place,
        seed=3,
        coordinates=8,
        steps=(1e-5, 1e-6, 1e-7, 1e-8),
    )
    assert report, str(report)


def test_where_alpha_max_holds_the_derivative_is_zero() -> None:
    g = oracle.cloud(4, 8, size=-0.7, spread=0.4)
    g = replace(g, opacity_logits=g.opacity_logits + 5)
    held, free = (Scene(g, 40, replace(SMOOTH, alpha_max=limit)) for limit in (0.6, 1.0))
    report = check_gradient(held.forward, held.backward, held.place, seed=7)
    assert report, str(report)
    d = {name: np.ones_like(a) for name, a in held.forward(held.place).items()}
    lost = held.backward(held.place, d)["opacity_logits"]
    whole = free.backward(free.place, d)["opacity_logits"]
    assert np.linalg.norm(lost - whole) > 0.1 * np.linalg.norm(whole)  # it holds something here


def test_lengths_of_quaternions_and_directions_have_no_gradient() -> None:
    scene = Scene(*SCENES["degree 3"])
    d = {name: np.ones_like(a) for name, a in scene.forward(scene.place).items()}
    found = scene.backward(scene.place, d)
    for name in ("quats", "directions"):
        radial = (found[name] * scene.place[name]).sum(1)
        size = np.linalg.norm(found[name]) * np.linalg.norm(scene.place[name], axis=1).max()
        assert size > 0.1
        assert np.abs(radial).max() < 1e-12 * size, name


def test_moving_all_is_moving_nothing() -> None:
    # Rays and means shifted together leave the picture alone: their gradients cancel.
    scene = Scene(*SCENES["degree 3"])
    d = {name: np.ones_like(a) for name, a in scene.forward(scene.place).items()}
    found = scene.backward(scene.place, d)
    total = found["means"].sum(0) + found["origins"].sum(0)
    assert np.linalg.norm(found["means"].sum(0)) > 0.1
    np.testing.assert_allclose(total, 0, atol=1e-12 * np.abs(found["means"]).sum())


def test_rays_are_differentiated_only_where_asked() -> None:
    scene = Scene(*SCENES["degree 0"])
    _, context = scene.rendered(scene.place)
    ones = np.ones_like(context.picture.color)
    without, with_rays = (render_backward(context, ones, rays=asked) for asked in (False, True))
    assert without.origins is None
    assert without.directions is None
    for name, array in with_rays.gaussians.items():
        assert np.array_equal(array, without.gaussians[name])


def test_what_no_ray_sees_has_no_gradient() -> None:
    g = oracle.cloud(12, 1)
    g.means[3] = [1e3, 0, 0]
    _, context = render(g, *ray_oracle.rays(60, 3))
    found = render_backward(context, np.ones((60, 3)))
    for name, array in found.gaussians.items():
        assert not array[3].any(), name
        assert array.any(), name
