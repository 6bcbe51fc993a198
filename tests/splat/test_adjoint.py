"""Derivatives of whole pictures, by everything, in double: differences, Taylor, mutants."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from photograd.capture.camera import Camera
from photograd.capture.frames import invert_rigid
from photograd.splats.splatting import (
    Gaussians,
    SplatOptions,
    render,
    render_backward,
    twist_gradient,
)
from photograd_course.gradcheck import check_gradient, taylor_slope

from support.gradient_mutants import check_gradient_mutants
from tests.splat import oracle

SMOOTH = SplatOptions().smooth()
BEHIND = np.array([0.2, 0.5, 0.9])


class Scene:
    """Gaussians, background and camera as groups of parameters, in the form the checks take."""

    def __init__(self, g: Gaussians, camera: Camera, options: SplatOptions = SMOOTH) -> None:
        self.camera, self.options = camera, options
        view = invert_rigid(camera.world_from_camera)[:3]
        self.place = {**g.arrays(), "background": BEHIND.copy(), "camera_from_world": view}

    def rendered(self, p: dict[str, Any]) -> Any:
        g = Gaussians(p["means"], p["log_scales"], p["quats"], p["opacity_logits"], p["sh"])
        return render(
            g,
            self.camera,
            background=p["background"],
            options=self.options,
            camera_from_world=p["camera_from_world"],
        )

    def forward(self, p: dict[str, Any]) -> dict[str, Any]:
        return dict(vars(self.rendered(p)[0]))

    def backward(self, p: dict[str, Any], d: dict[str, Any]) -> dict[str, Any]:
        _, context = self.rendered(p)
        found = render_backward(context, d["color"], d["opacity"], d["depth"])
        return {
            **found.gaussians,
            "background": found.background,
            "camera_from_world": found.camera_from_world,
        }


def off_screen() -> tuple[Gaussians, Camera]:
    """Wide Gaussians whose means lie outside of the picture and of the widened field of view."""
    camera, g = oracle.camera(turn=0.0), oracle.cloud(6, 11, size=-0.5)
    limit = camera.width / camera.fx * (0.52 + 0.15)  # of t_x / t_z
    side = np.array([1.2, 1.3, -1.25, -1.4, 1.1, 1.5])
    g.means[:, 0] = side * 3.0 * limit
    g.means[:, 2] = 0.1 * np.arange(6)
    g.means[::2, 1] = 1.3 * 3.0 * 0.9
    return g, camera


SCENES = {
    "degree 3": (*(oracle.cloud(12, 1), oracle.camera(20, 17, 17.0)), SMOOTH),
    "degree 0": (*(oracle.cloud(12, 2, degree=0), oracle.camera(20, 17, 17.0)), SMOOTH),
    "antialiased": (
        *(oracle.cloud(12, 3, size=-3.0), oracle.camera(20, 17, 17.0)),
        replace(SMOOTH, antialiased=True),
    ),
    "held by the field of view": (*off_screen(), SMOOTH),
}


@pytest.mark.parametrize("name", SCENES)
def test_every_group_agrees_with_differences(name: str) -> None:
    scene = Scene(*SCENES[name])
    report = check_gradient(scene.forward, scene.backward, scene.place, seed=3, coordinates=16)
    assert report, str(report)  # measured below 2e-9


def test_the_held_scene_is_held() -> None:
    g, camera = off_screen()
    t = g.means + np.array([0, 0, 3.0])
    limit_u = np.array([-0.52 - 0.15, 0.48 + 0.15]) * camera.width / camera.fx
    outside = (t[:, 0] / t[:, 2] < limit_u[0]) | (t[:, 0] / t[:, 2] > limit_u[1])
    assert outside.all()
    picture, context = render(g, camera, options=SMOOTH)
    assert context.visible.all()
    assert picture.opacity.max() > 0.01


def test_taylor_remainder_falls_quadratically() -> None:
    scene = Scene(*SCENES["degree 3"])
    report = taylor_slope(scene.forward, scene.backward, scene.place, seed=4)
    assert report, str(report)


def test_automatic_mutants_die() -> None:
    scene = Scene(oracle.cloud(5, 4, degree=1), oracle.camera(12, 9, 10.0))
    shapes = scene.forward(scene.place)
    g = np.random.default_rng(5)
    d = {name: g.uniform(0.5, 1.5, array.shape) for name, array in shapes.items()}
    report = check_gradient_mutants(
        scene.forward, scene.backward, scene.place, d, seed=6, coordinates=6, directions=4
    )
    assert report, str(report)


def test_gradients_with_cutoffs_are_those_of_the_cut_picture() -> None:
    # Away from the discontinuities the derivative exists: small steps cross none of them here, and
    # colors, which move none, need longer ones, or rounding drowns the difference.
    scene = Scene(oracle.cloud(12, 1), oracle.camera(20, 17, 17.0), SplatOptions())
    report = check_gradient(
        scene.forward,
        scene.backward,
        scene.place,
        seed=3,
        coordinates=8,
        steps=(1e-5, 1e-6, 1e-7, 1e-8),
    )
    assert report, str(report)
    smooth = Scene(oracle.cloud(12, 1), oracle.camera(20, 17, 17.0))
    d = {name: np.ones_like(a) for name, a in scene.forward(scene.place).items()}
    cut, whole = scene.backward(scene.place, d), smooth.backward(scene.place, d)
    for name in cut:
        # Measured: at most 3.6 %, of the pose.
        assert np.linalg.norm(cut[name] - whole[name]) < 0.06 * np.linalg.norm(whole[name]), name


def opaque(policy: Any) -> tuple[Scene, Any]:
    """Splats that alpha_max holds in some pixels."""
    g = oracle.cloud(4, 8, size=-0.7, spread=0.4)
    options = replace(SMOOTH, alpha_max=0.9, clamped_gradient=policy)
    return Scene(
        replace(g, opacity_logits=g.opacity_logits + 5), oracle.camera(12, 9, 10.0), options
    ), g


def test_the_clamp_of_alpha_has_derivative_zero_or_passes_it_as_named() -> None:
    right, _ = opaque("zero")
    assert check_gradient(right.forward, right.backward, right.place, seed=7)
    original, _ = opaque("pass")
    report = check_gradient(original.forward, original.backward, original.place, seed=7)
    assert not report
    assert max(group.error for group in report.groups) > 1e-3


def test_a_quaternions_length_has_no_gradient() -> None:
    scene = Scene(*SCENES["degree 3"])
    d = {name: np.ones_like(a) for name, a in scene.forward(scene.place).items()}
    d_q, q = scene.backward(scene.place, d)["quats"], scene.place["quats"]
    radial = (d_q * q).sum(1) / np.linalg.norm(q, axis=1)
    assert np.linalg.norm(d_q) > 0.1
    assert np.abs(radial).max() < 1e-12 * np.linalg.norm(d_q)


def test_a_twist_moves_the_camera_as_its_gradient_says() -> None:
    scene = Scene(*SCENES["degree 3"])
    view, g = scene.place["camera_from_world"], np.random.default_rng(2)
    d = {name: g.standard_normal(a.shape) for name, a in scene.forward(scene.place).items()}
    gradient = twist_gradient(scene.backward(scene.place, d)["camera_from_world"], view)

    def loss(twist: Any) -> float:
        angle = float(np.linalg.norm(twist[:3]))
        K = np.cross(np.eye(3), twist[:3] / angle)
        R = np.eye(3) + np.sin(angle) * K + (1 - np.cos(angle)) * K @ K
        moved = R @ view
        moved[:, 3] += twist[3:]
        out = scene.forward({**scene.place, "camera_from_world": moved})
        return float(sum((out[name] * d[name]).sum() for name in out))

    h = 1e-5
    for direction in g.standard_normal((3, 6)):
        slope = (loss(h * direction) - loss(-h * direction)) / (2 * h)
        assert slope == pytest.approx(float(gradient @ direction), rel=1e-6)


def test_screen_gradients_are_per_pixel_of_the_projected_mean() -> None:
    # Moving the principal point moves all projected means by as much, and nothing else.
    g, camera = oracle.cloud(12, 1, degree=0), oracle.camera(20, 17, 17.0)
    _, context = render(g, camera, options=SMOOTH)
    random = np.random.default_rng(3)
    d = random.standard_normal((17, 20, 3))
    screen = render_backward(context, d).screen.sum(0)
    # The field of view's limits move with it, but hold none of these means.
    h = 1e-5
    for axis, name in enumerate(("cx", "cy")):
        values = []
        for sign in (1, -1):
            moved = replace(camera, **{name: getattr(camera, name) + sign * h})
            values.append(float((render(g, moved, options=SMOOTH)[0].color * d).sum()))
        assert (values[0] - values[1]) / (2 * h) == pytest.approx(screen[axis], rel=1e-6)


def test_what_is_not_in_the_picture_has_no_gradient() -> None:
    g, camera = oracle.cloud(12, 1), oracle.camera(20, 17, 17.0)
    behind = camera.world_from_camera @ [0, 0, -1.0, 1]
    g.means[3] = behind[:3]
    _, context = render(g, camera)
    found = render_backward(context, np.ones((17, 20, 3)))
    assert not context.visible[3]
    for name, array in found.gaussians.items():
        assert not array[3].any(), name
        assert array.any(), name
