"""Small captures seen from twelve sides: a striped ball, a cloud of Gaussians."""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np
from photograd.capture.capture import Capture
from photograd.capture.orbit import orbit_cameras
from photograd.capture.view import View
from photograd.splats.splatting import Gaussians, render

COLOR = (0.8, 0.4, 0.2)
RADIUS = 0.5
SIZE = 40


@cache
def ball_capture(size: int = SIZE) -> Capture:
    """Ten training views and two held out; display values, striped in height."""
    box = np.array([[-0.6, -0.6, -0.6], [0.6, 0.6, 0.6]])
    views = []
    for turn, elevation in ((6, 30.0), (6, -30.0)):
        for camera in orbit_cameras(box, turn, size=size, elevation=elevation):
            origins, directions = camera.rays()
            along = -(origins * directions).sum(axis=1)
            nearest = origins + along[:, None] * directions
            miss = RADIUS**2 - (nearest**2).sum(axis=1)
            hit = nearest - np.sqrt(np.maximum(miss, 0))[:, None] * directions
            pixels = np.zeros((size * size, 4), np.float32)
            stripes = np.where(np.sin(12 * hit[:, 1:2]) > 0, 1.2, 0.8)
            pixels[:, :3] = np.array(COLOR) * stripes
            pixels[:, 3] = miss > 0
            views.append(
                View(f"{elevation:+.0f}_{len(views)}", camera, pixels.reshape(size, size, 4))
            )
    return Capture(
        train=tuple(views[:5] + views[6:11]),
        test=(views[5], views[11]),
        format="test",
        source=Path("ball"),
        color_space="display",
        has_alpha=True,
    )


@cache
def cloud_capture(size: int = SIZE) -> Capture:
    """Forty Gaussians of many colors in the same places of views, which Gaussians can explain."""
    g = np.random.default_rng(11)
    truth = Gaussians(
        means=g.uniform(-0.4, 0.4, (40, 3)),
        log_scales=np.log(0.1) + 0.3 * g.normal(size=(40, 3)),
        quats=g.normal(size=(40, 4)),
        opacity_logits=g.uniform(0, 3, 40),
        sh=g.uniform(-1.7, 1.7, (40, 1, 3)),
    )
    ball = ball_capture(size)
    return replace(
        ball,
        train=tuple(_painted(view, truth) for view in ball.train),
        test=tuple(_painted(view, truth) for view in ball.test),
    )


def _painted(view: View, truth: Gaussians) -> View:
    """What the view's camera sees of the Gaussians, with straight alpha."""
    picture, _ = render(truth, view.camera)
    alpha = picture.opacity[..., None]
    straight = np.clip(picture.color / np.maximum(alpha, 1e-6), 0, 1)
    return replace(view, image=np.concatenate([straight, alpha], axis=-1).astype(np.float32))
