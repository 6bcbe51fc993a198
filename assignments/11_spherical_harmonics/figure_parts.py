"""What the figures of assignment 11 draw: scenes, measurements, pieces of pictures."""

import numpy as np
from matplotlib.patches import Circle
from photograd_course.captures import all_around, rays_to_origin
from photograd_course.viz.style import FRAME, signed_color_map


def seen(module, volume, rays):
    return module.render(*volume, module.march(volume[0].shape, rays))


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


def ball_scene(module, n, light, second=False):
    """A glossy ball, perhaps with a second one: density (n, n, n) and coefficients."""
    x = (np.stack(np.indices((n, n, n)), axis=-1) + 0.5) / n * 2 - 1
    centers = [np.zeros(3)] if not second else [np.array([-0.25, 0.1, 0.0]), np.array([0.4, 0, 0])]
    radii = [0.6] if not second else [0.45, 0.3]
    away = [np.linalg.norm(x - center, axis=-1) for center in centers]
    inside = [np.clip((r - a) * n / 3 + 0.5, 0, 1) for r, a in zip(radii, away, strict=True)]
    which = np.argmax(inside, axis=0)
    normal = x - np.array(centers)[which]
    normal = normal / (np.linalg.norm(normal, axis=-1, keepdims=True) + 1e-12)
    facing = normal @ light
    mirrored = 2 * facing[..., None] * normal - light
    c = module.sh_basis(mirrored.reshape(-1, 3), 2) * np.repeat([0.9, 0.8, 0.6], [1, 3, 5])
    c = c.reshape(n, n, n, 9, 1)
    c[..., 0, 0] += np.array([2.5, 1.4])[which] * (0.3 + 0.5 * np.maximum(facing, 0))
    return 8 * np.max(inside, axis=0), c


def photographs(views, pixels, twist=0.0):
    """Rays of cameras spread evenly all around, that look at the middle."""
    positions = 3.2 * all_around(views, 2 * np.pi * twist)
    return rays_to_origin(positions, pixels, np.tan(0.375))


def dilated(mask):
    """A mask and all cells next to it."""
    grown = mask.copy()
    for axis in range(3):
        for step in (1, -1):
            grown |= np.roll(mask, step, axis)
    return grown
