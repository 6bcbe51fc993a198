"""What the captions of docs/images/derivative.png and caustic.png say."""

from __future__ import annotations

import sys

import numpy as np
from photograd.capture.camera import Camera
from photograd.transport import PathTracer

from support.tree import ROOT

sys.path.insert(0, str(ROOT / "docs"))
import figures_caustic as caustic
import figures_derivative as derivative


def test_what_one_number_does_to_every_pixel() -> None:
    _, found = derivative.derivatives(24, 64)
    wall, tint, roughness = (
        found[name] for name in (derivative.WALL, derivative.TINT, derivative.ROUGHNESS)
    )
    # No path is a falling function of a color; nearly every pixel has one by the wall.
    assert wall.min() >= 0
    assert tint.min() >= 0
    assert (wall > 0).mean() > 0.95
    # Brightest on the wall itself, at the left.
    assert wall[:, :5].mean() > 3 * wall[:, 5:].mean()
    # The glass is in the lower right; its tint counts there.
    assert tint[12:, 12:].sum() > 0.6 * tint.sum()
    # On the copper ball in the lower left both signs are strong, elsewhere little changes.
    ball = roughness[10:22, 3:13]
    up, down = ball[ball > 0].sum(), -ball[ball < 0].sum()
    assert min(up, down) > 0.5 * max(up, down)  # 0.79
    assert np.abs(ball).mean() > 4 * np.abs(roughness[:, 13:]).mean()


def test_camera_paths_leave_the_shadow_empty_and_particles_fill_it() -> None:
    tracer = PathTracer(caustic.scene(8))
    landed = caustic.table_irradiance(tracer, 20, 1 << 18).mean.sum(axis=2)
    # The middle of the shadow, on the line from the light through the ball.
    towards = caustic.CENTER - caustic.LAMP
    middle = caustic.LAMP - towards * (caustic.LAMP[1] / towards[1])
    to_table = middle[[0, 2]]
    column, row = ((to_table + caustic.HALF) / (2 * caustic.HALF) * 20).astype(int)
    open_table = landed[17:, :4].mean()
    assert open_table > 0
    gathered = landed[row - 1 : row + 2, column - 1 : column + 2].max()
    assert gathered > 3 * open_table
    # A camera close above the patch sees what the table sends through the ball, and no more.
    pose = np.array([[1.0, 0, 0, middle[0]], [0, 0, -1, 0.05], [0, 1, 0, middle[2]], [0, 0, 0, 1]])
    camera = Camera(4, 4, 4.0, 4.0, 2.0, 2.0, pose)  # 5 cm of the shadow
    radiance = tracer.render(spp=256, seed=1, camera=camera).mean.sum(axis=2)
    assert 0 < radiance.max() * np.pi / 0.68 < 0.05 * gathered
