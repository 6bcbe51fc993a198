"""What the figures of assignment 11 draw: scenes, measurements, pieces of pictures."""

import numpy as np
from matplotlib.patches import Circle
from photograd_course.build.kit_module import kit_module
from photograd_course.viz.style import FRAME, signed_color_map

TEAPOT = kit_module("11_spherical_harmonics", "teapot")
FIGURE_1 = kit_module("11_spherical_harmonics", "figure_1")
rate, seen = FIGURE_1.rate, FIGURE_1.seen


def ball(n):
    """Directions of the front half of a ball, seen along +y from y = -1, and which pixels."""
    x, z = np.meshgrid(np.linspace(-1, 1, n), np.linspace(1, -1, n))
    inside = x**2 + z**2 < 1
    y = -np.sqrt(np.maximum(1 - x**2 - z**2, 0))
    return np.stack([x, y, z], axis=-1)[inside], inside


def show_ball(axes, values, inside, top):
    picture = np.full(inside.shape, np.nan)
    picture[inside] = values
    image = axes.imshow(
        picture,
        cmap=signed_color_map(),
        vmin=-top,
        vmax=top,
        extent=(-1, 1, -1, 1),
        interpolation="nearest",
    )
    rim = Circle((0, 0), 0.985, facecolor="none", edgecolor=FRAME, linewidth=0.9)
    axes.add_patch(rim)
    image.set_clip_path(rim)
    axes.set_axis_off()
    return image


def direction_map(rows):
    """Directions (N, 3) of an equal-area map of the sphere: angle to the right, z up."""
    z = 1 - (np.arange(rows) + 0.5) * 2 / rows
    phi = (np.arange(2 * rows) + 0.5) * np.pi / rows
    z, phi = np.meshgrid(z, phi, indexing="ij")
    r = np.sqrt(1 - z * z)
    return np.stack([r * np.cos(phi), r * np.sin(phi), z], axis=-1).reshape(-1, 3), z.shape


LIGHT = np.array([0.48, 0.64, 0.6])


def sky(d, sharp=25.0, pale=0.3):
    """Radiance (N, 1): pale above, dark below, and a light, smaller for a larger exponent."""
    return pale * (0.35 + 0.3 * d[:, 2:] ** 3) + 4 * np.exp(sharp * (d @ LIGHT[:, None] - 1))


def ball_scene(module, n, light):
    """A glossy ball: density (n, n, n) and coefficients."""
    x = (np.stack(np.indices((n, n, n)), axis=-1) + 0.5) / n * 2 - 1
    away = np.linalg.norm(x, axis=-1)
    normal = x / (away[..., None] + 1e-12)
    facing = normal @ light
    mirrored = 2 * facing[..., None] * normal - light
    c = module.sh_basis(mirrored.reshape(-1, 3), 2) * np.repeat([0.9, 0.8, 0.6], [1, 3, 5])
    c = c.reshape(n, n, n, 9, 1)
    c[..., 0, 0] += 2.5 * (0.3 + 0.5 * np.maximum(facing, 0))
    return 8 * np.clip((0.6 - away) * n / 3 + 0.5, 0, 1), c
